// Options whose value is one of a few words.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "slf/encoder.h"
#include "slf/igc.h"
#include "slf/types.h"

namespace slf::tools {

CLI::Option* add_geometry_choice(CLI::App& verb, GeometryCoder& choice);
CLI::Option* add_coefficients_choice(CLI::App& verb, CoefficientCoder& choice);
/// --texture-bits, --texture-qp, --texture-mode, --texture-preset and --texture-lossless.
void add_texture_options(CLI::App& verb, TextureSettings& settings);
/// --predict on|off.
CLI::Option* add_predict_choice(CLI::App& verb, bool& choice);
CLI::Option* add_rdo(CLI::App& verb, double& strength);

/// How a scene is divided.
CLI::Option* add_base_levels(CLI::App& verb, int& levels);
CLI::Option* add_slice_points(CLI::App& verb, std::uint32_t& points);
CLI::Option* add_klt_choice(CLI::App& verb, TransformMode& choice);
CLI::Option* add_colour_choice(CLI::App& verb, ColourTransform& choice);
CLI::Option* add_fit_choice(CLI::App& verb, FitMethod& choice);
/// --fit-to: true is pictures.
CLI::Option* add_fit_to_choice(CLI::App& verb, bool& pictures);
CLI::Option* add_basis_choice(CLI::App& verb, std::optional<BasisId>& choice);  ///< none: auto
/// --refine-geometry on|off|auto
CLI::Option* add_densify_choice(CLI::App& verb, Densify& choice);
CLI::Option* add_refine_choice(CLI::App& verb, RefineGeometry& choice);
CLI::Option* add_frame_choice(CLI::App& verb, std::optional<FrameId>& choice);  ///< none: auto
/// --cross-validate on|off.
CLI::Option* add_cross_validate_choice(CLI::App& verb, bool& choice);
/// --check-cameras on|off.
CLI::Option* add_check_cameras_choice(CLI::App& verb, bool& choice);
CLI::Option* add_preset_choice(CLI::App& verb, Preset& choice);
CLI::Option* add_up_choice(CLI::App& verb, UpAxis& choice);
CLI::Option* add_igc_codec_choice(CLI::App& verb, IgcCodec& choice);
CLI::Option* add_igc_chroma_choice(CLI::App& verb, IgcChroma& choice);
/// As --codec spells it.
const char* igc_codec_name(IgcCodec codec);
/// --steps: true is by-norm.
CLI::Option* add_steps_choice(CLI::App& verb, bool& by_norm);

}  // namespace slf::tools
