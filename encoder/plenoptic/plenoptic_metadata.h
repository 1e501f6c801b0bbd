// SPDX-License-Identifier: Apache-2.0
// What a file says of the cloud that it was made from.
#pragma once

#include <string>
#include <vector>

#include "slf/plenoptic.h"

namespace slf {

/// Values of the keys "plenoptic..." (docs/plenoptic.md).
struct PlenopticRecord {
  PlenopticCoding as = PlenopticCoding::kPlanes;
  bool exact = false;  ///< a unit of corrections belongs to the file
  bool mean = false;   ///< the own colour is the rounded mean of the views, and no plane
  std::vector<int> hold_out;
  std::vector<Vec3> view_positions;
  std::vector<PlenopticProperty> properties;
  std::size_t views = 0;    ///< as the properties have it
  bool own_colour = false;  ///< the same
};

Metadata write_record(const PlenopticRecord& record);

/// @errors kInvalidInput: names the key
Result<PlenopticRecord, InputError> read_record(const Metadata& metadata);

}  // namespace slf
