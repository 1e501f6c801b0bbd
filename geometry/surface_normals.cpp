// SPDX-License-Identifier: Apache-2.0
#include "geometry/surface_normals.h"

#include <algorithm>
#include <bit>
#include <memory>

#include "geometry/block_grid.h"
#include "geometry/isqrt.h"
#include "geometry/morton.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr int kSide = 4;  // cells of a block along an axis

/// [cell][direction]: which cells of the block there lie within the radius, as bits.
using Reach = std::array<std::array<std::uint64_t, 27>, 64>;

const Reach& reach() {
  static const auto table = [] {
    auto reach = std::make_unique<Reach>();
    for (std::uint64_t cell = 0; cell < 64; ++cell)
      for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
          for (int x = -1; x <= 1; ++x) {
            std::uint64_t bits = 0;
            for (std::uint64_t other = 0; other < 64; ++other) {
              const Voxel a = from_morton(cell), b = from_morton(other);
              const int dx = b[0] - a[0] + kSide * x, dy = b[1] - a[1] + kSide * y,
                        dz = b[2] - a[2] + kSide * z;
              if (dx * dx + dy * dy + dz * dz <= kNormalRadiusSquared)
                bits |= std::uint64_t{1} << other;
            }
            (*reach)[cell][static_cast<std::size_t>(direction_index(x, y, z))] = bits;
          }
    return reach;
  }();
  return *table;
}

/// Sums over cells of 1, d and d d^T (xx, yy, zz, yz, xz, xy), d in sixteenths of a cell, below 80.
/// A ball of radius 4 has 257 cells, so n <= 257, |sum d| < 2^15, sum d d < 2^21; the covariance
/// n s - m m stays below 2^29 and the adjugate below 2^60.
struct Moments {
  std::int64_t n = 0;
  std::array<std::int64_t, 3> m{};
  std::array<std::int64_t, 6> s{};

  void add(std::int64_t x, std::int64_t y, std::int64_t z) {
    ++n;
    m[0] += x, m[1] += y, m[2] += z;
    s[0] += x * x, s[1] += y * y, s[2] += z * z;
    s[3] += y * z, s[4] += x * z, s[5] += x * y;
  }
};

using UnitVector = std::array<std::int32_t, 3>;

std::array<std::int64_t, 3> plane_normal(const Moments& sum) {
  const auto covariance = [&](std::size_t at, std::size_t a, std::size_t b) {
    return sum.n * sum.s[at] - sum.m[a] * sum.m[b];
  };
  const std::int64_t xx = covariance(0, 0, 0), yy = covariance(1, 1, 1), zz = covariance(2, 2, 2);
  const std::int64_t yz = covariance(3, 1, 2), xz = covariance(4, 0, 2), xy = covariance(5, 0, 1);
  const std::array<std::array<std::int64_t, 3>, 3> adjugate = {
      {{yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy},
       {xz * yz - xy * zz, xx * zz - xz * xz, xy * xz - xx * yz},
       {xy * yz - xz * yy, xy * xz - xx * yz, xx * yy - xy * xy}}};
  std::size_t best = 0;
  for (std::size_t a = 1; a < 3; ++a)
    if (adjugate[a][a] > adjugate[best][best]) best = a;
  if (adjugate[best][best] == 0) return {0, 0, 1};
  return adjugate[best];
}

/// The direction at length 2^17, but for rounding.
UnitVector unit_of(const std::array<std::int64_t, 3>& n) {
  constexpr int kBits = 30;  // of the largest component before it is divided
  const auto magnitude = [](std::int64_t x) { return static_cast<std::uint64_t>(x < 0 ? -x : x); };
  const int bits = static_cast<int>(
      std::bit_width(std::max({magnitude(n[0]), magnitude(n[1]), magnitude(n[2])})));
  std::array<std::uint64_t, 3> m{};
  for (std::size_t a = 0; a < 3; ++a)
    m[a] = bits > kBits ? magnitude(n[a]) >> (bits - kBits) : magnitude(n[a]) << (kBits - bits);
  const std::uint64_t length = isqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);  // >= 2^29
  UnitVector unit{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto u = static_cast<std::int32_t>((m[a] << 17) / length);
    unit[a] = n[a] < 0 ? -u : u;
  }
  return unit;
}

/// Finds the cells around a cell.
class NearCells {
 public:
  explicit NearCells(std::span<const std::uint64_t> codes)
      : codes_(codes),
        grid_(codes, codes.empty() ? 0 : (static_cast<int>(std::bit_width(codes.back())) + 2) / 3) {
  }

