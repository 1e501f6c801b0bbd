// SPDX-License-Identifier: Apache-2.0
// The one place of capture/ that includes Draco: meshes that it compressed, as GLB files have them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "slf/error.h"

namespace slf {

/// What is wanted of a compressed mesh, and how large it may be.
struct DracoRequest {
  std::uint32_t position = 0;           ///< unique id of the attribute
  std::optional<std::uint32_t> normal;  ///< the same
  std::uint64_t max_points = 0, max_faces = 0;
};

struct DracoMesh {
  std::vector<double> positions;  ///< [points][3]
  std::vector<double> normals;    ///< [points][3]; or empty
  std::vector<double> indices;    ///< [faces][3], each below points
};

/// Nothing is allocated by numbers of the header that the request does not allow.
/// @return a cause where it is refused
Result<DracoMesh, const char*> decode_draco_mesh(std::span<const std::uint8_t> bytes,
                                                 const DracoRequest& request);

}  // namespace slf
