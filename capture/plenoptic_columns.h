// SPDX-License-Identifier: Apache-2.0
// Which properties of a PLY's vertices are the colours of views.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "capture/ply_header.h"
#include "slf/error.h"

namespace slf {

/// Which bytes of vertices may be colours.
enum class PlenopticNames {
  kAny,         ///< whatever their names: of a cloud that was taken for plenoptic before
  kNoneOfScans  ///< "classification", "ring" and others of scans (LAS, lidar) are none
};

struct PlenopticColumns {
  /// [properties] 0, 1, 2: x, y, z; 3 + i: byte i of the colours of a point; nothing: left out
  std::vector<std::optional<std::size_t>> place;
  bool own_colour = false;  ///< red, green, blue are there: the first three bytes
  std::size_t views = 0;    ///< 0: no plenoptic cloud
  std::string taken;        ///< "13 views: red_0 green_0 blue_0 ... blue_12"
  std::string left_out;     ///< names; or empty
};

/// By file order; red, green, blue are the own colour of a point. A cloud of one triple is no
/// plenoptic one, and splats are none.
/// @errors kInvalidInput, without the file's name: bytes that are no whole triples, a triple whose
///         names say that a channel is missing, more than kMostViews
Result<PlenopticColumns, InputError> plenoptic_columns(const PlyElement& vertex,
                                                       PlenopticNames names = PlenopticNames::kAny);

}  // namespace slf
