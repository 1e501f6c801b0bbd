// SPDX-License-Identifier: Apache-2.0
#include "capture/ply_colours.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

namespace slf {

namespace {

constexpr double kWide = 1.0 / 257;  // of ushort
// The least of the largest float of colours 0 .. 255: below, it is light brighter than white.
constexpr double kLeastOfBytes = 16;
// The largest that 12 bits hold, as many sensors have them: a scene of 16 bits is rarely as dark.
constexpr double kMostOf12Bits = 4095;

bool is_float(PlyType type) { return type == PlyType::kFloat || type == PlyType::kDouble; }

std::uint8_t rounded(double value) { return static_cast<std::uint8_t>(std::floor(value + 0.5)); }

}  // namespace

PlyColours::PlyColours(std::span<const PlyType, 3> types) {
  std::copy(types.begin(), types.end(), types_.begin());
}

std::optional<std::size_t> PlyColours::add(std::span<const double, 3> samples) {
  std::array<std::uint8_t, 3> colour{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double sample = samples[k];
    if (!(sample >= 0)) return k;
    double scale = 1;
    if (types_[k] == PlyType::kUint16) {
      largest_wide_ = std::max(largest_wide_, sample);
      if (sample > 255 && !wide_is_16_bits_) read_as_16_bits();
      if (wide_is_16_bits_) scale = kWide;
    } else if (is_float(types_[k])) {
      largest_float_ = std::max(largest_float_, sample);
      if (std::floor(255 * sample + 0.5) > 255 && !float_is_255_) read_as_255();
      if (!float_is_255_) scale = 255;
    }
    if (std::floor(sample * scale + 0.5) > 255) return k;
    colour[k] = rounded(sample * scale);
  }
  colours_.push_back(colour);
  return std::nullopt;
}

void PlyColours::read_as_16_bits() {
  wide_is_16_bits_ = true;
  for (auto& colour : colours_)
    for (std::size_t k = 0; k < 3; ++k)
      if (types_[k] == PlyType::kUint16) colour[k] = rounded(colour[k] * kWide);
}

void PlyColours::read_as_255() {
  float_is_255_ = true;
  for (auto& colour : colours_)
    for (std::size_t k = 0; k < 3; ++k)
      if (is_float(types_[k])) colour[k] = colour[k] >= 128 ? 1 : 0;  // it was 0 to 1
}

std::string PlyColours::warning() const {
  if (float_is_255_) return "colours are floats above 1: they are read as 0 to 255";
  if (!wide_is_16_bits_ && largest_wide_ > 0)
    return "no colour of 16 bits is above 255: they are read as 8 bits";
  if (wide_is_16_bits_ && largest_wide_ <= kMostOf12Bits) {
    const auto bits = static_cast<int>(std::bit_width(static_cast<unsigned>(largest_wide_)));
    return "no colour of 16 bits is above " + std::to_string(static_cast<unsigned>(largest_wide_)) +
           ": they are read as 0 to 65535; if they have " + std::to_string(bits) +
           " bits, multiply them by " + std::to_string(1 << (16 - bits));
  }
  return {};
}

std::string PlyColours::problem() const {
  if (!float_is_255_ || largest_float_ >= kLeastOfBytes) return {};
  char text[120];
  std::snprintf(text, sizeof text,
                "colours are floats up to %.3g; their range is 0 to 1, or 0 to 255",
                largest_float_);
  return text;
}

}  // namespace slf
