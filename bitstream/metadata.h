// SPDX-License-Identifier: Apache-2.0
// The metadata unit: deflated key-value pairs. Spec 7.8.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "slf/error.h"
#include "slf/types.h"

namespace slf {

/// Well-formed: no character in more bytes than it needs, no half of a surrogate pair.
bool is_utf8(std::string_view text);

/// What write_metadata may be given: names, UTF-8, no zero byte, no more than a reader takes.
bool is_metadata(const Metadata& metadata);

/// @errors kOutOfRange: damaged, not sized as said, not UTF-8, more than 1 MiB when inflated.
Result<Metadata> parse_metadata(std::span<const std::uint8_t> payload);
std::vector<std::uint8_t> write_metadata(const Metadata& metadata);

}  // namespace slf
