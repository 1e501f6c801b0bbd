// SPDX-License-Identifier: Apache-2.0
// Numbers out of the binary chunk of a GLB file. glTF 2.0, 3.6.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "capture/gltf_buffers.h"
#include "capture/json.h"

namespace slf {

/// The arrays that accessors lead through.
struct GlbData {
  JsonItems accessors, buffer_views, buffers;
  GltfBuffers contents;
};

/// A whole number of an object, 0 .. most; `otherwise` where it is absent.
/// @errors kInvalidInput
Result<std::uint64_t, InputError> glb_number(const JsonView& json, const char* key,
                                             std::uint64_t otherwise, std::uint64_t most);

/// The item of `list` that a number names.
Result<JsonView, InputError> glb_item(const JsonView& json, const JsonItems& list,
                                      const char* kind);

/// The bytes of a view, all of them in its buffer.
Result<std::span<const std::uint8_t>, InputError> glb_view_bytes(const GlbData& data,
                                                                 const JsonView& view);

/// [count][components], normalised integers as 0 .. 1 or -1 .. 1.
/// @param type  "VEC3", ...: what it has to be
/// @errors kInvalidInput: what is not within the chunk; sparse or compressed accessors; buffers
///         that are not in the file.
Result<std::vector<double>, InputError> read_accessor(const GlbData& data, const JsonView& accessor,
                                                      const char* type, std::size_t components);

}  // namespace slf
