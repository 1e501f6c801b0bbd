// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace slf {

/// Keeps the values that are marked, in their order. A list that is empty, as one of values that a
/// cloud does not have, stays so.
/// @param kept  [values]
template <class T>
void keep_marked(std::vector<T>& values, const std::vector<bool>& kept) {
  if (values.empty()) return;
  std::size_t next = 0;
  for (std::size_t i = 0; i < kept.size(); ++i)
    if (kept[i]) values[next++] = values[i];
  values.resize(next);
}

}  // namespace slf
