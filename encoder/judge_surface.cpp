// SPDX-License-Identifier: Apache-2.0
#include "encoder/judge_surface.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "base/error_sum.h"
#include "capture/object_mask.h"
#include "encoder/fit_capture.h"
#include "encoder/measure/picture_background.h"
#include "encoder/measure/ssim.h"
#include "slf/parallel.h"
#include "slf/render.h"

namespace slf {
namespace {

constexpr int kEffort = 1;  // of the fit: degree 2, nothing searched

/// Of some photographs.
struct PictureSums {
  ErrorSum errors;
  double similarity = 0;  // sum over pixels

  DrawnQuality quality() const {
    return {errors.psnr(), similarity / double(std::max<std::uint64_t>(errors.count, 1))};
  }
};

Result<PictureSums, InputError> photograph_sums(
    const Capture& capture, int index, const std::function<Rendering(const Camera&)>& draw) {
  SLF_TRY(const Image loaded, load_image(capture, index));
  const auto camera = std::size_t(index);
  const Rendering drawn = draw(capture.cameras[camera]);
  const bool has_mask = camera < capture.mask_files.size() && !capture.mask_files[camera].empty();
  const std::size_t pixels = drawn.coverage.size();
  std::vector<std::uint8_t> object(pixels);
  for (std::size_t i = 0; i < pixels; ++i)
    object[i] = loaded.channels == 4 ? shows_object(loaded.data[4 * i + 3]) : drawn.coverage[i] > 0;
  const auto background = picture_background(loaded, object, has_mask);
  const Image photograph = over_background(loaded, background);
  const Image picture = over_background(drawn, background);
  PictureSums sums;
  std::vector<float> was(pixels), is(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    std::array<double, 3> error{};
    for (std::size_t c = 0; c < 3; ++c)
      error[c] = double(picture.data[3 * i + c]) - double(photograph.data[3 * i + c]);
    sums.errors.add(error);
    was[i] = float(luma(&photograph.data[3 * i]));
    is[i] = float(luma(&picture.data[3 * i]));
  }
  const std::vector<std::uint8_t> all(pixels, 1);
  sums.similarity = ssim(was, is, all, picture.width, picture.height).sum;
  return sums;
}

}  // namespace

Result<DrawnQuality, InputError> quick_quality(const Capture& capture, std::span<const int> fitted,
                                               std::span<const int> held_out,
                                               const VoxelCloud& cloud, int threads) {
  EncoderSettings settings = settings_of(Preset::kDefault, kEffort);
  settings.threads = settings.fit.threads = settings.observe.threads = threads;
  settings.fit.pictures.rounds = 0;
  settings.check_cameras = false;
  SLF_TRY(CaptureFit fit, fit_capture(capture, fitted, cloud, settings, {}));
  settings.fit = fit.chosen.settings;
  return surface_quality(capture, held_out,
                         quantise_grid(cloud, std::move(fit), capture.origin, capture.up, settings),
                         threads);
}

Result<DrawnQuality, InputError> surface_quality(const Capture& capture,
                                                 std::span<const int> cameras,
                                                 const LightField& field, int threads) {
  const ViewMaps maps(field);
  RenderSettings rendering;
  rendering.background = {0, 0, 0};
  rendering.threads = 1;
  const Renderer renderer(maps, rendering);
  return pictures_quality(
      capture, cameras,
      [&](const Camera& camera) { return renderer.render(moved(camera, capture.origin)); },
      threads);
}

Result<DrawnQuality, InputError> pictures_quality(
    const Capture& capture, std::span<const int> cameras,
    const std::function<Rendering(const Camera&)>& draw, int threads) {
  std::vector<PictureSums> sums(cameras.size());
  std::vector<std::optional<InputError>> failures(cameras.size());
  parallel_ranges(cameras.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      auto sum = photograph_sums(capture, cameras[i], draw);
      if (sum)
        sums[i] = *sum;
      else
        failures[i] = sum.error();
    }
  });
  PictureSums all;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (failures[i]) return *failures[i];
    all.errors.add_all(sums[i].errors);
    all.similarity += sums[i].similarity;
  }
  return all.quality();
}

}  // namespace slf
