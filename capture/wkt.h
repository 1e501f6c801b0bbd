// SPDX-License-Identifier: Apache-2.0
// Well-known text of coordinate systems.
#pragma once

#include <string_view>

namespace slf {

/// KEYWORD["name", ...], with as many brackets as it takes.
bool is_wkt(std::string_view text);

}  // namespace slf
