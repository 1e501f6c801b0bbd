// SPDX-License-Identifier: Apache-2.0
// What a person may want to know of a capture after its encode.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "slf/encoder.h"

namespace slf {

/// @param left_out  ObjectPoints::left_out
/// @param points  of the capture
std::string left_out_warning(std::size_t left_out, std::size_t points);

/// A line for each photograph that was dropped or has another exposure, and one where they are many.
/// @param used  how many photographs there were
void warn_of_cameras(std::span<const CameraTrust> cameras, std::size_t used, const Capture& capture,
                     std::vector<std::string>& warnings);

/// Warns of points that no photograph shows, where they are most.
/// @errors kInvalidInput: nearly all are
Result<Done, InputError> check_unseen(std::size_t unseen, std::size_t points,
                                      std::vector<std::string>& warnings);

}  // namespace slf
