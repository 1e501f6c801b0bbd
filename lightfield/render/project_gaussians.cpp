// SPDX-License-Identifier: Apache-2.0
// Splats to ellipses of the picture, with the colours that the eye sees, sorted by depth.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "base/multiversion.h"
#include "base/vec3.h"
#include "lightfield/harmonics.h"
#include "lightfield/render/gaussian_cloud.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kSplatsPerRange = 4096;
constexpr float kBrightest = 65504;  // so that what is not sensible stays a number

/// The camera in the numbers that every splat asks for.
struct Projection {
  const Camera& camera;
  double nearest, limit_x, limit_y;
  bool distorted;
};

Projection projection_of(const Camera& camera, double nearest) {
  return {camera, nearest, GaussianKernel::frustum_share * camera.width / (2 * camera.fx),
          GaussianKernel::frustum_share * camera.height / (2 * camera.fy),
          camera.distortion != std::array<double, 4>{0, 0, 0, 0}};
}

/// Rows of the derivative of the projection in world axes, at a point of camera axes.
std::array<std::array<float, 3>, 2> derivative(const Projection& from, const Vec3& at) {
  const double z = 1 / at[2];
  const auto& r = from.camera.rotation;
  const double fx = from.camera.fx * z, fy = from.camera.fy * z;
  const double x = std::clamp(at[0] * z, -from.limit_x, from.limit_x);
  const double y = std::clamp(at[1] * z, -from.limit_y, from.limit_y);
  std::array<std::array<float, 3>, 2> rows;
  for (std::size_t k = 0; k < 3; ++k) {
    rows[0][k] = static_cast<float>(fx * (r[0][k] - x * r[2][k]));
    rows[1][k] = static_cast<float>(fy * (r[1][k] - y * r[2][k]));
  }
  return rows;
}

/// a^T M b of a symmetric matrix.
float form(const std::array<float, 6>& m, const std::array<float, 3>& a,
           const std::array<float, 3>& b) {
  return a[0] * (m[0] * b[0] + m[1] * b[1] + m[2] * b[2]) +
         a[1] * (m[1] * b[0] + m[3] * b[1] + m[4] * b[2]) +
         a[2] * (m[2] * b[0] + m[4] * b[1] + m[5] * b[2]);
}

/// All but the colour. False where nothing of it can show.
bool project_gaussian(const Projection& from, const GaussianShape& shape, const Vec3& world,
                      ProjectedGaussian& out) {
  if (!(shape.reach > 0)) return false;
  const Vec3 at = from.camera.in_camera(world);
  if (!(at[2] > from.nearest)) return false;
  std::array<double, 2> image{from.camera.fx * at[0] / at[2] + from.camera.cx,
                              from.camera.fy * at[1] / at[2] + from.camera.cy};
  if (from.distorted) {
    const auto bent = from.camera.project(world);
    if (!bent) return false;
    image = *bent;
  }
  const auto [ju, jv] = derivative(from, at);
  const float uu = form(shape.covariance, ju, ju) + GaussianKernel::filter;
  const float uv = form(shape.covariance, ju, jv);
  const float vv = form(shape.covariance, jv, jv) + GaussianKernel::filter;
  const float inverse = 1 / (uu * vv - uv * uv);
  if (!(inverse > 0 && inverse < INFINITY)) return false;
  out.u = static_cast<float>(image[0]);
  out.v = static_cast<float>(image[1]);
  out.half_width = std::sqrt(shape.reach * uu);
  out.half_height = std::sqrt(shape.reach * vv);
  if (!(out.u + out.half_width > 0 && out.u - out.half_width < float(from.camera.width) &&
        out.v + out.half_height > 0 && out.v - out.half_height < float(from.camera.height)))
    return false;
  out.a = vv * inverse;
  out.b = -uv * inverse;
  out.c = uu * inverse;
  out.opacity = shape.opacity;
  out.reach = shape.reach;
  out.depth = static_cast<float>(at[2]);
  return out.half_width < INFINITY && out.half_height < INFINITY;
}

/// Colours of splats by their harmonics, eight directions at a time.
class Colouring {
 public:
  Colouring(const Gaussians& gaussians, const Vec3& eye, bool view_dependent)
      : gaussians_(gaussians),
        eye_(eye),
        harmonics_(view_dependent ? gaussians.degree : 0),
        rows_(std::size_t(harmonics_.size())) {}

