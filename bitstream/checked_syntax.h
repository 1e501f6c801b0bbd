// SPDX-License-Identifier: Apache-2.0
// Headers to bytes. A coder writes no header that a reader would refuse.
#pragma once

#include <cstdint>
#include <vector>

#include "bitstream/syntax.h"
#include "slf/error.h"

namespace slf {

/// The element that is wrong, its value and its range, as one line.
InputError refusal(const CheckSyntax& check);

/// A header's bytes, whatever its values are: of streams that a decoder must refuse.
/// @param visit  visit(v) visits the elements in their order
template <class Visit>
std::vector<std::uint8_t> header_as_is(const Visit& visit) {
  BitWriter out;
  WriteSyntax write{out};
  visit(write);
  return out.take();
}

/// A header's bytes. Nothing is written before every element was found within its range.
/// @errors kInvalidArgument: the first element that a reader would refuse
template <class Visit>
Result<std::vector<std::uint8_t>, InputError> checked_header(const Visit& visit) {
  CheckSyntax check;
  visit(check);
  if (!check.ok()) return refusal(check);
  return header_as_is(visit);
}

}  // namespace slf
