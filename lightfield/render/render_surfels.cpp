// SPDX-License-Identifier: Apache-2.0
#include "lightfield/render/render_surfels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>

#include "base/vec3.h"
#include "geometry/morton.h"
#include "lightfield/render/reference_kernel.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kMeanPerCell = 4;  // points; so that a window of a few cells has dozens
constexpr std::size_t kEnough = 12;      // neighbours for a normal
constexpr double kFirstWindow = 1.25;    // radius in cells
constexpr double kWindowGrowth = 1.6;
constexpr double kLastWindow = 5.2;  // cells; a point alone in there is alone
constexpr std::size_t kNearest = 6;  // neighbours that a disc should reach

/// Points in Morton order, so that every cubic cell of 2^k voxels is a run of them, and how large a
/// cell must be around each point to hold a few. Density may differ by any factor across a cloud.
class CellTree {
 public:
  explicit CellTree(std::span<const Voxel> positions) : positions_(positions) {
    std::vector<std::uint64_t> codes(positions.size());
    std::transform(positions.begin(), positions.end(), codes.begin(), morton);
    order_.resize(positions.size());
    std::iota(order_.begin(), order_.end(), 0u);
    if (!std::is_sorted(codes.begin(), codes.end())) sort_by(codes);
    codes_.reserve(codes.size());
    for (const std::uint32_t p : order_) codes_.push_back(codes[p]);
    cell_log2_.resize(positions.size());
    if (!codes_.empty()) choose_cells(0, codes_.size(), kRootLevel, -kHysteresis);
  }

  std::size_t size() const { return order_.size(); }
  /// The point at place i of the Morton order.
  std::uint32_t point(std::size_t i) const { return order_[i]; }
  double cell_size(std::size_t i) const { return std::ldexp(1.0, cell_log2_[i]); }

  /// Cell size of the cloud as a whole.
  double common_cell_size() const { return std::ldexp(1.0, common_log2_); }

