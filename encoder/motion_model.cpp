// SPDX-License-Identifier: Apache-2.0
#include "encoder/motion_model.h"

#include <Eigen/Cholesky>

namespace slf {
namespace {

/// How stiff the lattice is: a difference of neighbours costs as much as 1.5 points that miss by
/// it.
constexpr double kStiffness = 0.15;
constexpr int kSolverRounds = 20;  // fits follow one another, and each goes on from the last
constexpr double kSolved = 1e-5;   // squared residual, of that at the start

}  // namespace

void MotionModel::begin_lattice(const CoarseFrame& points, int log2) {
  log2_ = log2;
  side_ = std::ldexp(1.0, log2);
  Place low = points.centres[0], high = low;
  for (const Place& p : points.centres) low = low.cwiseMin(p), high = high.cwiseMax(p);
  for (int i = 0; i < 3; ++i) {
    first_[static_cast<std::size_t>(i)] = static_cast<int>(std::floor(low[i] / side_));
    size_[static_cast<std::size_t>(i)] =
        static_cast<int>(std::floor(high[i] / side_)) + 2 - first_[static_cast<std::size_t>(i)];
  }
  lattice_.assign(static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) *
                      static_cast<std::size_t>(size_[2]),
                  Place::Zero());
}

void MotionModel::sample_lattice(const MotionModel& other, const CoarseFrame& points, int log2) {
  begin_lattice(points, log2);
  std::size_t k = 0;
  for (int z = 0; z < size_[2]; ++z)
    for (int y = 0; y < size_[1]; ++y)
      for (int x = 0; x < size_[0]; ++x, ++k)
        lattice_[k] = other.added(side_ * Place(first_[0] + x, first_[1] + y, first_[2] + z));
}

void MotionModel::begin_part(const CoarseFrame& points, int log2, const MotionModel& moving,
                             const std::vector<bool>& still) {
  begin_lattice(points, log2);
  std::vector<double> votes(lattice_.size());
  for (std::size_t i = 0; i < points.centres.size(); ++i)
    for_corners(points.centres[i],
                [&](std::size_t at, double w) { votes[at] += still[i] ? -w : w; });
  std::size_t k = 0;
  for (int z = 0; z < size_[2]; ++z)
    for (int y = 0; y < size_[1]; ++y)
      for (int x = 0; x < size_[0]; ++x, ++k)
        if (votes[k] > 0)
          lattice_[k] = moving.at(side_ * Place(first_[0] + x, first_[1] + y, first_[2] + z));
}

void MotionModel::refine_lattice(const CoarseFrame& points) {
  const MotionModel wide = *this;
  sample_lattice(wide, points, log2_ - 1);
}

void MotionModel::start_from(const Motion& motion, const CoarseFrame& points) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j)
      matrix_(static_cast<int>(i), static_cast<int>(j)) =
          std::ldexp(motion.matrix[i][j], -Motion::kMatrixBits);
    shift_[static_cast<int>(i)] = motion.shift[i] / 16.0;
  }
  if (motion.lattice_log2 == 0) return;
  MotionModel given = *this;
  given.log2_ = motion.lattice_log2;
  given.side_ = std::ldexp(1.0, motion.lattice_log2);
  for (std::size_t i = 0; i < 3; ++i) {
    given.first_[i] = motion.lattice_first[i];
    given.size_[i] = motion.lattice_size[i];
  }
  for (const Displacement& d : motion.lattice)
    given.lattice_.emplace_back(d[0] / 16.0, d[1] / 16.0, d[2] / 16.0);
  sample_lattice(given, points, motion.lattice_log2);
}

void MotionModel::fit_affine(const std::vector<Match>& matches) {
  Eigen::Matrix<double, 12, 12> normal = Eigen::Matrix<double, 12, 12>::Zero();
  Eigen::Matrix<double, 12, 1> right = Eigen::Matrix<double, 12, 1>::Zero();
  double scale = 0, total = 0;
  for (const Match& m : matches) {
    Eigen::Vector4d at;
    at << m.place - centre_, 1;
    for (int a = 0; a < 4; ++a) {
      right.segment<3>(3 * a) += at[a] * m.wanted;
      for (int b = 0; b <= a; ++b) normal.block<3, 3>(3 * a, 3 * b) += at[a] * at[b] * m.weight;
    }
    scale += m.weight.trace() * at.head<3>().squaredNorm();
    total += m.weight.trace();
  }
  if (!(total > 0)) return;
  normal.triangularView<Eigen::StrictlyUpper>() = normal.transpose();  // weights are symmetric
  for (int k = 0; k < 12; ++k) {  // what nothing tells of stays as it is
    const double stay = 1e-6 * (k < 9 ? scale : total) + 1e-9;
    normal(k, k) += stay;
    right[k] += stay * (k < 9 ? matrix_(k % 3, k / 3) : shift_[k - 9]);
  }
  const Eigen::Matrix<double, 12, 1> x = normal.ldlt().solve(right);
  for (int k = 0; k < 9; ++k) matrix_(k % 3, k / 3) = x[k];
  shift_ = x.tail<3>();
}

