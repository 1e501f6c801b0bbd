// The metadata unit: deflated key-value pairs. Spec 7.8.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slf/error.h"
#include "slf/types.h"

namespace slf {

/// @errors kOutOfRange: damaged, not UTF-8 sized as said, more than 1 MiB when inflated.
Result<Metadata> parse_metadata(std::span<const std::uint8_t> payload);
std::vector<std::uint8_t> write_metadata(const Metadata& metadata);

}  // namespace slf
