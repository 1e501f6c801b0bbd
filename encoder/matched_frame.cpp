// SPDX-License-Identifier: Apache-2.0
#include "encoder/matched_frame.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "geometry/morton.h"

namespace slf {
namespace {

/// Grey levels that are as far apart as the side of a cell.
constexpr double kGreyPerCell = 24;
constexpr int kReach = 2;  // cells around a place that are looked at

/// By axis, and by the lowest two bits of a cell along it: the cells of a brick that lie there.
constexpr auto kSlabs = [] {
  std::array<std::array<std::uint64_t, 4>, 3> slabs{};
  for (std::uint64_t bit = 0; bit < 64; ++bit) {
    const Voxel cell = from_morton(bit);
    for (std::size_t axis = 0; axis < 3; ++axis)
      slabs[axis][static_cast<std::size_t>(cell[axis])] |= std::uint64_t{1} << bit;
  }
  return slabs;
}();

/// The cells of a brick from `low` to `high` along an axis, in cells of the level.
std::uint64_t slabs_between(std::size_t axis, std::int32_t brick, std::int32_t low,
                            std::int32_t high) {
  std::uint64_t cells = 0;
  for (std::int32_t i = std::max(low, 4 * brick); i <= std::min(high, 4 * brick + 3); ++i)
    cells |= kSlabs[axis][static_cast<std::size_t>(i & 3)];
  return cells;
}

CoarseFrame finest_frame(const FramePoints& points) {
  CoarseFrame frame;
  frame.codes.assign(points.codes.begin(), points.codes.end());
  frame.points.assign(frame.codes.size(), 1.0);
  frame.centres.reserve(frame.codes.size());
  frame.brightness.reserve(frame.codes.size());
  for (std::size_t i = 0; i < frame.codes.size(); ++i) {
    const Voxel v = from_morton(frame.codes[i]);
    const std::array<float, 3>& c = points.colours[i];
    frame.centres.emplace_back(v[0] + 0.5, v[1] + 0.5, v[2] + 0.5);
    frame.brightness.push_back((double{c[0]} + double{c[1]} + double{c[2]}) / 3);
  }
  return frame;
}

/// Means of the points in eight cells each.
CoarseFrame coarser(const CoarseFrame& fine) {
  CoarseFrame out;
  for (std::size_t i = 0; i < fine.codes.size();) {
    const std::uint64_t code = fine.codes[i] >> 3;
    Place centre = Place::Zero();
    double brightness = 0, points = 0;
    for (; i < fine.codes.size() && fine.codes[i] >> 3 == code; ++i) {
      centre += fine.points[i] * fine.centres[i];
      brightness += fine.points[i] * fine.brightness[i];
      points += fine.points[i];
    }
    out.codes.push_back(code);
    out.centres.emplace_back(centre / points);
    out.brightness.push_back(brightness / points);
    out.points.push_back(points);
  }
  return out;
}

}  // namespace

std::vector<CoarseFrame> coarser_frames(const FramePoints& points, int levels) {
  std::vector<CoarseFrame> frames = {finest_frame(points)};
  for (int i = 0; i < levels; ++i) frames.push_back(coarser(frames.back()));
  return frames;
}

Voxel MatchedFrame::cell_of(const Place& at) const {
  Voxel cell;
  for (std::size_t i = 0; i < 3; ++i)
    cell[i] = static_cast<std::int32_t>(std::floor(at[static_cast<int>(i)] / side_));
  return cell;
}

template <class Step>
void MatchedFrame::for_cells(const Voxel& low, const Voxel& high, const Step& step) {
  for (std::int32_t z = low[2] >> 2; z <= high[2] >> 2; ++z) {
    const std::uint64_t along_z = slabs_between(2, z, low[2], high[2]);
    for (std::int32_t y = low[1] >> 2; y <= high[1] >> 2; ++y) {
      const std::uint64_t along_y = along_z & slabs_between(1, y, low[1], high[1]);
      for (std::int32_t x = low[0] >> 2; x <= high[0] >> 2; ++x) {
        const ReferenceBrick& brick = walk_.brick({x, y, z});
        std::uint64_t cells = brick.morton & along_y & slabs_between(0, x, low[0], high[0]);
        for (; cells != 0; cells &= cells - 1)
          step(ReferenceWalk::place_in(brick, static_cast<unsigned>(std::countr_zero(cells))));
      }
    }
  }
}

/// The nearest point of the cells within kReach of a place, the first of several; kNone where there
/// is none. A point known to be near leaves few cells to look at, and changes no result.
std::uint32_t MatchedFrame::nearest(const Place& at, std::uint32_t last) {
  const Voxel cell = cell_of(at);
  double best = std::numeric_limits<double>::infinity();
  std::uint32_t nearest = kNone;
  const auto look = [&](const Voxel& low, const Voxel& high) {
    for_cells(low, high, [&](std::uint32_t i) {
      const double d = (frame_.centres[i] - at).squaredNorm();
      if (d < best || (d == best && i < nearest)) best = d, nearest = i;
    });
  };
  double most = std::numeric_limits<double>::infinity();
  if (last != kNone) {
    most = (frame_.centres[last] - at).squaredNorm();
  } else {
    look({cell[0] - 1, cell[1] - 1, cell[2] - 1}, {cell[0] + 1, cell[1] + 1, cell[2] + 1});
    most = best;
  }
  const double radius = std::min(std::sqrt(most), (kReach + 1) * side_);
  Voxel low = cell_of(at - Place::Constant(radius)), high = cell_of(at + Place::Constant(radius));
  bool seen = last == kNone;  // all of it
  for (std::size_t i = 0; i < 3; ++i) {
    low[i] = std::max(low[i], cell[i] - kReach);
    high[i] = std::min(high[i], cell[i] + kReach);
    seen = seen && low[i] >= cell[i] - 1 && high[i] <= cell[i] + 1;
  }
  if (!seen) look(low, high);
  return nearest;
}

/// A plane through what is around, and a slope of brightness in it.
const MatchedFrame::Surface& MatchedFrame::surface(std::uint32_t at) {
  Surface& surface = surface_[at];
  if (known_[at]) return surface;
  known_[at] = true;
  const Voxel cell = from_morton(frame_.codes[at]);
  const Place centre = frame_.centres[at];
  Place sum = Place::Zero(), slope = Place::Zero();
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  double count = 0, bright = 0;
  for_cells({cell[0] - kReach, cell[1] - kReach, cell[2] - kReach},
            {cell[0] + kReach, cell[1] + kReach, cell[2] + kReach}, [&](std::uint32_t i) {
              const Place d = frame_.centres[i] - centre;
              const double more = frame_.brightness[i] - frame_.brightness[at];
              sum += d;
              spread += d * d.transpose();
              slope += more * d;
              bright += more;
              ++count;
            });
  if (count < 5) return surface;
  spread -= sum * sum.transpose() / count;
  slope -= bright / count * sum;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.computeDirect(spread);
  surface.normal = axes.eigenvectors().col(0);
  for (int k = 1; k < 3; ++k)
    if (const double l = axes.eigenvalues()[k]; l > 1e-9)
      surface.gradient += axes.eigenvectors().col(k).dot(slope) / l * axes.eigenvectors().col(k);
  return surface;
}

/// Along the normal to the surface, along it to where colours agree.
Match MatchedFrame::match(const Place& place, double brightness, const Place& guess,
                          std::uint32_t& last) {
  const std::uint32_t nearest = last = this->nearest(place + guess, last);
  Match match{place, Eigen::Matrix3d::Zero(), Place::Zero()};
  if (nearest == kNone) return match;
  const Place to = frame_.centres[nearest] - place;
  const Surface& there = surface(nearest);
  const auto add = [&](const Place& row, double b) {  // row . d = b, both in cells
    const double wrong = row.dot(guess) - b, w = 1 / (1 + wrong * wrong);
    match.weight += w * row * row.transpose();
    match.wanted += w * row * b;
  };
  const Place normal = there.normal / side_, slope = there.gradient / kGreyPerCell;
  add(normal, normal.dot(to));
  add(slope, slope.dot(to) + (brightness - frame_.brightness[nearest]) / kGreyPerCell);
  if (scattered_ && there.normal.isZero()) {
    const double miss = (guess - to).norm() / side_,
                 other = (brightness - frame_.brightness[nearest]) / kGreyPerCell;
    const double w = 1 / ((1 + miss * miss) * (1 + other * other) * side_ * side_);
    match.weight += w * Eigen::Matrix3d::Identity();
    match.wanted += w * to;
  }
  constexpr double kHold = 1e-3;  // where neither tells
  match.weight += kHold / (side_ * side_) * Eigen::Matrix3d::Identity();
  match.wanted += kHold / (side_ * side_) * guess;
  return match;
}

}  // namespace slf
