// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/rings.h"

#include <numbers>
#include <set>

#include "tools/synth/vec.h"

namespace slf::synth {
namespace {

constexpr double kDistance = 5;  // of the cameras from the origin
constexpr double kLowest =
    -0.85;  // z of the first circle / kDistance; the last is its mirror image
constexpr std::size_t kMostEvaluation = 100;
// Where the paper's splits take no more than half of the cameras.
constexpr int kLeastCircles = 5, kLeastPerCircle = 14;

Camera ring_camera(double height, double azimuth, int width, int image_height, double radius) {
  Camera camera;
  camera.width = width;
  camera.height = image_height;
  // The ball's silhouette is at asin(radius / distance); 5 % are left as margin.
  const double tangent = std::tan(std::asin(radius / kDistance)) * 1.05;
  camera.fx = camera.fy = std::min(width, image_height) / (2 * tangent);
  camera.cx = width / 2.0;
  camera.cy = image_height / 2.0;
  const double across = std::sqrt(1 - height * height);
  const Vec3 forward{-across * std::cos(azimuth), -across * std::sin(azimuth), -height};
  const Vec3 right = normalised(cross(forward, Vec3{0, 0, 1}));
  camera.rotation = {right, cross(forward, right), forward};
  camera.translation = {0, 0, kDistance};
  return camera;
}

/// count indices spread evenly over per_circle, the first of them 0.
std::vector<int> spread(int count, int per_circle) {
  std::vector<int> indices;
  for (int i = 0; i < std::min(count, per_circle); ++i)
    indices.push_back(
        static_cast<int>(std::lround(double(i) * per_circle / std::min(count, per_circle))));
  return indices;
}

/// Numbers (circle * per_circle + index) of the cameras of every split.
std::map<std::string, std::set<int>> split_numbers(int circles, int per_circle) {
  std::map<std::string, std::set<int>> splits;
  const auto circle_at = [circles](double share) {
    return static_cast<int>(std::lround(share * (circles - 1)));
  };
  const auto put = [&](const char* split, int circle, const std::vector<int>& indices) {
    for (const int index : indices) splits[split].insert(circle * per_circle + index);
  };
  for (int circle = circles > 1 ? 1 : 0; circle < circles; circle += 2)
    put("dense", circle, spread((per_circle + 1) / 2, per_circle));
  for (const double share : {0.1, 0.5, 0.9})
    put("intermediate", circle_at(share), spread(13, per_circle));
  for (const double share : {0.3, 0.7}) put("sparse", circle_at(share), spread(7, per_circle));

  std::vector<int> rest;
  for (int number = 0; number < circles * per_circle; ++number)
    if (!splits["dense"].count(number) && !splits["intermediate"].count(number) &&
        !splits["sparse"].count(number))
      rest.push_back(number);
  const std::size_t kept = std::min(rest.size(), kMostEvaluation);
  for (std::size_t i = 0; i < kept; ++i) splits["evaluation"].insert(rest[i * rest.size() / kept]);
  return splits;
}

std::string ring_image(int number) {
  const std::string digits = std::to_string(number + 1);
  return "images/" + std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits + ".png";
}

void add_camera(Rings& rings, int circles, int per_circle, int number, int width, int height,
                double radius) {
  const int circle = number / per_circle, index = number % per_circle;
  const double at = circles > 1 ? kLowest - 2 * kLowest * circle / (circles - 1) : 0;
  const double azimuth = 2 * std::numbers::pi * index / per_circle;
  rings.cameras.push_back(ring_camera(at, azimuth, width, height, radius));
  rings.cameras.back().name = ring_image(number);
  rings.circle.push_back(circle);
  rings.index.push_back(index);
}

}  // namespace

Rings make_even_rings(int circles, int per_circle, int width, int height, double radius) {
  Rings rings;
  for (int number = 0; number < circles * per_circle; ++number) {
    rings.splits[number % 4 == 3 ? "evaluation" : "dense"].push_back(number);
    add_camera(rings, circles, per_circle, number, width, height, radius);
  }
  return rings;
}

Rings make_rings(int circles, int per_circle, int width, int height, double radius) {
  if (circles < kLeastCircles || per_circle < kLeastPerCircle)
    return make_even_rings(circles, per_circle, width, height, radius);
  const auto numbers = split_numbers(circles, per_circle);
  std::map<int, int> camera_of;  // number -> index into cameras
  for (const auto& [split, members] : numbers)
    for (const int number : members) camera_of[number] = 0;

  Rings rings;
  for (auto& [number, camera] : camera_of) {
    camera = static_cast<int>(rings.cameras.size());
    add_camera(rings, circles, per_circle, number, width, height, radius);
  }
  for (const auto& [split, members] : numbers)
    for (const int number : members) rings.splits[split].push_back(camera_of.at(number));
  return rings;
}

}  // namespace slf::synth
