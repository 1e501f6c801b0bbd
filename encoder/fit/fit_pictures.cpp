// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/fit_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/release.h"
#include "encoder/fit/camera_folds.h"
#include "encoder/fit/held_out_pictures.h"
#include "encoder/fit/picture_system.h"
#include "encoder/fit/picture_views.h"
#include "lightfield/render/surfel_cloud.h"

namespace slf {
namespace {

constexpr std::array kPulls = {1.0, 8.0};
constexpr int kTriedSteps = 5;
constexpr std::size_t kLeastSearchedCameras = 8;
constexpr std::size_t kGroupsHeldOut = 16;

using Which = std::function<bool(std::size_t view)>;

bool all(std::size_t) { return true; }

double psnr_of_views(const std::vector<PictureError>& errors, const Which& of) {
  PictureError sum;
  for (std::size_t v = 0; v < errors.size(); ++v)
    if (of(v)) sum += errors[v];
  return sum.psnr();
}

/// Directions from the middle of the points to the eyes.
std::vector<Vec3> towards(const std::vector<Vec3>& eyes, const SurfelCloud& cloud) {
  Vec3 middle{0, 0, 0};
  for (const Vec3& c : cloud.centres)
    for (std::size_t k = 0; k < 3; ++k) middle[k] += c[k] / static_cast<double>(cloud.size());
  std::vector<Vec3> directions;
  for (const Vec3& eye : eyes) {
    const Vec3 d{eye[0] - middle[0], eye[1] - middle[1], eye[2] - middle[2]};
    const double length = std::max(std::hypot(d[0], d[1], d[2]), 1e-300);
    directions.push_back({d[0] / length, d[1] / length, d[2] / length});
  }
  return directions;
}

/// The first pull with which the pictures of cameras held out from the fit gain; 0 where none does.
/// What it starts from knows them, so this errs to the safe side.
void choose_pull(PictureSystem& system, const PictureSystem::Vector& colours, const Which& held_out,
                 PictureFit& fit) {
  fit.held_out_before = psnr_of_views(system.errors(colours), held_out);
  fit.held_out_after = fit.held_out_before;
  fit.pull = 0;
  const auto kept = [&](std::size_t v) { return !held_out(v); };
  for (const double pull : kPulls) {
    system.set_pull(pull);
    auto tried = colours;
    system.improve(kept, kTriedSteps, tried, nullptr);
    const double gained = psnr_of_views(system.errors(tried), held_out);
    if (!(gained > fit.held_out_before)) continue;
    fit.held_out_after = gained;
    fit.pull = pull;
    return;
  }
}

}  // namespace

Result<PictureFit, InputError> fit_to_pictures(const PictureFitInput& input,
                                               const FitSettings& settings, bool search,
                                               std::vector<float>& coefficients,
                                               const Progress& progress,
                                               std::shared_ptr<const HeldOutPictures>* held_out) {
  const SurfelCloud cloud =
      surfel_cloud(input.grid, input.positions, input.normals, 0, settings.threads);
  SLF_TRY(PictureViews pictures,
          picture_views(input.capture, input.cameras, input.gains, cloud, input.transfer,
                        input.hidden_by, settings.threads, progress));
  std::vector<Vec3> eyes;
  for (const int c : input.cameras)
    eyes.push_back(input.capture.cameras[static_cast<std::size_t>(c)].centre());
  const std::vector<int> fold = camera_folds(towards(eyes, cloud));
  PictureSystem system(input.grid, input.positions, settings, input.gamma_range, pictures, eyes);
  auto colours = system.colours(coefficients);
  PictureFit fit;
  fit.pull = 1;
  const PictureFitSettings& s = settings.pictures;
  const bool hold_out = held_out != nullptr && input.seen != nullptr;
  const double parts = s.rounds + (search ? 2 : 0) + (hold_out ? 1 : 0);
  double done = 0;
  const auto next = [&] {
    if (progress) progress("fit pictures", done++ / parts);
  };
  next();
  system.set_trust(colours, s.outlier);
  if (search && input.cameras.size() >= kLeastSearchedCameras) {
    choose_pull(
        system, colours, [&](std::size_t v) { return fold[v] == 0; }, fit);
    done = 2;
  }
  fit.psnr_before = fit.psnr_after = psnr_of_views(system.errors(colours), all);
  PictureSystem::Vector z(colours.size());
  for (int round = 0; fit.pull > 0 && round < s.rounds; ++round) {
    if (round > 0) {
      next();
      system.set_trust(colours, s.outlier);
    }
    system.set_pull(fit.pull);
    system.improve(all, s.steps, colours, &z);
  }
  if (fit.pull > 0) {
    fit.psnr_after = psnr_of_views(system.errors(colours), all);
    system.add(z, coefficients);
  }
  if (!hold_out) return fit;
  next();
  release(colours);
  release(z);
  const std::vector<int> parts_held_out = camera_folds(towards(eyes, cloud), kGroupsHeldOut);
  SLF_TRY(*held_out, HeldOutPictures::of({input, settings, pictures, eyes, parts_held_out, fit.pull,
                                          coefficients}));
  return fit;
}

}  // namespace slf
