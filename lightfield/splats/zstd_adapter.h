// SPDX-License-Identifier: Apache-2.0
// The one place that includes zstd: streams of SPZ 4.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace slf {

/// Whether this build has it.
bool has_zstd();

/// Decompresses one or several frames (RFC 8878) to exactly `to.size()` bytes.
/// @return false: damaged, or of another size; false always where has_zstd() is
bool unzstd(std::span<const std::uint8_t> frames, std::span<std::uint8_t> to);

/// One frame that says its size. Nothing where there is no memory, or has_zstd() is false.
std::optional<std::vector<std::uint8_t>> zstd(std::span<const std::uint8_t> bytes);

}  // namespace slf
