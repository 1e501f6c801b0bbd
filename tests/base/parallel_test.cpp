// SPDX-License-Identifier: Apache-2.0
#include "slf/parallel.h"

#include <gtest/gtest.h>

#include <new>
#include <numeric>
#include <vector>

namespace slf::parallel_test {
namespace {

TEST(Parallel, EveryItemIsGivenOnceInRangesThatDoNotDependOnThreads) {
  for (const int threads : {1, 2, 7}) {
    std::vector<int> given(1000, 0);
    parallel_ranges(given.size(), 64, threads, [&](std::size_t begin, std::size_t end) {
      EXPECT_EQ(begin % 64, 0u);
      EXPECT_LE(end - begin, 64u);
      for (std::size_t i = begin; i < end; ++i) ++given[i];
    });
    EXPECT_EQ(given, std::vector<int>(1000, 1));
  }
  parallel_ranges(0, 1, 2, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(Parallel, AnExceptionOfAnyThreadReachesTheCaller) {
  for (const int threads : {1, 4})
    EXPECT_THROW(
        parallel_ranges(100, 1, threads, [](std::size_t, std::size_t) { throw std::bad_alloc(); }),
        std::bad_alloc);
}

}  // namespace
}  // namespace slf::parallel_test
