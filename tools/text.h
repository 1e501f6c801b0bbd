// SPDX-License-Identifier: Apache-2.0
// Text for people: formatted numbers, and writing it out.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/failure.h"

namespace slf::tools {

/// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string text(const char* format, ...);

/// 1234567 -> "1,234,567".
std::string grouped(std::uint64_t number);

/// As short as it reads back the same, in any locale: 0.1, 1e-09.
std::string shortest(double number);

/// "27.12 dB", in seven places before the unit; "- dB" where there was nothing to compare.
std::string psnr_text(double psnr);

/// A foreign text that cannot steer a terminal: control characters (C0, DEL, C1), those that turn
/// the direction of writing, and what is not UTF-8 become '?'. What is longer than 4,096 bytes is
/// cut, and says so.
std::string printable(const std::string& foreign);

/// To standard output, flushed; a full disk or a closed pipe is a failure.
Outcome print(const std::string& text);
/// Indented, with a line end. Strings that are not UTF-8 are shown with replacement characters;
/// what printable() replaces is escaped.
Outcome print(const nlohmann::ordered_json& json);
std::string to_text(const nlohmann::ordered_json& json);

/// "slf: warning: ..." on standard error, unless quiet.
void warn(const std::string& message, bool quiet);
void warn(const std::vector<std::string>& messages, bool quiet);

/// Largest resident set of this process so far, MiB.
double peak_memory_mib();

}  // namespace slf::tools
