// SPDX-License-Identifier: Apache-2.0
// Gaussian splats from other programs' files and back to them. docs/export.md says what each format
// keeps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "slf/error.h"
#include "slf/gaussians.h"
#include "slf/splats.h"

namespace slf {

/// What was read of a file of splats.
struct GaussianFile {
  Gaussians gaussians;
  std::string format;  ///< "PLY", "compressed PLY", "SPZ 3", "SOG 2", "splat", "ksplat", "glTF"
  std::size_t left_out = 0;  ///< splats with a value that means nothing: NaN, an infinite size
  std::size_t mended = 0;    ///< splats with a value beyond its range, which is the nearest now: an
                             ///< opacity of 1, a size of 0, a quaternion of 0 (no turn)
};

/// Whether bytes are a file of splats, by what they hold: PLY with opacity, scales and turns, or
/// SuperSplat's compressed one; SPZ; splat; ksplat; SOG; glTF with KHR_gaussian_splatting. Also
/// those that parse_gaussians refuses by name.
/// @param head  the first bytes, 64 KiB or all; a glTF is known when its JSON is among them
/// @param size  of the file in bytes
bool looks_like_gaussians(std::span<const std::uint8_t> head, std::uint64_t size);
/// The same of a file; false where it cannot be read, or is standard input.
bool looks_like_gaussians(const std::filesystem::path& file);

/// Reads the files of looks_like_gaussians(). Coordinates are the file's; nodes of a glTF move and
/// turn their splats. The up axis is the format's convention: -y of PLY, SOG, splat and ksplat, +y
/// of SPZ and glTF.
/// @param name    for messages
/// @param bytes   the whole file
/// @param folder  where the buffers of a .gltf, the pictures of a SOG are; empty: none are read
/// @errors kInvalidInput: damaged, no splats, or none that can be kept; names the element and the
///         place. kUnsupported: SPZ 4 and SOG in builds without zstd and WebP, SOG 1, and what a
///         newer version of a format has; says which program makes a file that is read.
/// O(bytes). Memory: the splats, and once more for SPZ, glTF and compressed PLY.
Result<GaussianFile, InputError> parse_gaussians(const std::string& name,
                                                 std::span<const std::uint8_t> bytes,
                                                 const std::filesystem::path& folder = {});
/// The same of a file; "-" is standard input.
/// @errors also kUnreadable, and kLimitExceeded: more than 4 GiB
Result<GaussianFile, InputError> read_gaussians(const std::filesystem::path& file);

/// The file, in axes_of(format). Splats whose up axis is another are turned, harmonics with them;
/// an unknown axis counts as -y. glTF, SPZ 2 and 3, and SOG keep harmonics to degree 3; SOG changes
/// the order of splats. The same bytes for the same splats and any thread count.
/// @param gaussians  turned in place: who moves them in saves a copy
/// @errors as splat_file; kInvalidInput: no splats; those of check_gaussians()
/// O(P), of SOG O(P log P): some tens of microseconds a splat.
Result<std::vector<std::uint8_t>, InputError> gaussian_file(Gaussians gaussians, SplatFormat format,
                                                            int threads = 0);

/// Discs of a light field as Gaussians, in their axes and from their origin.
/// @param up  of these axes
Gaussians gaussians_of(const SplatCloud& splats, UpAxis up);

}  // namespace slf
