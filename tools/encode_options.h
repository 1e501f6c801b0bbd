// The options of slf encode, most of them those of slf igc too: a preset, and what is set apart
// from it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slf/encoder.h"
#include "tools/options.h"

namespace slf::tools {

/// Empty where the command line says nothing: the preset decides.
struct EncodeOptions {
  const char* verb = "encode";  ///< for messages
  std::string capture, output, points, split;
  Preset preset = Preset::kDefault;
  std::optional<int> grid_bits, order, functions, iterations, neighbours, normal_bits;
  std::optional<int> degree, block_log2, environment_degree, effort;
  std::optional<double> block_strength, block_growth, point_penalty, point_growth,
      environment_radius;
  std::optional<double> voxel_size, q, delta, occlusion_resolution, depth_tolerance, lambda, beta;
  std::optional<double> target_psnr;
  std::optional<std::uint64_t> target_bytes;
  std::vector<int> scales;
  bool penalise_dc = false, free_dc = false, linear = false;
  bool steps_given = false, by_norm = true;
  bool densify_given = false;
  Densify densify = Densify::kAuto;
  bool refine_given = false;
  RefineGeometry refine = RefineGeometry::kAuto;
  bool fit_given = false, basis_given = false, frame_given = false;
  FitMethod fit = FitMethod::kHierarchical;
  bool fit_to_given = false, fit_to_pictures = true;
  std::optional<BasisId> basis;  ///< none: auto, if given
  std::optional<FrameId> frame;
  bool cross_validate = true, cross_validate_given = false;
  bool check_cameras = true, check_cameras_given = false;
  bool klt_given = false;
  TransformMode klt = TransformMode::kFunctions;
  std::optional<double> chroma_step;
  bool colour_given = false, geometry_given = false, coefficients_given = false, up_given = false;
  ColourTransform colour = ColourTransform::kOpponent;
  GeometryCoder geometry = GeometryCoder::kOctree;
  CoefficientCoder coefficients = CoefficientCoder::kVector;
  TextureSettings texture;
  bool predict_given = false, predict = EncoderSettings{}.predict;
  double rdo = EncoderSettings{}.rdo;
  CLI::Option* rdo_option = nullptr;
  int base_levels = kAutomaticBase;
  std::uint32_t slice_points = kDefaultSlicePoints;
  CLI::Option *base_levels_option = nullptr, *slice_points_option = nullptr;
  UpAxis up = UpAxis::kPlusZ;
  std::vector<std::string> metadata;  ///< key=value
  CommonOptions common;
};

void add_encode_options(CLI::App& verb, EncodeOptions& options);

/// Those of them that lead to view maps: input, preset, grid, geometry, observation, fit, and -j,
/// --quiet, --json.
/// @param file  ".slf": what the output is
void add_view_map_options(CLI::App& verb, EncodeOptions& options, const char* file);

/// The preset's settings with everything that was given in its place.
Result<EncoderSettings, Failure> resolved(const EncodeOptions& given);

}  // namespace slf::tools
