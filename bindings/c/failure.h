// SPDX-License-Identifier: Apache-2.0
// Errors on their way to a C caller.
#pragma once

#include <new>
#include <stdexcept>

#include "slf/error.h"
#include "slf/slf.h"

namespace slf::capi {

/// Fills `to`, where it is given, as far as its size goes. @return the code
slf_code fail(slf_error* to, const Error& error);
/// A failure of the call itself, not of the stream.
slf_code fail(slf_error* to, slf_code code, const char* argument);
inline slf_code invalid(slf_error* to, const char* argument) {
  return fail(to, SLF_INVALID_ARGUMENT, argument);
}

/// Nothing is thrown across the boundary. Without exceptions a lack of memory ends the program
/// before it gets here.
template <class Body>
slf_code guarded(slf_error* error, const Body& body) {
#if defined(__cpp_exceptions)
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return fail(error, SLF_OUT_OF_MEMORY, "memory");
  } catch (const std::length_error&) {
    return fail(error, SLF_OUT_OF_MEMORY, "memory");
  } catch (...) {
    return fail(error, SLF_INTERNAL, "library");
  }
#else
  static_cast<void>(error);
  return body();
#endif
}

}  // namespace slf::capi
