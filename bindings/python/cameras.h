// SPDX-License-Identifier: Apache-2.0
// slf.Camera of Python and slf::Camera.
#pragma once

#include "arrays.h"
#include "slf/capture.h"
#include "slf/rotation.h"

namespace slf::python {

/// @throws ValueError where K has an entry that slf::Camera has no place for
inline void check_pinhole(const Array<double>& k) {
  if (!(k.at(0, 0) > 0 && k.at(1, 1) > 0)) throw py::value_error("K has no focal length");
  // Calibrations leave a skew that is not quite 0: a millionth of the focal length moves no pixel.
  const double no_skew = 1e-6 * k.at(0, 0);
  if (!(std::abs(k.at(0, 1)) <= no_skew && std::abs(k.at(1, 0)) <= no_skew && k.at(2, 0) == 0 &&
        k.at(2, 1) == 0 && k.at(2, 2) == 1))
    throw py::value_error("K is not [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]");
}

/// @throws ValueError where a shape or a size is wrong, a value is not finite, K is no pinhole
///         camera's, or R is not a rotation
inline Camera camera_of(const py::object& from) {
  const auto matrix = [&](const char* name, std::vector<py::ssize_t> shape) {
    auto array = array_of<double>(from.attr(name), name);
    check_shape(array, shape, name);
    for (py::ssize_t i = 0; i < array.size(); ++i)
      if (!std::isfinite(array.data()[i]))
        throw py::value_error(std::string(name) + " is not finite");
    return array;
  };
  const auto pixels = [&](const char* name) {  // 0 for what is no whole number
    py::detail::make_caster<int> whole;
    return whole.load(from.attr(name), false) ? py::detail::cast_op<int>(whole) : 0;
  };
  Camera camera;
  camera.name = static_cast<std::string>(py::str(from.attr("name")));
  camera.width = pixels("width");
  camera.height = pixels("height");
  constexpr int kMost = 16384;
  if (camera.width < 1 || camera.height < 1 || camera.width > kMost || camera.height > kMost)
    throw py::value_error("width and height of a camera are 1 to 16384");
  const auto k = matrix("K", {3, 3}), r = matrix("R", {3, 3}), t = matrix("t", {3});
  const auto distortion = matrix("distortion", {4});
  check_pinhole(k);
  camera.fx = k.at(0, 0);
  camera.fy = k.at(1, 1);
  camera.cx = k.at(0, 2);
  camera.cy = k.at(1, 2);
  for (py::ssize_t i = 0; i < 3; ++i) {
    for (py::ssize_t j = 0; j < 3; ++j)
      camera.rotation[std::size_t(i)][std::size_t(j)] = r.at(i, j);
    camera.translation[std::size_t(i)] = t.at(i);
  }
  if (!is_rotation(camera.rotation)) throw py::value_error("R is not a rotation");
  for (py::ssize_t i = 0; i < 4; ++i) camera.distortion[std::size_t(i)] = distortion.at(i);
  return camera;
}

inline py::dict dict_of(const Camera& camera) {
  using namespace py::literals;
  py::array_t<double> k({3, 3}), r({3, 3}), t(3);
  std::fill_n(k.mutable_data(), 9, 0.0);
  k.mutable_at(0, 0) = camera.fx;
  k.mutable_at(1, 1) = camera.fy;
  k.mutable_at(0, 2) = camera.cx;
  k.mutable_at(1, 2) = camera.cy;
  k.mutable_at(2, 2) = 1;
  for (py::ssize_t i = 0; i < 3; ++i) {
    for (py::ssize_t j = 0; j < 3; ++j)
      r.mutable_at(i, j) = camera.rotation[std::size_t(i)][std::size_t(j)];
    t.mutable_at(i) = camera.translation[std::size_t(i)];
  }
  return py::dict("width"_a = camera.width, "height"_a = camera.height, "K"_a = k, "R"_a = r,
                  "t"_a = t, "distortion"_a = camera.distortion, "name"_a = camera.name);
}

}  // namespace slf::python
