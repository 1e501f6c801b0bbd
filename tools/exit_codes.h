// SPDX-License-Identifier: Apache-2.0
// What `slf` returns to the shell. Documented in docs/cli.md and at the end of `slf --help`.
#pragma once

#include "slf/error.h"

namespace slf::tools {

enum ExitCode : int {
  kSuccess = 0,
  kInternal = 1,         ///< a mistake of ours
  kUsage = 2,            ///< unknown option, value out of range, missing argument
  kInputUnreadable = 3,  ///< an input file is missing or cannot be read
  kInputInvalid = 4,     ///< an input was read and cannot be used; damaged streams too
  kLimitExceeded = 5,    ///< larger than the limits, or than the memory
  kUnsupported = 6,    ///< another format version, unknown profile, component left out of the build
  kWriteFailed = 7,    ///< an output could not be written; what was there before is untouched
  kQualityFailed = 8,  ///< eval: below the asked quality
  kCancelled = 130,    ///< SIGINT
};

inline constexpr const char* kExitCodeHelp =
    "Exit codes: 0 success, 1 internal error, 2 usage, 3 input unreadable, 4 input invalid or\n"
    "damaged, 5 limit or memory exceeded, 6 unsupported version or profile, 7 write failed,\n"
    "8 quality check failed, 130 cancelled. An error is one line on standard error; no output\n"
    "file is left behind and an older one of that name survives.";

inline ExitCode exit_code_of(Errc code) {
  switch (code) {
    case Errc::kNotSlf:
    case Errc::kTruncated:
    case Errc::kChecksum:
    case Errc::kOutOfRange:
    case Errc::kReserved:
    case Errc::kInvalidInput:
      return kInputInvalid;
    case Errc::kUnsupported:
      return kUnsupported;
    case Errc::kLimitExceeded:
      return kLimitExceeded;
    case Errc::kInvalidArgument:
      return kUsage;
    case Errc::kUnreadable:
      return kInputUnreadable;
    case Errc::kUnwritable:
      return kWriteFailed;
    case Errc::kCancelled:
      return kCancelled;
  }
  return kInternal;
}

}  // namespace slf::tools
