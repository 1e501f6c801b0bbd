// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/train_gaussians.h"

#include <algorithm>
#include <cmath>

#include "encoder/measure/outlines.h"
#include "encoder/train/camera_twists.h"
#include "encoder/train/empty_pixels.h"
#include "encoder/train/far_surfels.h"
#include "encoder/train/tile_pixels.h"
#include "encoder/train/train_surfels.h"
#include "encoder/train/training_start.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr float kThickness = 1e-2f;     // of the lesser deviation: pictures see none
constexpr float kSquared = 0.5f;        // of a loss of magnitudes highlights are outliers
constexpr float kFaint = 0.1f;          // while splats grow: docs/decisions/045
constexpr double kReplaced = 0.03;      // docs/decisions/073
constexpr double kCoarseShare = 0.5;    // of the iterations: docs/decisions/069
constexpr float kHarmonicRate = 3e-3f;  // docs/decisions/070
constexpr float kSparsity = 0.65f;      // over the root of the number of photographs
constexpr std::size_t kJudgedPerRange = 64;
// Photographed pixels that a splat needs: with fewer it learns their noise. docs/decisions/048
constexpr double kPixelsOfSplat = 100;
constexpr std::size_t kFarShare = 6;  // at first one in so many may be for what is far away

/// Pixels of the views that show the object, or all where nothing tells it from its background.
double pixels_shown(const std::vector<Outline>& outlines, std::span<const TrainingView> views) {
  double shown = 0, whole = 0, pixels = 0;
  for (const TrainingView& view : views) pixels += double(view.picture.pixels());
  for (const Outline& outline : outlines) {
    shown += double(std::count(outline.object.begin(), outline.object.end(), true));
    whole += double(outline.object.size());
  }
  return whole > 0 ? pixels * shown / whole : pixels;
}

/// [surfels] 1: what keep_object keeps.
std::vector<std::uint8_t> within_outlines(const std::vector<Outline>& outlines, int threads,
                                          const TrainedSurfels& surfels) {
  std::vector<std::uint8_t> inside(surfels.size());
  parallel_ranges(
      surfels.size(), kJudgedPerRange, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const float* v = surfels[i].value.data() + TrainedSurfel::kLogRadius;
          const double deviation = std::exp((v[0] + v[1]) / 2 - std::log(kGaussianReach) / 2);
          const auto at = surfels[i].position();
          inside[i] = in_hull(outlines, {at[0], at[1], at[2]}, deviation);
        }
      });
  return inside;
}

}  // namespace

void keep_object(const std::vector<Outline>& outlines, int threads, TrainedSurfels& surfels) {
  const std::vector<std::uint8_t> inside = within_outlines(outlines, threads, surfels);
  TrainedSurfels kept;
  for (std::size_t i = 0; i < surfels.size(); ++i)
    if (inside[i]) kept.push_back(surfels[i]);
  surfels = std::move(kept);
}

Gaussians gaussians_of(const TrainedSurfels& surfels) {
  const float reach = std::log(kGaussianReach) / 2;
  Gaussians out;
  out.degree = 3;
  for (const TrainedSurfel& surfel : surfels) {
    const float* v = surfel.value.data();
    out.positions.push_back(surfel.position());
    const float first = v[TrainedSurfel::kLogRadius] - reach,
                second = v[TrainedSurfel::kLogRadius + 1] - reach;
    const float least = std::min(first, second) + std::log(kThickness);
    out.log_deviations.push_back(
        {first, second, std::max(v[TrainedSurfel::kLogRadius + 2] - reach, least)});
    const float* turn = v + TrainedSurfel::kTurn;
    const float length =
        std::sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2] + turn[3] * turn[3]);
    out.rotations.push_back(
        {turn[0] / length, turn[1] / length, turn[2] / length, turn[3] / length});
    out.logits.push_back(v[TrainedSurfel::kOpacity]);
    const float* colour = v + TrainedSurfel::kColour;
    out.harmonics.insert(out.harmonics.end(), colour, colour + 3 * kTrainedFunctions);
  }
  return out;
}

void train_as_gaussians(bool is_volume, std::vector<TrainingView>& views, TrainSettings& training) {
  for (TrainingView& view : views) view.camera.gaussian = true;
  training.spread = training.together = training.decided = 0;
  training.squared = kSquared;
  if (!is_volume) training.least_opacity = kFaint;
  training.replaced = kReplaced;
  training.coarse = kCoarseShare;
  training.harmonics = {3, kHarmonicRate, kSparsity / std::sqrt(float(views.size()))};
}

Result<TrainedSurfels, InputError> train_gaussian_surfels(const Capture& capture,
                                                          std::span<const int> cameras,
                                                          const TrainGeometrySettings& settings,
                                                          const Progress& progress) {
  SLF_TRY(TrainingStart start, training_start(capture, cameras, settings, progress));
  if (start.views.empty()) return TrainedSurfels{};
  TrainSettings& training = start.settings;
  train_as_gaussians(settings.is_volume, start.views, training);
  SLF_TRY(std::vector<Outline> outlines, outlines_of(capture, cameras, settings.threads));
  const bool outlined = are_outlined(outlines.size(), cameras.size());
  if (!outlined) outlines.clear();
  if (settings.cache != nullptr) settings.cache->outlined = outlined;
  if (settings.surfels == 0) training.surfels = std::max<std::size_t>(training.surfels / 2, 1);
  const double taught = pixels_shown(outlines, start.views) / kPixelsOfSplat;
  if (settings.twists == nullptr)
    training.surfels = std::min(training.surfels, std::max(std::size_t(taught), kFewestSplats));
  if (outlined) SLF_CHECK(charge_for_hiding(capture, settings.threads, start.views));
  TrainedSurfels surfels = first_surfels(start, settings);
  if (!outlined) {
    const TrainedSurfels far =
        far_surfels(start.views, surfels, training.surfels / kFarShare, settings.threads);
    surfels.insert(surfels.end(), far.begin(), far.end());
  }
  if (settings.twists != nullptr) {
    *settings.twists = CameraTwists(start.views.size(), surfels, training_pixel(start.views));
    training.twists = settings.twists;
  }
  if (outlined)
    training.belong = [&](const TrainedSurfels& all) {
      return within_outlines(outlines, settings.threads, all);
    };
  SLF_CHECK(train_surfels(start.views, training, surfels));
  if (outlined) keep_object(outlines, settings.threads, surfels);
  return surfels;
}

Result<Gaussians, InputError> train_gaussians(const Capture& capture, std::span<const int> cameras,
                                              const TrainGeometrySettings& settings,
                                              const Progress& progress) {
  SLF_TRY(const TrainedSurfels surfels,
          train_gaussian_surfels(capture, cameras, settings, progress));
  Gaussians out = gaussians_of(surfels);
  if (!surfels.empty()) out.up = capture.up;
  return out;
}

}  // namespace slf
