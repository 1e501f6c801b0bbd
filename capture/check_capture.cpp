// SPDX-License-Identifier: Apache-2.0
#include "capture/check_capture.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/vec3.h"
#include "slf/rotation.h"

namespace slf {

namespace {

constexpr double kMaxPrincipalOffset = 0.1;   // of the image's size; more is suspicious
constexpr std::size_t kCheckedPoints = 4096;  // for warnings; an error looks at all points

InputError invalid(const std::string& where, const std::string& cause) {
  return {Errc::kInvalidInput, where + ": " + cause};
}

bool all_finite(const Camera& camera) {
  bool finite = std::isfinite(camera.fx) && std::isfinite(camera.fy) && std::isfinite(camera.cx) &&
                std::isfinite(camera.cy);
  for (const double d : camera.distortion) finite = finite && std::isfinite(d);
  for (const auto& row : camera.rotation)
    for (const double r : row) finite = finite && std::isfinite(r);
  for (const double t : camera.translation) finite = finite && std::isfinite(t);
  return finite;
}

Result<Done, InputError> check_rotation(const RotationRows& r, const std::string& label) {
  if (!is_orthonormal(r))
    return invalid(label, "the rotation is not orthonormal: leave a scale out of it");
  if (determinant(r) < 0)
    return invalid(label,
                   "the rotation mirrors (determinant -1): left-handed axes (Unity, Unreal) are to "
                   "be converted before");
  return Done{};
}

bool principal_point_is_far_off(const Camera& camera) {
  return std::abs(camera.cx - 0.5 * camera.width) > kMaxPrincipalOffset * camera.width ||
         std::abs(camera.cy - 0.5 * camera.height) > kMaxPrincipalOffset * camera.height;
}

// What a set of points looks like to the cameras.
struct Survey {
  std::size_t in_front = 0, in_view = 0, points = 0;  // by or to any camera
  std::vector<bool> camera_sees;
};

Survey survey(const Capture& capture, std::size_t stride) {
  Survey result;
  result.camera_sees.resize(capture.cameras.size());
  for (std::size_t p = 0; p < capture.cloud.positions.size(); p += stride) {
    const Vec3 point = to_double(capture.cloud.positions[p]);
    bool in_front = false, in_view = false;
    for (std::size_t c = 0; c < capture.cameras.size(); ++c) {
      const auto& camera = capture.cameras[c];
      double z = 0;
      const auto image = camera.project(point, &z);
      in_front = in_front || z > 0;
      if (!image || (*image)[0] < 0 || (*image)[1] < 0 || (*image)[0] > camera.width ||
          (*image)[1] > camera.height)
        continue;
      in_view = true;
      result.camera_sees[c] = true;
    }
    result.in_front += in_front;
    result.in_view += in_view;
    ++result.points;
  }
  return result;
}

InputError outside_error(const Survey& all, const std::string& cloud_name) {
  if (all.in_front == 0)
    return invalid(cloud_name,
                   "every point is behind every camera; are the camera axes those of the format?");
  return invalid(cloud_name,
                 "no point is inside the frustum of any camera; are cloud and cameras in one "
                 "world? --points-world turns, "
                 "scales and shifts the points");
}

// A float has 24 bits: fewer than 11 of them may be left for the extent of the cloud.
bool far_from_origin(const PointCloud& cloud) {
  float magnitude = 0, extent = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    float low = cloud.positions[0][k], high = low;
    for (const auto& p : cloud.positions) {
      low = std::min(low, p[k]);
      high = std::max(high, p[k]);
    }
    magnitude = std::max({magnitude, std::abs(low), std::abs(high)});
    extent = std::max(extent, high - low);
  }
  return extent > 0 && magnitude > 8192 * extent;  // all in one place: there is nothing to resolve
}

}  // namespace

Result<Done, InputError> check_camera(const Camera& camera, const std::string& label) {
  if (!all_finite(camera)) return invalid(label, "a calibration value is not finite");
  const auto size = std::to_string(camera.width) + " x " + std::to_string(camera.height);
  if (camera.width < 1 || camera.height < 1 || camera.width > 65535 || camera.height > 65535)
    return invalid(label, "image size " + size + " is out of range");
  if (!(camera.fx > 0 && camera.fy > 0))
    return invalid(label, "the focal length is not positive: it is in pixels");
  return check_rotation(camera.rotation, label);
}

Result<Done, InputError> check_cameras(Import& import) {
  auto& capture = import.capture;
  std::set<std::string> names;
  std::size_t far_off = 0;
  for (std::size_t i = 0; i < capture.cameras.size(); ++i) {
    SLF_CHECK(check_camera(capture.cameras[i], import.labels[i]));
    if (!names.insert(capture.cameras[i].name).second)
      return invalid(import.labels[i], "image '" + capture.cameras[i].name + "' twice");
    far_off += principal_point_is_far_off(capture.cameras[i]);
  }
  if (far_off > 0)
    capture.warnings.push_back(std::to_string(far_off) + " of " +
                               std::to_string(capture.cameras.size()) +
                               " cameras have a principal point more than 10 % off the centre");
  return Done{};
}

Result<Done, InputError> check_cloud(Capture& capture, const std::string& cloud_name) {
  const std::size_t count = capture.cloud.positions.size();
  if (count == 0) return invalid(cloud_name, "no points");
  auto& warnings = capture.warnings;
  if (far_from_origin(capture.cloud))
    warnings.push_back(cloud_name + ": far from the origin for its size: positions are coarse");
  if (capture.cloud.normals.empty() && !capture.cameras.empty())
    warnings.push_back(cloud_name + ": no normals: they are estimated");
  if (capture.cameras.empty()) return Done{};

  const Survey sample = survey(capture, std::max<std::size_t>(count / kCheckedPoints, 1));
  if (sample.in_view == 0) {
    const Survey all = survey(capture, 1);
    if (all.in_view == 0) return outside_error(all, cloud_name);
  }
  const auto blind = std::count(sample.camera_sees.begin(), sample.camera_sees.end(), false);
  if (blind > 0)
    warnings.push_back(std::to_string(blind) + " of " + std::to_string(capture.cameras.size()) +
                       " cameras do not see the cloud; are the camera axes those of the format? "
                       "--points-world turns, scales and shifts the points");
  if (sample.in_view < sample.points / 2)
    warnings.push_back(cloud_name +
                       ": more than half of the points are in no camera's view (--crop leaves them "
                       "out; --points-world moves them)");
  return Done{};
}

UpAxis up_of(const std::vector<Camera>& cameras, UpAxis otherwise) {
  if (cameras.empty()) return otherwise;
  Vec3 up{0, 0, 0};  // mean of the cameras' -y axes
  for (const auto& camera : cameras)
    for (std::size_t k = 0; k < 3; ++k)
      up[k] -= camera.rotation[1][k] / static_cast<double>(cameras.size());
  std::array<std::size_t, 3> axis{0, 1, 2};
  std::sort(axis.begin(), axis.end(),
            [&](std::size_t a, std::size_t b) { return std::abs(up[a]) > std::abs(up[b]); });
  const double most = std::abs(up[axis[0]]), second = std::abs(up[axis[1]]);
  if (!(most >= 0.3 && most >= 1.5 * second)) return otherwise;
  return static_cast<UpAxis>(2 * axis[0] + (up[axis[0]] < 0 ? 1 : 0));  // +x, -x, +y, ...
}

}  // namespace slf
