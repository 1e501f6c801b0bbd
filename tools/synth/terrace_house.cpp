// SPDX-License-Identifier: Apache-2.0
// A house of a terrace.
#include <cmath>

#include "tools/synth/noise.h"
#include "tools/synth/terrace_build.h"

namespace slf::synth {
namespace {

constexpr double kReveal = 0.16;  // how deep windows lie in the wall
constexpr double kPlinth = 0.45;  // floor of the ground storey
constexpr double kCloseness = 1e-3;

/// What a house's seed decides.
struct Style {
  explicit Style(std::uint32_t seed)
      : storeys(2 + static_cast<int>(2.4 * unit(seed, 2))),
        storey(2.95 + 0.4 * unit(seed, 3)),
        columns(unit(seed, 4) < 0.55 ? 3 : 2),
        door_column(static_cast<int>(columns * unit(seed, 5))),
        window_width((columns == 3 ? 1.0 : 1.25) + 0.2 * unit(seed, 6)),
        pitch(0.6 + 0.24 * unit(seed, 7)),
        wall(unit(seed, 8) < 0.55 ? Surface::kBrick : Surface::kPlaster),
        flat(unit(seed, 9) < 0.2),
        dormer(!flat && unit(seed, 10) < 0.55),
        portico(unit(seed, 12) < 0.4) {}
  int storeys;
  double storey;
  int columns, door_column;
  double window_width, pitch;
  Surface wall;
  bool flat, dormer, portico;
};

class House {
 public:
  House(const Lot& lot, std::vector<Solid>& solids)
      : lot_(lot),
        style_(lot.seed),
        solids_(solids),
        top_(kPlinth + style_.storeys * style_.storey + 0.35) {}

  void build() {
    facing_front_ = true;
    facade();
    entrance();
    facing_front_ = false;
    facade();
    facing_front_ = true;
    box(lot_.x0, lot_.x1, kReveal - kHouseDepth, -kReveal, 0, top_, style_.wall);
    if (style_.flat)
      parapet();
    else
      roof();
  }

 private:
  /// x and z as they are; `out` is measured from the facade outwards, or from the back wall.
  void box(double x0, double x1, double out0, double out1, double z0, double z1, Surface surface,
           std::uint32_t salt = 0) {
    const double a = y_at(out0), b = y_at(out1);
    solids_.push_back({{x0, std::min(a, b), z0},
                       {x1, std::max(a, b), z1},
                       Shape::kBox,
                       surface,
                       salt == 0 ? lot_.seed : mixed(lot_.seed, salt)});
  }
  double y_at(double out) const {
    return facing_front_ ? lot_.front + lot_.side * out
                         : lot_.front - lot_.side * (kHouseDepth + out);
  }
  double column_x(int column) const {
    return lot_.x0 + (lot_.x1 - lot_.x0) * (column + 0.5) / style_.columns;
  }
  bool has_door(int storey, int column) const {
    return facing_front_ && storey == 0 && column == style_.door_column;
  }

  void facade() {
    double below = 0;
    for (int storey = 0; storey < style_.storeys; ++storey) {
      const double floor = kPlinth + storey * style_.storey;
      const double sill = floor + (storey == 0 ? 0.75 : 0.6);
      const double head = floor + style_.storey - 0.55;
      if (storey == 0 && facing_front_) {
        wall(lot_.x0, lot_.x1, 0, kPlinth);
        const double x = column_x(style_.door_column), half = style_.window_width / 2;
        wall(lot_.x0, x - half, kPlinth, sill);
        wall(x + half, lot_.x1, kPlinth, sill);
      } else {
        wall(lot_.x0, lot_.x1, below, sill);
      }
      row(storey, sill, head);
      below = head;
    }
    wall(lot_.x0, lot_.x1, below, top_);
    box(lot_.x0, lot_.x1, -0.05, 0.24, top_ - 0.28, top_ - kCloseness, Surface::kTrim, 90);
    if (!facing_front_) return;
    box(lot_.x0, lot_.x1, -0.05, 0.05, 0, kPlinth - kCloseness, Surface::kTrim, 91);
    const double course = kPlinth + style_.storey - 0.1;
    box(lot_.x0, lot_.x1, -0.05, 0.07, course, course + 0.18, Surface::kTrim, 92);
  }
  void wall(double x0, double x1, double z0, double z1) {
    box(x0, x1, -kReveal, 0, z0, z1, style_.wall);
  }

  /// Windows of a storey and the wall between them.
  void row(int storey, double sill, double head) {
    double from = lot_.x0;
    for (int column = 0; column < style_.columns; ++column) {
      const double x = column_x(column), half = style_.window_width / 2;
      wall(from, x - half, sill, head);
      from = x + half;
      if (has_door(storey, column)) continue;
      const auto salt =
          static_cast<std::uint32_t>(100 + 10 * storey + column + (facing_front_ ? 0 : 50));
      box(x - half, x + half, -kReveal - 0.05, -kReveal + 0.03, sill, head, Surface::kWindow, salt);
      box(x - half - 0.1, x + half + 0.1, -kReveal + 0.01, 0.1, sill - 0.1, sill + 0.02,
          Surface::kTrim, 93);
      box(x - half - 0.12, x + half + 0.12, -0.05, 0.035, head, head + 0.22, Surface::kTrim, 93);
    }
    wall(from, lot_.x1, sill, head);
  }

