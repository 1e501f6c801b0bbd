// SPDX-License-Identifier: Apache-2.0
// A zip of files as they are: the bundle that is written of a SOG.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "slf/error.h"

namespace slf {

struct NamedBytes {
  std::string name;
  std::vector<std::uint8_t> bytes;
};

/// Files in their order, not packed, dated 1 January 1980: the same bytes for the same files.
/// @errors kInvalidInput: 4 GiB or more, for which a zip has no numbers
/// Source: PKWARE, APPNOTE.TXT 6.3.10: local file header, central directory, and its end.
Result<std::vector<std::uint8_t>, InputError> stored_zip(const std::vector<NamedBytes>& files);

}  // namespace slf
