// SPDX-License-Identifier: Apache-2.0
// .splat (Kwok): 32 bytes a splat, without a header. Position and deviations as floats, colour and
// opacity as bytes, a quaternion of four bytes about 128.
#include <bit>
#include <cmath>

#include "lightfield/splats/gaussian_readers.h"

namespace slf {
namespace {

constexpr std::size_t kSplatBytes = 32;
constexpr std::size_t kLookedAt = 64;  // splats that tell the format
constexpr float kFarthestPlace = 1e6f, kLargestSize = 1e5f;

float float_at(FileBytes bytes, std::size_t at) {
  return std::bit_cast<float>(word_at(bytes, at, 4));
}

RawGaussian record_at(FileBytes bytes, std::size_t at) {
  RawGaussian raw;
  for (std::size_t k = 0; k < 3; ++k) {
    raw.position[k] = float_at(bytes, at + 4 * k);
    raw.log_deviations[k] = log_deviation_of(float_at(bytes, at + 12 + 4 * k));
  }
  raw.logit = logit_of_byte(bytes[at + 27]);
  for (std::size_t k = 0; k < 4; ++k)
    raw.rotation[k] = (static_cast<float>(bytes[at + 28 + k]) - 128) / 128;
  return raw;
}

/// What a record of another kind is hardly ever: near, not large, and with a turn of unit length.
bool is_plausible(FileBytes bytes, std::size_t at) {
  float square = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const float x = (static_cast<float>(bytes[at + 28 + k]) - 128) / 128;
    square += x * x;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const float place = float_at(bytes, at + 4 * k), size = float_at(bytes, at + 12 + 4 * k);
    if (!(std::abs(place) < kFarthestPlace && size >= 0 && size < kLargestSize)) return false;
  }
  return square > 0.9f && square < 1.1f;
}

}  // namespace

bool is_splat(FileBytes head, std::uint64_t size) {
  if (size == 0 || size % kSplatBytes != 0 || head.size() < kSplatBytes) return false;
  const std::size_t records = std::min(head.size() / kSplatBytes, kLookedAt);
  std::size_t plausible = 0;
  for (std::size_t i = 0; i < records; ++i) plausible += is_plausible(head, kSplatBytes * i);
  return 10 * plausible >= 9 * records;  // some may be broken
}

Result<GaussianFile, InputError> read_splat(const std::string& name, FileBytes bytes) {
  if (bytes.size() % kSplatBytes != 0)
    return InputError{Errc::kInvalidInput,
                      name + ": splat: " + std::to_string(bytes.size()) +
                          " bytes, which is no multiple of the 32 that a splat takes"};
  GaussianCollector collector(0, UpAxis::kMinusY, bytes.size() / kSplatBytes);
  for (std::size_t at = 0; at < bytes.size(); at += kSplatBytes) {
    std::array<float, 3> harmonics;
    for (std::size_t c = 0; c < 3; ++c)
      harmonics[c] = harmonic_of_colour(static_cast<float>(bytes[at + 24 + c]) / 255);
    collector.add(record_at(bytes, at), harmonics);
  }
  return std::move(collector).take(name, "splat");
}

}  // namespace slf
