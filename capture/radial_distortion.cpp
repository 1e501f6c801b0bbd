// SPDX-License-Identifier: Apache-2.0
#include "capture/radial_distortion.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace slf {

namespace {

constexpr int kSteps = 512;    // along the radius
constexpr double kWidest = 8;  // tangents: no lens of this model looks further aside
constexpr double kMostMiss = 1, kMostShare = 1.0 / 2000;  // pixels; of the longer side
constexpr double kSeenMiss = 0.1;

/// By how much the lens moves a point outwards from r.
double bend(const RadialTerms& k, double r) {
  const double s = r * r;
  return r * s * (k[0] + s * (k[1] + s * (k[2] + s * k[3])));
}

/// The undistorted radius whose distorted one is that of the farthest corner.
std::optional<double> corner_radius(const RadialTerms& k, const Camera& camera) {
  double corner = 0;
  for (const double x : {0.0, double(camera.width)})
    for (const double y : {0.0, double(camera.height)})
      corner =
          std::max(corner, std::hypot((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy));
  double last = 0;
  for (double r = 0; r <= kWidest; r += corner / kSteps) {
    const double distorted = r + bend(k, r);
    if (distorted >= corner) return r;
    if (!(distorted >= last) || !(corner > 0)) return std::nullopt;
    last = distorted;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> set_radial(const RadialTerms& terms, Camera& camera) {
  for (const double k : terms)
    if (!std::isfinite(k)) return std::nullopt;
  camera.distortion[0] = terms[0];
  camera.distortion[1] = terms[1];
  if (terms[2] == 0 && terms[3] == 0) return 0;
  const auto radius = corner_radius(terms, camera);
  if (!radius) return std::nullopt;
  // Least squares of a r^3 + b r^5 over the picture: rings count by their area.
  double cc = 0, cd = 0, dd = 0, ct = 0, dt = 0;
  for (int i = 1; i <= kSteps; ++i) {
    const double r = *radius * i / kSteps;
    const double c = r * r * r, d = c * r * r, target = bend(terms, r);
    cc += r * c * c;
    cd += r * c * d;
    dd += r * d * d;
    ct += r * c * target;
    dt += r * d * target;
  }
  const double determinant = cc * dd - cd * cd;
  if (!(determinant > 0)) return std::nullopt;
  const RadialTerms near{(ct * dd - dt * cd) / determinant, (dt * cc - ct * cd) / determinant, 0,
                         0};
  camera.distortion[0] = near[0];
  camera.distortion[1] = near[1];
  double miss = 0;
  for (int i = 1; i <= kSteps; ++i) {
    const double r = *radius * i / kSteps;
    miss = std::max(miss, std::abs(bend(near, r) - bend(terms, r)));
  }
  return miss * std::max(camera.fx, camera.fy);
}

Result<Done, InputError> set_radial(const RadialTerms& terms, const std::string& label,
                                    Camera& camera, double& worst) {
  const auto miss = set_radial(terms, camera);
  const double most = std::max(kMostMiss, kMostShare * std::max(camera.width, camera.height));
  if (miss && *miss <= most) {
    worst = std::max(worst, *miss);
    return Done{};
  }
  return InputError{Errc::kInvalidInput,
                    label +
                        ": its lens has radial terms k3 or k4 that k1 and k2 do not express: "
                        "export undistorted photographs with their cameras"};
}

std::string radial_warning(const std::string& file, double worst) {
  if (worst < kSeenMiss) return {};
  char text[80];
  std::snprintf(text, sizeof text, ": k1 and k2 stand for k1 to k4, up to %.2f pixels beside them",
                worst);
  return file + text;
}

}  // namespace slf
