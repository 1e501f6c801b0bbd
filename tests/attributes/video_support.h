// SPDX-License-Identifier: Apache-2.0
// Skips, by name, of tests that need a video library which this build may lack.
#pragma once

#include <gtest/gtest.h>

#if SLF_WITH_X265 && SLF_WITH_HEVC
#define SLF_NEEDS_HEVC() static_cast<void>(0)
#else
#define SLF_NEEDS_HEVC() GTEST_SKIP() << "needs x265 (SLF_X265) and libde265 (SLF_HEVC)"
#endif

#if SLF_WITH_AV1
#define SLF_NEEDS_AV1() static_cast<void>(0)
#else
#define SLF_NEEDS_AV1() GTEST_SKIP() << "needs libaom (SLF_AV1)"
#endif
