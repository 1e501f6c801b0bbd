// SPDX-License-Identifier: Apache-2.0
// Splats in the numbers of SOG 2, before these are pictures. Numbers in brackets are clauses of its
// description, developer.playcanvas.com/user-manual/gaussian-splatting/formats/sog.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lightfield/splats/sog_codebook.h"
#include "lightfield/splats/splat_rows.h"

namespace slf {

inline constexpr int kSogDegree = 3;
/// Values of codebooks are whole multiples of 1 / kSogDigits.
inline constexpr double kSogDigits = 1e5;

/// [3.1] Coordinates as sign(x) log(1 + |x|), in 65535ths of the way from the least to the
/// greatest.
struct SogPlaces {
  std::array<double, 3> least{}, most{};
  std::vector<std::array<std::uint16_t, 3>> codes;

  float coordinate(std::size_t p, std::size_t axis) const;
};

/// Every list but `order` is by the number of a splat in the source; `order` says which a pixel is.
struct SogCodes {
  int degree = 0;
  std::vector<std::uint32_t> order;
  SogPlaces places;
  ByteCodebook sizes, colours;                     // [3.2, 3.4] [P][3]
  std::vector<std::array<std::uint8_t, 4>> turns;  // [3.3]
  std::vector<std::uint8_t> opacities;             // [3.4]
  ByteCodebook harmonics;                          // [3.5] [vectors][functions][3]
  std::vector<std::uint32_t> labels;               // [3.5] which vector a splat has

  std::size_t size() const { return order.size(); }
  /// Beyond degree 0.
  std::size_t functions() const { return functions_of(degree) - 1; }
  std::size_t vectors() const {
    return degree == 0 ? 0 : harmonics.bytes.size() / (3 * functions());
  }
};

/// Pixels are in the order of a Morton curve through the codes of places: neighbours are alike, and
/// pictures of them are smaller. The same for any number of threads.
/// @param splats  1 or more
SogCodes sog_codes(const SplatRows& splats, int threads);

}  // namespace slf
