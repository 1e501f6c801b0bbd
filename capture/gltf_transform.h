// SPDX-License-Identifier: Apache-2.0
// Transforms of glTF's nodes.
#pragma once

#include <array>

#include "capture/json.h"
#include "slf/types.h"

namespace slf {

using NodeMatrix = std::array<std::array<double, 4>, 3>;  ///< rows of an affine transform

NodeMatrix product(const NodeMatrix& a, const NodeMatrix& b);
Vec3 moved_by(const NodeMatrix& m, const Vec3& p);
/// Transposed inverse, but for its length: what normals take.
NodeMatrix cofactors(const NodeMatrix& m);
bool mirrors(const NodeMatrix& m);

/// glTF 2.0, 3.5.3: "matrix" by columns, or scale, then rotation, then translation.
/// @errors kInvalidInput
Result<NodeMatrix, InputError> transform_of(const JsonView& node);

}  // namespace slf
