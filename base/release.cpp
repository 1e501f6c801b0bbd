// SPDX-License-Identifier: Apache-2.0
#include "base/release.h"

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace slf {

void trim_heap() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace slf
