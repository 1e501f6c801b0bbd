#include "codec/slice_digest.h"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "base/multiversion.h"
#include "base/sha256.h"

namespace slf {
namespace {

template <class Integer>
void hash_little_endian(Sha256& sha, const Integer* values, std::size_t count) {
  if constexpr (std::endian::native == std::endian::little) {
    sha.update({reinterpret_cast<const std::uint8_t*>(values), count * sizeof(Integer)});
  } else {
    for (std::size_t i = 0; i < count; ++i) {
      std::array<std::uint8_t, sizeof(Integer)> bytes;
      for (std::size_t b = 0; b < sizeof(Integer); ++b)
        bytes[b] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(values[i]) >> (8 * b));
      sha.update(bytes);
    }
  }
}

/// Odd, so that no single wrong value goes unseen; powers, so that no few wrong values of
/// neighbouring planes cancel, as they would with multipliers in arithmetic progression.
std::vector<std::uint32_t> plane_multipliers(std::size_t planes) {
  constexpr std::uint32_t kRatio = 0x9E3779B5;
  std::vector<std::uint32_t> multipliers(planes, kRatio);
  for (std::size_t j = 1; j < planes; ++j) multipliers[j] = multipliers[j - 1] * kRatio;
  return multipliers;
}

SLF_OWN_CALL
inline std::uint64_t hash_row(const std::int32_t* __restrict components,
                              const std::uint32_t* __restrict multiplier, std::size_t planes) {
  std::uint64_t sum = 0;
  for (std::size_t j = 0; j < planes; ++j)
    sum += std::uint64_t{static_cast<std::uint32_t>(components[j])} * multiplier[j];
  return sum;
}

/// SHA-256 over every component would take as long as the inverse transform.
SLF_MULTIVERSION_LANES
void hash_rows(const std::int32_t* __restrict components,
               std::span<const std::uint32_t> multipliers, std::span<std::uint64_t> hashes) {
  const std::uint32_t* __restrict multiplier = multipliers.data();
  const std::size_t planes = multipliers.size();
  for (std::uint64_t& hash : hashes) {
    hash = hash_row(components, multiplier, planes);
    components += planes;
  }
}

}  // namespace

std::array<std::uint8_t, 32> slice_digest(std::span<const Voxel> positions,
                                          std::span<const std::int32_t> components,
                                          std::span<const std::array<std::uint16_t, 2>> normals) {
  Sha256 sha;
  hash_little_endian(sha, positions.data()->data(), positions.size() * 3);
  const auto multipliers = plane_multipliers(components.size() / positions.size());
  std::array<std::uint64_t, 512> hashes;
  while (!components.empty()) {
    const std::size_t rows = std::min(hashes.size(), components.size() / multipliers.size());
    hash_rows(components.data(), multipliers, std::span(hashes).first(rows));
    hash_little_endian(sha, hashes.data(), rows);
    components = components.subspan(rows * multipliers.size());
  }
  if (!normals.empty()) hash_little_endian(sha, normals.data()->data(), normals.size() * 2);
  return sha.finish();
}

}  // namespace slf
