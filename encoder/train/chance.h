// SPDX-License-Identifier: Apache-2.0
// Numbers that look like chance and are the same everywhere. Vigna, splitmix64.
#pragma once

#include <cstdint>

namespace slf {

struct Chance {
  std::uint64_t state;

  std::uint64_t next() {
    std::uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// 0 .. 1, without 1
  double share() { return double(next() >> 11) * 0x1p-53; }
};

}  // namespace slf
