// SPDX-License-Identifier: Apache-2.0
// HEVC byte streams by NAL unit, and sequence parameter sets with an element changed.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace slf::conformance {

using Bytes = std::vector<std::uint8_t>;

/// NAL units of an Annex B byte stream, with their headers, without start codes.
std::vector<Bytes> nal_units(const Bytes& stream);
Bytes byte_stream(const std::vector<Bytes>& units);

constexpr int nal_type(const Bytes& unit) { return unit[0] >> 1; }
inline constexpr int kSequenceParameterSet = 33, kPictureParameterSet = 34;

/// What an element is to be. A tool that is switched on gets the least that has to follow it.
/// name: as in ITU-T H.265 7.3.2.2, from chroma_format_idc to pcm_enabled_flag
using SpsEdit = std::function<std::uint32_t(std::string_view name, std::uint32_t value)>;

/// A sequence parameter set changed.
/// @pre one sub-layer, monochrome, no window, as x265 writes it for a texture
Bytes with_sps(const Bytes& unit, const SpsEdit& edit);

}  // namespace slf::conformance
