// SPDX-License-Identifier: Apache-2.0
#include "encoder/measure/evaluate_images.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "base/error_sum.h"
#include "base/stopwatch.h"
#include "capture/quantile.h"
#include "encoder/measure/align_camera.h"
#include "encoder/measure/picture_background.h"
#include "encoder/measure/ssim.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr int kErrorGain = 4;  // of an error map, about grey 128

/// Squared errors and similarity over the same pixels of one picture, or of several.
struct PictureSum {
  ErrorSum errors;
  SsimSum ssim;
  double ms_ssim = 0;
  std::uint64_t pictures = 0;  ///< that have such pixels

  void add_all(const PictureSum& other) {
    errors.add_all(other.errors);
    ssim.sum += other.ssim.sum;
    ssim.count += other.ssim.count;
    ms_ssim += other.ms_ssim;
    pictures += other.pictures;
  }
  PictureQuality quality() const {
    return {errors.psnr(), ssim.sum / double(std::max<std::uint64_t>(ssim.count, 1)),
            ms_ssim / double(std::max<std::uint64_t>(pictures, 1))};
  }
};

/// One picture, or several, pixels told apart by where they are.
struct PictureErrors {
  PictureSum inside, all;          ///< where both show the object; everywhere
  std::array<ErrorSum, 3> region;  ///< of inside, by PictureRegionId
  ErrorSum uncovered, outside;     ///< object pixels that are not drawn; no object pixels
  double seconds = 0;              ///< of one rendering
  double off = 0;                  ///< ImageQuality::off_pixels

  void add_all(const PictureErrors& other) {
    inside.add_all(other.inside);
    all.add_all(other.all);
    for (std::size_t r = 0; r < region.size(); ++r) region[r].add_all(other.region[r]);
    uncovered.add_all(other.uncovered);
    outside.add_all(other.outside);
  }
};

std::array<double, 3> difference(const Image& a, const Image& b, std::size_t pixel) {
  std::array<double, 3> error{};
  for (std::size_t k = 0; k < 3; ++k)
    error[k] = double(a.data[3 * pixel + k]) - double(b.data[3 * pixel + k]);
  return error;
}

/// Similarity of two lumas inside a mask.
void add_similarity(const std::vector<float>& a, const std::vector<float>& b,
                    const std::vector<std::uint8_t>& mask, const Image& picture, PictureSum& sum) {
  sum.ssim = ssim(a, b, mask, picture.width, picture.height);
  if (const auto similarity = ms_ssim(a, b, mask, picture.width, picture.height)) {
    sum.ms_ssim = *similarity;
    sum.pictures = 1;
  }
}

/// @param coverage  of the rendering, 0 .. 255: half or more is drawn
PictureErrors compare(const Image& photograph, const Image& rendering,
                      const std::vector<std::uint8_t>& coverage, const CapturedView& view) {
  PictureErrors result;
  const std::size_t pixels = coverage.size();
  std::vector<float> was(pixels), is(pixels);
  std::vector<std::uint8_t> both(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto error = difference(rendering, photograph, i);
    was[i] = static_cast<float>(luma(&photograph.data[3 * i]));
    is[i] = static_cast<float>(luma(&rendering.data[3 * i]));
    both[i] = view.object[i] && coverage[i] >= 128;
    result.all.errors.add(error);
    if (both[i]) {
      result.inside.errors.add(error);
      result.region[std::size_t(view.region[i])].add(error);
    } else {
      (view.object[i] ? result.uncovered : result.outside).add(error);
    }
  }
  add_similarity(was, is, both, photograph, result.inside);
  add_similarity(was, is, std::vector<std::uint8_t>(pixels, 1), photograph, result.all);
  return result;
}

/// Photograph, rendering and their difference, side by side.
Image error_map(const Image& photograph, const Image& rendering) {
  const auto width = static_cast<std::size_t>(photograph.width);
  Image map{3 * photograph.width, photograph.height, 3, {}};
  map.data.resize(3 * photograph.data.size());
  for (std::size_t i = 0; i < photograph.data.size() / 3; ++i) {
    const std::size_t row = i / width, column = i % width;
    std::uint8_t* at = &map.data[3 * (3 * width * row + column)];
    for (std::size_t k = 0; k < 3; ++k) {
      const int was = photograph.data[3 * i + k], is = rendering.data[3 * i + k];
      at[k] = static_cast<std::uint8_t>(was);
      at[3 * width + k] = static_cast<std::uint8_t>(is);
      at[6 * width + k] =
          static_cast<std::uint8_t>(std::clamp(128 + kErrorGain * (is - was), 0, 255));
    }
  }
  return map;
}

/// The rendering with R, G, B times what brings it nearest to the photograph.
Rendering with_exposure_of(const Image& photograph, Rendering over_black,
                           const std::vector<std::uint8_t>& object) {
  for (std::size_t k = 0; k < 3; ++k) {
    double products = 0, squares = 0;
    for (std::size_t i = 0; i < object.size(); ++i) {
      if (!object[i] || over_black.coverage[i] < 128) continue;
      const double drawn = over_black.image.data[3 * i + k];
      products += drawn * double(photograph.data[3 * i + k]);
      squares += drawn * drawn;
    }
    if (!(squares > 0)) continue;
    for (std::size_t i = 0; i < object.size(); ++i) {
      std::uint8_t& value = over_black.image.data[3 * i + k];
      value = std::uint8_t(std::lround(std::min(double(value) * products / squares, 255.0)));
    }
  }
  return over_black;
}

