// SPDX-License-Identifier: Apache-2.0
// Photographs of an analytic scene.
#pragma once

#include "slf/capture.h"
#include "tools/synth/scene.h"

namespace slf::synth {

/// One image by ray tracing, supersampling x supersampling rays per pixel averaged in linear light,
/// display values out. Display grey 128 where nothing is. Distortion is not looked at.
Image trace_image(const Subject& subject, const Camera& camera, int supersampling);

}  // namespace slf::synth
