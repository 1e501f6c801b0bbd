#include "capture/mesh_sampling.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <unordered_set>

#include "capture/density.h"

namespace slf {

namespace {

constexpr double kMostPoints = 1 << 24, kMostLines = 1 << 27;
constexpr double kOverlap = 0.88;    // of the largest component of a normal: its axis counts too
constexpr double kInclusive = 1e-7;  // voxels: edges belong to both of their triangles
constexpr std::size_t kSurveyed = 2000;  // triangles that tell the size of a pixel
constexpr int kSurveyBits = 6;           // of the sample that tells inside from outside
constexpr std::size_t kSurveyCameras = 32;

using Corners = std::array<Vec3, 3>;

Vec3 to_double(const std::array<float, 3>& p) { return {double{p[0]}, double{p[1]}, double{p[2]}}; }

std::array<float, 3> to_float(const Vec3& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Unit; nothing for a vector without a direction.
std::optional<Vec3> direction_of(const Vec3& v) {
  const double length = std::sqrt(dot(v, v));
  if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
  return Vec3{v[0] / length, v[1] / length, v[2] / length};
}

std::optional<Vec3> normal_of(const Corners& c) {
  return direction_of(cross(minus(c[1], c[0]), minus(c[2], c[0])));
}

Corners corners_of(const Mesh& mesh, std::size_t triangle) {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i)
    corners[i] = to_double(mesh.vertices.positions[mesh.triangles[triangle][i]]);
  return corners;
}

/// The same in voxels from the centre of the first.
Corners on_grid(Corners corners, const Grid& grid) {
  for (Vec3& c : corners)
    for (std::size_t k = 0; k < 3; ++k) c[k] = (c[k] - grid.origin[k]) / grid.step;
  return corners;
}

struct Range {
  double first, last;  // whole numbers, kInclusive beyond the ends
  double count() const { return std::max(last - first + 1, 0.0); }
};

Range whole_numbers_in(double low, double high) {
  return {std::ceil(low - kInclusive), std::floor(high + kInclusive)};
}

Range rows_of(const Corners& c, std::size_t up) {
  return whole_numbers_in(std::min({c[0][up], c[1][up], c[2][up]}),
                          std::max({c[0][up], c[1][up], c[2][up]}));
}

/// Where the line at height v meets a triangle's projection; empty if it does not.
Range columns_of(const Corners& c, std::size_t across, std::size_t up, double v) {
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
  Sampler(const Mesh& mesh, const Grid& grid) : mesh_(mesh), grid_(grid) {}

  /// Refuses what would take too long before it begins.
  Result<Done, InputError> check_size() const {
    const double points = sampled_area(mesh_) / (grid_.step * grid_.step);
    double lines = 0;
    for (std::size_t f = 0; f < mesh_.triangles.size(); ++f) {
      const Corners c = on_grid(corners_of(mesh_, f), grid_);
      for (std::size_t k = 0; k < 3; ++k) lines += rows_of(c, k).count();
    }
    if (points <= kMostPoints && lines <= kMostLines) return Done{};
    return InputError{Errc::kInvalidInput, "mesh: a voxel size of " + std::to_string(grid_.step) +
                                               " takes more points than the 2^24 accepted"};
  }

  PointCloud run() {
    for (const bool overlap : {false, true})
      for (std::size_t f = 0; f < mesh_.triangles.size(); ++f) add_triangle(f, overlap);
    return std::move(cloud_);
  }

 private:
  void add_triangle(std::size_t f, bool overlap) {
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
    const Range rows = rows_of(c, up);
    for (double v = rows.first; v <= rows.last; ++v) {
      const Range columns = columns_of(c, across, up, v);
      for (double u = columns.first; u <= columns.last; ++u) {
        const auto weights = weights_at(c, across, up, u, v);
        if (!weights) continue;
        Vec3 at{};
        at[across] = u;
        at[up] = v;
        for (std::size_t i = 0; i < 3; ++i) at[axis] += (*weights)[i] * c[i][axis];
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
    cloud_.positions.push_back(to_float(world));
    const PointCloud& vertices = mesh_.vertices;
    const auto mixed = [&](const auto& values) {
      Vec3 sum{};
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k)
          sum[k] += weights[i] * static_cast<double>(values[mesh_.triangles[f][i]][k]);
      return sum;
    };
    std::optional<Vec3> normal;
    if (!vertices.normals.empty()) normal = direction_of(mixed(vertices.normals));
    cloud_.normals.push_back(to_float(normal.value_or(face)));
    if (vertices.colours.empty()) return;
    const Vec3 colour = mixed(vertices.colours);
    auto& stored = cloud_.colours.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      stored[k] = static_cast<std::uint8_t>(std::lround(std::clamp(colour[k], 0.0, 255.0)));
  }

  const Mesh& mesh_;
  const Grid& grid_;
  std::unordered_set<std::uint64_t> taken_;  // asked, never iterated
  PointCloud cloud_;
};

/// Of the points that a camera sees in front of all others: how many more face it than do not.
/// @param tolerance  depth behind the foremost that still counts as in front
std::ptrdiff_t facing_in_front(const Camera& camera, const PointCloud& points, double tolerance) {
  struct Seen {
    double u, v, depth;
    std::size_t point;
  };
  std::vector<Seen> seen;
  double u0 = camera.width, u1 = 0, v0 = camera.height, v1 = 0;
  for (std::size_t p = 0; p < points.positions.size(); ++p) {
    double depth = 0;
    const auto at = camera.project(to_double(points.positions[p]), &depth);
    if (!at || !((*at)[0] >= 0 && (*at)[1] >= 0) || (*at)[0] > camera.width ||
        (*at)[1] > camera.height)
      continue;
    seen.push_back({(*at)[0], (*at)[1], depth, p});
    u0 = std::min(u0, (*at)[0]);
    u1 = std::max(u1, (*at)[0]);
    v0 = std::min(v0, (*at)[1]);
    v1 = std::max(v1, (*at)[1]);
  }
  constexpr std::size_t kSide = 32;  // cells, each wider than the points are apart
  const double cell = std::max({u1 - u0, v1 - v0, 1e-9}) / (kSide - 1);
  std::vector<double> nearest(kSide * kSide, std::numeric_limits<double>::infinity());
  const auto cell_of = [&](const Seen& s) {
    return static_cast<std::size_t>((s.v - v0) / cell) * kSide +
           static_cast<std::size_t>((s.u - u0) / cell);
  };
  for (const Seen& s : seen) nearest[cell_of(s)] = std::min(nearest[cell_of(s)], s.depth);
  std::ptrdiff_t facing = 0;
  const Vec3 centre = camera.centre();
  for (const Seen& s : seen) {
    if (s.depth > nearest[cell_of(s)] + tolerance) continue;
    const double cosine = dot(minus(centre, to_double(points.positions[s.point])),
                              to_double(points.normals[s.point]));
    facing += (cosine > 0) - (cosine < 0);
  }
  return facing;
}

}  // namespace

Box bounding_box(const Mesh& mesh) {
  Box box;
  bool first = true;
  const auto add = [&](const std::array<float, 3>& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      box.min[k] = first ? double{p[k]} : std::min(box.min[k], double{p[k]});
      box.max[k] = first ? double{p[k]} : std::max(box.max[k], double{p[k]});
    }
    first = false;
  };
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle) add(mesh.vertices.positions[v]);
  if (mesh.triangles.empty())
    for (const auto& p : mesh.vertices.positions) add(p);
  return box;
}

