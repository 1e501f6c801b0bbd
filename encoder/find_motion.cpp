// SPDX-License-Identifier: Apache-2.0
#include "encoder/find_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "encoder/motion_mismatch.h"
#include "encoder/motion_model.h"

namespace slf {
namespace {

constexpr int kWidestLattice = 8;
/// Rounds end where places move by less, root mean square, in sides of a cell.
constexpr double kSettled = 0.01;
/// A lattice is followed if the first trial of one leaves less than this of what misses.
constexpr double kWorthwhile = 0.98;
/// How much better a motion has to foretell that has more to code.
constexpr double kAffineCost = 1.002, kLatticeCost = 1.04, kFineCost = 1.10;
constexpr double kAllStill = 1;  // grey levels of scattered points that nothing moves
/// The same of those that one motion moves; one that nothing foretells counts 48 more.
constexpr double kFollowed = 12;
constexpr std::size_t kFewStill = 20;  // at most one point in so many
/// Sixteenths of a voxel that a vector of a lattice may have where things stand still.
constexpr std::int32_t kRest = 24;
constexpr double kRoomOfLattice = 1 << 18;  // points of a lattice. Spec 7.13
/// Places whose matches would pull a lattice as hard as its full stiffness holds.
constexpr std::size_t kStiffPlaces = 20000;

/// Places that are matched at a level, and how often at most.
struct MatchEffort {
  std::size_t places;
  int rounds;
};
constexpr MatchEffort kAffine{3000, 5}, kTrial{3000, 3}, kLattice{12000, 5}, kNextFrame{8000, 4};

class MotionSearch {
 public:
  MotionSearch(const FramePoints& now, const FramePoints& before, int bits)
      : bits_(bits),
        scattered_(now.scattered),
        here_(coarser_frames(now, std::max(bits - 4, 0))),
        there_(coarser_frames(before, std::max(bits - 4, 0))),
        mismatch_(now, before, bits, here_, there_),
        matched_(there_.size()),
        motion_(bits) {
    least_ = mismatch_.of(best_);
  }

  Motion find(const Motion& previous) {
    if (scattered_ && least_ < kAllStill) return {};
    const bool goes_on = !previous.is_zero() && mismatch_.of(previous) < least_;
    if (goes_on) go_on(previous);
    if (!goes_on || (scattered_ && !is_followed())) begin();
    return std::move(best_);
  }

 private:
  /// Do scattered points all move, and as the best motion says?
  bool is_followed() {
    if (!scattered_ || best_.is_zero() || least_ > Mismatch::kMoved + kFollowed) return false;
    std::size_t still = 0;
    for (std::size_t i = 0; i < here(0).codes.size(); ++i) still += mismatch_.is_still(i);
    return still < here(0).codes.size() / kFewStill;
  }
  int coarsest() const { return static_cast<int>(here_.size()) - 1; }
  const CoarseFrame& here(int level) const { return here_[static_cast<std::size_t>(level)]; }
  MatchedFrame& there(int level) {
    auto& there = matched_[static_cast<std::size_t>(level)];
    if (!there)
      there = std::make_unique<MatchedFrame>(there_[static_cast<std::size_t>(level)], level,
                                             scattered_);
    return *there;
  }

  /// Is a lattice of that distance over all points one that a frame can have?
  bool has_room(int log2) const {
    Place low = here(0).centres[0], high = low;
    for (const Place& p : here(0).centres) low = low.cwiseMin(p), high = high.cwiseMax(p);
    double points = 1;
    for (int i = 0; i < 3; ++i)
      points *= std::floor(std::ldexp(high[i], -log2)) + 2 - std::floor(std::ldexp(low[i], -log2));
    return points <= kRoomOfLattice;
  }

  int widest_lattice() const { return std::clamp(bits_ - 3, 3, kWidestLattice); }

  /// Adds a lattice to the affine motion. Does it help?
  bool try_lattice(int level) {
    motion_.begin_lattice(here(0), widest_lattice());
    fit(level, kTrial);
    return mismatch_.of(motion_.rounded()) <= kWorthwhile * least_;
  }

  /// A part moves, by the affine motion to begin with, and the rest stands still. Leaves that
  /// motion as it was.
  void try_parts() {
    const MotionModel affine = motion_;
    std::vector<bool> still;
    for (std::size_t i = 0; i < here(0).codes.size(); ++i) still.push_back(mismatch_.is_still(i));
    for (const int log2 : {widest_lattice(), widest_lattice() - 1}) {
      if (log2 < 3 || !has_room(log2)) break;
      motion_ = MotionModel(bits_);
      motion_.begin_part(here(0), log2, affine, still);
      const double cost = log2 == widest_lattice() ? kLatticeCost : kFineCost;
      consider(cost);
      for (int level = std::min(2, coarsest()); level >= 0; --level) fit(level, kNextFrame);
      consider(cost);
    }
    motion_ = affine;
  }

  /// From no motion, coarse to fine.
  void begin() {
    motion_ = MotionModel(bits_);
    for (int level = coarsest(); level >= 0; --level) fit(level, kAffine);
    consider(kAffineCost);
    if (is_followed()) return;
    if (scattered_) try_parts();
    const int first = std::max(bits_ - 6, 0);
    if (!has_room(widest_lattice()) || !try_lattice(first)) return;
    for (int level = std::max(first - 1, 0); level >= 0; --level) fit(level, kLattice);
    consider(kLatticeCost);
    const int finer = motion_.lattice_log2() - 1;
    if (finer < 3 || !has_room(finer)) return;
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
      if (is_followed() || !has_room(widest_lattice()) || !try_lattice(fine)) return;
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
    if (scattered_) rest(found);
    const double with = cost * mismatch_.of(found);
    if (with >= least_) return;
    least_ = with;
    best_ = std::move(found);
  }

  /// What hardly moves stands still.
  static void rest(Motion& motion) {
    for (Displacement& d : motion.lattice)
      if (std::all_of(d.begin(), d.end(), [](std::int32_t x) { return std::abs(x) < kRest; }))
        d = {};
  }

  int bits_;
  bool scattered_;
  std::vector<CoarseFrame> here_, there_;
  Mismatch mismatch_;
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
