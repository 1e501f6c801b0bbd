// SPDX-License-Identifier: Apache-2.0
#include "lightfield/splats/sog_palette.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <queue>

#include "slf/parallel.h"

namespace slf {
namespace {

constexpr int kHalvingRounds = 4, kPaletteRounds = 8;
/// Products of a round, which bound its time to some tenths of a second of one core; and clusters
/// to either side that a row looks at however many rows there are.
constexpr std::size_t kRoundProducts = std::size_t{1} << 31, kLeastReach = 64;
constexpr std::size_t kRowsPerRange = 256, kDistanceLanes = 8;

/// Rows of a cluster, a range of the list of rows that PaletteHalving keeps.
struct PaletteCluster {
  std::size_t begin = 0, end = 0;
  double error = 0;           // sum of squares about the mean
  std::size_t dimension = 0;  // in which most of it is
};

struct LessError {
  bool operator()(const PaletteCluster& a, const PaletteCluster& b) const {
    return a.error != b.error ? a.error < b.error : a.begin > b.begin;
  }
};

class PaletteHalving {
 public:
  explicit PaletteHalving(const VectorRows& rows) : rows_(rows), list_(rows.size()) {
    std::iota(list_.begin(), list_.end(), std::uint32_t{0});
  }

  /// Labels in the order of the list, so that clusters of one half have numbers next to each other.
  std::vector<std::uint32_t> labels(std::size_t most) {
    std::priority_queue<PaletteCluster, std::vector<PaletteCluster>, LessError> clusters;
    clusters.push(cluster(0, list_.size()));
    while (clusters.size() < most && clusters.top().error > 0) {
      const PaletteCluster whole = clusters.top();
      clusters.pop();
      const std::size_t middle = halve(whole);
      clusters.push(cluster(whole.begin, middle));
      clusters.push(cluster(middle, whole.end));
    }
    std::vector<std::size_t> begins;
    for (; !clusters.empty(); clusters.pop()) begins.push_back(clusters.top().begin);
    std::sort(begins.begin(), begins.end());
    std::vector<std::uint32_t> out(list_.size());
    for (std::size_t k = 0; k < begins.size(); ++k) {
      const std::size_t end = k + 1 < begins.size() ? begins[k + 1] : list_.size();
      for (std::size_t i = begins[k]; i < end; ++i) out[list_[i]] = static_cast<std::uint32_t>(k);
    }
    return out;
  }

 private:
  std::vector<double> mean(std::size_t begin, std::size_t end) const {
    std::vector<double> sums(rows_.dimensions);
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t d = 0; d < rows_.dimensions; ++d) sums[d] += double{rows_[list_[i]][d]};
    for (double& sum : sums) sum /= static_cast<double>(end - begin);
    return sums;
  }

  PaletteCluster cluster(std::size_t begin, std::size_t end) const {
    PaletteCluster out{begin, end, 0, 0};
    if (end - begin < 2) return out;
    const std::vector<double> middle = mean(begin, end);
    std::vector<double> errors(rows_.dimensions);
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t d = 0; d < rows_.dimensions; ++d) {
        const double off = double{rows_[list_[i]][d]} - middle[d];
        errors[d] += off * off;
      }
    out.dimension =
        static_cast<std::size_t>(std::max_element(errors.begin(), errors.end()) - errors.begin());
    out.error = std::accumulate(errors.begin(), errors.end(), 0.0);
    // What rounding of the mean leaves of equal rows is no error, and no half of them is nearer.
    if (std::all_of(list_.begin() + std::ptrdiff_t(begin), list_.begin() + std::ptrdiff_t(end),
                    [&](std::uint32_t row) {
                      return std::equal(rows_[row], rows_[row] + rows_.dimensions,
                                        rows_[list_[begin]]);
                    }))
      out.error = 0;
    return out;
  }

