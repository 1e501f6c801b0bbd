// SPDX-License-Identifier: Apache-2.0
// The codeword of a frame unit: vectors of a lattice, and of the points of the reference.
// Spec 7.13.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/frame_header.h"
#include "geometry/reference_cells.h"
#include "slf/error.h"

namespace slf {

/// The vectors of the lattice, at points with a cell of the reference around them, and of the
/// points of the reference, where these move one by one.
/// @param header  receives both
/// @errors kOutOfRange: a vector too long, a codeword that does not end where the unit does, or a
///         reference that lacks the level
Result<Done> read_vectors(std::span<const std::uint8_t> codeword, const ReferenceCells& reference,
                          int bits, FrameHeader& header);

/// The codeword. Vectors that are not coded become zero in `header`.
std::vector<std::uint8_t> write_vectors(const ReferenceCells& reference, int bits,
                                        FrameHeader& header);

}  // namespace slf
