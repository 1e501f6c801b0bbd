// SPDX-License-Identifier: Apache-2.0
#include "capture/mesh_sampling.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <unordered_set>

#include "base/shortest.h"
#include "capture/density.h"
#include "capture/mesh_triangles.h"

namespace slf {

namespace {

constexpr double kMostPoints = 1 << 24, kMostLines = 1 << 27;
constexpr double kOverlap = 0.88;    // of the largest component of a normal: its axis counts too
constexpr double kInclusive = 1e-7;  // voxels: edges belong to both of their triangles
constexpr std::size_t kSurveyed = 2000;  // triangles that tell the size of a pixel

/// The same in voxels from the centre of the first.
Corners on_grid(Corners corners, const Grid& grid) {
  for (Vec3& c : corners)
    for (std::size_t k = 0; k < 3; ++k) c[k] = (c[k] - grid.origin[k]) / grid.step;
  return corners;
}

struct WholeNumbers {
  double first, last;  // whole numbers, kInclusive beyond the ends
  double count() const { return std::max(last - first + 1, 0.0); }
};

WholeNumbers whole_numbers_in(double low, double high) {
  return {std::ceil(low - kInclusive), std::floor(high + kInclusive)};
}

WholeNumbers rows_of(const Corners& c, std::size_t up) {
  return whole_numbers_in(std::min({c[0][up], c[1][up], c[2][up]}),
                          std::max({c[0][up], c[1][up], c[2][up]}));
}

/// Where the line at height v meets a triangle's projection; empty if it does not.
WholeNumbers columns_of(const Corners& c, std::size_t across, std::size_t up, double v) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const auto add = [&](double u) {
    low = std::min(low, u);
    high = std::max(high, u);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = c[i], &b = c[(i + 1) % 3];
    const double bottom = std::min(a[up], b[up]), top = std::max(a[up], b[up]);
    if (v < bottom - kInclusive || v > top + kInclusive) continue;
    if (top - bottom < kInclusive) {
      add(a[across]);
      add(b[across]);
    } else {
      const double t = std::clamp((v - a[up]) / (b[up] - a[up]), 0.0, 1.0);
      add(a[across] + t * (b[across] - a[across]));
    }
  }
  return whole_numbers_in(low, high);
}

/// Barycentric weights of a point of the projection, none below 0.
std::optional<Vec3> weights_at(const Corners& c, std::size_t across, std::size_t up, double u,
                               double v) {
  Vec3 w{};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = c[(i + 1) % 3], &b = c[(i + 2) % 3];
    w[i] = (a[across] - u) * (b[up] - v) - (a[up] - v) * (b[across] - u);
    sum += w[i];
  }
  if (sum == 0) return std::nullopt;
  double kept = 0;
  for (double& weight : w) kept += weight = std::max(weight / sum, 0.0);
  for (double& weight : w) weight /= kept;  // kept >= 1: the weights sum to 1 before
  return w;
}

class Sampler {
 public:
  Sampler(const Mesh& mesh, const Grid& grid, const MeshWindow* window = nullptr)
      : mesh_(mesh), grid_(grid), window_(window) {}

  /// Refuses what would take too long before it begins.
  Result<Done, InputError> check_size() const {
    const double points = sampled_area(mesh_) / (grid_.step * grid_.step);
    double lines = 0;
    for (std::size_t f = 0; f < mesh_.triangles.size(); ++f) {
      const Corners c = on_grid(corners_of(mesh_, f), grid_);
      for (std::size_t k = 0; k < 3; ++k) lines += rows_of(c, k).count();
    }
    if (points <= kMostPoints && lines <= kMostLines) return Done{};
    return too_many();
  }

  Result<PointCloud, InputError> run() {
    for (const bool overlap : {false, true}) {
      if (window_ != nullptr) {
        for (const std::uint32_t f : window_->triangles) add_triangle(f, overlap);
      } else {
        for (std::size_t f = 0; f < mesh_.triangles.size(); ++f) add_triangle(f, overlap);
      }
    }
    if (double(cloud_.positions.size()) > kMostPoints) return too_many();
    return std::move(cloud_);
  }

 private:
  InputError too_many() const {
    return {Errc::kInvalidInput, "mesh: a voxel size of " + shortest(grid_.step) +
                                     " takes more points than the 2^24 accepted"};
  }

  /// Lines through the window, and one voxel around it: whether a voxel is free depends on all that
  /// lies in it, and floats may move a point over its border.
  WholeNumbers clipped(WholeNumbers range, std::size_t axis) const {
    if (window_ == nullptr) return range;
    return {std::max(range.first, double(window_->low[axis]) - 1),
            std::min(range.last, double(window_->high[axis]) + 1)};
  }

