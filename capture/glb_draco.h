// SPDX-License-Identifier: Apache-2.0
// KHR_draco_mesh_compression of a primitive.
#pragma once

#include <optional>

#include "capture/draco_mesh.h"
#include "capture/glb_accessor.h"

namespace slf {

/// The mesh of a primitive that Draco compressed, at most as large as its accessors say; nothing
/// where it is not compressed.
/// @errors kInvalidInput: names the place in the JSON chunk
Result<std::optional<DracoMesh>, InputError> draco_mesh_of(const GlbData& data,
                                                           const JsonView& primitive);

}  // namespace slf
