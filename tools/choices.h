// Options whose value is one of a few words.
#pragma once

#include <CLI/CLI.hpp>

#include "slf/igc.h"
#include "slf/types.h"

namespace slf::tools {

CLI::Option* add_up_choice(CLI::App& verb, UpAxis& choice);
CLI::Option* add_igc_codec_choice(CLI::App& verb, IgcCodec& choice);
CLI::Option* add_igc_chroma_choice(CLI::App& verb, IgcChroma& choice);
/// As --codec spells it.
const char* igc_codec_name(IgcCodec codec);
}  // namespace slf::tools
