// SPDX-License-Identifier: Apache-2.0
// Where the streets, houses and gardens of a terrace lie. Metres; streets run along x, z is up.
#pragma once

#include <cstdint>
#include <vector>

namespace slf::synth {

inline constexpr double kRoadHalf = 3.6;  ///< from the middle of a street to the kerb
inline constexpr double kFrontAt = 6.2;   ///< from the middle of a street to the facades
inline constexpr double kHouseDepth = 9;
inline constexpr double kGardenHalf = 5.5;  ///< from the back walls to the middle between streets
inline constexpr double kMargin = 7;        ///< of ground around the houses
/// From one street to the next.
inline constexpr double kStreetPitch = 2 * (kFrontAt + kHouseDepth + kGardenHalf);

struct Lot {
  double x0, x1;
  double front;  ///< y of the facade
  double side;   ///< +1: the street is towards +y of it, -1: towards -y
  std::uint32_t seed;
};

/// The middle of the whole is the origin.
struct Plan {
  int streets;
  double length;  ///< of a street's houses
  std::vector<Lot> lots;

  double low_x() const { return -length / 2 - kMargin; }
  double low_y() const { return street_y(0) - kFrontAt - kHouseDepth - kMargin; }
  double street_y(int street) const { return kStreetPitch * (street - (streets - 1) / 2.0); }
};

/// As many houses on both sides of as many streets as make the whole about square, and no street
/// with a side that is more than a house shorter.
Plan make_plan(int houses, std::uint32_t seed);

}  // namespace slf::synth
