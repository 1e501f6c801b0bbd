// SPDX-License-Identifier: Apache-2.0
// A program with this has an operator new that fails when it is told to, and counts.
#pragma once

#include <atomic>

namespace slf::test {

/// Allocations that succeed from now on; then all fail. Below 0: as many as one likes.
extern std::atomic<long> allocations_left;
/// Bytes that are allocated and not freed.
extern std::atomic<long> live_bytes;
/// The most that it has been since this was set.
extern std::atomic<long> most_live_bytes;

}  // namespace slf::test
