// SPDX-License-Identifier: Apache-2.0
#include "attributes/raht_inverse.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <memory>

#include "attributes/kept_means.h"
#include "attributes/level_prediction.h"
#include "attributes/quantiser.h"
#include "attributes/raht_arithmetic.h"
#include "attributes/weight_roots.h"
#include "base/huge_pages.h"
#include "base/multiversion.h"
#include "base/prefetch.h"
#include "slf/parallel.h"

namespace slf {
namespace {

/// Planes tested for zeros together: 192 bytes of a row, three cache lines.
constexpr std::size_t kBlock = kPredictionLanes;

/// Step of every plane, and the largest quantised value below 2^27.
struct Steps {
  explicit Steps(std::span<const std::uint32_t> of_planes) {
    for (const std::uint32_t s : of_planes) {
      step.push_back(static_cast<std::int32_t>(s));
      most.push_back(static_cast<std::int32_t>((kCoefficientLimit - 1) / s));
    }
  }
  std::vector<std::int32_t> step, most;
};

/// `lanes` of both rows of a merge where the difference is zero, as most are.
inline void spread_mean(const Merge& m, std::int32_t* __restrict low, std::int32_t* __restrict high,
                        std::size_t lanes) {
  const std::int32_t cosine = m.cos_q30, sine = m.sin_q30;
  if (cosine == sine)  // of the same weight, as single points are
    return for_values(lanes, [=](auto at) {
      const auto half = rounded<30>(product(value_at(low, at), cosine));
      set_value(low, at, half);
      set_value(high, at, half);
    });
  for_values(lanes, [=](auto at) {
    const auto mean = value_at(low, at);
    set_value(low, at, rounded<30>(product(mean, cosine)));
    set_value(high, at, rounded<30>(product(mean, sine)));
  });
}

/// The same for any difference, still quantised. Not zero: a coefficient is too large; it counts
/// as the largest. m: a copy, since a compiler takes what is stored for a part of any other.
inline std::int32_t inverse_rows(const Merge m, std::int32_t* __restrict low,
                                 std::int32_t* __restrict high, const std::int32_t* __restrict step,
                                 const std::int32_t* __restrict most, std::size_t lanes) {
  std::int32_t bad = 0;
  for_values(lanes, [=, &bad](auto at) {
    auto left = value_at(low, at), right = value_at(high, at);
    const auto within = limited(right, value_at(most, at));
    bad |= differ(right, within);
    inverse_merge(m, left, within * value_at(step, at), left, right);
    set_value(low, at, left);
    set_value(high, at, right);
  });
  return bad;
}

inline bool any_nonzero(const std::int32_t* values, std::size_t lanes) {
  std::int32_t any = 0;
  for_values(lanes, [&any, values](auto at) { any |= differ(value_at(values, at), 0); });
  return any != 0;
}

/// Planes begin .. end - 1 of everything.
struct Planes {
  Lanes values;
  const std::int32_t* step;
  const std::int32_t* most;
  std::size_t lanes;
  std::span<const std::uint8_t> nonzero;  // [rows] 0: the row's difference is zero; empty: unknown

  Planes(std::span<std::int32_t> all, const Steps& steps, std::size_t begin, std::size_t end,
         std::span<const std::uint8_t> nonzero_rows)
      : values{all.data() + begin, steps.step.size()},
        step(steps.step.data() + begin),
        most(steps.most.data() + begin),
        lanes(end - begin),
        nonzero(nonzero_rows) {}

