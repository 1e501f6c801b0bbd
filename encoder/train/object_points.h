// SPDX-License-Identifier: Apache-2.0
// Points of the object that photographs show, out of a cloud of everything around it.
#pragma once

#include <cstddef>
#include <span>

#include "slf/capture.h"
#include "slf/error.h"

namespace slf {

struct ObjectPoints {
  PointCloud cloud;          ///< empty where none is left out
  std::size_t left_out = 0;  ///< points of the capture's
};

/// Masks choose one thing of a room whose points are all there, and matches go wrong in front of an
/// even background. A start of such points has hardly any where the object is. So where a quarter
/// of them and more lie outside of the outlines, those are left out; fewer are left to training.
/// @errors those of load_image
/// The same for any thread count. Time: 16 photographs are read, or all where points are left out.
Result<ObjectPoints, InputError> object_points(const Capture& capture, std::span<const int> cameras,
                                               int threads);

}  // namespace slf
