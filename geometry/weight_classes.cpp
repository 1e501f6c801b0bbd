// SPDX-License-Identifier: Apache-2.0
#include "geometry/weight_classes.h"

#include <bit>

namespace slf {
namespace {

/// Face neighbours, of which the first three come before the cell itself.
constexpr std::array<int, 6> kFaces = {direction_index(0, 0, -1), direction_index(0, -1, 0),
                                       direction_index(-1, 0, 0), direction_index(1, 0, 0),
                                       direction_index(0, 1, 0),  direction_index(0, 0, 1)};
constexpr std::uint32_t kBesideSums = 3 * kMostWeightClass + 1;

}  // namespace

std::uint8_t weight_class(std::uint64_t points) {
  // 2^(2k - 1) <= points^2 < 2^(2k + 1)
  return static_cast<std::uint8_t>(std::bit_width(points * points) / 2);
}

std::vector<std::uint32_t> weights_before(std::span<const std::uint8_t> classes) {
  std::vector<std::uint32_t> before{0};
  before.reserve(classes.size() + 1);
  for (const std::uint8_t k : classes) before.push_back(before.back() + (std::uint32_t{1} << k));
  return before;
}

WeightClassModel::WeightClassModel(const OctreeLevel& cells) : cells_(&cells) {}

std::array<std::uint32_t, 3> WeightClassModel::next_contexts() {
  const std::size_t n = classes_.size();
  const auto& codes = cells_->morton;
  if (n == family_end_) {
    family_ = 0;
    for (; family_end_ < codes.size() && codes[family_end_] >> 3 == codes[n] >> 3; ++family_end_)
      family_ |= 1u << (codes[family_end_] & 7);
  }
  std::uint32_t faces = 0, beside = 0;
  for (std::size_t i = 0; i < kFaces.size(); ++i) {
    if ((cells_->around[n].directions >> kFaces[i] & 1) == 0) continue;
    faces |= 1u << i;
    if (i < 3)
      beside += kBesideSums + classes_[cells_->neighbour(n, static_cast<std::size_t>(kFaces[i]))];
  }
  return {Beside::index(beside, 0), Faces::index(faces, 0), Family::index(family_, 0)};
}

}  // namespace slf
