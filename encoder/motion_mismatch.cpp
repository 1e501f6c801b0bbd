// SPDX-License-Identifier: Apache-2.0
#include "encoder/motion_mismatch.h"

#include <algorithm>
#include <cmath>

#include "geometry/morton.h"

namespace slf {
namespace {

constexpr std::size_t kMostSampled = 6000;
constexpr double kMissed = 48;  // grey levels that a point counts whose place is empty there
constexpr double kStill = 4;    // the same: a splat that differs by less has not moved

}  // namespace

Mismatch::Mismatch(const FramePoints& now, const FramePoints& before, int bits,
                   const std::vector<CoarseFrame>& here, const std::vector<CoarseFrame>& there)
    : now_(now), before_(before), bits_(bits), here_(here), there_(there) {
  for (std::size_t level = 0; level < there.size(); ++level) {
    levels_.push_back(std::make_unique<Level>(there[level].codes));
    if (!now.scattered || 2 * here[level].codes.size() < now.codes.size()) break;
  }
}

double Mismatch::of(const Motion& motion) {
  return now_.scattered ? of_scattered(motion) : of_voxels(motion);
}

bool Mismatch::is_still(std::size_t point) {
  const std::uint32_t at = levels_[0]->index.find(from_morton(here_[0].codes[point]));
  return at != ReferenceLevel::kNone &&
         std::abs(here_[0].brightness[point] - there_[0].brightness[at]) < kStill;
}

double Mismatch::of_voxels(const Motion& motion) {
  const std::size_t apart = std::max<std::size_t>(1, now_.codes.size() / kMostSampled);
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < now_.codes.size(); i += apart, ++count) {
    const Voxel v = from_morton(now_.codes[i]);
    const Displacement d = motion.at({2 * v[0] + 1, 2 * v[1] + 1, 2 * v[2] + 1}, bits_);
    const std::uint32_t at = levels_[0]->index.find(
        {v[0] + ((d[0] + 8) >> 4), v[1] + ((d[1] + 8) >> 4), v[2] + ((d[2] + 8) >> 4)});
    if (at == ReferenceLevel::kNone) {
      sum += kMissed;
      continue;
    }
    for (std::size_t c = 0; c < 3; ++c)
      sum +=
          std::min(std::abs(double{now_.colours[i][c]} - double{before_.colours[at][c]}), kMissed) /
          3;
  }
  return count > 0 ? sum / count : 0;
}

double Mismatch::of_scattered(const Motion& motion) {
  const CoarseFrame& here = here_[0];
  const std::size_t apart = std::max<std::size_t>(1, here.codes.size() / kMostSampled);
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < here.codes.size(); i += apart, ++count) {
    const Voxel v = from_morton(here.codes[i]);
    const Displacement d = motion.at({2 * v[0] + 1, 2 * v[1] + 1, 2 * v[2] + 1}, bits_);
    double missed = 0;
    for (std::size_t level = 0; level < levels_.size(); ++level) {
      Voxel cell;
      for (std::size_t k = 0; k < 3; ++k) cell[k] = (v[k] + ((d[k] + 8) >> 4)) >> level;
      const std::uint32_t at = levels_[level]->index.find(cell);
      const double miss =
          at == ReferenceLevel::kNone
              ? kMissed
              : std::min(std::abs(here.brightness[i] - there_[level].brightness[at]), kMissed);
      if (level == 0 && d == Displacement{} && miss < kStill) {
        missed = miss - kMoved;
        break;
      }
      missed += miss / static_cast<double>(levels_.size());
    }
    sum += kMoved + missed;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace slf
