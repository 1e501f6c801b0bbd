// SPDX-License-Identifier: Apache-2.0
#include "encoder/find_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "encoder/motion_model.h"
#include "geometry/morton.h"
#include "geometry/reference_walk.h"

namespace slf {
namespace {

constexpr int kWidestLattice = 8;
/// Rounds end where places move by less, root mean square, in sides of a cell.
constexpr double kSettled = 0.01;
/// A lattice is followed if the first trial of one leaves less than this of what misses.
constexpr double kWorthwhile = 0.98;
/// How much better a motion has to foretell that has more to code.
constexpr double kAffineCost = 1.002, kLatticeCost = 1.04, kFineCost = 1.10;
/// Places whose matches would pull a lattice as hard as its full stiffness holds.
constexpr std::size_t kStiffPlaces = 20000;

/// Places that are matched at a level, and how often at most.
struct MatchEffort {
  std::size_t places;
  int rounds;
};
constexpr MatchEffort kAffine{3000, 5}, kTrial{3000, 3}, kLattice{12000, 5}, kNextFrame{8000, 4};

/// Grey levels by which a frame differs from what its reference shows there, of a sample of points:
/// others than those that are matched, where there are enough.
class Mismatch {
 public:
  Mismatch(const FramePoints& now, const FramePoints& before, int bits)
      : now_(now), before_(before), bits_(bits), level_(before.codes), index_(level_) {}

  double of(const Motion& motion) {
    constexpr std::size_t kMost = 6000;
    constexpr double kMissed = 48;  // grey levels that a point counts whose place is empty there
    const std::size_t apart = std::max<std::size_t>(1, now_.codes.size() / kMost);
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < now_.codes.size(); i += apart, ++count) {
      const Voxel v = from_morton(now_.codes[i]);
      const Displacement d = motion.at({2 * v[0] + 1, 2 * v[1] + 1, 2 * v[2] + 1}, bits_);
      const std::uint32_t at = index_.find(
          {v[0] + ((d[0] + 8) >> 4), v[1] + ((d[1] + 8) >> 4), v[2] + ((d[2] + 8) >> 4)});
      if (at == ReferenceLevel::kNone) {
        sum += kMissed;
        continue;
      }
      for (std::size_t c = 0; c < 3; ++c)
        sum += std::min(std::abs(double{now_.colours[i][c]} - double{before_.colours[at][c]}),
                        kMissed) /
               3;
    }
    return count > 0 ? sum / count : 0;
  }

 private:
  const FramePoints &now_, &before_;
  int bits_;
  ReferenceLevel level_;
  ReferenceWalk index_;
};

class MotionSearch {
 public:
  MotionSearch(const FramePoints& now, const FramePoints& before, int bits)
      : bits_(bits),
        mismatch_(now, before, bits),
        here_(coarser_frames(now, std::max(bits - 4, 0))),
        there_(coarser_frames(before, std::max(bits - 4, 0))),
        matched_(there_.size()),
        motion_(bits) {
    least_ = mismatch_.of(best_);
  }

  Motion find(const Motion& previous) {
    if (!previous.is_zero() && mismatch_.of(previous) < least_)
      go_on(previous);
    else
      begin();
    return std::move(best_);
  }

 private:
  int coarsest() const { return static_cast<int>(here_.size()) - 1; }
  const CoarseFrame& here(int level) const { return here_[static_cast<std::size_t>(level)]; }
  MatchedFrame& there(int level) {
    auto& there = matched_[static_cast<std::size_t>(level)];
    if (!there)
      there = std::make_unique<MatchedFrame>(there_[static_cast<std::size_t>(level)], level);
    return *there;
  }

  int widest_lattice() const { return std::clamp(bits_ - 3, 3, kWidestLattice); }

  /// Adds a lattice to the affine motion. Does it help?
  bool try_lattice(int level) {
    motion_.begin_lattice(here(0), widest_lattice());
    fit(level, kTrial);
    return mismatch_.of(motion_.rounded()) <= kWorthwhile * least_;
  }

  /// From no motion, coarse to fine.
  void begin() {
    for (int level = coarsest(); level >= 0; --level) fit(level, kAffine);
    consider(kAffineCost);
    const int first = std::max(bits_ - 6, 0);
    if (!try_lattice(first)) return;
    for (int level = std::max(first - 1, 0); level >= 0; --level) fit(level, kLattice);
    consider(kLatticeCost);
    if (motion_.lattice_log2() == 3) return;
    motion_.refine_lattice(here(0));
    fit(0, kNextFrame);
    consider(kFineCost);
  }

  /// From the motion of the frame before.
  void go_on(const Motion& previous) {
    motion_.start_from(previous, here(0));
    const int fine = std::min(1, coarsest());
    if (previous.lattice_log2 == 0) {
      for (int level = fine; level >= 0; --level) fit(level, kAffine);
      consider(kAffineCost);
      if (!try_lattice(fine)) return;
    }
    for (int level = fine; level >= 0; --level) fit(level, kNextFrame);
    consider(motion_.lattice_log2() == widest_lattice() ? kLatticeCost : kFineCost);
  }

  /// Fits the motion to what is nearest under it, again and again.
  void fit(int level, const MatchEffort& effort) {
    const CoarseFrame& now = here(level);
    MatchedFrame& before = there(level);
    const std::size_t apart = std::max<std::size_t>(1, now.codes.size() / effort.places);
    const std::size_t num_places = now.codes.size() / apart;
    const double stiffness = static_cast<double>(num_places) /
                             static_cast<double>(std::min(now.codes.size(), kStiffPlaces));
    std::vector<std::uint32_t> last;
    std::vector<Place> guesses;
    std::vector<Match> matches;
    for (int round = 0; round < effort.rounds; ++round) {
      matches.clear();
      double changed = 0;
      for (std::size_t i = apart / 2, k = 0; i < now.codes.size(); i += apart, ++k) {
        const Place guess = motion_.at(now.centres[i]);
        if (round == 0) {
          last.push_back(MatchedFrame::kNone);
          guesses.push_back(guess);
        }
        changed += (guess - guesses[k]).squaredNorm();
        guesses[k] = guess;
        matches.push_back(before.match(now.centres[i], now.brightness[i], guess, last[k]));
      }
      const double settled = kSettled * before.side();
      if (round > 0 && changed < settled * settled * static_cast<double>(matches.size())) return;
      if (motion_.lattice_log2() > 0)
        motion_.fit_lattice(matches, stiffness);
      else
        motion_.fit_affine(matches);
    }
  }

  /// cost: how much better a motion has to foretell that has more to code
  void consider(double cost) {
    Motion found = motion_.rounded();
    const double with = cost * mismatch_.of(found);
    if (with >= least_) return;
    least_ = with;
    best_ = std::move(found);
  }

  int bits_;
  Mismatch mismatch_;
  std::vector<CoarseFrame> here_, there_;
  std::vector<std::unique_ptr<MatchedFrame>> matched_;  // of there_, where it was needed
  MotionModel motion_;
  Motion best_;
  double least_ = 0;
};

}  // namespace

Motion choose_motion(const FramePoints& now, const FramePoints& before, int bits,
                     const Motion& previous) {
  if (now.codes.empty() || before.codes.empty()) return {};
  return MotionSearch(now, before, bits).find(previous);
}

}  // namespace slf
