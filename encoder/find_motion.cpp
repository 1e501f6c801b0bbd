#include "encoder/find_motion.h"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>

#include "geometry/morton.h"
#include "geometry/reference_cells.h"

namespace slf {
namespace {

using Place = Eigen::Vector3d;

/// A frame with fewer, larger cells.
struct CoarseFrame {
  std::vector<std::uint64_t> codes;
  std::vector<Place> centres;  // in voxels
  std::vector<Place> colours;
};

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
    out.colours.back() +=
        Place(points.colours[i][0], points.colours[i][1], points.colours[i][2]);
    ++count.back();
  }
  for (std::size_t i = 0; i < count.size(); ++i) {
    out.centres[i] /= count[i];
    out.colours[i] /= count[i];
  }
  return out;
}

/// What is looked for: displacements in voxels.
class MotionModel {
 public:
  explicit MotionModel(int bits) : centre_(Place::Constant(std::ldexp(0.5, bits))) {}

  Place affine(const Place& p) const { return matrix_ * (p - centre_) + shift_; }
  Place at(const Place& p) const {
    Place d = affine(p);
    if (side_ > 0)
      for_corners(p, [&](std::size_t i, double w) { d += w * lattice_[i]; });
    return d;
  }

  /// A lattice over all places of `points`.
  void begin_lattice(const CoarseFrame& points, int log2) {
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

  template <class Step>
  void for_corners(const Place& p, const Step& step) const {
    std::array<int, 3> cell{};
    std::array<double, 3> in{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double at = p[static_cast<int>(i)] / side_ - first_[i];
      cell[i] = std::clamp(static_cast<int>(std::floor(at)), 0, std::max(size_[i] - 2, 0));
      in[i] = std::clamp(at - cell[i], 0.0, 1.0);
    }
    for (int c = 0; c < 8; ++c) {
      double w = 1;
      std::size_t index = 0;
      for (std::size_t i = 3; i-- > 0;) {
        const int upper = c >> i & 1;
        w *= upper ? in[i] : 1 - in[i];
        index = index * static_cast<std::size_t>(size_[i]) +
                static_cast<std::size_t>(std::min(cell[i] + upper, size_[i] - 1));
      }
      if (w > 0) step(index, w);
    }
  }

  /// Weighted least squares of wanted displacements.
  void fit_affine(const std::vector<Place>& places, const std::vector<Place>& wanted,
                  const std::vector<double>& weights) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    Eigen::Matrix<double, 4, 3> right = Eigen::Matrix<double, 4, 3>::Zero();
    double scale = 0, total = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      Eigen::Vector4d row;
      row << places[i] - centre_, 1;
      normal += weights[i] * row * row.transpose();
      right += weights[i] * row * wanted[i].transpose();
      scale += weights[i] * (places[i] - centre_).squaredNorm();
      total += weights[i];
    }
    if (total <= 0) return;
    for (int i = 0; i < 3; ++i) normal(i, i) += 1e-6 * scale + 1e-6;  // thin clouds do not turn
    right.topRows<3>() += (1e-6 * scale + 1e-6) * matrix_.transpose();
    normal(3, 3) += 1e-9;
    const Eigen::Matrix<double, 4, 3> x = normal.ldlt().solve(right);
    matrix_ = x.topRows<3>().transpose();
    shift_ = x.row(3).transpose();
  }

  void fit_lattice(const std::vector<Place>& places, const std::vector<Place>& wanted,
                   const std::vector<double>& weights, double stiffness) {
    const auto n = static_cast<int>(lattice_.size());
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, 3);
    for (std::size_t i = 0; i < places.size(); ++i) {
      std::array<std::pair<int, double>, 8> corner;
      std::size_t count = 0;
      for_corners(places[i], [&](std::size_t k, double w) {
        corner[count++] = {static_cast<int>(k), w};
      });
      const Place rest = wanted[i] - affine(places[i]);
      for (std::size_t a = 0; a < count; ++a) {
        right.row(corner[a].first) += weights[i] * corner[a].second * rest.transpose();
        for (std::size_t b = 0; b < count; ++b)
          entries.emplace_back(corner[a].first, corner[b].first,
                               weights[i] * corner[a].second * corner[b].second);
      }
    }
    const std::array<int, 3> stride = {1, size_[0], size_[0] * size_[1]};
    for (int k = 0; k < n; ++k) {
      entries.emplace_back(k, k, 1e-3 * stiffness);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (k / stride[axis] % size_[axis] + 1 >= size_[axis]) continue;
        const int other = k + stride[axis];
        entries.emplace_back(k, k, stiffness);
        entries.emplace_back(other, other, stiffness);
        entries.emplace_back(k, other, -stiffness);
        entries.emplace_back(other, k, -stiffness);
      }
    }
    Eigen::SparseMatrix<double> normal(n, n);
    normal.setFromTriplets(entries.begin(), entries.end());
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver;
    solver.setTolerance(1e-4);
    solver.setMaxIterations(200);
    solver.compute(normal);
    const Eigen::MatrixXd x = solver.solve(right);
    for (int k = 0; k < n; ++k) lattice_[static_cast<std::size_t>(k)] = x.row(k).transpose();
  }

  Motion rounded() const {
    Motion m;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j)
        m.matrix[i][j] = static_cast<std::int32_t>(std::clamp<long>(
            std::lround(matrix_(static_cast<int>(i), static_cast<int>(j)) *
                        (1 << Motion::kMatrixBits)),
            -Motion::kMostEntry, Motion::kMostEntry));
      m.shift[i] = static_cast<std::int32_t>(std::lround(16 * shift_[static_cast<int>(i)]));
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

 private:
  Place centre_, shift_ = Place::Zero();
  Eigen::Matrix3d matrix_ = Eigen::Matrix3d::Zero();
  int log2_ = 0;
  double side_ = 0;
  std::array<int, 3> first_{}, size_{};
  std::vector<Place> lattice_;
};

