// SPDX-License-Identifier: Apache-2.0
#include "encoder/judge_surface.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "base/error_sum.h"
#include "capture/object_mask.h"
#include "capture/object_outline.h"
#include "encoder/fit_capture.h"
#include "encoder/measure/picture_background.h"
#include "encoder/measure/ssim.h"
#include "encoder/measure/outlines.h"
#include "slf/parallel.h"
#include "slf/render.h"

namespace slf {
namespace {

constexpr int kEffort = 1;  // of the fit: degree 2, nothing searched

/// Over pixels of some photographs.
struct PixelSums {
  ErrorSum errors;
  double similarity = 0;

  void add_all(const PixelSums& other) {
    errors.add_all(other.errors);
    similarity += other.similarity;
  }
  double mean_similarity() const {
    return similarity / double(std::max<std::uint64_t>(errors.count, 1));
  }
};

struct PictureSums {
  PixelSums all, inside;
  std::size_t outlined = 0;  // photographs that tell the object's outline

  DrawnQuality quality(std::size_t photographs) const {
    DrawnQuality out{all.errors.psnr(), all.mean_similarity()};
    if (inside.errors.count == 0 || !are_outlined(outlined, photographs)) return out;
    out.inside_psnr = inside.errors.psnr();
    out.inside_ssim = inside.mean_similarity();
    return out;
  }
};

/// @param mask  pixels that count
PixelSums pixel_sums(const Image& photograph, const Image& picture,
                     std::span<const std::uint8_t> mask) {
  PixelSums sums;
  std::vector<float> was(mask.size()), is(mask.size());
  for (std::size_t i = 0; i < mask.size(); ++i) {
    was[i] = float(luma(&photograph.data[3 * i]));
    is[i] = float(luma(&picture.data[3 * i]));
    if (mask[i] == 0) continue;
    std::array<double, 3> error{};
    for (std::size_t c = 0; c < 3; ++c)
      error[c] = double(picture.data[3 * i + c]) - double(photograph.data[3 * i + c]);
    sums.errors.add(error);
  }
  sums.similarity = ssim(was, is, mask, picture.width, picture.height).sum;
  return sums;
}

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
  sums.all = pixel_sums(photograph, picture, std::vector<std::uint8_t>(pixels, 1));
  const std::vector<std::uint8_t> outline = object_outline(loaded);
  if (outline.empty()) return sums;
  sums.outlined = 1;
  sums.inside = pixel_sums(photograph, picture, outline);
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
    all.all.add_all(sums[i].all);
    all.inside.add_all(sums[i].inside);
    all.outlined += sums[i].outlined;
  }
  return all.quality(cameras.size());
}

}  // namespace slf
