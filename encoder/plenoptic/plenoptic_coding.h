// SPDX-License-Identifier: Apache-2.0
// What a plenoptic cloud alone and frames of such clouds have in common on their way to bytes.
#pragma once

#include <string>
#include <vector>

#include "encoder/fit_capture.h"
#include "encoder/plenoptic/plenoptic_metadata.h"
#include "slf/encoder.h"
#include "slf/plenoptic.h"

namespace slf {

/// @errors kInvalidInput: parts of the cloud that do not go together, by name
Result<Done, InputError> check_plenoptic_cloud(const PlenopticCloud& cloud);

/// Those that a file of the cloud has: its own, or made up where it has none.
std::vector<PlenopticProperty> properties_of(const PlenopticCloud& cloud);

/// @errors kInvalidArgument, kInvalidInput: a setting that such clouds do not have, views that are
///         not there
Result<Done, InputError> check_plenoptic(const PlenopticCloud& cloud,
                                         const PlenopticSettings& settings, PlenopticCoding as);

/// The way, and why.
PlenopticCoding choose_coding(const PlenopticSettings& settings, std::string& reason);

/// Without what is known of the points alone: exact, mean.
PlenopticRecord record_of(const PlenopticCloud& cloud, const PlenopticSettings& settings,
                          PlenopticCoding as);

/// What encoder_metadata asks for, where there are no cameras.
/// @param cloud  perhaps without its points
/// @param fit    of view maps, or null
Metadata plenoptic_metadata(const PlenopticCloud& cloud, const EncoderSettings& settings,
                            const PlenopticRecord& record, const ChosenFit* fit,
                            std::size_t points);

/// How planes are coded.
struct PlanesCoding {
  int shift = 0;  ///< of the components
  double q = 0;   ///< grey levels
  CodingParameters parameters;
};
/// @param cloud   its views and its grid; its points are not looked at
/// @param record  whose `mean` is known; receives whether the file is exact: no step was given
PlanesCoding planes_coding(const PlenopticCloud& cloud, EncoderSettings settings,
                           PlenopticRecord& record);

/// The degree as far as memory goes.
/// @param points  of the cloud
/// @errors kLimitExceeded: most_memory is not enough
Result<Done, InputError> limit_memory(const PlenopticSettings& settings,
                                      const PlenopticCloud& cloud, std::uint64_t points,
                                      PlenopticCoding as, Basis& basis);

}  // namespace slf
