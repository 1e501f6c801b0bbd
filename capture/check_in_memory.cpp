// SPDX-License-Identifier: Apache-2.0
// A capture that a program made: whether its parts go together.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "base/shortest.h"
#include "base/vec3.h"
#include "capture/check_capture.h"
#include "slf/capture.h"

namespace slf {
namespace {

InputError wrong(const std::string& what) { return {Errc::kInvalidInput, "capture: " + what}; }

/// A vector with an entry for each of so many, or an empty one.
Result<Done, InputError> check_count(const char* name, std::size_t count, std::size_t of,
                                     const char* what) {
  if (count == 0 || count == of) return Done{};
  return wrong(std::string(name) + ": " + std::to_string(count) + " of " + std::to_string(of) +
               " " + what);
}

/// Nothing beyond can be drawn, and squares of it are no finite floats.
Result<Done, InputError> check_place(const std::string& what, const Vec3& place,
                                     const Vec3& origin) {
  for (std::size_t k = 0; k < 3; ++k)
    if (!(std::abs(place[k] + origin[k]) <= Grid::kMostCoordinate))
      return wrong(what + " has a coordinate of " + shortest(place[k] + origin[k]) +
                   ": places are within 1e12 of 0");
  return Done{};
}

Result<Done, InputError> check_points(const PointCloud& cloud, const std::string& of,
                                      const Vec3& origin) {
  const std::size_t points = cloud.positions.size();
  SLF_CHECK(check_count((of + "normals").c_str(), cloud.normals.size(), points, "points"));
  SLF_CHECK(check_count((of + "colours").c_str(), cloud.colours.size(), points, "points"));
  const auto is_finite = [](const auto& row) {
    return std::all_of(row.begin(), row.end(), [](float x) { return std::isfinite(x); });
  };
  for (std::size_t p = 0; p < points; ++p)
    if (!is_finite(cloud.positions[p]) || (!cloud.normals.empty() && !is_finite(cloud.normals[p])))
      return wrong(of + "point " + std::to_string(p) + " has a value that is not finite");
  for (std::size_t p = 0; p < points; ++p)
    SLF_CHECK(
        check_place(of + "point " + std::to_string(p), to_double(cloud.positions[p]), origin));
  return Done{};
}

Result<Done, InputError> check_faces(const Mesh& mesh) {
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    for (const std::uint32_t vertex : mesh.triangles[f])
      if (vertex >= mesh.vertices.positions.size())
        return wrong("mesh: face " + std::to_string(f) + " has vertex " + std::to_string(vertex) +
                     " of " + std::to_string(mesh.vertices.positions.size()));
  return Done{};
}

Result<Done, InputError> check_image(const Image& image, const std::string& name) {
  if (image.width < 1 || image.height < 1 || (image.channels != 3 && image.channels != 4))
    return wrong(name + ": an image has 3 or 4 channels, and pixels");
  const std::size_t bytes = static_cast<std::size_t>(image.width) *
                            static_cast<std::size_t>(image.height) *
                            static_cast<std::size_t>(image.channels);
  if (image.data.size() == bytes) return Done{};
  return wrong(name + ": an image of " + std::to_string(bytes) + " bytes has " +
               std::to_string(image.data.size()));
}

}  // namespace

Result<Done, InputError> check_capture(const Capture& capture, std::span<const int> cameras) {
  const std::size_t count = capture.cameras.size();
  for (const int camera : cameras)
    if (camera < 0 || static_cast<std::size_t>(camera) >= count)
      return InputError{Errc::kInvalidArgument, "camera " + std::to_string(camera) +
                                                    ": the capture has " + std::to_string(count)};
  for (const Camera& camera : capture.cameras) {
    const std::string name = "camera '" + camera.name + "'";
    SLF_CHECK(check_camera(camera, name));
    SLF_CHECK(check_place(name, camera.centre(), capture.origin));
  }
  const std::size_t images =
      capture.images.empty() ? capture.image_files.size() : capture.images.size();
  if (images != count)
    return wrong(std::to_string(images) + " images of " + std::to_string(count) + " cameras");
  SLF_CHECK(check_count("mask_files", capture.mask_files.size(), count, "cameras"));
  SLF_CHECK(check_count("orientation", capture.orientation.size(), count, "cameras"));
  SLF_CHECK(check_count("reduction", capture.reduction.size(), count, "cameras"));
  SLF_CHECK(check_count("gains", capture.gains.size(), count, "cameras"));
  for (std::size_t i = 0; i < capture.images.size(); ++i)
    SLF_CHECK(check_image(capture.images[i], "camera '" + capture.cameras[i].name + "'"));
  SLF_CHECK(check_points(capture.cloud, "", capture.origin));
  SLF_CHECK(check_points(capture.mesh.vertices, "mesh: ", capture.origin));
  return check_faces(capture.mesh);
}

}  // namespace slf
