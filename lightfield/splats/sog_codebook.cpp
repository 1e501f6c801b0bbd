// SPDX-License-Identifier: Apache-2.0
#include "lightfield/splats/sog_codebook.h"

#include <algorithm>
#include <cassert>

namespace slf {
namespace {

constexpr int kCodebookRounds = 64;  // each takes some microseconds: cells are found by bisection

/// Ascending numbers, and sums of those before each.
struct SortedNumbers {
  std::vector<float> numbers;
  std::vector<double> sums;  // [n + 1]

  explicit SortedNumbers(std::vector<float> given) : numbers(std::move(given)) {
    std::sort(numbers.begin(), numbers.end());
    sums.reserve(numbers.size() + 1);
    sums.push_back(0);
    for (const float x : numbers) sums.push_back(sums.back() + double{x});
  }
};

/// Half of the way from the least to the greatest goes by their distance, half by how many there
/// are: values far from the others then have levels of their own.
std::vector<float> first_levels(const std::vector<float>& sorted, std::size_t levels) {
  const double least = double{sorted.front()}, range = double{sorted.back()} - least;
  const auto count = static_cast<double>(sorted.size());
  std::vector<float> out;
  std::size_t i = 0;
  for (std::size_t level = 0; level < levels; ++level) {
    const double wanted = (static_cast<double>(level) + 0.5) / static_cast<double>(levels);
    const auto way = [&](std::size_t at) {
      return 0.5 * (static_cast<double>(at) + 0.5) / count +
             0.5 * (double{sorted[at]} - least) / range;
    };
    while (i + 1 < sorted.size() && way(i) < wanted) ++i;
    out.push_back(sorted[i]);
  }
  return out;
}

/// Every level becomes the mean of the numbers that are nearest to it. False: none moved.
bool move_levels(const SortedNumbers& sorted, std::vector<float>& levels) {
  bool moved = false;
  std::size_t begin = 0;
  const std::vector<float> before = levels;
  for (std::size_t level = 0; level < levels.size(); ++level) {
    std::size_t end = sorted.numbers.size();
    if (level + 1 < levels.size()) {
      const float middle = 0.5f * before[level] + 0.5f * before[level + 1];
      end = static_cast<std::size_t>(
          std::upper_bound(sorted.numbers.begin(), sorted.numbers.end(), middle) -
          sorted.numbers.begin());
    }
    if (end <= begin) continue;
    levels[level] = static_cast<float>((sorted.sums[end] - sorted.sums[begin]) /
                                       static_cast<double>(end - begin));
    moved = moved || levels[level] != before[level];
    begin = end;
  }
  return moved;
}

std::vector<float> levels_of(const std::vector<float>& numbers, std::size_t levels) {
  const SortedNumbers sorted(numbers);
  std::vector<float> different = sorted.numbers;
  different.erase(std::unique(different.begin(), different.end()), different.end());
  if (different.size() <= levels) return different;
  std::vector<float> out = first_levels(sorted.numbers, levels);
  for (int round = 0; round < kCodebookRounds && move_levels(sorted, out); ++round) {
  }
  std::sort(out.begin(), out.end());  // rounding of means may have exchanged two that are equal
  return out;
}

std::uint8_t nearest_level(const std::vector<float>& levels, float number) {
  const auto above = std::lower_bound(levels.begin(), levels.end(), number);
  if (above == levels.begin()) return 0;
  const bool below = above == levels.end() ||
                     double{number} - double{above[-1]} <= double{*above} - double{number};
  return static_cast<std::uint8_t>(above - levels.begin() - (below ? 1 : 0));
}

}  // namespace

ByteCodebook byte_codebook(const std::vector<float>& numbers, std::size_t levels) {
  assert(!numbers.empty() && levels >= 1 && levels <= 256);
  const std::vector<float> found = levels_of(numbers, levels);
  ByteCodebook out;
  out.values.fill(found.back());
  std::copy(found.begin(), found.end(), out.values.begin());
  out.bytes.reserve(numbers.size());
  for (const float x : numbers) out.bytes.push_back(nearest_level(found, x));
  return out;
}

}  // namespace slf
