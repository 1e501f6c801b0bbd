// SPZ version 2 (Niantic): fixed-point positions, bytes for the rest, in gzip. Every reader of SPZ
// knows this version. Its quaternions have x, y and z in 8 bits each, which is coarse only where w
// is small; those of discs (disc_rotation) never are.
#include <algorithm>
#include <cmath>

#include "bitstream/deflate.h"
#include "exchange/splat_axes.h"
#include "exchange/splat_writers.h"

namespace slf {
namespace {

constexpr std::uint32_t kMagic = 0x5053474e;  // "NGSP"
constexpr std::uint32_t kVersion = 2;
constexpr int kMostFractionBits = 24;
constexpr float kLargestCoordinate = 8388607;         // of 24 bits with sign
constexpr float kScaleOffset = 10, kScaleSteps = 16;  // byte = (log + 10) * 16
constexpr float kColourScale = 0.15f;                 // byte = 255 * (0.5 + 0.15 dc)
/// Of 8 for a harmonic, so that gzip has something. The format's own writer keeps 5, and 4 beyond
/// degree 1, which shows: docs/export.md.
constexpr int kHarmonicBits = 6;

std::uint8_t byte_of(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 255.0f)));
}

/// A coefficient of -1 .. 1 about 128, to the nearest multiple of a power of two.
std::uint8_t harmonic_byte(float value) {
  const int bucket = 1 << (8 - kHarmonicBits);
  const long level = std::lround(std::clamp(value, -2.0f, 2.0f) * 128) + 128;
  return static_cast<std::uint8_t>(std::clamp((level + bucket / 2) / bucket * bucket, 0L, 255L));
}

std::uint8_t scale_byte(float deviation) {
  return byte_of((std::log(deviation) + kScaleOffset) * kScaleSteps);
}

/// As many as the farthest coordinate leaves; -1 where it is beyond all.
int fraction_bits(const SplatCloud& splats) {
  float farthest = 0;
  for (const auto& at : splats.positions)
    for (const float x : at) farthest = std::max(farthest, std::abs(x));
  int bits = kMostFractionBits;
  while (bits >= 0 && std::ldexp(farthest, bits) > kLargestCoordinate) --bits;
  return bits;
}

void put_positions(const SplatCloud& splats, int bits, Bytes& out) {
  for (const auto& at : splats.positions)
    for (const float x : at) {
      const auto fixed = static_cast<std::uint32_t>(std::lround(std::ldexp(x, bits)));
      for (int shift = 0; shift < 24; shift += 8)
        out.push_back(static_cast<std::uint8_t>(fixed >> shift));
    }
}

void put_discs(const SplatCloud& splats, Bytes& out) {
  for (const float deviation : splats.deviations)
    for (const float scale : {deviation, deviation, deviation * kSplatFlatness})
      out.push_back(scale_byte(scale));
  for (const auto& normal : splats.normals) {
    const auto q = disc_rotation(normal);
    for (std::size_t k = 1; k < 4; ++k) out.push_back(byte_of(127.5f * (q[k] + 1)));
  }
}

void put_colours(const SplatCloud& splats, Bytes& out) {
  const std::size_t row = 3 * splats.num_harmonics();
  for (std::size_t p = 0; p < splats.size(); ++p)
    for (std::size_t c = 0; c < 3; ++c)
      out.push_back(byte_of(255 * (kColourScale * splats.harmonics[p * row + c] + 0.5f)));
}

void put_harmonics(const SplatCloud& splats, Bytes& out) {
  const std::size_t row = 3 * splats.num_harmonics();
  for (std::size_t p = 0; p < splats.size(); ++p)
    for (std::size_t i = 3; i < row; ++i)
      out.push_back(harmonic_byte(splats.harmonics[p * row + i]));
}

/// SPZ's bytes for discs: from exp(-10) to exp(5.9).
bool holds(const SplatCloud& splats) {
  const auto [least, most] =
      std::minmax_element(splats.deviations.begin(), splats.deviations.end());
  return std::log(*least) > -kScaleOffset && std::log(*most) < 255 / kScaleSteps - kScaleOffset;
}

}  // namespace

Result<Bytes, InputError> write_spz(const SplatCloud& splats) {
  const int bits = fraction_bits(splats);
  if (bits < 0 || std::ldexp(splats.step, bits) < 1)
    return InputError{Errc::kInvalidInput, "SPZ cannot hold its coordinates"};
  if (!holds(splats))
    return InputError{
        Errc::kInvalidInput,
        "SPZ holds discs of 0.00005 to 380 units, and points here are as far apart as " +
            std::to_string(splats.step)};
  Bytes raw;
  put(raw, kMagic);
  put(raw, kVersion);
  put(raw, static_cast<std::uint32_t>(splats.size()));
  for (const int byte : {splats.degree, bits, 0, 0}) raw.push_back(static_cast<std::uint8_t>(byte));
  put_positions(splats, bits, raw);
  raw.insert(raw.end(), splats.size(), byte_of(255 * kSplatOpacity));
  put_colours(splats, raw);
  put_discs(splats, raw);
  put_harmonics(splats, raw);
  return gzip(raw);
}

SplatCloud rounded_to_spz(SplatCloud splats) {
  const std::size_t row = 3 * splats.num_harmonics();
  const int bits = std::max(0, fraction_bits(splats));
  for (auto& at : splats.positions)
    for (float& x : at) x = std::ldexp(std::round(std::ldexp(x, bits)), -bits);
  for (float& deviation : splats.deviations)
    deviation = std::exp(float(scale_byte(deviation)) / kScaleSteps - kScaleOffset);
  for (std::size_t i = 0; i < splats.harmonics.size(); ++i) {
    float& h = splats.harmonics[i];
    const std::size_t k = i % row / 3;
    h = k == 0 ? (float(byte_of(255 * (kColourScale * h + 0.5f))) / 255 - 0.5f) / kColourScale
               : (float(harmonic_byte(h)) - 128) / 128;
  }
  return splats;
}

}  // namespace slf
