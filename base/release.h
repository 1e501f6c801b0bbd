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

/// Gives freed memory back to the system, where the allocator keeps it: glibc's does between blocks
/// that are in use, which after a search by trials is most of what the trials had. Milliseconds.
void trim_heap();

}  // namespace slf