  /// Calls each(q, x, y, z) for the cells within the radius: index, position less that of p.
  template <class Each>
  void visit(std::size_t p, const Each& each) const {
    const std::uint64_t cell = codes_[p] & 63;
    const Voxel at = from_morton(cell);
    const auto& neighbours = grid_.neighbours(grid_.block_of(p));
    for (int d = 0; d < 27; ++d) {
      const auto direction = static_cast<std::size_t>(d);
      if (neighbours[direction] < 0) continue;
      const auto& block = grid_.block(static_cast<std::size_t>(neighbours[direction]));
      const int x0 = (d % 3 - 1) * kSide - at[0], y0 = (d / 3 % 3 - 1) * kSide - at[1],
                z0 = (d / 9 - 1) * kSide - at[2];
      for (std::uint64_t cells = reach_[cell][direction] & block.cells; cells != 0;
           cells &= cells - 1) {
        const std::uint64_t before = (cells & (~cells + 1)) - 1;  // of lower Morton code
        const auto rank = static_cast<std::size_t>(std::popcount(block.cells & before));
        const Voxel v = from_morton(static_cast<std::uint64_t>(std::countr_zero(cells)));
        each(block.first + rank, v[0] + x0, v[1] + y0, v[2] + z0);
      }
    }
  }

 private:
  std::span<const std::uint64_t> codes_;
  BlockGrid grid_;
  const Reach& reach_ = reach();
};

/// The occupied cells, in Morton order.
struct Cells {
  std::vector<std::uint64_t> codes;
  std::vector<std::array<std::uint8_t, 3>> mean;  ///< of the points, in the cell, sixteenths
  std::vector<std::size_t> first;                 ///< [cells + 1] point

  std::size_t size() const { return codes.size(); }
};

Cells cells_of(std::span<const Voxel> positions, int cell_log2) {
  Cells cells;
  const std::int32_t inside = (std::int32_t{1} << cell_log2) - 1;
  for (std::size_t p = 0; p < positions.size();) {
    const std::uint64_t code = morton(positions[p]) >> (3 * cell_log2);
    std::array<std::uint64_t, 3> sum{};
    const std::size_t first = p;
    for (; p < positions.size() && morton(positions[p]) >> (3 * cell_log2) == code; ++p)
      for (std::size_t a = 0; a < 3; ++a)
        sum[a] += static_cast<std::uint64_t>(positions[p][a] & inside);
    std::array<std::uint8_t, 3> mean{};
    for (std::size_t a = 0; a < 3; ++a)
      mean[a] = static_cast<std::uint8_t>((16 * sum[a] / (p - first)) >> cell_log2);
    cells.codes.push_back(code);
    cells.mean.push_back(mean);
    cells.first.push_back(first);
  }
  cells.first.push_back(positions.size());
  return cells;
}

}  // namespace

std::vector<std::array<std::int64_t, 3>> surface_normals(std::span<const Voxel> positions,
                                                         int cell_log2, int threads) {
  constexpr std::size_t kGrain = 4096;
  const Cells cells = cells_of(positions, cell_log2);
  const NearCells near(cells.codes);
  std::vector<UnitVector> plane(cells.size());
  parallel_ranges(cells.size(), kGrain, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      Moments sum;
      const auto& from = cells.mean[p];
      near.visit(p, [&](std::size_t q, int x, int y, int z) {
        const auto& to = cells.mean[q];
        sum.add(16 * x + to[0] - from[0], 16 * y + to[1] - from[1], 16 * z + to[2] - from[2]);
      });
      plane[p] = unit_of(plane_normal(sum));
    }
  });
  std::vector<std::array<std::int64_t, 3>> normals(positions.size());
  parallel_ranges(cells.size(), kGrain, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      std::array<std::int64_t, 3> normal{};
      near.visit(p, [&](std::size_t q, int, int, int) {
        const UnitVector &u = plane[p], &v = plane[q];
        // The cosine makes it a sum along u whatever the signs, and keeps edges.
        const std::int64_t cosine =
            std::int64_t{u[0]} * v[0] + std::int64_t{u[1]} * v[1] + std::int64_t{u[2]} * v[2];
        for (std::size_t a = 0; a < 3; ++a) normal[a] += cosine * v[a];
      });
      std::fill(normals.begin() + static_cast<std::ptrdiff_t>(cells.first[p]),
                normals.begin() + static_cast<std::ptrdiff_t>(cells.first[p + 1]), normal);
    }
  });
  return normals;
}

int cell_of_spacing(std::span<const Voxel> positions) {
  int cell_log2 = 0;
  for (std::size_t before = positions.size(); before > 1 && cell_log2 < 20; ++cell_log2) {
    const std::size_t cells = cells_of(positions, cell_log2 + 1).size();
    // On a surface a cell twice as wide holds four of a full grid; hardly more than one where
    // points are farther apart than that.
    if (4 * before >= 7 * cells) break;
    before = cells;
  }
  return cell_log2;
}

}  // namespace slf
