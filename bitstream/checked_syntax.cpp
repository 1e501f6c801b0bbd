// SPDX-License-Identifier: Apache-2.0
#include "bitstream/checked_syntax.h"

namespace slf {

InputError refusal(const CheckSyntax& check) {
  std::string cause = std::string(check.element) + ": does not go with the rest of the header";
  if (check.range.min <= check.range.max)
    cause = std::string(check.element) + ": " + std::to_string(check.found) + ", not " +
            std::to_string(check.range.min) + " to " + std::to_string(check.range.max);
  return {Errc::kInvalidArgument, cause};
}

}  // namespace slf