  /// visit(offset, squared distance, how many points it stands for) for the other points within
  /// `radius` of the one at place i. A cell of very many is sampled evenly, so that the work is
  /// bounded whatever the cloud.
  template <class Visit>
  void visit_ball(std::size_t i, double radius, Visit&& visit) const {
    const Voxel& centre = positions_[order_[i]];
    const auto reach = static_cast<std::int32_t>(std::min(radius, 4e6));
    int level = 0;  // the first whose window is as wide
    for (double window = kFirstWindow; level < kRootLevel && window < radius; window *= 2) ++level;
    Voxel low, high;
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::max(0, centre[k] - reach) >> level;
      high[k] = std::min((1 << kRootLevel) - 1, centre[k] + reach) >> level;
    }
    for (std::int32_t z = low[2]; z <= high[2]; ++z)
      for (std::int32_t y = low[1]; y <= high[1]; ++y)
        for (std::int32_t x = low[0]; x <= high[0]; ++x) {
          const std::uint64_t cell = morton({x, y, z});
          const std::size_t begin = find(i, cell << 3 * level);
          std::size_t end = begin;  // mostly a few points on
          while (end < begin + 8 && end < size() && codes_[end] >> 3 * level == cell) ++end;
          if (end == begin + 8) end = find(end, (cell + 1) << 3 * level);
          const std::size_t stride = (end - begin) / kMostPerCell + 1;
          for (std::size_t j = begin; j < end; j += stride) {
            const Voxel& other = positions_[order_[j]];
            const std::array<double, 3> offset{double(other[0] - centre[0]),
                                               double(other[1] - centre[1]),
                                               double(other[2] - centre[2])};
            const double d2 = offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2];
            if (d2 <= radius * radius && d2 > 0) visit(offset, d2, std::min(stride, end - j));
          }
        }
  }

 private:
  /// Byte by byte from the lowest: fewer bytes of a program than a sort of the library's.
  void sort_by(std::span<const std::uint64_t> codes) {
    std::vector<std::uint32_t> sorted(order_.size());
    const std::uint64_t most = *std::max_element(codes.begin(), codes.end());
    const int bits = static_cast<int>(std::bit_width(most));
    for (int shift = 0; shift < bits; shift += 8) {
      std::array<std::uint32_t, 257> begin{};
      for (const std::uint64_t code : codes) ++begin[(code >> shift & 255) + 1];
      std::partial_sum(begin.begin(), begin.end(), begin.begin());
      for (const std::uint32_t p : order_) sorted[begin[codes[p] >> shift & 255]++] = p;
      order_.swap(sorted);
    }
  }

  static constexpr int kRootLevel = 21;
  static constexpr std::size_t kMeasured = 512;  // points of a node whose density is measured
  static constexpr int kHysteresis = 2;  // levels; what differs less has the cells around it
  static constexpr std::size_t kMostPerCell = 256;

  /// Cells of the points at places begin .. end - 1, a node of 2^level voxels; `around` is what the
  /// node above takes.
  void choose_cells(std::size_t begin, std::size_t end, int level, int around) {
    int own = around;
    if (end - begin >= kMeasured || level == kRootLevel) {
      std::array<std::size_t, kRootLevel + 1> parted{};  // neighbours in order, by parting level
      for (std::size_t i = begin + 1; i < end; ++i) ++parted[parting_level(i)];
      std::size_t cells = end - begin - parted[0];  // of two voxels
      for (own = 1; own < kRootLevel - 1 && cells * kMeanPerCell > end - begin; ++own)
        cells -= parted[std::size_t(own)];
      if (std::abs(own - around) < kHysteresis) own = around;
    }
    if (level == kRootLevel) common_log2_ = own;
    if (end - begin < kMeasured || level == 0) {
      std::fill(cell_log2_.begin() + std::ptrdiff_t(begin),
                cell_log2_.begin() + std::ptrdiff_t(end), static_cast<std::uint8_t>(own));
      return;
    }
    for (std::size_t i = begin, next; i < end; i = next) {
      for (next = i + 1; next < end && parting_level(next) + 1 < std::size_t(level);) ++next;
      choose_cells(i, next, level - 1, own);
    }
  }

  /// The greatest k for which the points at places i - 1 and i are in different cells of 2^k
  /// voxels.
  std::size_t parting_level(std::size_t i) const {
    const std::uint64_t differ = codes_[i] ^ codes_[i - 1];
    return differ == 0 ? 0 : std::size_t(std::bit_width(differ) - 1) / 3;
  }

  /// The first place whose code is at least `code`; quick where that is near place `from`.
  std::size_t find(std::size_t from, std::uint64_t code) const {
    std::size_t low = from, high = from, step = 16;
    if (from < size() && codes_[from] < code) {
      for (; high < size() && codes_[high] < code; step *= 2) {
        low = high;
        high += step;
      }
      high = std::min(high, size());
    } else {
      for (; low > 0 && codes_[low - 1] >= code; step *= 2) {
        high = low;
        low -= std::min(low, step);
      }
    }
    return std::size_t(std::lower_bound(codes_.begin() + std::ptrdiff_t(low),
                                        codes_.begin() + std::ptrdiff_t(high), code) -
                       codes_.begin());
  }

  std::span<const Voxel> positions_;
  std::vector<std::uint32_t> order_;     // Morton order
  std::vector<std::uint64_t> codes_;     // of the points in that order
  std::vector<std::uint8_t> cell_log2_;  // the same
  int common_log2_ = 1;
};

/// What is around one point.
struct Neighbourhood {
  std::size_t count = 0;
  std::array<double, 3> sum{};
  std::array<double, 6> products{};      // xx, yy, zz, xy, xz, yz
  std::array<double, kNearest> nearest;  // squared distances, ascending

  Neighbourhood() { nearest.fill(INFINITY); }

  void add(const std::array<double, 3>& d, double d2, std::size_t times) {
    count += times;
    const double n = static_cast<double>(times);
    for (std::size_t k = 0; k < 3; ++k) {
      sum[k] += n * d[k];
      products[k] += n * d[k] * d[k];
    }
    products[3] += n * d[0] * d[1];
    products[4] += n * d[0] * d[2];
    products[5] += n * d[1] * d[2];
    if (d2 >= nearest.back()) return;
    std::size_t at = kNearest - 1;
    for (; at > 0 && nearest[at - 1] > d2; --at) nearest[at] = nearest[at - 1];
    nearest[at] = d2;
  }
};

