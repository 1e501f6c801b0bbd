// SPDX-License-Identifier: Apache-2.0
#include "lightfield/splats/sog_codes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "lightfield/splats/sog_palette.h"

namespace slf {
namespace {

constexpr double kPlaceSteps = 65535;
/// Half as many vectors as splats, between these: labels have 16 bits.
constexpr std::size_t kFewestVectors = 64, kMostVectors = std::size_t{1} << 16;

double log_of_coordinate(float x) {
  return std::copysign(std::log1p(std::abs(double{x})), double{x});
}

SogPlaces sog_places(const SplatRows& splats) {
  SogPlaces out;
  out.least.fill(INFINITY);
  out.most.fill(-INFINITY);
  for (std::size_t p = 0; p < splats.size(); ++p) {
    const auto at = splats.position(p);
    for (std::size_t k = 0; k < 3; ++k) {
      out.least[k] = std::min(out.least[k], log_of_coordinate(at[k]));
      out.most[k] = std::max(out.most[k], log_of_coordinate(at[k]));
    }
  }
  for (std::size_t p = 0; p < splats.size(); ++p) {
    const auto at = splats.position(p);
    auto& codes = out.codes.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const double range = out.most[k] - out.least[k];
      const double share = range > 0 ? (log_of_coordinate(at[k]) - out.least[k]) / range : 0;
      codes[k] = static_cast<std::uint16_t>(std::lround(kPlaceSteps * share));
    }
  }
  return out;
}

/// Bits of three coordinates by turns, the last one's first.
std::uint64_t interleaved(const std::array<std::uint16_t, 3>& codes) {
  std::uint64_t out = 0;
  for (int bit = 15; bit >= 0; --bit)
    for (std::size_t k = 3; k-- > 0;) out = out << 1 | (std::uint64_t{codes[k]} >> bit & 1);
  return out;
}

std::vector<std::uint32_t> sog_order(const SogPlaces& places) {
  std::vector<std::uint64_t> keys;
  for (const auto& codes : places.codes) keys.push_back(interleaved(codes));
  std::vector<std::uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
  return order;
}

/// The largest of w, x, y, z by its number, the others in 255ths of -sqrt(1/2) .. sqrt(1/2).
std::array<std::uint8_t, 4> sog_turn(const std::array<float, 4>& q) {
  std::size_t largest = 0;
  for (std::size_t k = 1; k < 4; ++k)
    if (std::abs(q[k]) > std::abs(q[largest])) largest = k;
  const float scale = std::copysign(std::sqrt(2.0f), q[largest]);
  std::array<std::uint8_t, 4> out{};
  for (std::size_t k = 0, to = 0; k < 4; ++k)
    if (k != largest)
      out[to++] = static_cast<std::uint8_t>(
          std::lround(127.5f * (std::clamp(scale * q[k], -1.0f, 1.0f) + 1)));
  out[3] = static_cast<std::uint8_t>(252 + largest);
  return out;
}

/// Harmonics beyond degree 0.
VectorRows sog_harmonics(const SplatRows& splats, std::size_t functions) {
  VectorRows rows{(3 * functions + 7) / 8 * 8, {}};
  rows.numbers.resize(rows.dimensions * splats.size());
  for (std::size_t p = 0; p < splats.size(); ++p)
    std::copy_n(splats.harmonics(p) + 3, 3 * functions, rows[p]);
  return rows;
}

/// Sum of squares, for a splat.
double palette_error(const VectorRows& rows, const VectorPalette& palette) {
  double sum = 0;
  for (std::size_t p = 0; p < rows.size(); ++p)
    for (std::size_t d = 0; d < rows.dimensions; ++d) {
      const double off = double{rows[p][d]} - double{palette.vectors[palette.labels[p]][d]};
      sum += off * off;
    }
  return sum / static_cast<double>(rows.size());
}

/// The same of a codebook, for a vector.
double codebook_error(const std::vector<float>& numbers, const ByteCodebook& book,
                      std::size_t vectors) {
  double sum = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double off = double{numbers[i]} - double{book.of(i)};
    sum += off * off;
  }
  return sum / static_cast<double>(vectors);
}

/// Vectors are most of a file, and fewer values make a smaller picture of them. So there are as few
/// as add a tenth to the error that the palette has anyway.
void add_palette(const SplatRows& splats, int threads, SogCodes& out) {
  constexpr std::size_t kFewestLevels = 16;
  constexpr double kLevelShare = 0.1;
  const std::size_t width = 3 * out.functions();
  const VectorRows rows = sog_harmonics(splats, out.functions());
  const std::size_t most = std::clamp(splats.size() / 2, kFewestVectors, kMostVectors);
  VectorPalette palette = vector_palette(rows, most, threads);
  std::vector<float> numbers;
  for (std::size_t k = 0; k < palette.vectors.size(); ++k)
    numbers.insert(numbers.end(), palette.vectors[k], palette.vectors[k] + width);
  const double error = kLevelShare * palette_error(rows, palette);
  for (std::size_t levels = kFewestLevels; levels <= 256; levels *= 2) {
    out.harmonics = byte_codebook(numbers, levels);
    if (codebook_error(numbers, out.harmonics, palette.vectors.size()) <= error) break;
  }
  out.labels = std::move(palette.labels);
}

/// Five digits behind the point: less than bytes of a picture show, and half of the text.
void round_values(ByteCodebook& book) {
  for (float& value : book.values)
    value = static_cast<float>(std::round(double{value} * kSogDigits) / kSogDigits);
}

}  // namespace

float SogPlaces::coordinate(std::size_t p, std::size_t axis) const {
  const double share = static_cast<double>(codes[p][axis]) / kPlaceSteps;
  const double log = least[axis] + (most[axis] - least[axis]) * share;
  return static_cast<float>(std::copysign(std::expm1(std::abs(log)), log));
}

SogCodes sog_codes(const SplatRows& splats, int threads) {
  SogCodes out;
  out.degree = std::min(splats.degree(), kSogDegree);
  out.places = sog_places(splats);
  out.order = sog_order(out.places);
  std::vector<float> sizes, colours;
  for (std::size_t p = 0; p < splats.size(); ++p) {
    const auto size = splats.log_deviations(p);
    sizes.insert(sizes.end(), size.begin(), size.end());
    colours.insert(colours.end(), splats.harmonics(p), splats.harmonics(p) + 3);
    out.turns.push_back(sog_turn(splats.rotation(p)));
    out.opacities.push_back(static_cast<std::uint8_t>(std::lround(255 * splats.opacity(p))));
  }
  out.sizes = byte_codebook(sizes, 256);
  out.colours = byte_codebook(colours, 256);
  if (out.degree > 0) add_palette(splats, threads, out);
  for (ByteCodebook* book : {&out.sizes, &out.colours, &out.harmonics}) round_values(*book);
  return out;
}

}  // namespace slf
