// SPDX-License-Identifier: Apache-2.0
// Why a verb stopped: an exit code and the one line that a person reads.
#pragma once

#include <string>
#include <utility>

#include "slf/error.h"
#include "tools/exit_codes.h"

namespace slf::tools {

struct Failure {
  ExitCode code = kInternal;
  std::string message;  ///< file (or option) and cause; without "slf: ", no full stop. main()
                        ///< shows it as one line that cannot steer a terminal
};

using Outcome = Result<Done, Failure>;

/// @param file  the input or output that was worked on; put in front where the message lacks it.
///              A wrong setting names itself and gets no file. Empty: nothing is put in front.
Failure failure_of(const InputError& error, const std::string& file);
Failure failure_of(const Error& error, const std::string& file);

/// The result of a library call, its error turned into a Failure that names `file`.
template <class T, class E>
Result<T, Failure> from(const std::string& file, Result<T, E> result) {
  if (!result) return failure_of(result.error(), file);
  return *std::move(result);
}

/// "-" as a person reads it.
std::string input_name(const std::string& file);
std::string output_name(const std::string& file);

}  // namespace slf::tools
