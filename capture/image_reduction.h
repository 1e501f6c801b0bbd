// SPDX-License-Identifier: Apache-2.0
// Images made smaller by powers of two.
#pragma once

#include "slf/capture.h"

namespace slf {

/// An image of half the size, rounded up, log2 times: means of four pixels, at the border of those
/// that there are; the least of their alphas.
Image reduced(Image image, int log2);

/// The same of a mask: the least of all channels.
Image reduced_mask(Image mask, int log2);

}  // namespace slf
