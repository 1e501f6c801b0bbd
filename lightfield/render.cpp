#include "slf/render.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lightfield/colour.h"
#include "lightfield/octahedral.h"
#include "lightfield/render_splats.h"
#include "lightfield/render_surfels.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr float kMostShift = 0.6f;  // voxels; rounding moves a surface by no more than about half

/// Grey levels 0 .. 255 of linear light as display values, by table: within 0.1 level.
class DisplayCurve {
 public:
  DisplayCurve() : table_(kSteps + 1) {
    for (std::size_t i = 0; i <= kSteps; ++i)
      table_[i] = static_cast<float>(255 * linear_to_srgb(double(i) / kSteps));
  }
  float operator()(float linear) const {
    return table_[static_cast<std::size_t>(std::clamp(linear / 255, 0.0f, 1.0f) * kSteps + 0.5f)];
  }

 private:
  static constexpr std::size_t kSteps = 1 << 14;
  std::vector<float> table_;
};

/// Splats of all points that the camera can see, in point order.
std::vector<Splat> project_surfels(const ViewMaps& maps, const Camera& camera,
                                   const std::vector<std::array<float, 3>>& centres,
                                   const std::vector<std::array<float, 3>>& normals,
                                   const std::vector<float>& radii, int threads) {
  const Vec3& origin = maps.header().grid.origin;
  constexpr std::size_t kGrain = 4096;
  std::vector<std::vector<Splat>> parts((maps.num_points() + kGrain - 1) / kGrain);
  parallel_ranges(maps.num_points(), kGrain, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<Splat>& part = parts[begin / kGrain];
    part.reserve(end - begin);
    for (std::size_t p = begin; p < end; ++p) {
      const auto& c = centres[p];
      const auto& n = normals[p];
      const Disc disc{
          {origin[0] + c[0], origin[1] + c[1], origin[2] + c[2]}, {n[0], n[1], n[2]}, radii[p]};
      if (const auto splat = project_disc(camera, disc, static_cast<std::uint32_t>(p)))
        part.push_back(*splat);
    }
  });
  std::vector<Splat> splats;
  std::size_t count = 0;
  for (const auto& part : parts) count += part.size();
  splats.reserve(count);
  for (const auto& part : parts) splats.insert(splats.end(), part.begin(), part.end());
  return splats;
}

/// Colours over the background, 8 bit.
Rendering compose(SplatImage&& splatted, const Camera& camera, const RenderSettings& settings,
                  Transfer transfer) {
  static const DisplayCurve to_display;
  Rendering out;
  out.image.width = camera.width;
  out.image.height = camera.height;
  const std::size_t width = std::size_t(camera.width);
  out.image.data.resize(3 * splatted.coverage.size());
  out.coverage.resize(splatted.coverage.size());
  out.depth = std::move(splatted.depth);
  parallel_ranges(std::size_t(camera.height), 64, settings.threads,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin * width; i < end * width; ++i) {
                      const float cover = splatted.coverage[i];
                      out.coverage[i] = static_cast<std::uint8_t>(255 * cover + 0.5f);
                      for (std::size_t k = 0; k < 3; ++k) {
                        float c = splatted.colour[i][k];
                        if (transfer == Transfer::kLinear) c = to_display(c);
                        c = cover * c + (1 - cover) * settings.background[k];
                        out.image.data[3 * i + k] = static_cast<std::uint8_t>(c + 0.5f);
                      }
                    }
                  });
  return out;
}

}  // namespace

Renderer::Renderer(const ViewMaps& maps, const RenderSettings& settings)
    : maps_(maps), settings_(settings) {
  Surfels surfels = estimate_surfels(maps.positions(), settings.threads);
  normals_ = std::move(surfels.normals);
  radii_ = std::move(surfels.radii);
  const CodedNormals& coded = maps.normals();
  const bool has_coded = coded.bits > 0 && coded.octahedral.size() == maps.num_points();
  const auto step = static_cast<float>(maps.header().grid.step);
  centres_.resize(maps.num_points());
  for (std::size_t p = 0; p < maps.num_points(); ++p) {
    if (has_coded) {
      const auto n = dequantise_normal(coded.octahedral[p], coded.bits);
      normals_[p] = {float(n[0]), float(n[1]), float(n[2])};
    }
    radii_[p] = step * (settings.radius > 0 ? static_cast<float>(settings.radius) : radii_[p]);
    const auto& n = normals_[p];
    const auto& c = surfels.centroids[p];
    // Along the normal onto the neighbours' plane: takes the voxels' staircase away.
    const float shift =
        std::clamp(n[0] * c[0] + n[1] * c[1] + n[2] * c[2], -kMostShift, kMostShift);
    for (std::size_t k = 0; k < 3; ++k)
      centres_[p][k] = step * (static_cast<float>(maps.positions()[p][k]) + shift * n[k]);
  }
}

Rendering Renderer::render(const Camera& camera) const {
  const auto splats = project_surfels(maps_, camera, centres_, normals_, radii_, settings_.threads);
  const Vec3 eye = camera.centre();
  const auto colour = [&](std::uint32_t p) {
    if (!settings_.view_dependent) return maps_.mean(p);
    const Vec3 at = maps_.header().grid.world(maps_.positions()[p]);
    const auto [theta, gamma] = direction_of({eye[0] - at[0], eye[1] - at[1], eye[2] - at[2]});
    return maps_.radiance(p, theta, gamma);
  };
  return compose(rasterise(splats, camera.width, camera.height, settings_.threads, colour), camera,
                 settings_, maps_.header().transfer);
}

}  // namespace slf
