// SPDX-License-Identifier: Apache-2.0
// Where an error is, as seen by whoever called the function that found it.
#pragma once

#include <cstdint>

#include "slf/error.h"

namespace slf {

/// An error of bytes that begin at bit `begin`: its place counted from the caller's first bit.
template <class T>
Result<T> counted_from(std::uint64_t begin, Result<T> result) {
  if (result) return result;
  Error error = result.error();
  error.bit_offset += begin;
  return error;
}

}  // namespace slf
