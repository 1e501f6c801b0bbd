// SPDX-License-Identifier: Apache-2.0
// What decoding and showing a file take, for people and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "slf/decoder.h"

namespace slf::tools {

/// Bytes of a page of web/viewer with a whole light field, beside the browser's own.
struct PageMemory {
  std::uint64_t most = 0;      ///< while it opens; web/test/browser/memory.mjs measures it
  std::uint64_t graphics = 0;  ///< textures, which stay, as does as much for another context
};

/// @return nothing of files that the page treats otherwise (frames) or cannot show
///         (planes without a basis, or that are pictures)
std::optional<PageMemory> page_memory(const StreamInfo& info, const DecodeCost& cost,
                                      std::size_t frames);

nlohmann::ordered_json decode_cost_json(const DecodeCost& cost,
                                        const std::optional<PageMemory>& page);
std::string decode_cost_text(const DecodeCost& cost, const std::optional<PageMemory>& page);

}  // namespace slf::tools
