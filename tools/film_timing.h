// SPDX-License-Identifier: Apache-2.0
// A file of AVI has one rate; frames of a light field have times of their own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace slf::tools {

struct FilmTiming {
  double rate = 30;                  ///< pictures a second, 0.001 .. 1000; others are the nearest
  std::vector<std::uint32_t> shown;  ///< [pictures] how many times each follows itself, 1 or more
};

/// All pictures once, at the rate of the mean.
/// @param times  seconds, ascending, of all pictures; fewer than two tell no rate
FilmTiming even_timing(std::size_t pictures, std::span<const double> times);

/// The fewest pictures that show each within an eighth of the mean duration of its time, else those
/// that come closest: pictures are repeated where durations differ.
FilmTiming timing_of(std::size_t pictures, std::span<const double> times);

}  // namespace slf::tools
