// SPDX-License-Identifier: Apache-2.0
// A decision that processors foresee.
#pragma once

namespace slf {

/// `bit`, 0 or 1, by way of a branch: a processor guesses it and goes on with what depends on it.
/// For decisions most of which are easy to foresee; of others a wrong guess costs more than the
/// wait.
inline unsigned by_branch(unsigned bit) {
#if defined(__GNUC__) && !defined(__wasm__)
  unsigned value = 0;
  if (bit != 0) {
    value = 1;
    asm("" : "+r"(value));  // or compilers make one value of both
  } else {
    asm("" : "+r"(value));
  }
  return value;
#else
  return bit;
#endif
}

}  // namespace slf
