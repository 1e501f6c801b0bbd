// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/offset_field.h"

#include <algorithm>
#include <cmath>

#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kGrain = 2048;

/// A point's costs with those of its neighbours, as a larger patch would have them.
std::vector<float> aggregated(const std::vector<float>& costs, std::size_t labels,
                              const SurfaceNeighbours& neighbours, int threads) {
  std::vector<float> sums(costs.size());
  const std::size_t points = costs.size() / labels;
  parallel_ranges(points, kGrain, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      float* sum = &sums[p * labels];
      std::copy_n(&costs[p * labels], labels, sum);
      float total = 1;
      const auto near = neighbours.of(p);
      const auto weights = neighbours.weights_of(p);
      for (std::size_t i = 0; i < near.size(); ++i) {
        const float* other = &costs[near[i] * labels];
        for (std::size_t l = 0; l < labels; ++l) sum[l] += weights[i] * other[l];
        total += weights[i];
      }
      for (std::size_t l = 0; l < labels; ++l) sum[l] /= total;
    }
  });
  return sums;
}

/// Least cost + coupling * (label - field)^2, in labels, between labels by a parabola; of those
/// within the limits.
float best_label(const float* costs, const OffsetLimits& limits, float field, float coupling) {
  const auto first = std::size_t(std::lround(limits.least)),
             last = std::size_t(std::lround(limits.most));
  const auto total = [&](std::size_t l) {
    const float d = float(l) - field;
    return costs[l] + coupling * d * d;
  };
  std::size_t best = first;
  float least = total(first);
  for (std::size_t l = first + 1; l <= last; ++l)
    if (const float cost = total(l); cost < least) {
      least = cost;
      best = l;
    }
  if (best == first || best == last) return std::clamp(float(best), limits.least, limits.most);
  const float before = total(best - 1), after = total(best + 1);
  const float curve = before + after - 2 * least;
  const float between = curve > 1e-6f ? 0.5f * (before - after) / curve : 0;
  return std::clamp(float(best) + between, limits.least, limits.most);
}

/// Limits in labels, within those that there are.
std::vector<OffsetLimits> in_labels(std::span<const OffsetLimits> limits, const OffsetRange& range,
                                    std::size_t points) {
  const auto last = float(range.count - 1);
  const auto label = [&](float offset) {
    return std::clamp((offset - float(range.first)) / float(range.step), 0.0f, last);
  };
  std::vector<OffsetLimits> within(points, {0, last});
  for (std::size_t p = 0; p < limits.size(); ++p)
    within[p] = {label(limits[p].least), label(limits[p].most)};
  return within;
}

}  // namespace

std::vector<float> choose_offsets(const std::vector<float>& costs, const OffsetRange& range,
                                  const SurfaceNeighbours& neighbours,
                                  const OffsetSettings& settings,
                                  std::span<const OffsetLimits> limits) {
  const std::size_t labels = range.count, points = costs.size() / labels;
  const std::vector<float> sums = aggregated(costs, labels, neighbours, settings.threads);
  const auto none = float(-range.first / range.step);  // the label of no offset
  const std::vector<OffsetLimits> within = in_labels(limits, range, points);
  std::vector<float> field(points, none), choice(points), next(points);
  for (int round = 0; round < settings.rounds; ++round) {
    // From weak to strong: the field first learns where the costs are, then they agree.
    const float t = float(round) / float(std::max(settings.rounds - 1, 1));
    const float coupling = round == 0 ? 1e-4f : 0.0005f * std::pow(400.0f, t);
    parallel_ranges(points, kGrain, settings.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p)
        choice[p] = best_label(&sums[p * labels], within[p], field[p], coupling);
    });
    const auto smooth = float(settings.smooth), tear = float(settings.tear);
    for (int sweep = 0; sweep < settings.sweeps; ++sweep) {
      parallel_ranges(points, kGrain, settings.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
          const auto near = neighbours.of(p);
          const auto weights = neighbours.weights_of(p);
          float sum = choice[p], total = 1;
          for (std::size_t i = 0; i < near.size(); ++i) {
            const float apart = field[near[i]] - field[p];
            const float w = smooth * weights[i] / (1 + tear * apart * apart);
            sum += w * field[near[i]];
            total += w;
          }
          next[p] = std::clamp(sum / total, within[p].least, within[p].most);
        }
      });
      field.swap(next);
    }
  }
  for (float& f : field) f = float(range.first) + float(range.step) * f;
  return field;
}

}  // namespace slf