/// How far the picture lies off its photograph, pixels; 0 where it does not say.
/// @param photograph  over its background
/// @param align      the rendering, over black, becomes that of the camera that stands right
double off_pixels(const Image& photograph, const DrawPicture& draw, const Capture& capture,
                  Camera camera, const std::array<std::uint8_t, 3>& background, bool align,
                  Rendering& rendering) {
  constexpr int kAlignments = 3;  // each from the picture of the one before: later ones are small
  double off = 0;
  for (int i = 0; i < kAlignments; ++i) {
    const Alignment next =
        aligned(camera, photograph, over_background(rendering, background), rendering.coverage);
    if (i == 0) off = next.pixels;
    if (!align || !(next.pixels > 0)) break;
    camera = next.camera;
    rendering = draw(moved(camera, capture.origin));
  }
  return off;
}

/// `camera`'s photograph against what is drawn over black.
Result<PictureErrors, InputError> compare_camera(const DrawPicture& draw, const Capture& capture,
                                                 int camera_index, const CapturedSurface& surface,
                                                 const EvaluateSettings& settings) {
  SLF_TRY(const Image loaded, load_image(capture, camera_index));
  const auto index = static_cast<std::size_t>(camera_index);
  const Camera& camera = capture.cameras[index];
  Stopwatch watch;
  Rendering over_black = draw(moved(camera, capture.origin));
  const double seconds = watch.lap();
  const CapturedView view =
      captured_view(capture, surface, camera, loaded, settings.depth_tolerance);
  const bool has_mask = index < capture.mask_files.size() && !capture.mask_files[index].empty();
  const auto background = picture_background(loaded, view.object, has_mask);
  const Image photograph = over_background(loaded, background);
  const double off =
      off_pixels(photograph, draw, capture, camera, background, settings.align_cameras, over_black);
  if (settings.match_exposure)
    over_black = with_exposure_of(photograph, std::move(over_black), view.object);
  const Image rendering = over_background(over_black, background);
  PictureErrors errors = compare(photograph, rendering, over_black.coverage, view);
  errors.seconds = seconds;
  errors.off = off;
  if (settings.error_map)
    SLF_CHECK(settings.error_map(camera_index, error_map(photograph, rendering)));
  return errors;
}

/// 0 of nothing.
double share(double part, double whole) { return whole > 0 ? part / whole : 0; }

PictureRegion region_quality(const ErrorSum& part, const ErrorSum& inside) {
  return {part.psnr(), share(double(part.count), double(inside.count)),
          share(part.total(), inside.total())};
}

void set_image_quality(const PictureErrors& sum, ImageQuality& image) {
  const ErrorSum& inside = sum.inside.errors;
  static_cast<PictureQuality&>(image) = sum.inside.quality();
  image.all = sum.all.quality();
  image.coverage = share(double(inside.count), double(inside.count + sum.uncovered.count));
  image.uncovered_error_share =
      share(sum.uncovered.total(), inside.total() + sum.uncovered.total());
  image.outside_error_share = share(sum.outside.total(), sum.all.errors.total());
  image.grazing = region_quality(sum.region[std::size_t(PictureRegionId::kGrazing)], inside);
  image.rim = region_quality(sum.region[std::size_t(PictureRegionId::kRim)], inside);
  image.rest = region_quality(sum.region[std::size_t(PictureRegionId::kRest)], inside);
}

}  // namespace

Result<Done, InputError> evaluate_images(const DrawPicture& draw, const Capture& capture,
                                         std::span<const int> cameras,
                                         const CapturedSurface& surface,
                                         const EvaluateSettings& settings, const Progress& progress,
                                         Quality& quality) {
  std::vector<PictureErrors> each(cameras.size());
  std::vector<std::optional<InputError>> failures(cameras.size());
  parallel_ranges(
      cameras.size(), 1, settings.threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          auto errors = compare_camera(draw, capture, cameras[i], surface, settings);
          if (errors) {
            each[i] = *std::move(errors);
          } else {
            failures[i] = errors.error();
          }
        }
      },
      [&](std::size_t done) {
        if (progress) progress("images", double(done) / double(cameras.size()));
      });
  PictureErrors pooled;
  std::vector<double> seconds, off;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (failures[i]) return *failures[i];
    pooled.add_all(each[i]);
    seconds.push_back(each[i].seconds);
    off.push_back(each[i].off);
    quality.image.psnr_each.push_back(each[i].inside.errors.psnr());
  }
  set_image_quality(pooled, quality.image);
  quality.image.off_pixels = median(std::move(off));
  quality.render_seconds = median(std::move(seconds));
  return Done{};
}

}  // namespace slf
