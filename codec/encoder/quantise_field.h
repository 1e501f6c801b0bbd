// SPDX-License-Identifier: Apache-2.0
// What quantisation leaves of a light field, without coding it.
#pragma once

#include "slf/encoder.h"
#include "slf/types.h"

namespace slf {

/// The light field that a decoder gets of one coded with these parameters: the same transforms
/// across planes, prediction and quantiser, as one slice without a base.
/// @param field       positions in Morton order, no texture
/// @param scale       points of the scene that each of these stands for: what transforms pay for
/// @errors those of pack
/// The same for any thread count of one binary. O(points (levels + planes)).
Result<LightField, InputError> quantise_field(const LightField& field, CodingParameters parameters,
                                              double scale);

}  // namespace slf
