// SPDX-License-Identifier: Apache-2.0
#include "encoder/matched_frame.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "geometry/morton.h"

namespace slf {
namespace {

/// Grey levels that are as far apart as the side of a cell.
constexpr double kGreyPerCell = 24;
constexpr int kReach = 2;            // cells around a place that are looked at
constexpr double kAnywhere = 1e300;  // squared distance

}  // namespace

CoarseFrame coarsen(const FramePoints& points, int dropped) {
  CoarseFrame out;
  std::vector<double> count;
  for (std::size_t i = 0; i < points.codes.size(); ++i) {
    const std::uint64_t code = points.codes[i] >> (3 * dropped);
    if (out.codes.empty() || out.codes.back() != code) {
      out.codes.push_back(code);
      out.centres.emplace_back(Place::Zero());
      out.colours.emplace_back(Place::Zero());
      count.push_back(0);
    }
    const Voxel v = from_morton(points.codes[i]);
    out.centres.back() += Place(v[0] + 0.5, v[1] + 0.5, v[2] + 0.5);
    out.colours.back() += Place(points.colours[i][0], points.colours[i][1], points.colours[i][2]);
    ++count.back();
  }
  for (std::size_t i = 0; i < count.size(); ++i) {
    out.centres[i] /= count[i];
    out.colours[i] /= count[i];
  }
  return out;
}

template <class Step>
void MatchedFrame::for_cells(const Place& at, int reach, double square, const Step& step) {
  Voxel cell;
  for (std::size_t i = 0; i < 3; ++i)
    cell[i] = static_cast<std::int32_t>(std::floor(at[static_cast<int>(i)] / side_));
  const auto apart = [&](std::size_t axis, int by) {  // squared, of the place and a slab of cells
    if (by == 0) return 0.0;
    const double in = at[static_cast<int>(axis)] - side_ * (cell[axis] + (by > 0 ? by : by + 1));
    return in * in;
  };
  for (int z = -reach; z <= reach; ++z)
    for (int y = -reach; y <= reach; ++y) {
      const double of_row = apart(2, z) + apart(1, y);
      if (of_row > square) continue;
      for (int x = -reach; x <= reach; ++x)
        if (of_row + apart(0, x) <= square)
          if (const std::uint32_t i = walk_.find({cell[0] + x, cell[1] + y, cell[2] + z});
              i != ReferenceLevel::kNone)
            step(i);
    }
}

/// A point within kReach cells; ReferenceLevel::kNone where there is none.
std::uint32_t MatchedFrame::nearest(const Place& at) {
  double most = kAnywhere;
  for_cells(at, 1, kAnywhere, [&](std::uint32_t i) {
    most = std::min(most, (frame_.centres[i] - at).squaredNorm());
  });
  double best = kAnywhere;
  std::uint32_t nearest = ReferenceLevel::kNone;
  for_cells(at, kReach, most, [&](std::uint32_t i) {  // the first of those that are as near
    const double d = (frame_.centres[i] - at).squaredNorm();
    if (d < best) best = d, nearest = i;
  });
  return nearest;
}

/// A plane through what is around, and a slope of brightness in it.
const MatchedFrame::Surface& MatchedFrame::surface(std::uint32_t at) {
  Surface& surface = surface_[at];
  if (known_[at]) return surface;
  known_[at] = true;
  Place mean = Place::Zero();
  double count = 0, bright = 0;
  for_cells(frame_.centres[at], kReach, kAnywhere, [&](std::uint32_t i) {
    mean += frame_.centres[i];
    bright += brightness(frame_.colours[i]);
    ++count;
  });
  if (count < 5) return surface;
  mean /= count;
  bright /= count;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  Place slope = Place::Zero();
  for_cells(frame_.centres[at], kReach, kAnywhere, [&](std::uint32_t i) {
    const Place d = frame_.centres[i] - mean;
    spread += d * d.transpose();
    slope += d * (brightness(frame_.colours[i]) - bright);
  });
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  surface.normal = axes.eigenvectors().col(0);
  for (int k = 1; k < 3; ++k)
    if (const double l = axes.eigenvalues()[k]; l > 1e-9)
      surface.gradient += axes.eigenvectors().col(k).dot(slope) / l * axes.eigenvectors().col(k);
  return surface;
}

/// Along the normal to the surface, along it to where colours agree.
Match MatchedFrame::match(const Place& place, const Place& colour, const Place& guess) {
  const Place q = place + guess;
  const std::uint32_t nearest = this->nearest(q);
  Match match{place, Eigen::Matrix3d::Zero(), Place::Zero()};
  if (nearest == ReferenceLevel::kNone) return match;
  const Place to = frame_.centres[nearest] - place;
  const Surface& there = surface(nearest);
  const auto add = [&](const Place& row, double b) {  // row . d = b, both in cells
    const double wrong = row.dot(guess) - b, w = 1 / (1 + wrong * wrong);
    match.weight += w * row * row.transpose();
    match.wanted += w * row * b;
  };
  const Place normal = there.normal / side_, slope = there.gradient / kGreyPerCell;
  add(normal, normal.dot(to));
  add(slope,
      slope.dot(to) + (brightness(colour) - brightness(frame_.colours[nearest])) / kGreyPerCell);
  constexpr double kHold = 1e-3;  // where neither tells
  match.weight += kHold / (side_ * side_) * Eigen::Matrix3d::Identity();
  match.wanted += kHold / (side_ * side_) * guess;
  return match;
}

}  // namespace slf