/// Unit eigenvector of the smallest eigenvalue of a symmetric matrix (xx, yy, zz, xy, xz, yz), in
/// closed form; 0 where it is not determined (a line or a point).
std::array<float, 3> smallest_eigenvector(const std::array<double, 6>& m) {
  const double mean = (m[0] + m[1] + m[2]) / 3;
  const double a = m[0] - mean, b = m[1] - mean, c = m[2] - mean;
  const double off = m[3] * m[3] + m[4] * m[4] + m[5] * m[5];
  const double p = std::sqrt((a * a + b * b + c * c + 2 * off) / 6);
  if (!(p > 1e-9 * mean)) return {0, 0, 0};
  const double determinant =
      a * (b * c - m[5] * m[5]) - m[3] * (m[3] * c - m[5] * m[4]) + m[4] * (m[3] * m[5] - b * m[4]);
  const double angle = std::acos(std::clamp(determinant / (2 * p * p * p), -1.0, 1.0)) / 3;
  const double smallest = mean + 2 * p * std::cos(angle + 2 * std::numbers::pi / 3);
  const std::array<double, 3> rows[3] = {
      {m[0] - smallest, m[3], m[4]}, {m[3], m[1] - smallest, m[5]}, {m[4], m[5], m[2] - smallest}};
  std::array<double, 3> best{};
  double best_square = 0;
  for (int i = 0; i < 3; ++i) {
    const auto v = cross(rows[i], rows[(i + 1) % 3]);
    const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    if (square <= best_square) continue;
    best = v;
    best_square = square;
  }
  if (!(best_square > 1e-12 * p * p * p * p)) return {0, 0, 0};
  const double scale = 1 / std::sqrt(best_square);
  return {float(best[0] * scale), float(best[1] * scale), float(best[2] * scale)};
}

std::array<float, 3> normal_of(const Neighbourhood& around) {
  if (around.count < 3) return {0, 0, 0};
  const double n = static_cast<double>(around.count + 1);  // the point itself, at offset 0
  const auto& s = around.sum;
  auto m = around.products;
  for (std::size_t k = 0; k < 3; ++k) m[k] -= s[k] * s[k] / n;
  m[3] -= s[0] * s[1] / n;
  m[4] -= s[0] * s[2] / n;
  m[5] -= s[1] * s[2] / n;
  return smallest_eigenvector(m);
}

/// Spacing of the points around one, in voxels, and the radius of its disc. Annex E.2.
void measure_spacing(const Neighbourhood& around, double window, float& spacing, float& radius) {
  constexpr const ReferenceKernel& k = kReferenceKernel;
  double even = k.smallest / k.spacing_reach, least = 0;
  if (around.count > 0) {
    const double nearest = std::sqrt(around.nearest[std::min(around.count, kNearest) - 1]);
    // At the rim of a surface the density is half: the sixth nearest keeps the disc from growing.
    even = std::min(window * std::sqrt(std::numbers::pi / static_cast<double>(around.count + 1)),
                    nearest * k.most_reach / k.spacing_reach);
    least = std::max(k.smallest, k.least_reach * nearest);
  }
  spacing = static_cast<float>(even);
  radius = static_cast<float>(std::max(k.spacing_reach * even, least));
}

}  // namespace

Surfels estimate_surfels(std::span<const Voxel> positions, int threads) {
  Surfels surfels;
  surfels.normals.resize(positions.size());
  surfels.radii.resize(positions.size());
  surfels.spacings.resize(positions.size());
  surfels.centroids.resize(positions.size());
  const CellTree tree(positions);
  parallel_ranges(positions.size(), 1024, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double last = kLastWindow * std::max(tree.cell_size(i), tree.common_cell_size());
      double window = kFirstWindow * tree.cell_size(i);
      Neighbourhood around;
      for (;; window *= kWindowGrowth) {
        around = Neighbourhood();
        tree.visit_ball(i, window, [&](const auto& offset, double d2, std::size_t times) {
          around.add(offset, d2, times);
        });
        if (around.count >= kEnough || window * kWindowGrowth > last) break;
      }
      const std::uint32_t p = tree.point(i);
      surfels.normals[p] = normal_of(around);
      for (std::size_t k = 0; k < 3; ++k)
        surfels.centroids[p][k] =
            static_cast<float>(around.sum[k] / static_cast<double>(around.count + 1));
      measure_spacing(around, window, surfels.spacings[p], surfels.radii[p]);
    }
  });
  return surfels;
}

}  // namespace slf
