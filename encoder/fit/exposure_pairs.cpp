// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/exposure_pairs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "capture/quantile.h"
#include "lightfield/directions.h"

namespace slf {
namespace {

constexpr std::size_t kNearestViews = 4;          // of each view of a point
constexpr double kDarkest = 8, kBrightest = 247;  // grey levels between which ratios are taken
constexpr std::size_t kLeastShared = 12;          // points of a pair
constexpr double kEnoughShared = 50;              // with which a pair has half of its weight
constexpr double kWideRatios = 0.15;              // distance of quartiles that halves the weight
constexpr double kFarthest = 1;                   // squared chord: 60 degrees

/// Both cameras at one point.
struct SharedPoint {
  std::uint32_t a = 0, b = 0;
  std::array<float, 3> log_ratio{};
  float apart = 0;  ///< squared chord of directions

  bool operator<(const SharedPoint& other) const {
    return a != other.a ? a < other.a : b < other.b;
  }
};

struct View {
  std::uint32_t camera = 0;
  Vec3 direction{};
  std::array<float, 3> log_value{};
};

std::vector<View> usable_views(const Observations& seen, std::size_t point) {
  std::vector<View> views;
  for (auto i = seen.first[point]; i < seen.first[point + 1]; ++i) {
    const auto& colour = seen.colour[i];
    View view{seen.camera[i], vector_of(seen.direction[i]), {}};
    bool usable = true;
    for (std::size_t k = 0; k < 3; ++k) {
      usable = usable && double(colour[k]) > kDarkest && double(colour[k]) < kBrightest;
      view.log_value[k] = usable ? std::log(colour[k]) : 0;
    }
    if (usable) views.push_back(view);
  }
  return views;
}

double squared_chord(const Vec3& a, const Vec3& b) {
  return 2 - 2 * (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

void add_point(const std::vector<View>& views, std::vector<SharedPoint>& shared) {
  std::vector<std::pair<double, std::size_t>> near;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < views.size(); ++i) {
    near.clear();
    for (std::size_t j = 0; j < views.size(); ++j) {
      const double apart = squared_chord(views[i].direction, views[j].direction);
      if (j != i && apart < kFarthest) near.emplace_back(apart, j);
    }
    const std::size_t most = std::min(near.size(), kNearestViews);
    std::partial_sort(near.begin(), near.begin() + std::ptrdiff_t(most), near.end());
    for (std::size_t n = 0; n < most; ++n)
      pairs.emplace_back(std::min(i, near[n].second), std::max(i, near[n].second));
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  for (const auto& [i, j] : pairs) {
    SharedPoint& point = shared.emplace_back();
    point.a = views[i].camera, point.b = views[j].camera;
    for (std::size_t k = 0; k < 3; ++k)
      point.log_ratio[k] = views[j].log_value[k] - views[i].log_value[k];
    point.apart = float(squared_chord(views[i].direction, views[j].direction));
  }
}

/// Points of one pair.
ExposurePair pair_of(std::span<const SharedPoint> points) {
  ExposurePair pair{points.front().a, points.front().b, {}, 0};
  double wide = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<float> ratios;
    for (const SharedPoint& point : points) ratios.push_back(point.log_ratio[k]);
    std::sort(ratios.begin(), ratios.end());
    pair.log_ratio[k] = double(ratios[ratios.size() / 2]);
    wide += double(ratios[3 * ratios.size() / 4] - ratios[ratios.size() / 4]) / 3;
  }
  const auto count = double(points.size());
  pair.weight = count / (count + kEnoughShared) / (1 + (wide / kWideRatios) * (wide / kWideRatios));
  return pair;
}

}  // namespace

std::vector<ExposurePair> exposure_pairs(const Observations& seen) {
  std::vector<SharedPoint> shared;
  for (std::size_t p = 0; p + 1 < seen.first.size(); ++p) add_point(usable_views(seen, p), shared);
  std::stable_sort(shared.begin(), shared.end());
  std::vector<ExposurePair> pairs;
  for (std::size_t begin = 0, end = 0; begin < shared.size(); begin = end) {
    while (end < shared.size() && !(shared[begin] < shared[end])) ++end;
    if (end - begin >= kLeastShared)
      pairs.push_back(pair_of(std::span(shared).subspan(begin, end - begin)));
  }
  return pairs;
}

}  // namespace slf