  /// @param splats  indices of those in `out`, which receives their colours
  void colour(std::span<const std::uint32_t> splats, ProjectedGaussian* out) {
    for (std::size_t first = 0; first < splats.size(); first += Harmonics::kLanes) {
      const auto group = splats.subspan(first, std::min(Harmonics::kLanes, splats.size() - first));
      std::array<std::array<float, Harmonics::kLanes>, 3> directions{};
      for (std::size_t i = 0; i < group.size(); ++i) {
        const Vec3 d = minus(to_double(gaussians_.positions[group[i]]), eye_);
        const double scale = 1 / std::sqrt(std::max(dot(d, d), 1e-300));
        for (std::size_t k = 0; k < 3; ++k) directions[k][i] = static_cast<float>(scale * d[k]);
      }
      harmonics_.evaluate(directions, rows_.data());
      for (std::size_t i = 0; i < group.size(); ++i) sum(group[i], i, out[first + i]);
    }
  }

 private:
  void sum(std::uint32_t splat, std::size_t lane, ProjectedGaussian& out) const {
    constexpr auto kScale = static_cast<float>(std::numbers::inv_sqrtpi / 2);  // to orthonormal
    const float* coefficient = &gaussians_.harmonics[3 * gaussians_.num_harmonics() * splat];
    std::array<float, 3> rgb{};
    for (std::size_t k = 0; k < rows_.size(); ++k, coefficient += 3)
      for (std::size_t c = 0; c < 3; ++c) rgb[c] += rows_[k][lane] * coefficient[c];
    for (float& value : rgb) {
      value = 0.5f + kScale * value;
      value = value > 0 ? std::min(value, kBrightest) : 0;  // 0 of NaN
    }
    out.red = rgb[0];
    out.green = rgb[1];
    out.blue = rgb[2];
  }

  const Gaussians& gaussians_;
  Vec3 eye_;
  Harmonics harmonics_;
  std::vector<std::array<float, Harmonics::kLanes>> rows_;
};

struct DepthKey {
  std::uint32_t depth, index;  // bits of a positive float are in its order
};

/// Stable, by eleven bits at a time.
void sort_by_depth(std::vector<DepthKey>& keys) {
  constexpr int kBits = 11;
  constexpr std::size_t kBuckets = std::size_t{1} << kBits;
  std::vector<DepthKey> other(keys.size());
  for (int shift = 0; shift < 32; shift += kBits) {
    std::vector<std::size_t> begin(kBuckets + 1);
    for (const DepthKey& key : keys) ++begin[(key.depth >> shift) % kBuckets + 1];
    for (std::size_t i = 1; i < kBuckets; ++i) begin[i] += begin[i - 1];
    for (const DepthKey& key : keys) other[begin[(key.depth >> shift) % kBuckets]++] = key;
    keys.swap(other);
  }
}

/// In the order of depth.
std::vector<ProjectedGaussian> sorted_by_depth(
    const std::vector<std::vector<ProjectedGaussian>>& parts, int threads) {
  std::vector<const ProjectedGaussian*> all;
  std::vector<DepthKey> keys;
  for (const auto& part : parts)
    for (const ProjectedGaussian& splat : part) {
      keys.push_back(
          {std::bit_cast<std::uint32_t>(splat.depth), static_cast<std::uint32_t>(all.size())});
      all.push_back(&splat);
    }
  sort_by_depth(keys);
  std::vector<ProjectedGaussian> out(keys.size());
  parallel_ranges(out.size(), kSplatsPerRange, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) out[i] = *all[keys[i].index];
  });
  return out;
}

}  // namespace

std::vector<ProjectedGaussian> project_gaussians(const Gaussians& gaussians,
                                                 const GaussianCloud& cloud, const Camera& camera,
                                                 bool view_dependent, int threads) {
  const Projection projection = projection_of(camera, cloud.nearest);
  const Vec3 eye = camera.centre();
  std::vector<std::vector<ProjectedGaussian>> parts((gaussians.size() + kSplatsPerRange - 1) /
                                                    kSplatsPerRange);
  parallel_ranges(gaussians.size(), kSplatsPerRange, threads,
                  [&](std::size_t begin, std::size_t end) {
                    auto& own = parts[begin / kSplatsPerRange];
                    std::vector<std::uint32_t> indices;
                    ProjectedGaussian splat{};
                    for (std::size_t p = begin; p < end; ++p)
                      if (project_gaussian(projection, cloud.shapes[p],
                                           to_double(gaussians.positions[p]), splat)) {
                        own.push_back(splat);
                        indices.push_back(static_cast<std::uint32_t>(p));
                      }
                    Colouring(gaussians, eye, view_dependent).colour(indices, own.data());
                  });
  return sorted_by_depth(parts, threads);
}

}  // namespace slf
