// SPDX-License-Identifier: Apache-2.0
// The file: a signature and three sections.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "slf/error.h"

namespace slf {

inline constexpr std::array<std::uint8_t, 8> kIgcSignature = {0x8B, 'I',  'G',  'C',
                                                              0x0D, 0x0A, 0x1A, 0x0A};

/// Bytes that a section adds to its payload: length before it (8, little endian), CRC-32 after (4).
inline constexpr std::size_t kIgcSectionBytes = 12;

struct IgcSections {
  std::span<const std::uint8_t> parameters;  ///< tools/rd/igc/igc_parameters.h
  std::span<const std::uint8_t> geometry;    ///< an .slf stream without functions
  std::span<const std::uint8_t> images;      ///< of the video codec
};

std::vector<std::uint8_t> write_igc_file(const IgcSections& sections);

/// Views of `stream`.
/// @errors kNotSlf; kTruncated; kChecksum; kOutOfRange: bytes after the last section
Result<IgcSections> read_igc_file(std::span<const std::uint8_t> stream);

}  // namespace slf
