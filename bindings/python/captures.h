// SPDX-License-Identifier: Apache-2.0
// slf.Capture of Python and slf::Capture.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "arrays.h"
#include "cameras.h"
#include "slf/capture.h"

namespace slf::python {

template <class T, std::size_t N>
void copy_rows(const Array<T>& from, std::vector<std::array<T, N>>& to) {
  to.resize(static_cast<std::size_t>(from.shape(0)));
  for (std::size_t i = 0; i < to.size(); ++i)
    for (std::size_t k = 0; k < N; ++k) to[i][k] = from.data()[N * i + k];
}

/// The mean, rounded: floats from there keep their digits.
inline Vec3 middle(const Array<double>& points) {
  Vec3 mean{0, 0, 0};
  const auto count = static_cast<std::size_t>(points.shape(0));
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < 3; ++k) mean[k] += points.data()[3 * i + k] / double(count);
  for (double& c : mean) c = std::abs(c) > 1000 ? std::round(c) : 0;
  return mean;
}

inline Image photograph_of(const py::handle& given, const Camera& camera) {
  const auto array = array_of<std::uint8_t>(py::reinterpret_borrow<py::object>(given), "images");
  if (array.ndim() != 3 || array.shape(0) != camera.height || array.shape(1) != camera.width ||
      (array.shape(2) != 3 && array.shape(2) != 4))
    throw py::value_error("an image is uint8 [height, width, 3 or 4], as large as its camera says");
  Image image{camera.width, camera.height, static_cast<int>(array.shape(2)), {}};
  image.data.assign(array.data(), array.data() + array.size());
  return image;
}

/// The capture of a slf.Capture, whose arrays are copied.
/// @throws ValueError where they do not fit together
inline Capture capture_of(const py::object& from) {
  Capture capture;
  const auto points = array_of<double>(from.attr("points"), "points");
  check_shape(points, {-1, 3}, "points");
  capture.origin = middle(points);
  for (py::ssize_t i = 0; i < points.shape(0); ++i)
    capture.cloud.positions.push_back({float(points.at(i, 0) - capture.origin[0]),
                                       float(points.at(i, 1) - capture.origin[1]),
                                       float(points.at(i, 2) - capture.origin[2])});
  if (const py::object given = from.attr("normals"); !given.is_none()) {
    const auto normals = array_of<float>(given, "normals");
    check_shape(normals, {points.shape(0), 3}, "normals");
    copy_rows(normals, capture.cloud.normals);
  }
  if (const py::object given = from.attr("colours"); !given.is_none()) {
    const auto colours = array_of<std::uint8_t>(given, "colours");
    check_shape(colours, {points.shape(0), 3}, "colours");
    copy_rows(colours, capture.cloud.colours);
  }
  for (const py::handle camera : from.attr("cameras"))
    capture.cameras.push_back(moved(camera_of(py::reinterpret_borrow<py::object>(camera)),
                                    {-capture.origin[0], -capture.origin[1], -capture.origin[2]}));
  std::size_t i = 0;
  for (const py::handle image : from.attr("images")) {
    if (i == capture.cameras.size()) throw py::value_error("there are more images than cameras");
    capture.images.push_back(photograph_of(image, capture.cameras[i++]));
  }
  if (i != capture.cameras.size()) throw py::value_error("there are more cameras than images");
  capture.image_files.resize(capture.cameras.size());
  capture.up = static_cast<UpAxis>(from.attr("up_index").cast<int>());
  return capture;
}

}  // namespace slf::python
