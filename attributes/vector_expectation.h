// SPDX-License-Identifier: Apache-2.0
// How large the values of a vector are likely to be, by the vectors around it. Spec 8.7.2.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "attributes/kept_vectors.h"
#include "attributes/vector_surroundings.h"

namespace slf {

/// The vectors of the rows around one; zeros where there is no row.
struct VectorsAround {
  std::array<const std::int16_t*, Around::kRows> of{};  ///< as Around::row
  const std::int16_t* same_axis = nullptr;
};

inline VectorsAround vectors_around(const Around& around, const KeptVectors& kept) {
  VectorsAround vectors;
  for (std::size_t k = 0; k < Around::kRows; ++k) vectors.of[k] = kept.vector(around.row[k]);
  vectors.same_axis = kept.vector(around.same_axis);
  return vectors;
}

/// Expected magnitudes, 8 fractional bits.
class VectorExpectation {
 public:
  static constexpr std::size_t kRun = 4;  ///< functions

  /// width: planes of the group
  explicit VectorExpectation(std::size_t width)
      : parents_(KeptVectors::whole_blocks(width)),
        beside_(parents_.size()),
        rest_((width + 3 * kRun - 1) / (3 * kRun)) {}

  std::uint32_t parents(std::size_t j) const { return parents_[j]; }  ///< by what is above the row
  std::uint32_t beside(std::size_t j) const { return beside_[j]; }
  std::uint32_t both(std::size_t j) const { return (parents_[j] + beside_[j]) / 2; }
  /// The expectation for the functions of a run and those behind it.
  std::uint32_t rest(std::size_t run) const { return rest_[run]; }

  /// All planes at once. activity: [width] as VectorStates has it
  void expect(const Around& around, const VectorsAround& vectors,
              const std::vector<std::int32_t>& activity) {
    for (std::size_t j = 0; j < parents_.size(); j += kBlock) {
      const Block above = sum_of<0, Around::kParents>(around, vectors, j);
      std::copy(above.begin(), above.end(), &parents_[j]);
      const Block sum =
          around.any_beside ? sum_of<Around::kParents, Around::kRows>(around, vectors, j) : above;
      std::copy(sum.begin(), sum.end(), &beside_[j]);
    }
    sum_rest(activity);
  }

 private:
  static constexpr std::size_t kBlock = KeptVectors::kBlock;
  using Block = std::array<std::uint32_t, kBlock>;

  /// Weighted magnitudes of vectors kBegin .. kEnd - 1 in the planes from j on; behind the last
  /// plane they are of no meaning. Without branches: a vector that does not count has weight 0.
  template <std::size_t kBegin, std::size_t kEnd>
  static Block sum_of(const Around& around, const VectorsAround& vectors, std::size_t j) {
    Block sum{};
    for (std::size_t k = kBegin; k < kEnd; ++k) {
      const std::int16_t* const vector = vectors.of[k] + j;
      const std::uint32_t weight = around.weight[k];
      for (std::size_t i = 0; i < kBlock; ++i)
        sum[i] += weight * static_cast<std::uint32_t>(std::abs(int{vector[i]}));
    }
    return sum;
  }

  void sum_rest(const std::vector<std::int32_t>& activity) {
    std::uint32_t sum = 0;
    for (std::size_t run = rest_.size(); run-- > 0;) {
      for (std::size_t j = 3 * kRun * run; j < std::min(3 * kRun * (run + 1), activity.size()); ++j)
        sum += std::min(both(j) + (static_cast<std::uint32_t>(activity[j]) >> 5), 1u << 18);
      rest_[run] = sum;
    }
  }

  std::vector<std::uint32_t> parents_, beside_;  // [width], and to the end of the last block
  std::vector<std::uint32_t> rest_;              // [runs]
};

}  // namespace slf
