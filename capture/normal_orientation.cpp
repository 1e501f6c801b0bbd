// SPDX-License-Identifier: Apache-2.0
#include "capture/normal_orientation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "capture/spacing.h"
#include "slf/parallel.h"

namespace slf {

namespace {

constexpr std::size_t kMaxViewpoints = 32;  // more add time, not knowledge
constexpr std::size_t kMaxSide = 2048;      // of a depth map, cells
constexpr std::size_t kBatch = 4096;
constexpr int kMaxRounds = 64;    // of asking the neighbours
constexpr double kGrazing = 0.3;  // cosine; just behind a silhouette points still count as seen
constexpr double kSure = 0.25;    // mean cosine towards the viewpoints that decides alone

using Floats = std::array<float, 3>;

double product(const Floats& a, const Floats& b) {
  return double{a[0]} * b[0] + double{a[1]} * b[1] + double{a[2]} * b[2];
}

Vec3 centroid_of(std::span<const Floats> positions) {
  Vec3 sum{0, 0, 0};
  for (const auto& p : positions)
    for (std::size_t k = 0; k < 3; ++k) sum[k] += double{p[k]};
  for (double& s : sum) s /= static_cast<double>(positions.size());
  return sum;
}

double distance(const Vec3& a, const Vec3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// Clouds may reach further than the largest float.
float clamped_float(double value) {
  constexpr double kLargest = double{std::numeric_limits<float>::max()};
  return static_cast<float>(std::min(value, kLargest));
}

// Depth around one viewpoint on an octahedral map, in cells two point spacings wide.
class DepthAround {
 public:
  DepthAround(std::span<const Floats> positions, double spacing, const Vec3& centroid)
      : positions_(positions),
        spacing_(spacing),
        centroid_(centroid),
        cell_(positions.size()),
        depth_(positions.size()) {}

  void look_from(const Vec3& viewpoint, int threads) {
    const double far = distance(viewpoint, centroid_);
    // The map covers the 4 pi of the sphere: a cell spans sqrt(4 pi) / side.
    const double cells = 3.54 * far / (2 * spacing_);
    side_ = cells < kMaxSide ? static_cast<std::size_t>(std::max(cells, 8.0)) : kMaxSide;
    tolerance_ = clamped_float(2 * std::max(spacing_, 3.54 * far / (2 * double(side_))));
    parallel_ranges(positions_.size(), kBatch, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) place(viewpoint, i);
    });
    nearest_.assign(side_ * side_, std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < depth_.size(); ++i) cover(i);
  }

  bool sees(std::size_t i) const {
    return depth_[i] > 0 && depth_[i] <= nearest_[cell_[i]] + tolerance_;
  }
  double depth(std::size_t i) const { return double{depth_[i]}; }

 private:
  void place(const Vec3& viewpoint, std::size_t i) {
    const double x = double{positions_[i][0]} - viewpoint[0];
    const double y = double{positions_[i][1]} - viewpoint[1];
    const double z = double{positions_[i][2]} - viewpoint[2];
    const double norm = std::abs(x) + std::abs(y) + std::abs(z);
    depth_[i] = clamped_float(std::hypot(x, y, z));
    cell_[i] = 0;
    if (!(norm > 0)) return;
    double u = x / norm, v = y / norm;
    if (z < 0) {  // the lower half folds over the edges
      const double folded = (1 - std::abs(v)) * (u < 0 ? -1 : 1);
      v = (1 - std::abs(u)) * (v < 0 ? -1 : 1);
      u = folded;
    }
    const auto coordinate = [&](double w) {
      // Not a number where distances are beyond a double: any cell will do.
      const double at = (w + 1) / 2 * double(side_);
      return at > 0 ? static_cast<std::size_t>(std::min(at, double(side_ - 1))) : std::size_t{0};
    };
    cell_[i] = static_cast<std::uint32_t>(coordinate(v) * side_ + coordinate(u));
  }

  // A point closer than the centroid covers as many cells as it takes to leave no hole to the next.
  void cover(std::size_t i) {
    const double cell_angle = 3.54 / static_cast<double>(side_);
    const double cells = 0.75 * spacing_ / (std::max(depth(i), spacing_) * cell_angle);
    const std::size_t reach = cells < 15.5 ? static_cast<std::size_t>(cells + 0.5) : 16;
    const std::size_t u = cell_[i] % side_, v = cell_[i] / side_;
    const std::size_t u_end = std::min(u + reach + 1, side_),
                      v_end = std::min(v + reach + 1, side_);
    for (std::size_t y = v - std::min(v, reach); y < v_end; ++y)
      for (std::size_t x = u - std::min(u, reach); x < u_end; ++x)
        nearest_[y * side_ + x] = std::min(nearest_[y * side_ + x], depth_[i]);
  }