  /// Where the second half begins; neither is empty. First by the dimension with most error, then
  /// by which mean is nearer.
  std::size_t halve(const PaletteCluster& whole) {
    const auto begin = list_.begin() + std::ptrdiff_t(whole.begin);
    const auto end = list_.begin() + std::ptrdiff_t(whole.end);
    const std::size_t d = whole.dimension;
    const double middle = mean(whole.begin, whole.end)[d];
    auto cut = std::stable_partition(
        begin, end, [&](std::uint32_t row) { return double{rows_[row][d]} < middle; });
    if (cut == begin || cut == end) {  // by rounding: one of them stands alone
      std::stable_sort(begin, end,
                       [&](std::uint32_t a, std::uint32_t b) { return rows_[a][d] < rows_[b][d]; });
      return whole.begin + 1;
    }
    for (int round = 0; round < kHalvingRounds; ++round) {
      const auto at = whole.begin + std::size_t(cut - begin);
      const std::vector<double> left = mean(whole.begin, at), right = mean(at, whole.end);
      const auto next = std::stable_partition(begin, end, [&](std::uint32_t row) {
        return distance(row, left) <= distance(row, right);
      });
      if (next == begin || next == end || next == cut) break;
      cut = next;
    }
    return whole.begin + std::size_t(cut - begin);
  }

  double distance(std::uint32_t row, const std::vector<double>& from) const {
    double sum = 0;
    for (std::size_t d = 0; d < rows_.dimensions; ++d) {
      const double off = double{rows_[row][d]} - from[d];
      sum += off * off;
    }
    return sum;
  }

  const VectorRows& rows_;
  std::vector<std::uint32_t> list_;
};

float squared_distance(const float* a, const float* b, std::size_t dimensions) {
  std::array<float, kDistanceLanes> lanes{};
  for (std::size_t d = 0; d < dimensions; d += kDistanceLanes)
    for (std::size_t lane = 0; lane < kDistanceLanes; ++lane) {
      const float off = a[d + lane] - b[d + lane];
      lanes[lane] += off * off;
    }
  return std::accumulate(lanes.begin(), lanes.end(), 0.0f);
}

/// Means of the rows of every label; labels without rows go, and those behind them move up.
VectorRows means_of(const VectorRows& rows, std::vector<std::uint32_t>& labels) {
  const std::size_t dimensions = rows.dimensions;
  const std::size_t count = std::size_t{*std::max_element(labels.begin(), labels.end())} + 1;
  std::vector<double> sums(count * dimensions);
  std::vector<std::size_t> members(count);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ++members[labels[i]];
    for (std::size_t d = 0; d < dimensions; ++d)
      sums[labels[i] * dimensions + d] += double{rows[i][d]};
  }
  VectorRows out{dimensions, {}};
  std::vector<std::uint32_t> number(count);
  for (std::size_t k = 0; k < count; ++k) {
    if (members[k] == 0) continue;
    number[k] = static_cast<std::uint32_t>(out.size());
    for (std::size_t d = 0; d < dimensions; ++d)
      out.numbers.push_back(
          static_cast<float>(sums[k * dimensions + d] / static_cast<double>(members[k])));
  }
  for (std::uint32_t& label : labels) label = number[label];
  return out;
}

/// The nearest vector of those at most `reach` numbers away.
std::uint32_t nearest_vector(const float* row, const VectorRows& vectors, std::uint32_t label,
                             std::size_t reach) {
  const std::size_t begin = label > reach ? label - reach : 0;
  const std::size_t end = std::min(vectors.size(), label + reach + 1);
  std::size_t best = label;
  float least = squared_distance(row, vectors[label], vectors.dimensions);
  for (std::size_t k = begin; k < end; ++k) {
    const float distance = squared_distance(row, vectors[k], vectors.dimensions);
    if (distance < least) {
      least = distance;
      best = k;
    }
  }
  return static_cast<std::uint32_t>(best);
}

}  // namespace

VectorPalette vector_palette(const VectorRows& rows, std::size_t most, int threads) {
  VectorPalette out;
  out.labels = PaletteHalving(rows).labels(most);
  out.vectors = means_of(rows, out.labels);
  const std::size_t reach = std::max(kLeastReach, kRoundProducts / 2 / rows.numbers.size());
  for (int round = 0; round < kPaletteRounds; ++round) {
    const std::vector<std::uint32_t> before = out.labels;
    parallel_ranges(rows.size(), kRowsPerRange, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        out.labels[i] = nearest_vector(rows[i], out.vectors, before[i], reach);
    });
    if (out.labels == before) break;
    out.vectors = means_of(rows, out.labels);
  }
  return out;
}

}  // namespace slf