double sampled_area(const Mesh& mesh) {
  double area = 0;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Corners c = corners_of(mesh, f);
    const Vec3 n = cross(minus(c[1], c[0]), minus(c[2], c[0]));
    area += std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])}) / 2;
  }
  return area;
}

double automatic_step(const Mesh& mesh, double pixel) {
  return std::max(kPixelsPerVoxel * pixel,
                  std::sqrt(sampled_area(mesh) / double(kMostAutomaticPoints)));
}

Result<PointCloud, InputError> sample_mesh(const Mesh& mesh, const Grid& grid) {
  Sampler sampler(mesh, grid);
  SLF_CHECK(sampler.check_size());
  return sampler.run();
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

PointCloud triangle_centres(const Mesh& mesh, std::size_t count) {
  PointCloud cloud;
  const std::size_t all = mesh.triangles.size();
  const std::size_t stride =
      std::max<std::size_t>((all + count - 1) / std::max<std::size_t>(count, 1), 1);
  for (std::size_t f = 0; f < all; f += stride) {
    const Corners c = corners_of(mesh, f);
    const auto normal = normal_of(c);
    if (!normal) continue;
    cloud.positions.push_back(
        to_float({(c[0][0] + c[1][0] + c[2][0]) / 3, (c[0][1] + c[1][1] + c[2][1]) / 3,
                  (c[0][2] + c[1][2] + c[2][2]) / 3}));
    cloud.normals.push_back(to_float(*normal));
  }
  return cloud;
}

bool turn_towards(const std::vector<Camera>& cameras, Mesh& mesh) {
  const auto grid = choose_grid(bounding_box(mesh), 1, kSurveyBits, 0);
  if (!grid) return false;
  const auto points = sample_mesh(mesh, *grid);
  if (!points) return false;
  std::ptrdiff_t facing = 0;
  const std::size_t chosen = std::min(cameras.size(), kSurveyCameras);
  for (std::size_t c = 0; c < chosen; ++c)
    facing += facing_in_front(cameras[c * cameras.size() / chosen], *points, 2 * grid->step);
  if (facing >= 0) return false;
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  for (auto& normal : mesh.vertices.normals)
    for (float& n : normal) n = -n;
  return true;
}

}  // namespace slf
