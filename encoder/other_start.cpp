// SPDX-License-Identifier: Apache-2.0
#include "encoder/other_start.h"

#include <utility>

#include "encoder/fit_capture.h"
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
    SLF_TRY(StartingPoints points, starting_points(capture, cameras, settings.threads));
    return Start{std::move(points)};
  }
  if (!capture.mesh.triangles.empty()) {
    const bool keeps = settings.surface == Surface::kGiven || settings.surface == Surface::kAuto;
    return keeps ? Start{} : Start{{capture.cloud, StartId::kPoints}};
  }
  const bool trains = settings.surface == Surface::kAuto || settings.surface == Surface::kTrained ||
                      settings.surface == Surface::kSplats;
  if (!trains || !training_obstacle(capture, cameras).empty() || is_dense(capture, cameras))
    return Start{};
  auto points = starting_points(capture, cameras, settings.threads);
  const bool taken = points && points->start == StartId::kHull &&
                     points->cloud.positions.size() > capture.cloud.positions.size() &&
                     lies_on(points->cloud, capture.cloud);
  return taken ? Start{*std::move(points)} : Start{};
}

}  // namespace slf
