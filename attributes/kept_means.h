// SPDX-License-Identifier: Apache-2.0
// Means of nodes that are kept for the frame after, and what they say of its root. Spec 8.12.4.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "attributes/transform_levels.h"

namespace slf {

/// Means of the nodes that begin at these rows, of planes begin .. end - 1.
void keep_means(std::span<const std::int32_t> values, std::span<const std::uint32_t> rows,
                std::span<const NodePlace> places, std::size_t planes, std::size_t begin,
                std::size_t end, std::vector<std::int32_t>& means);

/// What the reference says of row 0 of a frame of `weight` points: of its root.
std::int32_t predicted_root(std::int32_t mean, std::uint32_t weight);

/// Adds it to what was coded of row 0.
void predict_root(std::span<const std::int32_t> means, std::size_t points,
                  std::span<std::int32_t> row);

}  // namespace slf
