// SPDX-License-Identifier: Apache-2.0
// Values in the middle, and elsewhere in the order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace slf {

/// The value that a share `q` (0 .. 1) of the others is below; 0 without values.
template <class T>
T quantile(std::vector<T> values, double q) {
  if (values.empty()) return T{};
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The middle value, of an even number the upper one; 0 without values.
template <class T>
T median(std::vector<T> values) {
  if (values.empty()) return T{};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace slf