/// Of the lattice: what a difference of its neighbours costs, in points that are as far away.
constexpr double kStiffness = 2;
constexpr int kAffineRounds = 8, kLatticeRounds = 5;

/// Grey levels that are as far apart as the side of a cell.
constexpr double kGreyPerCell = 24;

/// For some places of `now` the displacement to the nearest of `before`, by place and colour.
struct Matches {
  std::vector<Place> places, wanted;
  std::vector<double> weights;
};

Matches match(const CoarseFrame& now, const CoarseFrame& before, const ReferenceLevel& index,
              int dropped, const MotionModel& motion) {
  constexpr std::size_t kMost = 20000;
  constexpr int kReach = 2;  // cells
  const double side = std::ldexp(1.0, dropped), by_colour = side * side / (kGreyPerCell * kGreyPerCell);
  const std::size_t apart = std::max<std::size_t>(1, now.codes.size() / kMost);
  Matches out;
  for (std::size_t i = apart / 2; i < now.codes.size(); i += apart) {
    const Place q = now.centres[i] + motion.at(now.centres[i]);
    const Voxel cell = {static_cast<std::int32_t>(std::floor(q[0] / side)),
                        static_cast<std::int32_t>(std::floor(q[1] / side)),
                        static_cast<std::int32_t>(std::floor(q[2] / side))};
    double best = 1e300;
    std::uint32_t nearest = ReferenceLevel::kNone;
    for (int z = -kReach; z <= kReach; ++z)
      for (int y = -kReach; y <= kReach; ++y)
        for (int x = -kReach; x <= kReach; ++x) {
          const std::uint32_t at = index.find({cell[0] + x, cell[1] + y, cell[2] + z});
          if (at == ReferenceLevel::kNone) continue;
          const double d = (before.centres[at] - q).squaredNorm() +
                           by_colour * (before.colours[at] - now.colours[i]).squaredNorm();
          if (d < best) best = d, nearest = at;
        }
    if (nearest == ReferenceLevel::kNone) continue;
    out.places.push_back(now.centres[i]);
    out.wanted.push_back(before.centres[nearest] - now.centres[i]);
    out.weights.push_back(1 / (1 + best / (side * side)));
  }
  return out;
}

}  // namespace

Motion find_motion(const FramePoints& now, const FramePoints& before, int bits) {
  if (now.codes.empty() || before.codes.empty()) return {};
  MotionModel motion(bits);
  const int lattice_log2 = std::clamp(bits - 4, 3, 8);
  for (int dropped = std::max(bits - 4, 0); dropped >= 0; --dropped) {
    const CoarseFrame coarse = coarsen(now, dropped), coarse_before = coarsen(before, dropped);
    const ReferenceLevel index(coarse_before.codes);
    for (int round = 0; round < kAffineRounds; ++round) {
      const Matches m = match(coarse, coarse_before, index, dropped, motion);
      motion.fit_affine(m.places, m.wanted, m.weights);
    }
  }
  for (int dropped = std::max(bits - 6, 0); dropped >= 0; --dropped) {
    const CoarseFrame coarse = coarsen(now, dropped), coarse_before = coarsen(before, dropped);
    const ReferenceLevel index(coarse_before.codes);
    if (dropped == std::max(bits - 6, 0)) motion.begin_lattice(coarse, lattice_log2);
    for (int round = 0; round < kLatticeRounds; ++round) {
      const Matches m = match(coarse, coarse_before, index, dropped, motion);
      motion.fit_lattice(m.places, m.wanted, m.weights, kStiffness);
    }
  }
  return motion.rounded();
}

namespace {

/// Grey levels by which a frame differs from what its reference shows there, of a sample of points.
double mismatch(const FramePoints& now, const FramePoints& before, const ReferenceLevel& index,
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
      sum += std::min(std::abs(double{now.colours[i][c]} - double{before.colours[at][c]}), kMissed) / 3;
  }
  return count > 0 ? sum / count : 0;
}

}  // namespace

Motion choose_motion(const FramePoints& now, const FramePoints& before, int bits) {
  const ReferenceLevel index(before.codes);
  const Motion found = find_motion(now, before, bits);
  Motion affine = found;
  affine.lattice_log2 = 0;
  affine.lattice_first = affine.lattice_size = {};
  affine.lattice.clear();
  // What is simpler has to be worse by more than it saves.
  constexpr double kAffineCost = 1.002, kLatticeCost = 1.02;
  const double none = mismatch(now, before, index, {}, bits),
               by_affine = kAffineCost * mismatch(now, before, index, affine, bits),
               by_lattice = kLatticeCost * mismatch(now, before, index, found, bits);
  if (none <= by_affine && none <= by_lattice) return {};
  return by_affine <= by_lattice ? affine : found;
}

}  // namespace slf
