#include "slf/render.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lightfield/colour.h"
#include "lightfield/render_splats.h"
#include "lightfield/surfel_cloud.h"
#include "slf/parallel.h"

namespace slf {
namespace {

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
    : maps_(maps),
      settings_(settings),
      surfels_(std::make_shared<const SurfelCloud>(
          surfel_cloud(maps.header().grid, maps.positions(), maps.normals(), settings.radius,
                       settings.threads))) {}

Rendering Renderer::render(const Camera& camera) const {
  const auto splats = project_surfels(*surfels_, camera, settings_.threads);
  const Vec3 eye = camera.centre();
  const ColourSource colours = [&](std::span<const std::uint32_t> points,
                                   std::span<std::array<float, 3>> out) {
    if (settings_.view_dependent) return maps_.radiances(eye, points, out);
    for (std::size_t i = 0; i < points.size(); ++i) out[i] = maps_.mean(points[i]);
  };
  return compose(rasterise(splats, camera.width, camera.height, settings_.threads, colours), camera,
                 settings_, maps_.header().transfer);
}

}  // namespace slf
