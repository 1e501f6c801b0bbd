// SPDX-License-Identifier: Apache-2.0
// A part of a .slf file as input of a verb: read where it lies in the file.
#pragma once

#include <optional>
#include <string>

#include "tools/stream_input.h"

namespace slf::tools {

/// What decode_file() gives of a part that an option asked for, by reading the file's beginning and
/// that part. Damage elsewhere is not seen.
/// @return nullopt: the file is to be read whole. So it is where no option asked for a part (means
///         alone are of the whole, whose checksums are looked at), where it is no regular file, has
///         no index, or anything is wrong: who reads all of it says what.
std::optional<DecodedFile> decode_part_alone(const std::string& file, const PartOptions& part,
                                             const LimitOptions& given,
                                             const CommonOptions& common);

}  // namespace slf::tools