  void add_triangle(std::size_t f, bool overlap) {
    if (double(cloud_.positions.size()) > kMostPoints) return;  // run() says so
    const Corners corners = on_grid(corners_of(mesh_, f), grid_);
    const auto normal = normal_of(corners);
    if (!normal) return;
    std::size_t main = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if (std::abs((*normal)[k]) > std::abs((*normal)[main])) main = k;
    for (std::size_t k = 0; k < 3; ++k) {
      if ((k == main) == overlap) continue;
      if (std::abs((*normal)[k]) >= kOverlap * std::abs((*normal)[main]))
        add_crossings(f, corners, *normal, k, overlap);
    }
  }

  void add_crossings(std::size_t f, const Corners& c, const Vec3& normal, std::size_t axis,
                     bool if_free) {
    const std::size_t across = (axis + 1) % 3, up = (axis + 2) % 3;
    const WholeNumbers rows = clipped(rows_of(c, up), up);
    for (double v = rows.first; v <= rows.last; ++v) {
      const WholeNumbers columns = clipped(columns_of(c, across, up, v), across);
      for (double u = columns.first; u <= columns.last; ++u) {
        const auto weights = weights_at(c, across, up, u, v);
        if (!weights) continue;
        Vec3 at{};
        at[across] = u;
        at[up] = v;
        for (std::size_t i = 0; i < 3; ++i) at[axis] += (*weights)[i] * c[i][axis];
        const double depth = std::floor(at[axis] + 0.5);
        if (clipped({depth, depth}, axis).count() == 0) continue;
        if (taken_.insert(voxel_number(at)).second || !if_free) add_point(f, at, normal, *weights);
      }
    }
  }

  /// 21 bits an axis are what a grid has; beyond them numbers may meet, which costs a point.
  static std::uint64_t voxel_number(const Vec3& at) {
    std::uint64_t number = 0;
    for (const double x : at)
      number = number << 21 ^ static_cast<std::uint64_t>(std::max(std::floor(x + 0.5), 0.0));
    return number;
  }

  void add_point(std::size_t f, const Vec3& at, const Vec3& face, const Vec3& weights) {
    Vec3 world{};
    for (std::size_t k = 0; k < 3; ++k) world[k] = grid_.origin[k] + grid_.step * at[k];
    const std::array<float, 3> position = to_float(world);
    if (window_ != nullptr && !is_inside(voxel_at(position, grid_), *window_)) return;
    cloud_.positions.push_back(position);
    const PointCloud& vertices = mesh_.vertices;
    const auto mixed = [&](const auto& values) {
      Vec3 sum{};
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k)
          sum[k] += weights[i] * static_cast<double>(values[mesh_.triangles[f][i]][k]);
      return sum;
    };
    std::optional<Vec3> normal;
    if (!vertices.normals.empty()) normal = unit_vector(mixed(vertices.normals));
    cloud_.normals.push_back(to_float(normal.value_or(face)));
    if (vertices.colours.empty()) return;
    const Vec3 colour = mixed(vertices.colours);
    auto& stored = cloud_.colours.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      stored[k] = static_cast<std::uint8_t>(std::lround(std::clamp(colour[k], 0.0, 255.0)));
  }

  static bool is_inside(const Voxel& voxel, const MeshWindow& window) {
    for (std::size_t k = 0; k < 3; ++k)
      if (voxel[k] < window.low[k] || voxel[k] > window.high[k]) return false;
    return true;
  }

  const Mesh& mesh_;
  const Grid& grid_;
  const MeshWindow* window_;                 // or all
  std::unordered_set<std::uint64_t> taken_;  // asked, never iterated
  PointCloud cloud_;
};

}  // namespace

double automatic_step(const Mesh& mesh, double pixel) {
  return std::max(kPixelsPerVoxel * pixel,
                  std::sqrt(sampled_area(mesh) / double(kMostAutomaticPoints)));
}

Result<PointCloud, InputError> sample_mesh(const Mesh& mesh, const Grid& grid) {
  Sampler sampler(mesh, grid);
  SLF_CHECK(sampler.check_size());
  return sampler.run();
}

Result<PointCloud, InputError> sample_mesh_in(const Mesh& mesh, const Grid& grid,
                                              const MeshWindow& window) {
  return Sampler(mesh, grid, &window).run();
}

Result<PointCloud, InputError> sample_for_cameras(const Capture& capture, const Mesh& mesh) {
  const Box box = bounding_box(mesh);
  std::vector<int> all(capture.cameras.size());
  std::iota(all.begin(), all.end(), 0);
  const PointCloud centres = triangle_centres(mesh, kSurveyed);
  const double pixel = pixel_on_surface(capture, all, centres.positions, centres.normals);
  constexpr int kUnseenBits = 8;
  SLF_TRY(const Grid grid, choose_grid(box, mesh.triangles.size(), kUnseenBits,
                                       pixel > 0 ? automatic_step(mesh, pixel) : 0));
  return sample_mesh(mesh, grid);
}

}  // namespace slf
