// SPDX-License-Identifier: Apache-2.0
// Memory given back before its owner goes.
#pragma once

#include <vector>

namespace slf {

/// `v = {}` and clear() keep the memory for values to come.
template <class T>
void release(std::vector<T>& v) {
  std::vector<T>().swap(v);
}

}  // namespace slf
