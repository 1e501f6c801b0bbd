// The transforms across planes of a stream, from their units. Spec 7.11.
#pragma once

#include <vector>

#include "attributes/coefficient_decoder.h"
#include "attributes/plane_transform.h"
#include "bitstream/parameter_sets.h"
#include "bitstream/units.h"

namespace slf {

/// Functions of the groups from `first` on, by group.
std::vector<std::uint16_t> functions_of_groups(const PlaneGroups& groups, std::size_t first,
                                               std::size_t count);

/// The transforms in stream order. They stand before the first slice unit, over ascending groups.
/// @param groups  all of the sequence
/// @errors kOutOfRange: one is missing, too many, out of order or not a matrix.
Result<std::vector<PlaneTransform>> collect_transforms(const Units& units,
                                                       const SequenceParameterSet& set,
                                                       const PlaneGroups& groups);

/// What is coded of every group: without the functions that no component stands in.
PlaneGroups coded_groups(PlaneGroups groups, const std::vector<PlaneTransform>& transforms);

}  // namespace slf
