// SPDX-License-Identifier: Apache-2.0
#include "codec/slice_digest.h"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "base/multiversion.h"
#include "base/sha256.h"

namespace slf {
namespace {

constexpr std::size_t kRun = 64;
constexpr std::uint64_t kRunRatio = 0x9E3779B97F4A7C15;

/// Odd, so that no single wrong number goes unseen; powers, so that no few wrong numbers of
/// neighbouring planes cancel, as they would with multipliers in arithmetic progression.
std::vector<std::uint32_t> multipliers_of_numbers(std::size_t numbers) {
  constexpr std::uint32_t kRatio = 0x9E3779B5;
  std::vector<std::uint32_t> multipliers(numbers, kRatio);
  for (std::size_t i = 1; i < numbers; ++i) multipliers[i] = multipliers[i - 1] * kRatio;
  return multipliers;
}

SLF_OWN_CALL
inline std::uint64_t hash_numbers(const std::int32_t* __restrict numbers,
                                  const std::uint32_t* __restrict multiplier, std::size_t count) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < count; ++i)
    sum += std::uint64_t{static_cast<std::uint32_t>(numbers[i])} * multiplier[i];
  return sum;
}

/// SHA-256 over every component would take as long as the inverse transform.
SLF_MULTIVERSION_LANES
std::uint64_t hash_run(std::span<const Voxel> positions, const std::int32_t* components,
                       const std::array<std::uint16_t, 2>* normals,
                       std::span<const std::uint32_t> multipliers) {
  const std::uint32_t* m = multipliers.data();
  const std::size_t planes = multipliers.size() - 5;
  std::uint64_t hash = 0;
  for (const Voxel& v : positions) {
    hash =
        hash * kRunRatio + hash_numbers(v.data(), m, 3) + hash_numbers(components, m + 3, planes);
    components += planes;
    if (normals == nullptr) continue;
    const std::array<std::int32_t, 2> normal = {(*normals)[0], (*normals)[1]};
    hash += hash_numbers(normal.data(), m + 3 + planes, 2);
    ++normals;
  }
  return hash;
}

}  // namespace

std::array<std::uint8_t, 32> slice_digest(std::span<const Voxel> positions,
                                          std::span<const std::int32_t> components,
                                          std::span<const std::array<std::uint16_t, 2>> normals) {
  Sha256 sha;
  const std::size_t planes = components.size() / positions.size();
  const auto multipliers = multipliers_of_numbers(3 + planes + 2);
  for (std::size_t begin = 0; begin < positions.size(); begin += kRun) {
    const std::uint64_t hash =
        hash_run(positions.subspan(begin, std::min(kRun, positions.size() - begin)),
                 components.data() + begin * planes,
                 normals.empty() ? nullptr : normals.data() + begin, multipliers);
    auto bytes = std::bit_cast<std::array<std::uint8_t, 8>>(hash);
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
    sha.update(bytes);
  }
  return sha.finish();
}

}  // namespace slf