std::vector<MotionModel::CellSums> MotionModel::sum_cells(const std::vector<Match>& matches) const {
  constexpr int kPairs = 36;                      // of the eight points
  using Sums = Eigen::Matrix<double, kPairs, 6>;  // [pair][of a symmetric matrix]
  std::vector<CellSums> cells;
  std::vector<Sums> sums;
  std::vector<std::size_t> cell_at(lattice_.size(), ~std::size_t{0});  // by its first point
  for (const Match& m : matches) {
    const Corners corners = corners_of(m.place);
    std::size_t& at = cell_at[corners.point[0]];
    if (at >= cells.size()) {
      at = cells.size();
      cells.push_back({corners.point, Eigen::Matrix<double, 24, 24>::Zero()});
      sums.emplace_back(Sums::Zero());
    }
    Eigen::Matrix<double, kPairs, 1> both;
    for (std::size_t a = 0, pair = 0; a < 8; ++a)
      for (std::size_t b = 0; b <= a; ++b, ++pair)
        both[static_cast<int>(pair)] = corners.weight[a] * corners.weight[b];
    for (int i = 0, entry = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j, ++entry) sums[at].col(entry) += m.weight(i, j) * both;
  }
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (int a = 0, pair = 0; a < 8; ++a)
      for (int b = 0; b <= a; ++b, ++pair)
        for (int i = 0, entry = 0; i < 3; ++i)
          for (int j = 0; j <= i; ++j, ++entry) {
            const double sum = sums[c](pair, entry);
            cells[c].normal(3 * a + i, 3 * b + j) = cells[c].normal(3 * a + j, 3 * b + i) = sum;
            cells[c].normal(3 * b + i, 3 * a + j) = cells[c].normal(3 * b + j, 3 * a + i) = sum;
          }
  return cells;
}

void MotionModel::fit_lattice(const std::vector<Match>& matches, double stiffness) {
  stiffness_ = kStiffness * stiffness;
  using Field = std::vector<Place>;
  const std::vector<CellSums> cells = sum_cells(matches);
  const auto apply = [&](const Field& x) {
    Field y(x.size(), Place::Zero());
    Eigen::Matrix<double, 24, 1> of_cell;
    for (const CellSums& cell : cells) {
      for (std::size_t c = 0; c < 8; ++c)
        of_cell.segment<3>(3 * static_cast<int>(c)) = x[cell.point[c]];
      of_cell = (cell.normal * of_cell).eval();
      for (std::size_t c = 0; c < 8; ++c)
        y[cell.point[c]] += of_cell.segment<3>(3 * static_cast<int>(c));
    }
    add_stiffness(x, y);
    return y;
  };
  const auto dot = [](const Field& a, const Field& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += a[k].dot(b[k]);
    return sum;
  };
  Field rest(lattice_.size(), Place::Zero());
  for (const Match& m : matches) {
    const Place d = m.wanted - m.weight * affine(m.place);
    for_corners(m.place, [&](std::size_t k, double w) { rest[k] += w * d; });
  }
  const Field of_now = apply(lattice_);
  for (std::size_t k = 0; k < rest.size(); ++k) rest[k] -= of_now[k];
  Field way = rest;
  const double first = dot(rest, rest);
  double size = first;
  for (int round = 0; round < kSolverRounds && size > kSolved * first; ++round) {
    const Field there = apply(way);
    const double by = size / dot(way, there);
    for (std::size_t k = 0; k < rest.size(); ++k) {
      lattice_[k] += by * way[k];
      rest[k] -= by * there[k];
    }
    const double now = dot(rest, rest);
    for (std::size_t k = 0; k < rest.size(); ++k) way[k] = rest[k] + now / size * way[k];
    size = now;
  }
}

Motion MotionModel::rounded() const {
  Motion m;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j)
      m.matrix[i][j] = static_cast<std::int32_t>(
          std::clamp<long>(std::lround(matrix_(static_cast<int>(i), static_cast<int>(j)) *
                                       (1 << Motion::kMatrixBits)),
                           -Motion::kMostEntry, Motion::kMostEntry));
    m.shift[i] = static_cast<std::int32_t>(std::clamp<long>(
        std::lround(16 * shift_[static_cast<int>(i)]), -Motion::kMostShift, Motion::kMostShift));
  }
  if (side_ == 0) return m;
  m.lattice_log2 = log2_;
  m.lattice_first = {first_[0], first_[1], first_[2]};
  m.lattice_size = {size_[0], size_[1], size_[2]};
  for (const Place& v : lattice_)
    m.lattice.push_back({static_cast<std::int32_t>(4 * std::lround(4 * v[0])),
                         static_cast<std::int32_t>(4 * std::lround(4 * v[1])),
                         static_cast<std::int32_t>(4 * std::lround(4 * v[2]))});
  return m;
}

void MotionModel::add_stiffness(const std::vector<Place>& x, std::vector<Place>& y) const {
  const std::array<int, 3> stride = {1, size_[0], size_[0] * size_[1]};
  for (int k = 0; k < static_cast<int>(x.size()); ++k) {
    const auto here = static_cast<std::size_t>(k);
    y[here] += 1e-2 * stiffness_ * x[here];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (k / stride[axis] % size_[axis] + 1 >= size_[axis]) continue;
      const auto other = static_cast<std::size_t>(k + stride[axis]);
      const Place pull = stiffness_ * (x[here] - x[other]);
      y[here] += pull;
      y[other] -= pull;
    }
  }
}

}  // namespace slf
