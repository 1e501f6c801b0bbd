// SPDX-License-Identifier: Apache-2.0
// What is between the houses of a terrace.
#include "tools/synth/noise.h"
#include "tools/synth/terrace_build.h"

namespace slf::synth {
namespace {

constexpr double kKerb = 0.15;  // top of the pavement
constexpr double kRoad = 0.03;  // top of the road

void lamp(double x, double y, std::uint32_t seed, std::vector<Solid>& solids) {
  solids.push_back(pillar(x, y, 0.16, 0, 0.7, Surface::kIron, seed));
  solids.push_back(pillar(x, y, 0.07, 0.7, 4.2, Surface::kIron, seed));
  solids.push_back(ball({x, y, 4.45}, 0.27, Surface::kLampGlass, seed));
}

void tree(double x, double y, std::uint32_t seed, std::vector<Solid>& solids) {
  const double size = 0.8 + 0.35 * unit(seed, 1), trunk = 2.3 * size;
  solids.push_back(pillar(x, y, 0.14 * size, 0, trunk + 0.6, Surface::kBark, seed));
  for (std::uint32_t i = 0; i < 14; ++i) {
    // By the golden angle around the trunk, in the shape of an egg.
    const double angle = 2.4 * i + 6 * unit(seed, 2), height = i / 13.0;
    const double out = size * (0.25 + 1.0 * std::sqrt(std::max(0.0, height * (1 - height))) * 1.4);
    const double up = trunk + size * (0.3 + 1.9 * height);
    solids.push_back(ball({x + out * std::cos(angle), y + out * std::sin(angle), up},
                          size * (0.42 + 0.22 * unit(seed, 20 + i)), Surface::kLeaves,
                          mixed(seed, 30 + i)));
  }
}

void bollard(double x, double y, std::uint32_t seed, std::vector<Solid>& solids) {
  solids.push_back(pillar(x, y, 0.12, 0, 0.85, Surface::kMarble, seed));
  solids.push_back(
      ball({x, y, 1.0}, 0.19, unit(seed, 1) < 0.6 ? Surface::kChrome : Surface::kBrass, seed));
}

/// Steps, a column and a ball of metal on it.
void monument(double x, double y, std::uint32_t seed, std::vector<Solid>& solids) {
  const auto block = [&](double half, double z0, double z1) {
    solids.push_back(
        {{x - half, y - half, z0}, {x + half, y + half, z1}, Shape::kBox, Surface::kTrim, seed});
  };
  block(1.7, 0, 0.3);
  block(1.3, 0.3, 0.6);
  block(0.85, 0.6, 1.9);
  block(1.0, 1.9, 2.05);
  solids.push_back(pillar(x, y, 0.5, 2.05, 5.0, Surface::kMarble, seed));
  block(0.7, 5.0, 5.2);
  solids.push_back(
      ball({x, y, 6.15}, 1.0, unit(seed, 1) < 0.5 ? Surface::kBrass : Surface::kChrome, seed));
}

void build_street(const Plan& plan, int street, std::uint32_t seed, std::vector<Solid>& solids) {
  const double y = plan.street_y(street), x0 = plan.low_x(), x1 = -plan.low_x();
  solids.push_back(
      {{x0, y - kRoadHalf, -0.4}, {x1, y + kRoadHalf, kRoad}, Shape::kBox, Surface::kSetts, seed});
  for (const double side : {-1.0, 1.0}) {
    const double a = y + side * kRoadHalf, b = y + side * (kFrontAt + 0.4);
    solids.push_back({{x0, std::min(a, b), -0.4},
                      {x1, std::max(a, b), kKerb},
                      Shape::kBox,
                      Surface::kPaving,
                      mixed(seed, 7)});
    const double kerb = y + side * (kRoadHalf + 0.45);
    constexpr double kApart = 3.3;
    const int places = static_cast<int>((plan.length + 4) / kApart);
    for (int i = 0; i < places; ++i) {
      const double x = (i - (places - 1) / 2.0) * kApart;
      const std::uint32_t own = mixed(seed, std::uint32_t(2 * i + (side > 0 ? 1 : 0)));
      const int kind = (i + (side > 0 ? 2 : 0)) % 5;  // lamp, ball, ball, tree, ball
      if (kind == 0)
        lamp(x, kerb, own, solids);
      else if (kind == 3)
        tree(x, kerb + 0.2 * side, own, solids);
      else
        bollard(x, kerb, own, solids);
    }
  }
  for (const double end : {-1.0, 1.0})
    monument(end * (plan.length / 2 + 4), y, mixed(seed, end > 0 ? 5 : 6), solids);
}

/// Trees and a wall along the middle between two streets, and outside of the outermost.
void build_gardens(const Plan& plan, std::uint32_t seed, std::vector<Solid>& solids) {
  for (int row = 0; row <= plan.streets; ++row) {
    const bool outermost = row == 0 || row == plan.streets;
    const double y = plan.street_y(row) - kStreetPitch / 2;
    const double x = plan.length / 2;
    solids.push_back({{-x, y - 0.15, -0.2},
                      {x, y + 0.15, outermost ? 1.2 : 1.9},
                      Shape::kBox,
                      Surface::kBrick,
                      mixed(seed, 900 + std::uint32_t(row))});
    const int places = static_cast<int>(plan.length / 7.5);
    for (int i = 0; i < places; ++i) {
      const std::uint32_t own =
          mixed(seed, 100'000 + 4'000 * std::uint32_t(row) + std::uint32_t(i));
      const double side = unit(own, 40) < 0.5 ? -1 : 1;
      const double inwards = row == 0 ? 1 : row == plan.streets ? -1 : side;
      tree((i - (places - 1) / 2.0) * 7.5 + 3 * unit(own, 41),
           y + inwards * (2 + 1.2 * unit(own, 42)), own, solids);
    }
  }
}

}  // namespace

void build_streets(const Plan& plan, std::uint32_t seed, std::vector<Solid>& solids) {
  solids.push_back({{plan.low_x(), plan.low_y(), -0.5},
                    {-plan.low_x(), -plan.low_y(), 0},
                    Shape::kBox,
                    Surface::kGrass,
                    seed});
  for (int street = 0; street < plan.streets; ++street)
    build_street(plan, street, mixed(seed, 500 + std::uint32_t(street)), solids);
  build_gardens(plan, mixed(seed, 3), solids);
}

}  // namespace slf::synth
