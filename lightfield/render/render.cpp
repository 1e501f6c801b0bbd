// SPDX-License-Identifier: Apache-2.0
#include "slf/render.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lightfield/colour.h"
#include "lightfield/render/empty_rendering.h"
#include "lightfield/render/render_splats.h"
#include "lightfield/render/surfel_cloud.h"

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

/// Rows over the background, 8 bit.
void compose(const SplatImage& rows, std::size_t first_pixel, const RenderSettings& settings,
             Transfer transfer, Rendering& out) {
  static const DisplayCurve to_display;
  std::copy(rows.depth.begin(), rows.depth.end(),
            out.depth.begin() + static_cast<std::ptrdiff_t>(first_pixel));
  std::uint8_t* sample = out.image.data.data() + 3 * first_pixel;
  for (std::size_t i = 0; i < rows.coverage.size(); ++i, sample += 3) {
    const float cover = rows.coverage[i];
    if (!(cover > 0)) {
      std::copy(settings.background.begin(), settings.background.end(), sample);
      continue;
    }
    out.coverage[first_pixel + i] = static_cast<std::uint8_t>(255 * cover + 0.5f);
    for (std::size_t k = 0; k < 3; ++k) {
      float c = rows.colour[i][k];
      if (transfer == Transfer::kLinear) c = to_display(c);
      c = cover * c + (1 - cover) * settings.background[k];
      sample[k] = static_cast<std::uint8_t>(c + 0.5f);
    }
  }
}

}  // namespace

Renderer::Renderer(const ViewMaps& maps, const RenderSettings& settings)
    : maps_(maps),
      settings_(settings),
      surfels_(std::make_shared<const SurfelCloud>(
          maps.header().grid.fits_floats()
              ? surfel_cloud(maps.header().grid, maps.positions(), maps.normals(), settings.radius,
                             settings.threads)
              : SurfelCloud{})) {}

Rendering Renderer::render(const Camera& camera, const std::atomic<bool>* ended) const {
  const auto splats = project_surfels(*surfels_, camera, settings_.threads, ended);
  const Vec3 eye = camera.centre();
  const ColourSource colours = [&](std::span<const std::uint32_t> points,
                                   std::span<std::array<float, 3>> out) {
    if (settings_.view_dependent) return maps_.radiances(eye, points, out);
    for (std::size_t i = 0; i < points.size(); ++i) out[i] = maps_.mean(points[i]);
  };
  Rendering out = empty_rendering(camera, ended);
  rasterise(
      splats, camera.width, camera.height, settings_.threads, colours,
      [&](std::size_t first_pixel, const SplatImage& rows) {
        compose(rows, first_pixel, settings_, maps_.header().transfer, out);
      },
      ended);
  return out;
}

}  // namespace slf
