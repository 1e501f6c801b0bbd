// SPDX-License-Identifier: Apache-2.0
#include "encoder/judge_surface.h"

#include <optional>
#include <vector>

#include "base/error_sum.h"
#include "capture/object_mask.h"
#include "encoder/fit_capture.h"
#include "encoder/measure/picture_background.h"
#include "slf/parallel.h"
#include "slf/render.h"

namespace slf {
namespace {

constexpr int kEffort = 1;  // of the fit: degree 2, nothing searched

/// Squared errors of one photograph.
Result<ErrorSum, InputError> photograph_error(const Capture& capture, int index,
                                              const std::function<Rendering(const Camera&)>& draw) {
  SLF_TRY(const Image loaded, load_image(capture, index));
  const auto camera = std::size_t(index);
  const Rendering drawn = draw(capture.cameras[camera]);
  const bool has_mask = camera < capture.mask_files.size() && !capture.mask_files[camera].empty();
  std::vector<std::uint8_t> object(drawn.coverage.size());
  for (std::size_t i = 0; i < object.size(); ++i)
    object[i] = loaded.channels == 4 ? shows_object(loaded.data[4 * i + 3]) : drawn.coverage[i] > 0;
  const auto background = picture_background(loaded, object, has_mask);
  const Image photograph = over_background(loaded, background);
  const Image picture = over_background(drawn, background);
  ErrorSum sum;
  for (std::size_t i = 0; i < object.size(); ++i) {
    std::array<double, 3> error{};
    for (std::size_t c = 0; c < 3; ++c)
      error[c] = double(picture.data[3 * i + c]) - double(photograph.data[3 * i + c]);
    sum.add(error);
  }
  return sum;
}

}  // namespace

Result<double, InputError> surface_psnr(const Capture& capture, std::span<const int> fitted,
                                        std::span<const int> held_out, const VoxelCloud& cloud,
                                        int threads) {
  EncoderSettings settings = settings_of(Preset::kDefault, kEffort);
  settings.threads = settings.fit.threads = settings.observe.threads = threads;
  settings.fit.pictures.rounds = 0;
  settings.check_cameras = false;
  SLF_TRY(CaptureFit fit, fit_capture(capture, fitted, cloud, settings, {}));
  settings.fit = fit.chosen.settings;
  const LightField field =
      quantise_grid(cloud, std::move(fit), capture.origin, capture.up, settings);
  const ViewMaps maps(field);
  RenderSettings rendering;
  rendering.background = {0, 0, 0};
  rendering.threads = 1;
  const Renderer renderer(maps, rendering);
  return pictures_psnr(
      capture, held_out,
      [&](const Camera& camera) { return renderer.render(moved(camera, capture.origin)); },
      threads);
}

Result<double, InputError> pictures_psnr(const Capture& capture, std::span<const int> cameras,
                                         const std::function<Rendering(const Camera&)>& draw,
                                         int threads) {
  std::vector<ErrorSum> sums(cameras.size());
  std::vector<std::optional<InputError>> failures(cameras.size());
  parallel_ranges(cameras.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      auto sum = photograph_error(capture, cameras[i], draw);
      if (sum)
        sums[i] = *sum;
      else
        failures[i] = sum.error();
    }
  });
  ErrorSum all;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (failures[i]) return *failures[i];
    all.add_all(sums[i]);
  }
  return all.psnr();
}

}  // namespace slf
