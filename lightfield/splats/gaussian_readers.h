// SPDX-License-Identifier: Apache-2.0
// The formats of splats that are read, one file each. The first of a pair tells them by their
// content, the second reads them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "lightfield/splats/gaussian_collector.h"

namespace slf {

using FileBytes = std::span<const std::uint8_t>;

/// PLY as 3-D Gaussian splatting and its relatives write it: columns by name.
bool is_gaussian_ply(FileBytes head, std::uint64_t size);
Result<GaussianFile, InputError> read_gaussian_ply(const std::string& name, FileBytes bytes);

/// SuperSplat's compressed PLY.
bool is_compressed_ply(FileBytes head, std::uint64_t size);
Result<GaussianFile, InputError> read_compressed_ply(const std::string& name, FileBytes bytes);

/// SPZ, versions 1 to 3, and 4 in builds with zstd; else it is refused by name.
bool is_spz(FileBytes head);
Result<GaussianFile, InputError> read_spz(const std::string& name, FileBytes bytes);

/// 32 bytes a splat and nothing else.
bool is_splat(FileBytes head, std::uint64_t size);
Result<GaussianFile, InputError> read_splat(const std::string& name, FileBytes bytes);

/// GaussianSplats3D's format, version 0.1.
bool is_ksplat(FileBytes head, std::uint64_t size);
Result<GaussianFile, InputError> read_ksplat(const std::string& name, FileBytes bytes);

/// PlayCanvas' bundle of pictures, or the text that stands beside them; refused by name in builds
/// without WebP.
bool is_sog(FileBytes head);
Result<GaussianFile, InputError> read_sog(const std::string& name, FileBytes bytes,
                                          const std::filesystem::path& folder);
InputError refuse_sog(const std::string& name);

/// glTF or GLB with KHR_gaussian_splatting.
bool is_gaussian_gltf(FileBytes head);
Result<GaussianFile, InputError> read_gaussian_gltf(const std::string& name, FileBytes bytes,
                                                    const std::filesystem::path& folder);

/// Little endian; the caller has checked that they are there.
inline std::uint32_t word_at(FileBytes bytes, std::size_t at, std::size_t count) {
  std::uint32_t word = 0;
  for (std::size_t i = count; i-- > 0;) word = word << 8 | bytes[at + i];
  return word;
}

}  // namespace slf
