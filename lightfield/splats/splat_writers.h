// SPDX-License-Identifier: Apache-2.0
// The formats of splats, one file each.
#pragma once

#include <bit>
#include <cstdint>
#include <string_view>
#include <vector>

#include "lightfield/splats/splat_rows.h"
#include "slf/splats.h"

namespace slf {

using Bytes = std::vector<std::uint8_t>;

Bytes write_splat_ply(const SplatRows& splats);
Result<Bytes, InputError> write_splat_glb(const SplatRows& splats);
/// Bytes of a GLB's buffer. @errors kInvalidInput: GLB has 32 bits for them.
Result<std::uint32_t, InputError> glb_buffer_bytes(std::uint64_t splats,
                                                   std::uint64_t num_harmonics);
/// @param version  2, 3 or 4. @errors also kUnsupported: 4 without zstd
Result<Bytes, InputError> write_spz(const SplatRows& splats, int version);
/// What write_spz() leaves of it.
SplatCloud rounded_to_spz(SplatCloud splats);
/// @errors kUnsupported: no WebP. kInvalidInput: too many, or coordinates that it does not resolve.
Result<Bytes, InputError> write_sog(const SplatRows& splats, int threads);
/// What write_sog() leaves of it.
SplatCloud rounded_to_sog(SplatCloud splats, int threads);

/// Little endian.
inline void put(Bytes& out, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8)
    out.push_back(static_cast<std::uint8_t>(value >> shift));
}
inline void put(Bytes& out, float value) { put(out, std::bit_cast<std::uint32_t>(value)); }
inline void put(Bytes& out, std::string_view text) {
  out.insert(out.end(), text.begin(), text.end());
}

}  // namespace slf
