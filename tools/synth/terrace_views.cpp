// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/terrace_views.h"

#include <numbers>

#include "tools/synth/noise.h"
#include "tools/synth/vec.h"

namespace slf::synth {
namespace {

constexpr double kEyes = 1.7, kLowestFlight = 24, kHighestFlight = 31;  // metres
constexpr double kFocal = 0.78;  // of the larger side: 65 degrees
constexpr std::uint32_t kSalt = 4242;

Camera camera_at(const Vec3& centre, const Vec3& target, int width, int height) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = kFocal * std::max(width, height);
  camera.cx = width / 2.0;
  camera.cy = height / 2.0;
  const Vec3 forward = normalised(target - centre);
  const Vec3 right = normalised(cross(forward, Vec3{0, 0, 1}));
  camera.rotation = {right, cross(forward, right), forward};
  for (std::size_t row = 0; row < 3; ++row)
    camera.translation[row] = -dot(camera.rotation[row], centre);
  return camera;
}

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

Camera walker(const Plan& plan, int i, int count, int width, int height) {
  const double whole = plan.length + 6;  // from before the first house to behind the last
  const double way = (i + 0.5) / count * plan.streets;
  const int street = std::min(static_cast<int>(way), plan.streets - 1);
  const double x = (way - street - 0.5) * whole;
  const auto number = static_cast<std::uint32_t>(i);
  const double y = plan.street_y(street) + 2.2 * (unit(kSalt, 3 * number) - 0.5);
  // Ahead or back, left or right; no four in a row start with the same.
  const int look = (i + i / 4) % 4;
  double ahead = look < 2 ? 1 : -1;
  if (std::abs(x) > plan.length / 2 - 6) ahead = x > 0 ? -1 : 1;
  const double aside = look % 2 == 0 ? 1 : -1;
  const double angle = radians(22 + 36 * unit(kSalt, 3 * number + 1));
  const double up = 0.10 + 0.12 * unit(kSalt, 3 * number + 2);
  const Vec3 eye{x, y, kEyes};
  return camera_at(eye, eye + Vec3{ahead * std::cos(angle), aside * std::sin(angle), up}, width,
                   height);
}

Camera drone(const Plan& plan, int i, int count, int width, int height) {
  constexpr double kAround = 6;  // metres beyond the houses
  const double across = plan.length + 2 * kAround;
  const double half_y = -plan.low_y() - kMargin, up = 2 * (half_y + kAround);
  const int lines =
      std::clamp(static_cast<int>(std::lround(std::sqrt(count * up / across))), 1, count);
  const double way = (i + 0.5) / count * lines;
  const int line = std::min(static_cast<int>(way), lines - 1);
  const double along = (way - line - 0.5) * (line % 2 == 0 ? 1 : -1);
  const auto number = static_cast<std::uint32_t>(i) + 1'000'000;
  const Vec3 at{along * across, ((line + 0.5) / lines - 0.5) * up,
                kLowestFlight + (kHighestFlight - kLowestFlight) * unit(kSalt, 3 * number)};
  const double azimuth =
      radians(90 * ((i + i / 4) % 4) + 45 + 50 * (unit(kSalt, 3 * number + 1) - 0.5));
  const double reach = at[2] / std::tan(radians(38 + 12 * unit(kSalt, 3 * number + 2)));
  Vec3 target{at[0] + reach * std::cos(azimuth), at[1] + reach * std::sin(azimuth), 3};
  // There is nothing to see beyond the houses: who would look there looks back across them.
  const double half_x = plan.length / 2;
  if (std::abs(target[0]) > half_x) target[0] = 2 * at[0] - target[0];
  if (std::abs(target[1]) > half_y) target[1] = 2 * at[1] - target[1];
  const double most_x = std::max(half_x - 9, half_x / 2), most_y = std::max(half_y - 9, half_y / 2);
  target[0] = std::clamp(target[0], -most_x, most_x);
  target[1] = std::clamp(target[1], -most_y, most_y);
  return camera_at(at, target, width, height);
}

std::string terrace_image(int number) {
  const std::string digits = std::to_string(number + 1);
  return "images/" + std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits + ".png";
}

}  // namespace

Rings make_terrace_views(const Plan& plan, int cameras, int width, int height) {
  const int walking = (cameras + 1) / 2, flying = cameras - walking;
  Rings views;
  int input = 0;
  for (int i = 0; i < cameras; ++i) {
    const bool flies = i >= walking;
    const int index = flies ? i - walking : i;
    views.cameras.push_back(flies ? drone(plan, index, flying, width, height)
                                  : walker(plan, index, walking, width, height));
    views.cameras.back().name = terrace_image(i);
    views.circle.push_back(flies);
    views.index.push_back(index);
    if (i % 8 == 4 || (cameras <= 4 && i == cameras - 1)) {
      views.splits["evaluation"].push_back(i);
      continue;
    }
    views.splits["dense"].push_back(i);
    if (input % 3 == 0) views.splits["intermediate"].push_back(i);
    if (input % 9 == 0) views.splits["sparse"].push_back(i);
    ++input;
  }
  return views;
}

}  // namespace slf::synth
