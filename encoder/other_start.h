// SPDX-License-Identifier: Apache-2.0
// Points that a surface starts with in place of the capture's own.
#pragma once

#include <optional>
#include <span>

#include "encoder/train/starting_points.h"
#include "slf/encoder.h"

namespace slf {

/// The capture's points lie so close that no photograph shows holes between them.
bool is_dense(const Capture& capture, std::span<const int> cameras);

/// What takes the place of the capture's points and mesh: where it has none, where points are few
/// and the outlines' hull says the same with more, and points of a mesh that is to be mended or to
/// start training. Nothing: they stay.
/// @errors those of starting_points, of captures without points
Result<std::optional<StartingPoints>, InputError> other_start(const Capture& capture,
                                                              std::span<const int> cameras,
                                                              const EncoderSettings& settings);

}  // namespace slf
