// SPDX-License-Identifier: Apache-2.0
// How large the values of a vector are likely to be, by the vectors around it. Spec 8.7.2.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "attributes/kept_vectors.h"
#include "attributes/vector_surroundings.h"

namespace slf {

/// Expected magnitudes, 8 fractional bits.
class VectorExpectation {
 public:
  static constexpr std::size_t kRun = 4;  ///< functions

  /// width: planes of the group
  explicit VectorExpectation(std::size_t width)
      : parents_(width), beside_(width), rest_((width + 3 * kRun - 1) / (3 * kRun)) {}

  std::uint32_t parents(std::size_t j) const { return parents_[j]; }  ///< by what is above the row
  std::uint32_t beside(std::size_t j) const { return beside_[j]; }
  std::uint32_t both(std::size_t j) const { return (parents_[j] + beside_[j]) / 2; }
  /// The expectation for the functions of a run and those behind it.
  std::uint32_t rest(std::size_t run) const { return rest_[run]; }

  /// All planes at once: most vectors around are zero. activity: [width] as VectorStates has it
  void expect(const Around& around, const KeptVectors& kept,
              const std::vector<std::int32_t>& activity) {
    std::fill(parents_.begin(), parents_.end(), 0u);
    std::fill(beside_.begin(), beside_.end(), 0u);
    for (std::size_t k = 0; k < Around::kRows; ++k) {
      if (around.weight[k] == 0) continue;
      const std::int16_t* vector = kept.vector(around.row[k]);
      std::uint32_t* sums = k < Around::kParents ? parents_.data() : beside_.data();
      for (std::size_t j = 0; j < parents_.size(); ++j)
        sums[j] += around.weight[k] * static_cast<std::uint32_t>(std::abs(int{vector[j]}));
    }
    if (!around.any_beside) beside_ = parents_;
    sum_rest(activity);
  }

 private:
  void sum_rest(const std::vector<std::int32_t>& activity) {
    std::uint32_t sum = 0;
    for (std::size_t run = rest_.size(); run-- > 0;) {
      for (std::size_t j = 3 * kRun * run; j < std::min(3 * kRun * (run + 1), parents_.size()); ++j)
        sum += std::min(both(j) + (static_cast<std::uint32_t>(activity[j]) >> 5), 1u << 18);
      rest_[run] = sum;
    }
  }

  std::vector<std::uint32_t> parents_, beside_;  // [width]
  std::vector<std::uint32_t> rest_;              // [runs]
};

}  // namespace slf
