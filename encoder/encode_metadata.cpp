// SPDX-License-Identifier: Apache-2.0
#include "encoder/encode_metadata.h"

#include <cmath>
#include <utility>

#include "base/shortest.h"
#include "encoder/setting_rows.h"
#include "lightfield/render/reference_kernel.h"

namespace slf {
namespace {

std::string text(double value) { return shortest(value); }  // in any locale

std::string hundredths(double value) { return text(std::round(value * 100) / 100); }

std::string cross_validation(const ChosenFit& chosen) {
  switch (chosen.outcome) {
    case ChosenFit::kNothingToSearch:
      return "off";
    case ChosenFit::kTooFewCameras:
      return "too few cameras";
    case ChosenFit::kSearched:
      break;
  }
  return hundredths(chosen.psnr_chosen) + " dB, " + hundredths(chosen.psnr_given) + " before";
}

/// What was tried, and what it was worth.
Metadata surface_metadata(const SurfaceReport& r) {
  Metadata out = {{"surface", word_of(r.kept)}};
  if (r.start != StartId::kPoints) out.emplace_back("surface_start", word_of(r.start));
  const RefineReport& mended = r.mended;
  if (r.kept == Surface::kMended)
    out.insert(out.end(), {{"refine_moved", std::to_string(mended.moved)},
                           {"refine_median_move", hundredths(mended.median_move)},
                           {"refine_max_move", hundredths(mended.max_move)},
                           {"refine_removed", std::to_string(mended.removed)},
                           {"refine_added", std::to_string(mended.added)},
                           {"refine_psnr_before", hundredths(mended.held_out_before)},
                           {"refine_psnr_after", hundredths(mended.held_out_after)}});
  if (r.kept == Surface::kTrained) out.emplace_back("surfels", std::to_string(r.surfels));
  if (r.before_psnr > 0) out.emplace_back("surface_psnr_before", hundredths(r.before_psnr));
  if (r.trained_psnr > 0) out.emplace_back("surface_psnr_trained", hundredths(r.trained_psnr));
  if (r.as_splats.bytes > 0) out.emplace_back("surface_psnr_splats", hundredths(r.as_splats.psnr));
  if (r.as_surface.bytes > 0)
    out.emplace_back("surface_psnr_fitted", hundredths(r.as_surface.psnr));
  return out;
}

Metadata step_metadata(const EncoderSettings& s, const ChosenStep& step) {
  Metadata metadata = {{"q", text(s.q)}};
  if (step.origin == ChosenStep::kChosen)
    metadata.insert(metadata.end(), {{"quality", "auto"},
                                     {"quality_loss", text(s.quality_loss)},
                                     {"quality_loss_held_out", hundredths(step.loss)}});
  return metadata;
}

/// What became of the cameras, and of the fit to what they saw.
Metadata camera_metadata(const Encoded& encoded) {
  Metadata metadata;
  for (const auto& [key, verdict] : {std::pair{"cameras_dropped", CameraVerdict::kDropped},
                                     {"cameras_gain_corrected", CameraVerdict::kGainCorrected}})
    if (const auto indices = cameras_with(verdict, encoded.cameras); !indices.empty())
      metadata.emplace_back(key, indices);
  const Metadata fit = fit_metadata(encoded.fit);
  metadata.insert(metadata.end(), fit.begin(), fit.end());
  if (encoded.fit.settings.pictures.rounds > 0) {
    metadata.emplace_back("picture_pull", text(encoded.pictures.pull));
    metadata.emplace_back("kernel", std::to_string(kReferenceKernel.version));
  }
  return metadata;
}

}  // namespace

std::string cameras_with(CameraVerdict verdict, const std::vector<CameraTrust>& cameras) {
  std::string indices;
  for (const CameraTrust& trust : cameras)
    if (trust.verdict == verdict) indices += std::to_string(trust.camera) + " ";
  if (!indices.empty()) indices.pop_back();
  return indices;
}

Metadata fit_metadata(const ChosenFit& chosen) {
  EncoderSettings used;
  used.fit = chosen.settings;
  Metadata metadata = {{"functions", std::to_string(used.fit.basis.num_functions())}};
  const Metadata fit = recorded_settings(used, {SettingPart::kFit});
  metadata.insert(metadata.end(), fit.begin(), fit.end());
  if (used.fit.method == FitMethod::kHierarchical)
    metadata.emplace_back("cross_validation", cross_validation(chosen));
  return metadata;
}

Metadata grid_metadata(const EncoderSettings& s, const Grid& grid, const Density& density) {
  Metadata metadata = {{"grid", s.voxel_size > 0 || s.grid_bits > 0 ? "given" : "auto"}};
  if (density.densified) metadata.emplace_back("densified", "yes");
  if (density.pixel > 0)
    metadata.emplace_back("voxel_pixels", hundredths(grid.step / density.pixel));
  return metadata;
}

Metadata encoder_metadata(const EncoderSettings& s, const Encoded& encoded, std::size_t cameras) {
  Metadata metadata = {
      {"encoder", "slf " SLF_VERSION},
      {"preset", s.preset == Preset::kPaper ? "paper" : "default"},
      {"cameras", std::to_string(cameras)},
      {"observations", std::to_string(encoded.observations)},
      {"merged_points", std::to_string(encoded.merged)},
  };
  const auto append = [&metadata](const Metadata& more) {
    metadata.insert(metadata.end(), more.begin(), more.end());
  };
  if (s.coefficients != CoefficientCoder::kTexture) append(step_metadata(s, encoded.step));
  append(grid_metadata(s, encoded.grid, encoded.density));
  append(
      recorded_settings(s, {SettingPart::kGeometry, SettingPart::kCoding, SettingPart::kTexture}));
  if (cameras > 0) {
    append(recorded_settings(s, {SettingPart::kObservation}));
    append(camera_metadata(encoded));
  }
  if (s.surface != Surface::kGiven) append(surface_metadata(encoded.surface));
  append(s.metadata);
  return metadata;
}

}  // namespace slf
