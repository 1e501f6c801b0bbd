// SPDX-License-Identifier: Apache-2.0
// The two errors that most steps of an encoder end in.
#pragma once

#include <string>
#include <utility>

#include "slf/error.h"

namespace slf {

/// A setting or an argument is outside its documented range.
inline InputError invalid_argument(std::string message) {
  return {Errc::kInvalidArgument, std::move(message)};
}

/// A file was read, and its content cannot be used.
inline InputError invalid_input(std::string message) {
  return {Errc::kInvalidInput, std::move(message)};
}

}  // namespace slf
