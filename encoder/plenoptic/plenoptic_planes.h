// SPDX-License-Identifier: Apache-2.0
// Views as functions without a meaning: the way of planes.
#pragma once

#include "encoder/plenoptic/plenoptic_metadata.h"
#include "slf/plenoptic.h"

namespace slf {

/// Is the own colour the rounded mean of the views at every point?
bool own_is_mean(const PlenopticCloud& cloud);

/// The field whose functions are the colours that are coded.
/// @param shift  of the components: finer steps than a grey level
LightField field_of_planes(const PlenopticCloud& cloud, const PlenopticRecord& record, int shift);

/// The coded bytes of a decoded field: [P][colours that are coded][3].
std::vector<std::uint8_t> bytes_of_planes(const LightField& field, int threads);

/// Those of a cloud, in the order of its colours.
std::vector<std::uint8_t> coded_bytes(const PlenopticCloud& cloud, const PlenopticRecord& record);

/// Puts the coded bytes in the cloud's place, and the mean of views where it is not coded.
void set_colours(std::vector<std::uint8_t> coded, const PlenopticRecord& record,
                 PlenopticCloud& cloud);

}  // namespace slf
