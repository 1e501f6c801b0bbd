#include "codec/slice_digest.h"

#include <algorithm>
#include <bit>
#include <vector>

#include "bitstream/sha256.h"

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
        bytes[b] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(values[i]) >> (8 * b));
      sha.update(bytes);
    }
  }
}

}  // namespace

std::array<std::uint8_t, 32> slice_digest(std::span<const Voxel> positions,
                                          std::span<const std::int32_t> components,
                                          std::span<const std::array<std::uint16_t, 2>> normals) {
  Sha256 sha;
  hash_little_endian(sha, positions.data()->data(), positions.size() * 3);
  hash_little_endian(sha, components.data(), components.size());
  if (!normals.empty()) hash_little_endian(sha, normals.data()->data(), normals.size() * 2);
  return sha.finish();
}

}  // namespace slf
