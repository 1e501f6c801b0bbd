// SPDX-License-Identifier: Apache-2.0
// One grid for clouds of several instants.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "slf/plenoptic.h"

namespace slf {

/// Clouds whose voxels are those of the first, wherever their grids begin.
class PlenopticGrid {
 public:
  /// @param cloud  has points
  /// @errors kInvalidInput: voxels of another size, or between those of the first
  Result<Done, InputError> add(const PlenopticCloud& cloud);
  /// That of the first where all begin with it, as large as the largest. Else it begins with the
  /// lowest point. A cloud was added.
  /// @errors kInvalidInput: more than 21 bits
  Result<Grid, InputError> grid() const;

 private:
  std::optional<Grid> first_;
  bool same_origin_ = true;
  std::array<std::int64_t, 3> low_{}, high_{};  // voxels of the first grid
};

}  // namespace slf
