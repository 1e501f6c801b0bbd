// SPDX-License-Identifier: Apache-2.0
// The bytes of glTF's buffers, wherever they are. glTF 2.0, 3.6.1.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "capture/json.h"

namespace slf {

/// Decodes base 64 (RFC 4648), with padding or without; nothing where it is damaged.
std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text);

class GltfBuffers {
 public:
  /// @param buffers  of the document
  /// @param binary   the chunk of a GLB, kept by reference; empty: there is none
  /// @param folder   where files of a .gltf are; empty: none are read
  /// @errors kInvalidInput: a data URI that is damaged, a path out of the folder; kUnreadable
  static Result<GltfBuffers, InputError> load(const JsonItems& buffers,
                                              std::span<const std::uint8_t> binary,
                                              const std::filesystem::path& folder);

  /// Nothing where the buffer is a file that is not read.
  std::optional<std::span<const std::uint8_t>> of(std::size_t buffer) const;
  std::size_t bytes() const;  ///< of all of them

 private:
  std::span<const std::uint8_t> binary_;
  std::vector<std::optional<std::vector<std::uint8_t>>> own_;  // [buffers]
  std::vector<bool> in_chunk_;
};

}  // namespace slf
