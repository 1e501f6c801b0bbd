// Options whose value is one of a few words.
#pragma once

#include <CLI/CLI.hpp>

#include "slf/encoder.h"
#include "slf/types.h"

namespace slf::tools {

CLI::Option* add_geometry_choice(CLI::App& verb, GeometryCoder& choice);
CLI::Option* add_coefficients_choice(CLI::App& verb, CoefficientCoder& choice);
CLI::Option* add_colour_choice(CLI::App& verb, ColourTransform& choice);
CLI::Option* add_preset_choice(CLI::App& verb, Preset& choice);
CLI::Option* add_up_choice(CLI::App& verb, UpAxis& choice);
/// --steps: true is by-norm.
CLI::Option* add_steps_choice(CLI::App& verb, bool& by_norm);

}  // namespace slf::tools
