// SPDX-License-Identifier: Apache-2.0
// SPZ versions 2 to 4 (Niantic): fixed-point positions, bytes for the rest, in gzip. Every reader
// of SPZ knows version 2. Its quaternions have x, y and z in 8 bits each, which is coarse only
// where w is small; those of discs (disc_rotation) never are. Version 3 leaves the largest out.
// Version 4 has each attribute in zstd, behind a header that is not packed.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "bitstream/encoder/deflate.h"
#include "lightfield/splats/splat_writers.h"
#include "lightfield/splats/zstd_adapter.h"

namespace slf {
namespace {

constexpr std::uint32_t kMagic = 0x5053474e;  // "NGSP"
constexpr int kSpzDegree = 3;                 // the most that readers of versions 2 and 3 know
constexpr int kSpz4Degree = 4;
constexpr std::uint32_t kSpz4Header = 32;
constexpr int kMostFractionBits = 24;
constexpr float kLargestCoordinate = 8388607;         // of 24 bits with sign
constexpr float kScaleOffset = 10, kScaleSteps = 16;  // byte = (log + 10) * 16
constexpr float kColourScale = 0.15f;                 // byte = 255 * (0.5 + 0.15 dc)
/// Bits, of 8, for a harmonic, so that gzip has something. The format's own writer keeps 5, and 4
/// beyond degree 1, which shows: docs/decisions/027.
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
int fraction_bits(const SplatRows& splats) {
  float farthest = 0;
  for (std::size_t p = 0; p < splats.size(); ++p)
    for (const float x : splats.position(p)) farthest = std::max(farthest, std::abs(x));
  int bits = kMostFractionBits;
  while (bits >= 0 && std::ldexp(farthest, bits) > kLargestCoordinate) --bits;
  return bits;
}

void put_positions(const SplatRows& splats, int bits, Bytes& out) {
  for (std::size_t p = 0; p < splats.size(); ++p)
    for (const float x : splats.position(p)) {
      const auto fixed = static_cast<std::uint32_t>(std::lround(std::ldexp(x, bits)));
      for (int shift = 0; shift < 24; shift += 8)
        out.push_back(static_cast<std::uint8_t>(fixed >> shift));
    }
}

/// x, y, z of the quaternion that has w of 0 or more.
void put_first_three(const std::array<float, 4>& q, Bytes& out) {
  const float sign = q[0] < 0 ? -1.0f : 1.0f;
  for (std::size_t k = 1; k < 4; ++k) out.push_back(byte_of(127.5f * (sign * q[k] + 1)));
}

/// The largest of x, y, z, w by its number, the others as a sign and nine bits of sqrt(1/2).
void put_smallest_three(const std::array<float, 4>& q, Bytes& out) {
  const std::array<float, 4> xyzw{q[1], q[2], q[3], q[0]};
  std::size_t largest = 0;
  for (std::size_t k = 1; k < 4; ++k)
    if (std::abs(xyzw[k]) > std::abs(xyzw[largest])) largest = k;
  auto word = static_cast<std::uint32_t>(largest);
  for (std::size_t k = 0; k < 4; ++k) {
    if (k == largest) continue;
    const bool negative = (xyzw[k] < 0) != (xyzw[largest] < 0);
    const long size = std::lround(511 * std::min(1.0f, std::abs(xyzw[k]) * std::sqrt(2.0f)));
    word = word << 10 | (negative ? 512u : 0u) | static_cast<std::uint32_t>(size);
  }
  put(out, word);
}

void put_sizes(const SplatRows& splats, Bytes& out) {
  for (std::size_t p = 0; p < splats.size(); ++p)
    for (const float scale : splats.deviations(p)) out.push_back(scale_byte(scale));
}

void put_turns(const SplatRows& splats, int version, Bytes& out) {
  for (std::size_t p = 0; p < splats.size(); ++p)
    if (version == 2)
      put_first_three(splats.rotation(p), out);
    else
      put_smallest_three(splats.rotation(p), out);
}

void put_opacities(const SplatRows& splats, Bytes& out) {
  for (std::size_t p = 0; p < splats.size(); ++p) out.push_back(byte_of(255 * splats.opacity(p)));
}

void put_colours(const SplatRows& splats, Bytes& out) {
  for (std::size_t p = 0; p < splats.size(); ++p)
    for (std::size_t c = 0; c < 3; ++c)
      out.push_back(byte_of(255 * (kColourScale * splats.harmonics(p)[c] + 0.5f)));
}

void put_harmonics(const SplatRows& splats, int degree, Bytes& out) {
  for (std::size_t p = 0; p < splats.size(); ++p)
    for (std::size_t i = 3; i < 3 * functions_of(degree); ++i)
      out.push_back(harmonic_byte(splats.harmonics(p)[i]));
}

/// SPZ has bytes for sizes from exp(-10) to exp(5.9). What is smaller may be drawn larger, but not
/// discs of which a cloud is made.
bool holds(const SplatRows& splats) {
  float least = INFINITY, most = 0;
  for (std::size_t p = 0; p < splats.size(); ++p) {
    const auto sizes = splats.deviations(p);
    least = std::min(least, std::max({sizes[0], sizes[1], sizes[2]}));
    most = std::max({most, sizes[0], sizes[1], sizes[2]});
  }
  return (splats.step() == 0 || std::log(least) > -kScaleOffset) &&
         std::log(most) < 255 / kScaleSteps - kScaleOffset;
}

/// Attributes in their order; degree 0 has no last one.
std::vector<Bytes> spz_attributes(const SplatRows& splats, int version, int bits, int degree) {
  std::vector<Bytes> out(degree == 0 ? 5 : 6);
  put_positions(splats, bits, out[0]);
  put_opacities(splats, out[1]);
  put_colours(splats, out[2]);
  put_sizes(splats, out[3]);
  put_turns(splats, version, out[4]);
  if (degree > 0) put_harmonics(splats, degree, out[5]);
  return out;
}

/// Version 4: how many bytes each attribute takes, packed and not, then these.
Result<Bytes, InputError> spz4_file(Bytes header, const std::vector<Bytes>& attributes) {
  if (!has_zstd())
    return InputError{Errc::kUnsupported,
                      "SPZ 4 is in zstd, which this build does not write (SLF_ZSTD)"};
  const auto put_long = [&](std::uint64_t value) {
    put(header, static_cast<std::uint32_t>(value));
    put(header, static_cast<std::uint32_t>(value >> 32));
  };
  header.back() = static_cast<std::uint8_t>(attributes.size());
  put(header, kSpz4Header);
  header.resize(kSpz4Header);
  Bytes all;
  for (const Bytes& attribute : attributes) {
    const auto packed = zstd(attribute);
    if (!packed) return InputError{Errc::kInvalidInput, "SPZ 4: no memory to pack it"};
    put_long(packed->size());
    put_long(attribute.size());
    all.insert(all.end(), packed->begin(), packed->end());
  }
  header.insert(header.end(), all.begin(), all.end());
  return header;
}

}  // namespace

Result<Bytes, InputError> write_spz(const SplatRows& splats, int version) {
  const int bits = fraction_bits(splats);
  const int degree = std::min(splats.degree(), version == 4 ? kSpz4Degree : kSpzDegree);
  if (bits < 0 || (splats.step() > 0 && std::ldexp(splats.step(), bits) < 1))
    return InputError{Errc::kInvalidInput, "SPZ cannot hold its coordinates"};
  if (!holds(splats))
    return InputError{Errc::kInvalidInput,
                      "SPZ holds splats of 0.00005 to 380 units" +
                          (splats.step() > 0 ? ", and points here are as far apart as " +
                                                   std::to_string(splats.step())
                                             : ", and one here is larger")};
  Bytes raw;
  put(raw, kMagic);
  put(raw, static_cast<std::uint32_t>(version));
  put(raw, static_cast<std::uint32_t>(splats.size()));
  for (const int byte : {degree, bits, 0, 0}) raw.push_back(static_cast<std::uint8_t>(byte));
  const std::vector<Bytes> attributes = spz_attributes(splats, version, bits, degree);
  if (version == 4) return spz4_file(std::move(raw), attributes);
  for (const Bytes& attribute : attributes)
    raw.insert(raw.end(), attribute.begin(), attribute.end());
  return gzip(raw);
}

SplatCloud rounded_to_spz(SplatCloud splats) {
  const std::size_t row = 3 * splats.num_harmonics();
  const int bits = std::max(0, fraction_bits(DiscRows(splats)));
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
