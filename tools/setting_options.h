// SPDX-License-Identifier: Apache-2.0
// Options of the command line made from the table of the encoder's settings.
#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "slf/settings.h"

namespace slf::tools {

/// Adds --NAME for every setting that `wanted` accepts. What is given stands in `given` afterwards.
void add_settings(CLI::App& verb, GivenSettings& given,
                  const std::function<bool(const SettingInfo&)>& wanted);

/// "FLOAT:0 to 90", "INT:1 to 21 or auto", "on|off".
std::string type_of(const SettingInfo& setting);

/// [{name, kind, low, high, words, initial, help, group, excludes}] for programs that give them.
nlohmann::ordered_json settings_table_json();

}  // namespace slf::tools
