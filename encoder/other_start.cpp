// SPDX-License-Identifier: Apache-2.0
#include "encoder/other_start.h"

#include <string>
#include <utility>

#include "encoder/fit_capture.h"
#include "encoder/train/object_points.h"
#include "encoder/train/train_geometry.h"

namespace slf {
namespace {

constexpr double kDense = 3;  // pixels: points that lie farther apart leave holes, exact or not

}  // namespace

bool is_dense(const Capture& capture, std::span<const int> cameras) {
  const Density density = choose_density(capture, cameras);
  return density.spacing <= kDense * density.pixel;
}

Result<std::optional<StartingPoints>, InputError> other_start(const Capture& capture,
                                                              std::span<const int> cameras,
                                                              const EncoderSettings& settings) {
  using Start = std::optional<StartingPoints>;
  if (cameras.empty()) return Start{};
  if (capture.cloud.positions.empty()) {
    if (cameras.size() < kLeastTrainingCameras)
      return InputError{Errc::kInvalidInput,
                        "the capture has no points, and from " + std::to_string(cameras.size()) +
                            " photographs none can be found: 5 at least, better 30 and more, or "
                            "points of the object"};
    SLF_TRY(StartingPoints points, starting_points(capture, cameras, settings.threads));
    return Start{std::move(points)};
  }
  if (!capture.mesh.triangles.empty()) {
    const bool keeps = settings.surface == Surface::kGiven || settings.surface == Surface::kAuto;
    return keeps ? Start{} : Start{{capture.cloud, StartId::kPoints}};
  }
  const bool trains = settings.surface == Surface::kAuto || settings.surface == Surface::kTrained ||
                      settings.surface == Surface::kSplats;
  if (!trains || !training_obstacle(capture, cameras).empty()) return Start{};
  SLF_TRY(ObjectPoints own, object_points(capture, cameras, settings.threads));
  std::optional<Capture> of_object;
  if (own.left_out > 0) {
    of_object = capture;
    of_object->cloud = std::move(own.cloud);
  }
  const Capture& shown = of_object ? *of_object : capture;
  const bool few = !training_obstacle(shown, cameras).empty();
  if (few || !is_dense(shown, cameras)) {
    auto hull = starting_points(capture, cameras, settings.threads);
    const bool taken = hull && hull->start == StartId::kHull &&
                       hull->cloud.positions.size() > shown.cloud.positions.size() &&
                       (few || lies_on(hull->cloud, shown.cloud));
    if (taken) hull->left_out = own.left_out;
    if (taken) return Start{*std::move(hull)};
  }
  if (few || !of_object) return Start{};
  return Start{{std::move(of_object->cloud), StartId::kPoints, own.left_out}};
}

}  // namespace slf
