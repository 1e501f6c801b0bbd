// SPDX-License-Identifier: Apache-2.0
// Versions, and what a build can do.
#include "bitstream/parameter_sets.h"
#include "slf/slf.h"

#ifndef SLF_VERSION
#define SLF_VERSION "unknown"
#endif

uint32_t slf_api_version(void) { return SLF_API_VERSION_MAJOR << 16 | SLF_API_VERSION_MINOR; }

const char* slf_version(void) { return SLF_VERSION; }

uint32_t slf_format_version(void) {
  return static_cast<uint32_t>(slf::kVersionMajor) << 16 |
         static_cast<uint32_t>(slf::kVersionMinor);
}

int slf_has_feature(uint32_t feature) {
  switch (feature) {
#if SLF_WITH_DRACO
    case SLF_FEATURE_DRACO:
      return 1;
#endif
#if SLF_WITH_HEVC
    case SLF_FEATURE_HEVC:
      return 1;
#endif
#if !defined(SLF_SERIAL)
    case SLF_FEATURE_THREADS:
      return 1;
#endif
    default:
      return 0;
  }
}
