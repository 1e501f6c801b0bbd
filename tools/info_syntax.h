// SPDX-License-Identifier: Apache-2.0
// slf info --syntax: the elements of the headers for people and for programs.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "slf/limits.h"
#include "tools/failure.h"

namespace slf::tools {

/// @param file    the name in messages
/// @param limits  max_memory: of units, and of what is listed of one
Outcome print_syntax(std::span<const std::uint8_t> stream, const std::string& file,
                     const DecodeLimits& limits, bool json);

}  // namespace slf::tools
