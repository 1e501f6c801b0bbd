// SPDX-License-Identifier: Apache-2.0
#include "capture/transforms_intrinsics.h"

#include <array>
#include <cmath>

#include "capture/json_numbers.h"
#include "capture/radial_distortion.h"

namespace slf {

namespace {

constexpr double kPi = 3.14159265358979323846;

using Number = std::optional<double>;

Result<Number, InputError> number_at(const JsonView& json, const char* name) {
  const auto found = json.find(name);
  if (!found) return Number{};
  SLF_TRY(const double value, found->number());
  return Number{value};
}

// The frame's, else the document's, else a default.
Result<double, InputError> number_of(const JsonView& frame, const JsonView& document,
                                     const char* name, double otherwise) {
  for (const JsonView* json : {&frame, &document}) {
    SLF_TRY(const Number value, number_at(*json, name));
    if (value) return *value;
  }
  return otherwise;
}

// How one object spells the focal length along one axis.
struct FocalNames {
  const char* pixels;
  const char* radians;
  const char* degrees;
};
constexpr FocalNames kFocalX{"fl_x", "camera_angle_x", "x_fov"};
constexpr FocalNames kFocalY{"fl_y", "camera_angle_y", "y_fov"};

Result<Number, InputError> focal_in(const JsonView& json, const FocalNames& names, int pixels) {
  SLF_TRY(const Number focal, number_at(json, names.pixels));
  if (focal) return focal;
  SLF_TRY(Number angle, number_at(json, names.radians));
  SLF_TRY(const Number degrees, number_at(json, names.degrees));
  if (!angle && degrees) angle = *degrees * kPi / 180;
  if (!angle) return Number{};
  if (!(*angle > 0 && *angle < kPi))
    return json.error(std::string(names.radians) +
                      ": a field of view between 0 and 180 degrees is needed");
  return Number{0.5 * pixels / std::tan(0.5 * *angle)};
}

Result<Done, InputError> read_focal(const JsonView& frame, const JsonView& document,
                                    Camera& camera) {
  // A frame that gives but one axis means square pixels, whatever the document says of the other.
  for (const JsonView* json : {&frame, &document}) {
    SLF_TRY(const Number x, focal_in(*json, kFocalX, camera.width));
    SLF_TRY(const Number y, focal_in(*json, kFocalY, camera.height));
    if (!x && !y) continue;
    camera.fx = x ? *x : *y;
    camera.fy = y ? *y : *x;
    return Done{};
  }
  return frame.error(
      "no focal length: neither fl_x (pixels) nor camera_angle_x (radians); add one");
}

// Refuses what Brown distortion with k1, k2, p1, p2 does not express.
Result<Done, InputError> check_model(const JsonView& frame, const JsonView& document) {
  for (const JsonView* json : {&frame, &document}) {
    const auto model = json->find("camera_model");
    if (!model) continue;
    SLF_TRY(const auto name, model->string());
    bool known = false;
    for (const char* supported :
         {"PINHOLE", "SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL", "OPENCV", "PERSPECTIVE"})
      known = known || name == supported;
    if (!known)
      return model->error("camera model " + name +
                          " is not supported: undistort the photographs (colmap "
                          "image_undistorter)");
    break;
  }
  for (const JsonView* json : {&frame, &document}) {
    if (const auto fisheye = json->find("is_fisheye")) {
      SLF_TRY(const bool is, fisheye->boolean());
      if (is)
        return fisheye->error(
            "fisheye cameras are not supported: undistort the photographs (colmap "
            "image_undistorter)");
      break;  // a frame may take back what the document says
    }
  }
  for (const char* name : {"ftheta_p0", "latlong", "equirectangular"})
    if (frame.find(name) || document.find(name))
      return frame.error(std::string("cameras with '") + name + "' are not supported");
  for (const char* name : {"k5", "k6"}) {
    SLF_TRY(const double k, number_of(frame, document, name, 0));
    if (k != 0)
      return frame.error(std::string("distortion ") + name +
                         " is not supported; only k1 to k4, p1, p2");
  }
  return Done{};
}

}  // namespace

Result<Done, InputError> read_transforms_intrinsics(const JsonView& frame, const JsonView& document,
                                                    Camera& camera, double& worst) {
  SLF_CHECK(check_model(frame, document));
  SLF_CHECK(read_focal(frame, document, camera));
  SLF_TRY(camera.cx, number_of(frame, document, "cx", 0.5 * camera.width));
  SLF_TRY(camera.cy, number_of(frame, document, "cy", 0.5 * camera.height));
  SLF_TRY(camera.distortion[2], number_of(frame, document, "p1", 0));
  SLF_TRY(camera.distortion[3], number_of(frame, document, "p2", 0));
  // As nerfstudio's camera_utils has them: k3 of r^6, k4 of r^8.
  RadialTerms radial{};
  constexpr std::array<const char*, 4> kNames{"k1", "k2", "k3", "k4"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    SLF_TRY(radial[i], number_of(frame, document, kNames[i], 0));
  }
  return set_radial(radial, frame.error("camera").message, camera, worst);
}

Result<std::optional<ImageSize>, InputError> read_transforms_size(const JsonView& frame,
                                                                  const JsonView& document) {
  std::array<std::optional<int>, 2> sides;
  for (std::size_t i = 0; i < 2; ++i) {
    const char* name = i == 0 ? "w" : "h";
    auto found = frame.find(name);
    if (!found) found = document.find(name);
    if (!found) continue;
    SLF_TRY(sides[i], json_size(*found));
  }
  using Size = std::optional<ImageSize>;
  if (!sides[0] || !sides[1]) return Size{};
  return Size{
      ImageSize{static_cast<std::uint32_t>(*sides[0]), static_cast<std::uint32_t>(*sides[1])}};
}

}  // namespace slf
