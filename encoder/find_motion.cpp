// SPDX-License-Identifier: Apache-2.0
#include "encoder/find_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "encoder/motion_model.h"
#include "geometry/morton.h"
#include "geometry/reference_walk.h"

namespace slf {
namespace {

constexpr int kAffineRounds = 8, kLatticeRounds = 8, kFineRounds = 4, kWidestLattice = 8;
constexpr std::size_t kAffinePlaces = 6000, kLatticePlaces = 20000;

std::vector<Match> match_all(const CoarseFrame& now, MatchedFrame& before,
                             const MotionModel& motion, std::size_t most) {
  const std::size_t apart = std::max<std::size_t>(1, now.codes.size() / most);
  std::vector<Match> matches;
  for (std::size_t i = apart / 2; i < now.codes.size(); i += apart)
    matches.push_back(before.match(now.centres[i], now.colours[i], motion.at(now.centres[i])));
  return matches;
}

}  // namespace

std::vector<Motion> find_motions(const FramePoints& now, const FramePoints& before, int bits) {
  if (now.codes.empty() || before.codes.empty()) return {};
  MotionModel motion(bits);
  for (int dropped = std::max(bits - 4, 0); dropped >= 0; --dropped) {
    const CoarseFrame coarse = coarsen(now, dropped);
    MatchedFrame there(before, dropped);
    for (int round = 0; round < kAffineRounds; ++round)
      motion.fit_affine(match_all(coarse, there, motion, kAffinePlaces));
  }
  std::vector<Motion> found = {motion.rounded()};
  for (int dropped = std::max(bits - 6, 0); dropped >= 0; --dropped) {
    const CoarseFrame coarse = coarsen(now, dropped);
    MatchedFrame there(before, dropped);
    if (dropped == std::max(bits - 6, 0))
      motion.begin_lattice(coarse, std::clamp(bits - 3, 3, kWidestLattice));
    for (int round = 0; round < kLatticeRounds; ++round)
      motion.fit_lattice(match_all(coarse, there, motion, kLatticePlaces));
    if (dropped > 0) continue;
    found.push_back(motion.rounded());
    if (motion.lattice_log2() == 3) continue;
    motion.refine_lattice(coarse);
    for (int round = 0; round < kFineRounds; ++round)
      motion.fit_lattice(match_all(coarse, there, motion, kLatticePlaces));
    found.push_back(motion.rounded());
  }
  return found;
}

namespace {

/// Grey levels by which a frame differs from what its reference shows there, of a sample of points.
double mismatch(const FramePoints& now, const FramePoints& before, ReferenceWalk& index,
                const Motion& motion, int bits) {
  constexpr std::size_t kMost = 20000;
  constexpr double kMissed = 48;  // grey levels that a point counts whose place is empty there
  const std::size_t apart = std::max<std::size_t>(1, now.codes.size() / kMost);
  double sum = 0, count = 0;
  for (std::size_t i = apart / 2; i < now.codes.size(); i += apart, ++count) {
    const Voxel v = from_morton(now.codes[i]);
    const Displacement d = motion.at({2 * v[0] + 1, 2 * v[1] + 1, 2 * v[2] + 1}, bits);
    const std::uint32_t at =
        index.find({v[0] + ((d[0] + 8) >> 4), v[1] + ((d[1] + 8) >> 4), v[2] + ((d[2] + 8) >> 4)});
    if (at == ReferenceLevel::kNone) {
      sum += kMissed;
      continue;
    }
    for (std::size_t c = 0; c < 3; ++c)
      sum +=
          std::min(std::abs(double{now.colours[i][c]} - double{before.colours[at][c]}), kMissed) /
          3;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace

Motion choose_motion(const FramePoints& now, const FramePoints& before, int bits) {
  const ReferenceLevel level(before.codes);
  ReferenceWalk index(level);
  // A motion with more to code is taken where it foretells this much better.
  constexpr std::array<double, 3> kCost = {1.002, 1.04, 1.07};
  Motion best;
  double least = mismatch(now, before, index, best, bits);
  std::vector<Motion> found = find_motions(now, before, bits);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double with = kCost[i] * mismatch(now, before, index, found[i], bits);
    if (with >= least) continue;
    least = with;
    best = std::move(found[i]);
  }
  return best;
}

}  // namespace slf