  std::span<const Floats> positions_;
  double spacing_;
  Vec3 centroid_;
  std::size_t side_ = 8;
  float tolerance_ = 0;
  std::vector<std::uint32_t> cell_;  // [P]
  std::vector<float> depth_;         // [P]
  std::vector<float> nearest_;       // [side][side]
};

struct Vote {
  double towards = 0;  // sum of the cosines to the viewpoints that see the point
  int seen = 0;
  bool sure() const { return seen > 0 && std::abs(towards) >= kSure * seen; }
};

std::vector<Vote> votes_of(std::span<const Floats> positions, std::span<const Vec3> viewpoints,
                           const std::vector<Floats>& normals, int threads) {
  const double spacing = std::max(typical_spacing(positions), std::numeric_limits<double>::min());
  DepthAround around(positions, spacing, centroid_of(positions));
  std::vector<Vote> votes(positions.size());
  const std::size_t chosen = std::min(viewpoints.size(), kMaxViewpoints);
  for (std::size_t c = 0; c < chosen; ++c) {
    const Vec3& viewpoint = viewpoints[c * viewpoints.size() / chosen];
    around.look_from(viewpoint, threads);
    parallel_ranges(positions.size(), kBatch, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!around.sees(i)) continue;
        double cosine = 0;
        for (std::size_t k = 0; k < 3; ++k)
          cosine += double{normals[i][k]} * (viewpoint[k] - double{positions[i][k]});
        cosine /= around.depth(i);
        if (std::abs(cosine) < kGrazing) continue;
        votes[i].towards += cosine;
        ++votes[i].seen;
      }
    });
  }
  return votes;
}

void flip(Floats& normal) {
  for (float& n : normal) n = -n;
}

}  // namespace

void orient_towards(std::span<const Floats> positions, std::span<const Vec3> viewpoints,
                    std::span<const std::uint32_t> neighbours, int threads,
                    std::vector<Floats>& normals) {
  const std::size_t count = positions.size();
  if (count == 0) return;
  const auto votes = votes_of(positions, viewpoints, normals, threads);
  std::vector<std::uint8_t> decided(count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    if (votes[i].towards < 0) flip(normals[i]);
    decided[i] = votes[i].sure();
  }
  const std::size_t k = neighbours.size() / count;
  for (int round = 0; round < kMaxRounds; ++round) {
    // Each round sees only what the one before decided, so that the order of points is no matter.
    std::vector<std::pair<std::uint32_t, bool>> newly;  // point, flipped
    for (std::size_t i = 0; i < count; ++i) {
      if (decided[i]) continue;
      double agreement = 0;
      for (std::size_t j = i * k; j < (i + 1) * k; ++j)
        if (decided[neighbours[j]]) agreement += product(normals[i], normals[neighbours[j]]);
      if (agreement != 0) newly.emplace_back(static_cast<std::uint32_t>(i), agreement < 0);
    }
    if (newly.empty()) break;
    for (const auto& [point, flipped] : newly) {
      if (flipped) flip(normals[point]);
      decided[point] = 1;
    }
  }
}

double share_facing_away(std::span<const Floats> positions, std::span<const Vec3> viewpoints,
                         const std::vector<Floats>& normals, int threads) {
  std::size_t sure = 0, away = 0;
  for (const Vote& vote : votes_of(positions, viewpoints, normals, threads)) {
    sure += vote.sure();
    away += vote.sure() && vote.towards < 0;
  }
  return static_cast<double>(away) / static_cast<double>(std::max<std::size_t>(sure, 1));
}

void orient_outwards(std::span<const Floats> positions, std::vector<Floats>& normals) {
  if (positions.empty()) return;
  const Vec3 centroid = centroid_of(positions);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    double outward = 0;
    for (std::size_t k = 0; k < 3; ++k)
      outward += double{normals[i][k]} * (double{positions[i][k]} - centroid[k]);
    if (outward < 0) flip(normals[i]);
  }
}

}  // namespace slf
