// SPDX-License-Identifier: Apache-2.0
// The transforms across planes of a stream, from their units. Spec 7.11.
#pragma once

#include <vector>

#include "attributes/coefficient_models.h"
#include "attributes/plane_transform.h"
#include "bitstream/parameter_sets.h"
#include "bitstream/units.h"

namespace slf {

/// Functions of the groups from `first` on, by group.
std::vector<std::uint16_t> functions_of_groups(const PlaneGroups& groups, std::size_t first,
                                               std::size_t count);

/// The columns that stand for the functions of a group. groups: all of the sequence
ColumnRange columns_of_group(const PlaneTransform& t, const PlaneGroups& groups, std::size_t group);

/// The transforms in stream order, their matrices 0.
/// @param units   in order (collect_units)
/// @param groups  all of the sequence
/// @errors kOutOfRange: groups do not ascend, or a matrix is too large.
Result<std::vector<PlaneTransform>> collect_transforms(const Units& units,
                                                       const PlaneGroups& groups);

/// The matrices, of the coefficient units of the first `kept` groups that are there; else 0.
/// @errors kOutOfRange: not a matrix, or columns of a group that has none; those of headers
Result<Done> read_matrices(const Units& units, const SequenceParameterSet& set,
                           const PlaneGroups& groups, std::size_t kept,
                           std::vector<PlaneTransform>& transforms);

/// The functions that components stand in, and the groups as places among them. Spec 8.7.1.
struct CodedFunctions {
  std::vector<std::uint16_t> functions;  ///< [R] ascending
  PlaneGroups groups;                    ///< places 0 .. R - 1, ascending in a group
};

/// @param groups      those to code, of all K functions
/// @param transforms  told where their components stand; of those whose groups are left out, none
CodedFunctions code_functions(PlaneGroups groups, std::vector<PlaneTransform>& transforms);

}  // namespace slf
