#include "encoder/find_motion.h"

#include <Eigen/Dense>
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

/// Of the lattice: what a difference of its neighbours costs, in points that are as far away.
constexpr double kStiffness = 2;
constexpr int kAffineRounds = 8, kLatticeRounds = 5;
constexpr int kSolverRounds = 60;
constexpr std::size_t kAffinePlaces = 6000, kLatticePlaces = 20000;

/// What one place asks of its displacement d: (weight d - wanted) is to be small.
struct Match {
  Place place;
  Eigen::Matrix3d weight;
  Place wanted;
};

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

  /// Least squares of what matches ask for.
  void fit_affine(const std::vector<Match>& matches) {
    Eigen::Matrix<double, 12, 12> normal = Eigen::Matrix<double, 12, 12>::Zero();
    Eigen::Matrix<double, 12, 1> right = Eigen::Matrix<double, 12, 1>::Zero();
    double scale = 0, total = 0;
    for (const Match& m : matches) {
      Eigen::Vector4d at;
      at << m.place - centre_, 1;
      for (int a = 0; a < 4; ++a) {
        right.segment<3>(3 * a) += at[a] * m.wanted;
        for (int b = 0; b < 4; ++b)
          normal.block<3, 3>(3 * a, 3 * b) += at[a] * at[b] * m.weight;
      }
      scale += m.weight.trace() * at.head<3>().squaredNorm();
      total += m.weight.trace();
    }
    if (!(total > 0)) return;
    for (int k = 0; k < 12; ++k) {  // what nothing tells of stays as it is
      const double stay = 1e-6 * (k < 9 ? scale : total) + 1e-9;
      normal(k, k) += stay;
      right[k] += stay * (k < 9 ? matrix_(k % 3, k / 3) : shift_[k - 9]);
    }
    const Eigen::Matrix<double, 12, 1> x = normal.ldlt().solve(right);
    for (int k = 0; k < 9; ++k) matrix_(k % 3, k / 3) = x[k];
    shift_ = x.tail<3>();
  }

  /// The same of the lattice, beside the affine part: conjugate gradients.
  void fit_lattice(const std::vector<Match>& matches) {
    using Field = std::vector<Place>;
    const auto apply = [&](const Field& x) {
      Field y(x.size(), Place::Zero());
      for (const Match& m : matches) {
        Place d = Place::Zero();
        for_corners(m.place, [&](std::size_t k, double w) { d += w * x[k]; });
        d = m.weight * d;
        for_corners(m.place, [&](std::size_t k, double w) { y[k] += w * d; });
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
    for (int round = 0; round < kSolverRounds && size > 1e-8 * first; ++round) {
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
  /// Neighbours on the lattice are alike, and small.
  void add_stiffness(const std::vector<Place>& x, std::vector<Place>& y) const {
    const std::array<int, 3> stride = {1, size_[0], size_[0] * size_[1]};
    for (int k = 0; k < static_cast<int>(x.size()); ++k) {
      const auto here = static_cast<std::size_t>(k);
      y[here] += 1e-2 * kStiffness * x[here];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (k / stride[axis] % size_[axis] + 1 >= size_[axis]) continue;
        const auto other = static_cast<std::size_t>(k + stride[axis]);
        const Place pull = kStiffness * (x[here] - x[other]);
        y[here] += pull;
        y[other] -= pull;
      }
    }
  }

  Place centre_, shift_ = Place::Zero();
  Eigen::Matrix3d matrix_ = Eigen::Matrix3d::Zero();
  int log2_ = 0;
  double side_ = 0;
  std::array<int, 3> first_{}, size_{};
  std::vector<Place> lattice_;
};

/// Grey levels that are as far apart as the side of a cell.
constexpr double kGreyPerCell = 24;

/// A frame of some level that others are matched with: its surface and how colours change on it.
class MatchedFrame {
 public:
  MatchedFrame(const FramePoints& points, int dropped)
      : frame_(coarsen(points, dropped)),
        index_(frame_.codes),
        side_(std::ldexp(1.0, dropped)),
        known_(frame_.codes.size()),
        surface_(frame_.codes.size()) {}

  double side() const { return side_; }
  Match match(const Place& place, const Place& colour, const Place& guess);

 private:
  struct Surface {
    Place normal = Place::Zero();    ///< 0: not known
    Place gradient = Place::Zero();  ///< of the brightness, grey levels a voxel, along the surface
  };
  const Surface& surface(std::uint32_t at);
  template <class Step>
  void for_cells(const Place& at, const Step& step) const;
  static double brightness(const Place& colour) { return colour.sum() / 3; }

  CoarseFrame frame_;
  ReferenceLevel index_;
  double side_;
  std::vector<bool> known_;
  std::vector<Surface> surface_;
};

/// Those within two cells of a place.
template <class Step>
void MatchedFrame::for_cells(const Place& at, const Step& step) const {
  constexpr int kReach = 2;
  const Voxel cell = {static_cast<std::int32_t>(std::floor(at[0] / side_)),
                      static_cast<std::int32_t>(std::floor(at[1] / side_)),
                      static_cast<std::int32_t>(std::floor(at[2] / side_))};
  for (int z = -kReach; z <= kReach; ++z)
    for (int y = -kReach; y <= kReach; ++y)
      for (int x = -kReach; x <= kReach; ++x)
        if (const std::uint32_t i = index_.find({cell[0] + x, cell[1] + y, cell[2] + z});
            i != ReferenceLevel::kNone)
          step(i);
}

/// A plane through what is around, and a slope of brightness in it.
const MatchedFrame::Surface& MatchedFrame::surface(std::uint32_t at) {
  Surface& surface = surface_[at];
  if (known_[at]) return surface;
  known_[at] = true;
  Place mean = Place::Zero();
  double count = 0, bright = 0;
  for_cells(frame_.centres[at], [&](std::uint32_t i) {
    mean += frame_.centres[i];
    bright += brightness(frame_.colours[i]);
    ++count;
  });
  if (count < 5) return surface;
  mean /= count;
  bright /= count;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  Place slope = Place::Zero();
  for_cells(frame_.centres[at], [&](std::uint32_t i) {
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
  double best = 1e300;
  std::uint32_t nearest = ReferenceLevel::kNone;
  for_cells(q, [&](std::uint32_t i) {
    const double d = (frame_.centres[i] - q).squaredNorm();
    if (d < best) best = d, nearest = i;
  });
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
  add(slope, slope.dot(to) +
                 (brightness(colour) - brightness(frame_.colours[nearest])) / kGreyPerCell);
  constexpr double kHold = 1e-3;  // where neither tells
  match.weight += kHold / (side_ * side_) * Eigen::Matrix3d::Identity();
  match.wanted += kHold / (side_ * side_) * guess;
  return match;
}

std::vector<Match> match_all(const CoarseFrame& now, MatchedFrame& before,
                             const MotionModel& motion, std::size_t most) {
  const std::size_t apart = std::max<std::size_t>(1, now.codes.size() / most);
  std::vector<Match> matches;
  for (std::size_t i = apart / 2; i < now.codes.size(); i += apart)
    matches.push_back(before.match(now.centres[i], now.colours[i], motion.at(now.centres[i])));
  return matches;
}

}  // namespace

Motion find_motion(const FramePoints& now, const FramePoints& before, int bits) {
  if (now.codes.empty() || before.codes.empty()) return {};
  MotionModel motion(bits);
  const int lattice_log2 = std::clamp(bits - 4, 3, 8);
  for (int dropped = std::max(bits - 4, 0); dropped >= 0; --dropped) {
    const CoarseFrame coarse = coarsen(now, dropped);
    MatchedFrame there(before, dropped);
    for (int round = 0; round < kAffineRounds; ++round)
      motion.fit_affine(match_all(coarse, there, motion, kAffinePlaces));
  }
  for (int dropped = std::max(bits - 6, 0); dropped >= 0; --dropped) {
    const CoarseFrame coarse = coarsen(now, dropped);
    MatchedFrame there(before, dropped);
    if (dropped == std::max(bits - 6, 0)) motion.begin_lattice(coarse, lattice_log2);
    for (int round = 0; round < kLatticeRounds; ++round)
      motion.fit_lattice(match_all(coarse, there, motion, kLatticePlaces));
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
