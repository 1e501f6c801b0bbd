// SPDX-License-Identifier: Apache-2.0
// Options whose value is one of a few words.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "slf/types.h"
#include "tools/rd/igc/igc.h"

namespace slf::tools {

CLI::Option* add_up_choice(CLI::App& verb, UpAxis& choice);
CLI::Option* add_igc_codec_choice(CLI::App& verb, IgcCodec& choice);
CLI::Option* add_igc_chroma_choice(CLI::App& verb, IgcChroma& choice);
/// As --codec spells it.
const char* igc_codec_name(IgcCodec codec);

/// What an .igc file says of a setting, its number as the options spell it where it stands for one
/// of a few words.
std::string igc_setting_in_words(const std::string& key, const std::string& value);

}  // namespace slf::tools
