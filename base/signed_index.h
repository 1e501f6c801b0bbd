// SPDX-License-Identifier: Apache-2.0
// Indices of containers for libraries that count with a sign.
#pragma once

#include <cstddef>

namespace slf {

/// As Eigen::Index is by default.
constexpr std::ptrdiff_t index(std::size_t i) { return static_cast<std::ptrdiff_t>(i); }

}  // namespace slf
