// SPDX-License-Identifier: Apache-2.0
#include "geometry/occupancy_states.h"

namespace slf {

OccupancyStates::OccupancyStates(std::uint64_t points)
    : hashed_bits(hashed_bits_of(points)),
      corner(Corner::kCount),
      slabs(Slabs::kCount),
      beside(Places::kCount),
      latest(Places::kCount),
      rows(kRows) {
  for (auto& contexts : hashed) contexts.resize(std::size_t{1} << hashed_bits);
}

void OccupancyStates::add_reference() {
  if (!reference_faces.empty()) return;
  reference_faces.resize(ReferenceFaces::kCount);
  reference_siblings.resize(ReferenceSiblings::kCount);
  reference_cells.resize(std::size_t{1} << hashed_bits);
  by_reference = WeightSets(ByReference::kCount, kFirstWeight);
  rows.resize(kPredictedRows);
  if (!only_rows.empty()) only_rows.resize(kPredictedRows);
}

}  // namespace slf
