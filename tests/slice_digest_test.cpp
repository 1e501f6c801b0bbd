#include "codec/slice_digest.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/sha256.h"

namespace slf::slice_digest_test {
namespace {

using Positions = std::vector<Voxel>;

void append(std::vector<std::uint8_t>& bytes, std::uint64_t value, int size) {
  for (int b = 0; b < size; ++b) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * b)));
}

TEST(SliceDigest, IsOfTheBytesOfClause7_9) {
  const Positions positions = {{1, 2, 3}, {4, 5, 600}};
  const std::vector<std::int32_t> components = {0, -1, 7, 1 << 26, -(1 << 26), 12345};
  const std::vector<std::array<std::uint16_t, 2>> normals = {{1, 2}, {300, 65535}};
  std::vector<std::uint8_t> bytes;
  for (const Voxel& v : positions)
    for (const std::int32_t x : v) append(bytes, static_cast<std::uint32_t>(x), 4);
  for (std::size_t p = 0; p < 2; ++p) {
    std::uint64_t hash = 0, power = 1;
    for (std::size_t j = 0; j < 3; ++j) {
      power = power * 0x9E3779B5u % (std::uint64_t{1} << 32);
      hash += static_cast<std::uint32_t>(components[3 * p + j]) * power;
    }
    append(bytes, hash, 8);
  }
  for (const auto& normal : normals)
    for (const std::uint16_t x : normal) append(bytes, x, 2);
  Sha256 sha;
  sha.update(bytes);
  EXPECT_EQ(slice_digest(positions, components, normals), sha.finish());
}

TEST(SliceDigest, ChangesWithErrorsThatCancelInSums) {
  const Positions positions(1);
  std::vector<std::int32_t> components(363);
  for (std::size_t j = 0; j < components.size(); ++j)
    components[j] = static_cast<std::int32_t>(j * j % 97) - 48;
  const auto sound = slice_digest(positions, components, {});
  for (std::size_t j = 0; j + 4 <= components.size(); ++j)
    for (const auto& errors :
         {std::array{1, 0, 0, 0}, {1, -1, 0, 0}, {1, -2, 1, 0}, {1, -1, -1, 1}, {1, -3, 3, -1}}) {
      auto damaged = components;
      for (std::size_t i = 0; i < 4; ++i) damaged[j + i] += errors[i];
      EXPECT_NE(slice_digest(positions, damaged, {}), sound) << j;
    }
}

}  // namespace
}  // namespace slf::slice_digest_test
