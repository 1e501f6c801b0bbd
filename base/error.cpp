// SPDX-License-Identifier: Apache-2.0
#include "slf/error.h"

namespace slf {

const char* to_string(Errc code) {
  switch (code) {
    case Errc::kNotSlf:
      return "kNotSlf";
    case Errc::kTruncated:
      return "kTruncated";
    case Errc::kChecksum:
      return "kChecksum";
    case Errc::kOutOfRange:
      return "kOutOfRange";
    case Errc::kReserved:
      return "kReserved";
    case Errc::kUnsupported:
      return "kUnsupported";
    case Errc::kLimitExceeded:
      return "kLimitExceeded";
    case Errc::kInvalidArgument:
      return "kInvalidArgument";
    case Errc::kUnreadable:
      return "kUnreadable";
    case Errc::kInvalidInput:
      return "kInvalidInput";
    case Errc::kUnwritable:
      return "kUnwritable";
    case Errc::kCancelled:
      return "kCancelled";
  }
  return "kUnknown";
}

std::string where(const Error& error) {
  std::string text;
  if (const FormatVersions& versions = error.versions; versions.read != 0)
    text = "format " + std::to_string(versions.major) + "." + std::to_string(versions.minor) +
           ", where " + std::to_string(versions.read) + ".x is read: ";
  text += error.element;
  if (*error.unit != 0) text += std::string(" in the ") + error.unit + " unit";
  if (has_place(error)) text += ", bit " + std::to_string(error.bit_offset);
  return text;
}

std::string to_string(const Error& error) {
  return std::string(to_string(error.code)) + ": " + where(error);
}

}  // namespace slf
