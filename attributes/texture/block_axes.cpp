// SPDX-License-Identifier: Apache-2.0
#include "attributes/texture/block_axes.h"

#include <algorithm>
#include <bit>

#include "geometry/morton.h"

namespace slf {
namespace {

constexpr int kSweeps = 2;
constexpr std::int64_t kSide = 4;  // cells of a block along an axis

/// Sums over points of 1, d and d d^T (xx, yy, zz, yz, xz, xy), d from the corner of a block.
///
/// Over the 27 blocks around a block n <= 27 * 64 < 2^11 and -4 <= d <= 7, so |m| < 2^14,
/// s < 2^17, |n s - m m| < 2^28, and the products of two of these, and their difference, stay
/// below 2^57.
struct Moments {
  std::int64_t n = 0;
  std::array<std::int64_t, 3> m{};
  std::array<std::int64_t, 6> s{};

  void add(const std::array<std::int64_t, 3>& d) {
    ++n;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      m[a] += d[a];
      s[a] += d[a] * d[a];
      s[3 + a] += d[b] * d[c];
    }
  }

  /// Adds those of a block whose corner lies at t.
  void add(const Moments& o, const std::array<std::int64_t, 3>& t) {
    n += o.n;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      m[a] += o.m[a] + o.n * t[a];
      s[a] += o.s[a] + 2 * t[a] * o.m[a] + o.n * t[a] * t[a];
      s[3 + a] += o.s[3 + a] + t[b] * o.m[c] + t[c] * o.m[b] + o.n * t[b] * t[c];
    }
  }
};

/// Calls each(b, t) for the occupied blocks around block b, itself included, in the order of
/// directions; t is the corner's offset in cells.
template <class Each>
void for_each_around(const BlockGrid& grid, std::size_t block, Each each) {
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const auto d = static_cast<std::size_t>(direction_index(dx, dy, dz));
        if (const std::int32_t b = grid.neighbours(block)[d]; b >= 0)
          each(static_cast<std::size_t>(b),
               std::array<std::int64_t, 3>{dx * kSide, dy * kSide, dz * kSide});
      }
}

/// The eigenvector of least variance is the dominant one of the adjugate of the covariance; its
/// largest coordinate is where the adjugate's diagonal is largest.
std::uint8_t axis_of(const Moments& around) {
  std::array<std::int64_t, 6> cov;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
    cov[a] = around.n * around.s[a] - around.m[a] * around.m[a];
    cov[3 + a] = around.n * around.s[3 + a] - around.m[b] * around.m[c];
  }
  std::array<std::int64_t, 3> adjugate;
  for (std::size_t a = 0; a < 3; ++a)
    adjugate[a] = cov[(a + 1) % 3] * cov[(a + 2) % 3] - cov[3 + a] * cov[3 + a];
  return static_cast<std::uint8_t>(std::max_element(adjugate.begin(), adjugate.end()) -
                                   adjugate.begin());  // the first of equals
}

/// Every block takes the axis that most points around it have, all blocks at once.
void smooth(const BlockGrid& grid, std::vector<std::uint8_t>& axes) {
  const std::vector<std::uint8_t> before = axes;
  for (std::size_t b = 0; b < grid.size(); ++b) {
    std::array<int, 3> votes{};
    for_each_around(grid, b, [&](std::size_t at, const auto&) {
      votes[before[at]] += std::popcount(grid.block(at).cells);
    });
    const auto most =
        static_cast<std::size_t>(std::max_element(votes.begin(), votes.end()) - votes.begin());
    if (votes[most] > votes[before[b]]) axes[b] = static_cast<std::uint8_t>(most);
  }
}

}  // namespace

std::vector<std::uint8_t> block_axes(const BlockGrid& grid, std::span<const std::uint64_t> morton) {
  std::vector<Moments> own(grid.size());
  for (std::size_t i = 0; i < morton.size(); ++i) {
    const Voxel d = from_morton(morton[i] & 63);
    own[grid.block_of(i)].add({d[0], d[1], d[2]});
  }
  std::vector<std::uint8_t> axes(grid.size());
  for (std::size_t b = 0; b < grid.size(); ++b) {
    Moments around;
    for_each_around(grid, b, [&](std::size_t at, const auto& t) { around.add(own[at], t); });
    axes[b] = axis_of(around);
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) smooth(grid, axes);
  return axes;
}

}  // namespace slf
