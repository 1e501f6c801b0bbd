// SPDX-License-Identifier: Apache-2.0
#include "failure.h"

namespace slf::python {
namespace {

/// "kOutOfRange" to "SLF_OUT_OF_RANGE".
std::string c_name(Errc code) {
  std::string name = "SLF";
  for (const char c : std::string(to_string(code)).substr(1)) {
    const bool capital = c >= 'A' && c <= 'Z';
    if (capital) name += '_';
    name += capital || c < 'a' ? c : static_cast<char>(c - 'a' + 'A');
  }
  return name;
}

}  // namespace

Failure failure_of(const InputError& error) {
  Failure failure;
  failure.code = c_name(error.code);
  failure.message = error.message;
  return failure;
}

Failure failure_of(const Error& error) {
  Failure failure;
  failure.code = c_name(error.code);
  failure.message = to_string(error);
  failure.element = error.element;
  failure.unit = error.unit;
  failure.bit_offset = error.bit_offset;
  return failure;
}

}  // namespace slf::python
