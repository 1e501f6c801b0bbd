#include "lightfield/render_surfels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>

#include "geometry/morton.h"
#include "lightfield/reference_kernel.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kMeanPerCell = 4;  // points; so that a window of a few cells has dozens
constexpr std::size_t kEnough = 12;      // neighbours for a normal
constexpr double kFirstWindow = 1.25;    // radius in cells
constexpr double kWindowGrowth = 1.6;
constexpr int kMostWindows = 4;      // the last reaches 5 cells; a point alone in there is alone
constexpr std::size_t kNearest = 6;  // neighbours that a disc should reach

/// Cubic cells of 2^k voxels, each a run of the points in Morton order.
class CellGrid {
 public:
  explicit CellGrid(std::span<const Voxel> positions) : positions_(positions) {
    std::vector<std::uint64_t> codes(positions.size());
    std::transform(positions.begin(), positions.end(), codes.begin(), morton);
    order_.resize(positions.size());
    std::iota(order_.begin(), order_.end(), 0u);
    if (!std::is_sorted(codes.begin(), codes.end()))
      std::stable_sort(order_.begin(), order_.end(),
                       [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
    while (cell_log2_ < 20 && count_cells(codes) * kMeanPerCell > positions.size()) ++cell_log2_;
    build_table(codes);
  }

  double cell_size() const { return static_cast<double>(std::int64_t{1} << cell_log2_); }

  /// visit(offset, squared distance) for the other points within `radius` of point p.
  template <class Visit>
  void visit_ball(std::size_t p, double radius, Visit&& visit) const {
    const Voxel& centre = positions_[p];
    const auto reach = static_cast<std::int32_t>(std::min(radius, 4e6));
    const double square = radius * radius;
    Voxel low, high;
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::max(0, centre[k] - reach) >> cell_log2_;
      high[k] = std::min((1 << 21) - 1, centre[k] + reach) >> cell_log2_;
    }
    for (std::int32_t z = low[2]; z <= high[2]; ++z)
      for (std::int32_t y = low[1]; y <= high[1]; ++y)
        for (std::int32_t x = low[0]; x <= high[0]; ++x) {
          const auto [begin, end] = run(morton({x, y, z}));
          for (std::uint32_t i = begin; i < end; ++i) {
            const Voxel& other = positions_[order_[i]];
            const std::array<double, 3> offset{double(other[0] - centre[0]),
                                               double(other[1] - centre[1]),
                                               double(other[2] - centre[2])};
            const double d2 = offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2];
            if (d2 <= square && d2 > 0) visit(offset, d2);
          }
        }
  }

 private:
  struct Cell {
    std::uint64_t code = ~std::uint64_t{0};
    std::uint32_t begin = 0, end = 0;
  };

  std::uint64_t cell_of(std::uint64_t code) const { return code >> 3 * cell_log2_; }

  std::size_t count_cells(const std::vector<std::uint64_t>& codes) const {
    std::size_t cells = 0;
    for (std::size_t i = 0; i < order_.size(); ++i)
      cells += i == 0 || cell_of(codes[order_[i]]) != cell_of(codes[order_[i - 1]]);
    return cells;
  }

  void build_table(const std::vector<std::uint64_t>& codes) {
    std::size_t size = 16;  // open addressing, at most half full
    while (size < 2 * count_cells(codes)) size *= 2;
    table_.resize(size);
    for (std::uint32_t i = 0, end; i < order_.size(); i = end) {
      const std::uint64_t code = cell_of(codes[order_[i]]);
      for (end = i + 1; end < order_.size() && cell_of(codes[order_[end]]) == code;) ++end;
      table_[slot_of(code)] = {code, i, end};
    }
  }

  std::size_t slot_of(std::uint64_t code) const {
    const std::size_t mask = table_.size() - 1;
    std::size_t slot = (code * 0x9E3779B97F4A7C15u >> 32) & mask;
    while (table_[slot].code != code && table_[slot].code != ~std::uint64_t{0})
      slot = (slot + 1) & mask;
    return slot;
  }

  std::array<std::uint32_t, 2> run(std::uint64_t code) const {
    const Cell& cell = table_[slot_of(code)];
    return {cell.begin, cell.end};  // an empty slot is an empty run
  }

  std::span<const Voxel> positions_;
  std::vector<std::uint32_t> order_;  // Morton order
  std::vector<Cell> table_;
  int cell_log2_ = 1;
};

/// What is around one point.
struct Neighbourhood {
  std::size_t count = 0;
  std::array<double, 3> sum{};
  std::array<double, 6> products{};      // xx, yy, zz, xy, xz, yz
  std::array<double, kNearest> nearest;  // squared distances, ascending

  Neighbourhood() { nearest.fill(INFINITY); }

  void add(const std::array<double, 3>& d, double d2) {
    ++count;
    for (std::size_t k = 0; k < 3; ++k) {
      sum[k] += d[k];
      products[k] += d[k] * d[k];
    }
    products[3] += d[0] * d[1];
    products[4] += d[0] * d[2];
    products[5] += d[1] * d[2];
    if (d2 >= nearest.back()) return;
    std::size_t at = kNearest - 1;
    for (; at > 0 && nearest[at - 1] > d2; --at) nearest[at] = nearest[at - 1];
    nearest[at] = d2;
  }
};

std::array<double, 3> cross(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

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
  const CellGrid grid(positions);
  parallel_ranges(positions.size(), 1024, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      double window = kFirstWindow * grid.cell_size();
      Neighbourhood around;
      for (int i = 0; i < kMostWindows; ++i, window *= kWindowGrowth) {
        around = Neighbourhood();
        grid.visit_ball(p, window, [&](const auto& offset, double d2) { around.add(offset, d2); });
        if (around.count >= kEnough || i + 1 == kMostWindows) break;
      }
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