  void entrance() {
    const double x = column_x(style_.door_column), half = style_.window_width / 2;
    const double top = kPlinth + 2.1, head = kPlinth + style_.storey - 0.55;
    box(x - half, x + half, -kReveal - 0.05, -kReveal + 0.06, kPlinth, top, Surface::kDoor);
    box(x - half, x + half, -kReveal - 0.05, -kReveal + 0.03, top, head, Surface::kWindow, 80);
    solids_.push_back(ball({x + 0.36 * style_.window_width, y_at(-kReveal + 0.11), kPlinth + 1},
                           0.06, Surface::kBrass, lot_.seed));
    box(x - half - 0.3, x + half + 0.3, -0.1, 1.1, 0, 0.3, Surface::kTrim, 94);
    box(x - half - 0.12, x + half + 0.12, -0.1, 0.7, 0, kPlinth, Surface::kTrim, 95);
    if (!style_.portico) return;
    for (const double sign : {-1.0, 1.0})
      solids_.push_back(pillar(x + sign * (half + 0.14), y_at(0.88), 0.13, 0.3, head + 0.05,
                               Surface::kMarble, lot_.seed));
    box(x - half - 0.4, x + half + 0.4, -0.1, 1.1, head + 0.05, head + 0.27, Surface::kTrim, 96);
    for (const double sign : {-1.0, 1.0})
      solids_.push_back(ball({x + sign * (half + 0.14), y_at(0.88), head + 0.42}, 0.17,
                             unit(lot_.seed, 13) < 0.5 ? Surface::kBrass : Surface::kChrome,
                             lot_.seed));
  }

  void roof() {
    constexpr double kEaves = 0.38;
    const double height = style_.pitch * (kHouseDepth / 2 + kEaves);
    const double a = y_at(kEaves), b = y_at(-kHouseDepth - kEaves);
    solids_.push_back(
        {{lot_.x0, std::min(a, b), top_},
         {lot_.x1, std::max(a, b), top_ + height},
         Shape::kRoof,
         style_.wall == Surface::kBrick ? Surface::kTilesOnBrick : Surface::kTilesOnPlaster,
         lot_.seed});
    chimney(top_ + height);
    if (!style_.dormer) return;
    const double x = (lot_.x0 + lot_.x1) / 2, low = top_ + 0.55;
    box(x - 0.85, x + 0.85, -3.4, -0.75, low - 0.4, low + 1.5, Surface::kPlaster, 97);
    box(x - 1.0, x + 1.0, -3.6, -0.6, low + 1.5, low + 1.62, Surface::kIron);
    box(x - 0.6, x + 0.6, -0.9, -0.71, low + 0.15, low + 1.35, Surface::kWindow, 81);
  }
  void chimney(double ridge) {
    const double x = lot_.x1 - 0.75, y = y_at(-kHouseDepth / 2 - 1);
    box(x - 0.35, x + 0.35, -kHouseDepth / 2 - 1.7, -kHouseDepth / 2 - 0.3, ridge - 1.5,
        ridge + 0.9, Surface::kBrick, 98);
    for (const double d : {-0.35, 0.35})
      solids_.push_back(
          pillar(x, y + d, 0.13, ridge + 0.9, ridge + 1.4, Surface::kPottery, lot_.seed));
  }

  /// Low walls around a flat roof.
  void parapet() {
    const double high = top_ + 0.8;
    box(lot_.x0, lot_.x1, -0.3, 0, top_, high, style_.wall);
    box(lot_.x0, lot_.x1, -kHouseDepth, -kHouseDepth + 0.3, top_, high, style_.wall);
    for (const double x : {lot_.x0, lot_.x1 - 0.3})
      box(x, x + 0.3, -kHouseDepth + 0.3, -0.3, top_, high, style_.wall);
    box(lot_.x0, lot_.x1, -0.4, 0.1, high, high + 0.12, Surface::kTrim, 99);
    box(lot_.x0 + 0.3, lot_.x1 - 0.3, -kHouseDepth + 0.3, -0.3, top_, top_ + 0.03,
        Surface::kGravel);
    chimney(top_ + 0.6);
  }

  const Lot& lot_;
  Style style_;
  std::vector<Solid>& solids_;
  double top_;
  bool facing_front_ = true;
};

}  // namespace

void build_house(const Lot& lot, std::vector<Solid>& solids) { House(lot, solids).build(); }

Solid ball(const Vec3& centre, double radius, Surface surface, std::uint32_t seed) {
  const Vec3 r{radius, radius, radius};
  return {centre - r, centre + r, Shape::kSphere, surface, seed};
}

Solid pillar(double x, double y, double radius, double z0, double z1, Surface surface,
             std::uint32_t seed) {
  return {
      {x - radius, y - radius, z0}, {x + radius, y + radius, z1}, Shape::kCylinder, surface, seed};
}

}  // namespace slf::synth