  bool is_zero(std::uint32_t row) const { return !nonzero.empty() && nonzero[row] == 0; }
};

inline std::int32_t inverse_block(const Merge& m, bool zero, const Planes& range, std::size_t j,
                                  std::size_t lanes) {
  std::int32_t* low = range.values.row(m.left) + j;
  std::int32_t* high = range.values.row(m.right) + j;
  if (!zero && any_nonzero(high, lanes))
    return inverse_rows(m, low, high, range.step + j, range.most + j, lanes);
  if (any_nonzero(low, lanes)) spread_mean(m, low, high, lanes);
  return 0;
}

SLF_MULTIVERSION_LANES
std::int32_t inverse_lanes(std::span<const Merge> merges, const Planes& range, std::size_t first,
                           std::size_t lanes) {
  std::int32_t bad = 0;
  for (const Merge& m : merges) {
    const bool zero = range.is_zero(m.right);
    std::size_t j = first;
    for (; j + kBlock <= first + lanes; j += kBlock)
      bad |= inverse_block(m, zero, range, j, kBlock);
    if (j < first + lanes) bad |= inverse_block(m, zero, range, j, first + lanes - j);
  }
  return bad;
}

/// Row 0 holds the mean of all, which no merge dequantises.
std::int32_t dequantise_mean(const Planes& range) {
  std::int32_t bad = 0;
  for (std::size_t j = 0; j < range.lanes; ++j) {
    std::int32_t& value = range.values.first[j];
    const bool good = value <= range.most[j] && value >= -range.most[j];
    bad |= !good;
    value = good ? value * range.step[j] : 0;
  }
  return bad;
}

/// Planes begin .. end - 1 of a range.
struct Run {
  std::size_t begin, end;
  std::uint32_t mode;
};

/// Spec 8.7.6: a node, its own merges.
std::int32_t inverse_node(const TransformLevel& level, std::size_t n, std::span<const Merge> own,
                          const Run& run, const Planes& range, Lanes means, ConstLanes reference) {
  if (run.mode == 0) return inverse_lanes(own, range, run.begin, run.end - run.begin);
  std::int32_t bad = 0;
  NodePrediction plan;
  Corrections corrections;
  plan_node(level, n, run.mode, plan);
  for (std::size_t j = run.begin; j < run.end; j += kBlock) {
    const std::size_t lanes = std::min(kBlock, run.end - j);
    const Lanes values{range.values.first + j, range.values.stride};
    predict_children(plan, values, {means.first + j, means.stride}, reference.from(j), lanes,
                     corrections);
    bad |= inverse_lanes(own, range, j, lanes);
    add_corrections(plan, corrections, values, lanes);
  }
  return bad;
}

constexpr std::size_t kMergesAhead = 8;  // whose rows are asked for: a node or two

/// Spec 8.7.6. merges: of the level. Node by node, not run by run: a level does not fit the cache.
std::int32_t inverse_level(const TransformLevel& level, std::span<const Merge> merges,
                           std::span<const Run> runs, const Planes& range, Lanes means,
                           ConstLanes reference) {
  if (runs.size() == 1 && runs[0].mode == 0) return inverse_lanes(merges, range, 0, range.lanes);
  std::int32_t bad = 0;
  std::size_t means_begin = 0;
  for (std::size_t n = 0, merge = 0; n < level.nodes.size(); ++n) {
    if (!level.branches(n)) continue;
    const auto children = static_cast<std::size_t>(std::popcount(level.nodes.occupancy[n]));
    const std::size_t ahead = merge + kMergesAhead;
    for (std::size_t i = ahead; i < std::min(ahead + children - 1, merges.size()); ++i) {
      prefetch_row(range.values.row(merges[i].left), range.lanes);
      prefetch_row(range.values.row(merges[i].right), range.lanes);
    }
    for (const Run& run : runs) {
      if (run.mode != 0)
        level_means(level, means_begin, level.means_end[n],
                    {range.values.first + run.begin, range.values.stride},
                    {means.first + run.begin, means.stride}, run.end - run.begin);
      bad |=
          inverse_node(level, n, merges.subspan(merge, children - 1), run, range, means, reference);
    }
    means_begin = level.means_end[n];
    merge += children - 1;
  }
  return bad;
}

/// Whole rows on one thread: merges of a level follow one another in memory.
template <class Body>
bool over_planes(std::size_t planes, int threads, const Body& body) {
  const std::size_t blocks = (planes + kBlock - 1) / kBlock;
  const auto parts = static_cast<std::size_t>(thread_count(threads, blocks));
  const std::size_t grain = parts == 1 ? planes : blocks / parts * kBlock;
  std::atomic<bool> good = true;
  parallel_ranges(planes, grain, threads, [&](std::size_t begin, std::size_t end) {
    if (body(begin, end) != 0) good = false;
  });
  return good;
}

Error too_large() { return {Errc::kOutOfRange, "cu_magnitude"}; }

/// Runs of planes with the same mode on a level, neighbours joined.
std::vector<Run> runs_of_level(std::span<const PredictedPlanes> planes, std::size_t level) {
  std::vector<Run> runs;
  for (const PredictedPlanes& p : planes) {
    const std::uint32_t mode = level < p.modes.size() ? p.modes[level] : 0u;
    if (!runs.empty() && runs.back().mode == mode) {
      runs.back().end = p.end;
    } else {
      runs.push_back({p.begin, p.end, mode});
    }
  }
  return runs;
}

/// The parts of runs within begin .. end - 1, counted from begin.
std::vector<Run> clip(std::span<const Run> runs, std::size_t begin, std::size_t end) {
  std::vector<Run> clipped;
  for (const Run& run : runs)
    if (run.begin < end && run.end > begin)
      clipped.push_back(
          {std::max(run.begin, begin) - begin, std::min(run.end, end) - begin, run.mode});
  return clipped;
}

}  // namespace

Result<Done> raht_inverse(const RahtTree& tree, std::span<const std::uint32_t> steps,
                          std::span<std::int32_t> values, int threads,
                          std::span<const std::uint8_t> nonzero, std::size_t used,
                          std::size_t cells) {
  const Steps table(steps);
  used = std::min(used, steps.size());
  const auto merges = merges_below(tree, cells);
  const bool good = over_planes(used, threads, [&](std::size_t begin, std::size_t end) {
    const Planes range(values, table, begin, end, nonzero);
    const std::int32_t bad = cells == 0 ? dequantise_mean(range) : 0;
    return bad | inverse_lanes(merges, range, 0, range.lanes);
  });
  if (!good) return too_large();
  return Done{};
}

Result<Done> raht_inverse_predicted(const RahtTree& tree, TransformLevels& levels,
                                    std::span<const PredictedPlanes> planes,
                                    std::span<const std::uint32_t> steps,
                                    std::span<std::int32_t> values, int threads,
                                    std::span<const std::uint8_t> nonzero, std::size_t used,
                                    std::size_t cells, const ReferenceMeans* reference,
                                    LevelMeans* kept) {
  const Steps table(steps);
  used = std::min(used, steps.size());
  bool good = cells > 0 || dequantise_mean(Planes(values, table, 0, used, nonzero)) == 0;
  if (reference != nullptr) {
    levels.predict_from(*reference);
    predict_root(reference->means[0], levels.points(), values.first(used));
  }
  std::unique_ptr<std::int32_t[]> means;  // [slot][width], of one level after the other
  std::size_t capacity = 0;
  for (int l = 0; l < levels.count(); ++l) {
    const TransformLevel& level = levels.next();
    const std::span<const Merge> merges =
        std::span(tree.merges)
            .subspan(level.nodes.size() - 1, level.child_rows.size() - 1 - level.nodes.size());
    const std::vector<Run> runs = runs_of_level(planes, static_cast<std::size_t>(l));
    if (kept != nullptr && l == 0)
      keep_means(values, level.rows, level.places, steps.size(), 0, used, (*kept)[0]);
    const std::int32_t* there =
        reference == nullptr ? nullptr : reference->means[static_cast<std::size_t>(l) + 1].data();
    std::size_t width = 0;  // planes up to the last predicted one
    for (const Run& run : runs)
      if (run.mode != 0) width = run.end;
    if (level.num_slots * width > capacity) {
      capacity = level.num_slots * width;
      means.reset();
      means = std::make_unique_for_overwrite<std::int32_t[]>(capacity);
      advise_huge_pages(means.get(), capacity * sizeof(std::int32_t));
    }
    good &= over_planes(used, threads, [&](std::size_t begin, std::size_t end) {
      const std::int32_t bad = inverse_level(
          level, merges, clip(runs, begin, end), Planes(values, table, begin, end, nonzero),
          {means ? means.get() + std::min(begin, width) : nullptr, width},
          there == nullptr ? ConstLanes{nullptr, 0} : ConstLanes{there + begin, steps.size()});
      if (kept != nullptr)
        keep_means(values, level.child_rows, level.child_places, steps.size(), begin, end,
                   (*kept)[static_cast<std::size_t>(l) + 1]);
      return bad;
    });
  }
  if (!good) return too_large();
  return Done{};
}

SLF_MULTIVERSION_LANES
void to_node_means(std::span<std::int32_t> row, std::uint32_t weight) {
  if (weight == 1) return;
  const std::int64_t root = roots_of(small_roots(), weight).reciprocal_q30;
  for (std::int32_t& value : row) value = rounded<30>(value * root);
}

}  // namespace slf
