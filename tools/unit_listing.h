// SPDX-License-Identifier: Apache-2.0
// Units and slices of a file, one a line and one an element.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "slf/decoder.h"

namespace slf::tools {

nlohmann::ordered_json unit_json(const UnitInfo& unit);
nlohmann::ordered_json slice_json(const SliceInfo& slice);
std::string units_text(const StreamInfo& info);
std::string slices_text(const StreamInfo& info);

}  // namespace slf::tools
