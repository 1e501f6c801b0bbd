// SPDX-License-Identifier: Apache-2.0
// A number as a person writes it.
#pragma once

#include <charconv>
#include <string>

namespace slf {

/// The shortest text that reads back as the same number: "1e-09", where std::to_string has
/// "0.000000".
template <class Number>
std::string shortest(Number number) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, number).ptr};
}

}  // namespace slf
