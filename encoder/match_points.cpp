// SPDX-License-Identifier: Apache-2.0
#include "encoder/match_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "capture/nearest.h"
#include "geometry/morton.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kNear = 192;       // points around where one may be
constexpr std::size_t kCandidates = 12;  // of these, that look most like it
constexpr std::size_t kTelling = 12;     // planes that are looked at for that
constexpr float kSurely = 0.4f;  // of what it costs alone: nothing farther away is more alike
constexpr std::size_t kMatchGrain = 64;

struct Pair {
  float cost;  // bits
  std::uint32_t before, now;
};

/// Bits of a difference of so many steps, about.
float bits_of(float steps) { return std::log2(1 + steps); }

/// What a point costs by another's values, in bits.
float cost_of_values(const std::int32_t* a, const std::int32_t* b,
                     std::span<const float> per_step) {
  float bits = 0;
  for (std::size_t j = 0; j < per_step.size(); ++j)
    bits += bits_of(std::abs(static_cast<float>(a[j]) - static_cast<float>(b[j])) * per_step[j]);
  return bits;
}

/// What it costs by the mean of all, as a point that is new.
std::vector<float> costs_alone(const PointValues& points, std::span<const float> per_step) {
  const std::size_t planes = per_step.size(), count = points.codes.size();
  std::vector<double> sums(planes);
  for (std::size_t p = 0; p < count; ++p)
    for (std::size_t j = 0; j < planes; ++j) sums[j] += points.values[p * planes + j];
  std::vector<std::int32_t> mean(planes);
  for (std::size_t j = 0; j < planes; ++j)
    mean[j] = static_cast<std::int32_t>(std::lround(sums[j] / static_cast<double>(count)));
  std::vector<float> costs(count);
  for (std::size_t p = 0; p < count; ++p)
    costs[p] = cost_of_values(&points.values[p * planes], mean.data(), per_step);
  return costs;
}

std::array<float, 3> place(const Voxel& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// Planes in which points differ by most steps.
std::vector<std::size_t> telling_planes(const PointValues& points,
                                        std::span<const float> per_step) {
  const std::size_t planes = per_step.size();
  std::vector<std::pair<float, std::size_t>> order;
  for (std::size_t j = 0; j < planes; ++j) {
    float sum = 0;
    for (std::size_t p = 1; p < points.codes.size(); ++p)
      sum += bits_of(std::abs(static_cast<float>(points.values[p * planes + j]) -
                              static_cast<float>(points.values[(p - 1) * planes + j])) *
                     per_step[j]);
    order.emplace_back(-sum, j);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> telling;
  for (std::size_t i = 0; i < std::min(kTelling, planes); ++i) telling.push_back(order[i].second);
  return telling;
}

/// Finds what a point of one frame may be in the next.
class Matcher {
 public:
  Matcher(const PointValues& now, const PointValues& before, std::span<const std::uint32_t> steps,
          const Motion& motion, int bits)
      : now_(now), before_(before), motion_(motion), bits_(bits) {
    for (const std::uint32_t step : steps) per_step_.push_back(1 / static_cast<float>(step));
    for (const std::uint64_t code : now.codes) places_.push_back(place(from_morton(code)));
    nearest_.emplace(places_);
    alone_ = costs_alone(now, per_step_);
    telling_ = telling_planes(now, per_step_);
  }

  Voxel carried_to(std::size_t p) const {
    return carried(motion_, from_morton(before_.codes[p]), bits_);
  }
  std::size_t candidates() const { return std::min(kCandidates, places_.size()); }

  /// to: [candidates()] of point p
  void find(std::size_t p, Pair* to) const {
    const std::array<float, 3> at = place(carried_to(p));
    const std::size_t near = std::min(kNear, places_.size()), count = candidates();
    std::array<std::uint32_t, kNear> index{};
    nearest_->nearest(at, static_cast<int>(count), index.data(), nullptr);
    if (set_pairs(p, at, index.data(), to)) return;
    nearest_->nearest(at, static_cast<int>(near), index.data(), nullptr);
    std::array<std::pair<float, std::uint32_t>, kNear> order;
    for (std::size_t c = 0; c < near; ++c) order[c] = {cost_by_telling(p, index[c], at), index[c]};
    std::partial_sort(order.begin(), order.begin() + std::ptrdiff_t(count),
                      order.begin() + std::ptrdiff_t(near));
    for (std::size_t c = 0; c < count; ++c) index[c] = order[c].second;
    set_pairs(p, at, index.data(), to);
  }

 private:
  /// @return whether one of them is surely the point
  bool set_pairs(std::size_t p, const std::array<float, 3>& at, const std::uint32_t* index,
                 Pair* to) const {
    const std::size_t planes = per_step_.size();
    bool surely = false;
    for (std::size_t c = 0; c < candidates(); ++c) {
      const std::uint32_t n = index[c];
      const float cost =
          cost_of_place(n, at) +
          cost_of_values(&now_.values[n * planes], &before_.values[p * planes], per_step_);
      to[c] = {cost - alone_[n], static_cast<std::uint32_t>(p), n};
      surely |= cost < kSurely * alone_[n];
    }
    return surely;
  }
  float cost_of_place(std::uint32_t n, const std::array<float, 3>& at) const {
    float cost = 0;
    for (std::size_t k = 0; k < 3; ++k) cost += 2 * bits_of(std::abs(places_[n][k] - at[k]));
    return cost;
  }
  float cost_by_telling(std::size_t p, std::uint32_t n, const std::array<float, 3>& at) const {
    const std::size_t planes = per_step_.size();
    float cost = cost_of_place(n, at);
    for (const std::size_t j : telling_)
      cost += bits_of(std::abs(static_cast<float>(now_.values[n * planes + j]) -
                               static_cast<float>(before_.values[p * planes + j])) *
                      per_step_[j]);
    return cost;
  }

  const PointValues &now_, &before_;
  const Motion& motion_;
  int bits_;
  std::vector<float> per_step_, alone_;
  std::vector<std::size_t> telling_;
  std::vector<std::array<float, 3>> places_;
  std::optional<NearestPoints> nearest_;
};

}  // namespace

std::vector<PointMove> match_points(const PointValues& now, const PointValues& before,
                                    std::span<const std::uint32_t> steps, const Motion& motion,
                                    int bits, int threads) {
  const Matcher matcher(now, before, steps, motion, bits);
  const std::size_t candidates = matcher.candidates();
  std::vector<Pair> pairs(before.codes.size() * candidates);
  parallel_ranges(before.codes.size(), kMatchGrain, threads,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t p = begin; p < end; ++p)
                      matcher.find(p, &pairs[p * candidates]);
                  });
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.cost, a.before, a.now) < std::tie(b.cost, b.before, b.now);
  });
  std::vector<PointMove> moves(before.codes.size());
  std::vector<std::uint8_t> taken(now.codes.size()), goes_on(before.codes.size());
  for (const Pair& pair : pairs) {
    if (goes_on[pair.before] || taken[pair.now]) continue;
    goes_on[pair.before] = taken[pair.now] = 1;
    const Voxel from = matcher.carried_to(pair.before), to = from_morton(now.codes[pair.now]);
    for (std::size_t k = 0; k < 3; ++k) moves[pair.before][k] = to[k] - from[k];
  }
  return moves;
}

}  // namespace slf
