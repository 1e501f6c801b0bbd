// Inverse transform and the means of coarser levels. Spec 8.8, 8.9.
#pragma once

#include <cstdint>
#include <span>

#include "attributes/raht_tree.h"

namespace slf {

/// Values are [rows][planes], row-major; transform coefficients in, values out, in place. Every
/// |coefficient| is below 2^27, which bounds every intermediate below 2^31 (spec 8.8.2).
void raht_inverse(const RahtTree& tree, int planes, std::span<std::int32_t> values, int threads);

/// The mean of a node of `weight` points, from the value raht_inverse leaves in its row.
std::int32_t node_mean(std::int32_t value, std::uint32_t weight);

}  // namespace slf
