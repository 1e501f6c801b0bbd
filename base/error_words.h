// SPDX-License-Identifier: Apache-2.0
// An error of a bitstream, for the message of a file that holds more than one.
#pragma once

#include <string>

#include "slf/error.h"

namespace slf {

/// "damaged (igc_images, bit 9400)": what a person can do about it, then where it is.
inline std::string in_words(const Error& error) {
  const char* cause = "damaged";
  if (error.code == Errc::kTruncated) cause = "truncated";
  if (error.code == Errc::kLimitExceeded) cause = "larger than the decoder's limits";
  if (error.code == Errc::kUnsupported) cause = "not supported by this slf";
  if (error.code == Errc::kCancelled) cause = "cancelled";
  return std::string(cause) + " (" + where(error) + ")";
}

}  // namespace slf
