// SPDX-License-Identifier: Apache-2.0
#include "encoder/measure/captured_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "capture/object_mask.h"
#include "capture/spacing.h"
#include "encoder/fit/observe_camera.h"
#include "lightfield/render/render_splats.h"

namespace slf {
namespace {

constexpr double kGrazingDegrees = 10;

/// The capture's points as discs, with their normals for colours.
SplatImage splat_surface(const Capture& capture, const CapturedSurface& surface,
                         const Camera& camera) {
  std::vector<Splat> splats;
  for (std::size_t p = 0; p < capture.cloud.positions.size(); ++p) {
    const auto& at = capture.cloud.positions[p];
    const auto& n = surface.normals[p];
    const Disc disc{{at[0], at[1], at[2]}, {n[0], n[1], n[2]}, surface.spacing};
    if (const auto splat = project_disc(camera, disc, static_cast<std::uint32_t>(p)))
      splats.push_back(*splat);
  }
  return rasterise(splats, camera.width, camera.height, 1,
                   [&](std::uint32_t p) { return surface.normals[p]; });
}

/// Cosine between a surface and the ray of a pixel's centre, distortion neglected; 0 where the
/// surface faces away, 1 where there is none.
double ray_cosine(const Camera& camera, double x, double y, const std::array<float, 3>& normal) {
  const Vec3 ray{(x + 0.5 - camera.cx) / camera.fx, (y + 0.5 - camera.cy) / camera.fy, 1};
  double along = 0, ray_squared = 0, normal_squared = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    double n = 0;  // of the normal in camera axes
    for (std::size_t a = 0; a < 3; ++a) n += camera.rotation[k][a] * static_cast<double>(normal[a]);
    along -= n * ray[k];
    ray_squared += ray[k] * ray[k];
    normal_squared += n * n;
  }
  if (!(normal_squared > 0)) return 1;
  return std::max(along / std::sqrt(ray_squared * normal_squared), 0.0);
}

/// Whether a silhouette or a step in depth is between two neighbouring pixels.
class Edges {
 public:
  Edges(const std::vector<std::uint8_t>& object, const SplatImage& surface,
        const std::vector<double>& cosine, const Camera& camera, double spacing, double tolerance)
      : object_(object),
        surface_(surface),
        cosine_(cosine),
        spacing_(spacing),
        focal_(std::max(camera.fx, camera.fy)),
        tolerance_(tolerance) {}

  bool between(std::size_t i, std::size_t j) const {
    if (object_[i] != object_[j]) return true;
    if (!object_[i]) return false;
    const double a = static_cast<double>(surface_.depth[i]);
    const double b = static_cast<double>(surface_.depth[j]);
    if (!std::isfinite(a) || !std::isfinite(b)) return std::isfinite(a) != std::isfinite(b);
    const double reach = std::max(spacing_, std::min(a, b) / focal_);
    return std::abs(a - b) >
           tolerance_ * reach / std::max({cosine_[i], cosine_[j], least_cosine(kGrazingDegrees)});
  }

 private:
  const std::vector<std::uint8_t>& object_;
  const SplatImage& surface_;
  const std::vector<double>& cosine_;
  double spacing_, focal_, tolerance_;
};

/// Pixels within 2 of an edge: those on both sides of it, and their neighbours.
std::vector<std::uint8_t> rim(const Edges& edges, int width, int height) {
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  std::vector<std::uint8_t> at_edge(columns * rows), out(columns * rows);
  for (std::size_t y = 0; y < rows; ++y)
    for (std::size_t x = 0; x < columns; ++x) {
      const std::size_t i = y * columns + x;
      if (x + 1 < columns && edges.between(i, i + 1)) at_edge[i] = at_edge[i + 1] = 1;
      if (y + 1 < rows && edges.between(i, i + columns)) at_edge[i] = at_edge[i + columns] = 1;
    }
  for (std::size_t y = 0; y < rows; ++y)
    for (std::size_t x = 0; x < columns; ++x) {
      if (!at_edge[y * columns + x]) continue;
      for (std::size_t v = y - (y > 0); v < std::min(y + 2, rows); ++v)
        for (std::size_t u = x - (x > 0); u < std::min(x + 2, columns); ++u)
          out[v * columns + u] = 1;
    }
  return out;
}

}  // namespace

CapturedSurface captured_surface(const Capture& capture, int threads) {
  CapturedSurface surface;
  surface.spacing = typical_spacing(capture.cloud.positions);
  surface.normals = capture.cloud.normals;
  if (!surface.normals.empty()) return surface;
  std::vector<Vec3> viewpoints;
  for (const Camera& camera : capture.cameras) viewpoints.push_back(camera.centre());
  surface.normals = estimate_normals(capture.cloud, viewpoints, 16, threads);
  return surface;
}

CapturedView captured_view(const Capture& capture, const CapturedSurface& surface,
                           const Camera& camera, const Image& photograph, double depth_tolerance) {
  const SplatImage seen = splat_surface(capture, surface, camera);
  const std::size_t pixels = seen.coverage.size();
  CapturedView view;
  view.object.resize(pixels);
  view.region.assign(pixels, PictureRegionId::kRest);
  std::vector<double> cosine(pixels);
  const auto columns = static_cast<std::size_t>(camera.width);
  for (std::size_t i = 0; i < pixels; ++i) {
    view.object[i] = photograph.channels == 4 ? shows_object(photograph.data[4 * i + 3])
                                              : seen.coverage[i] >= 0.5f;
    const std::size_t row = i / columns;
    cosine[i] = ray_cosine(camera, double(i % columns), double(row), seen.colour[i]);
    if (cosine[i] < least_cosine(kGrazingDegrees)) view.region[i] = PictureRegionId::kGrazing;
  }
  const auto near_edge =
      rim(Edges(view.object, seen, cosine, camera, surface.spacing, depth_tolerance), camera.width,
          camera.height);
  for (std::size_t i = 0; i < pixels; ++i)
    if (near_edge[i] && view.region[i] == PictureRegionId::kRest)
      view.region[i] = PictureRegionId::kRim;
  return view;
}

}  // namespace slf
