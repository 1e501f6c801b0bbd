// SPDX-License-Identifier: Apache-2.0
// What goes wrong becomes an exception of slf._errors.
#pragma once

#include <cstdint>
#include <exception>
#include <string>

#include "slf/error.h"

namespace slf::python {

struct Failure : std::exception {
  std::string code;  ///< "SLF_OUT_OF_RANGE", as slf_code_name() spells it
  std::string message, element, unit;
  std::uint64_t bit_offset = 0;

  const char* what() const noexcept override { return message.c_str(); }
};

Failure failure_of(const InputError& error);
Failure failure_of(const Error& error);

/// The value, or the exception.
template <class T, class E>
T value_of(Result<T, E> result) {
  if (!result) throw failure_of(result.error());
  return *std::move(result);
}

}  // namespace slf::python
