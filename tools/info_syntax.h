// SPDX-License-Identifier: Apache-2.0
// slf info --syntax: the elements of the headers for people and for programs.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "tools/failure.h"

namespace slf::tools {

/// @param file  the name in messages
Outcome print_syntax(std::span<const std::uint8_t> stream, const std::string& file, bool json);

}  // namespace slf::tools
