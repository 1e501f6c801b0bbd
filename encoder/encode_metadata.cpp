// SPDX-License-Identifier: Apache-2.0
#include "encoder/encode_metadata.h"

#include <charconv>
#include <cmath>
#include <utility>

#include "lightfield/render/reference_kernel.h"

namespace slf {
namespace {

/// The shortest form that reads back as the same number, whatever the locale.
std::string text(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return {buffer, end};
}

std::string hundredths(double value) { return text(std::round(value * 100) / 100); }

/// Indices of the cameras with a verdict, in the order of the capture: "3 17".
std::string cameras_with(CameraVerdict verdict, const std::vector<CameraTrust>& cameras) {
  std::string indices;
  for (const CameraTrust& trust : cameras)
    if (trust.verdict == verdict) indices += std::to_string(trust.camera) + " ";
  if (!indices.empty()) indices.pop_back();
  return indices;
}

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
  if (r.before_psnr > 0)
    out.insert(out.end(), {{"surface_psnr_before", hundredths(r.before_psnr)},
                           {"surface_psnr_trained", hundredths(r.trained_psnr)}});
  if (r.splats_psnr > 0) out.emplace_back("surface_psnr_splats", hundredths(r.splats_psnr));
  return out;
}

}  // namespace

Metadata fit_metadata(const ChosenFit& chosen) {
  const FitSettings& fit = chosen.settings;
  const PictureFitSettings& pictures = fit.pictures;
  Metadata metadata = {{"functions", std::to_string(fit.basis.num_functions())}};
  if (fit.basis.id == BasisId::kBspline)
    metadata.emplace_back("order", std::to_string(fit.basis.order));
  metadata.emplace_back("fit_to", pictures.rounds > 0 ? "pictures" : "points");
  if (pictures.rounds > 0)
    metadata.insert(metadata.end(), {
                                        {"picture_rounds", std::to_string(pictures.rounds)},
                                        {"picture_steps", std::to_string(pictures.steps)},
                                        {"picture_mean_penalty", text(pictures.mean_penalty)},
                                        {"picture_penalty", text(pictures.penalty)},
                                        {"picture_growth", text(pictures.growth)},
                                        {"picture_outlier", text(pictures.outlier)},
                                    });
  if (fit.method == FitMethod::kHierarchical) {
    const HierarchySettings& h = fit.hierarchy;
    metadata.insert(metadata.end(),
                    {
                        {"fit", "hierarchical"},
                        {"frame", fit.frame == FrameId::kReflected ? "reflected" : "global"},
                        {"block_log2", std::to_string(h.block_log2)},
                        {"block_strength", text(h.strength)},
                        {"block_growth", text(h.growth)},
                        {"point_penalty", text(h.point_penalty)},
                        {"point_growth", text(h.point_growth)},
                        {"environment_degree", std::to_string(fit.environment.degree)},
                        {"environment_radius", text(fit.environment.radius)},
                        {"cross_validation", cross_validation(chosen)},
                    });
    return metadata;
  }
  metadata.insert(metadata.end(), {
                                      {"lambda", text(fit.lambda)},
                                      {"beta", text(fit.beta)},
                                      {"iterations", std::to_string(fit.iterations)},
                                      {"neighbours", std::to_string(fit.neighbours)},
                                      {"penalise_dc", fit.penalise_dc ? "yes" : "no"},
                                  });
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
      {"steps", s.steps_by_norm ? "by-norm" : "uniform"},
  };
  if (s.coefficients == CoefficientCoder::kTexture) {
    metadata.insert(
        metadata.end(),
        {
            {"texture_bits", std::to_string(s.texture.bits)},
            {"texture_qp", s.texture.lossless ? "lossless" : std::to_string(s.texture.qp)},
            {"texture_mode", s.texture.mode == TextureSettings::kIntra ? "intra" : "low-delay"},
            {"texture_preset", s.texture.preset},
        });
  } else {
    metadata.emplace_back("q", text(s.q));
    if (encoded.step.origin == ChosenStep::kChosen)
      metadata.insert(metadata.end(), {
                                          {"quality", "auto"},
                                          {"quality_loss", text(s.quality_loss)},
                                          {"quality_loss_held_out", hundredths(encoded.step.loss)},
                                      });
    if (s.transform != TransformMode::kNone)
      metadata.emplace_back("klt",
                            s.transform == TransformMode::kFunctions ? "functions" : "joint");
    if (s.chroma_step != 1) metadata.emplace_back("chroma_step", text(s.chroma_step));
  }
  const Metadata grid = grid_metadata(s, encoded.grid, encoded.density);
  metadata.insert(metadata.end(), grid.begin(), grid.end());
  if (cameras > 0) {
    metadata.insert(metadata.end(),
                    {
                        {"delta", text(s.observe.delta_degrees)},
                        {"occlusion_resolution", text(s.observe.occlusion_resolution)},
                        {"depth_tolerance", text(s.observe.depth_tolerance)},
                    });
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
  }
  const Metadata surface = surface_metadata(encoded.surface);
  if (s.surface != Surface::kGiven) metadata.insert(metadata.end(), surface.begin(), surface.end());
  metadata.insert(metadata.end(), s.metadata.begin(), s.metadata.end());
  return metadata;
}

}  // namespace slf
