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
  }
  return "kUnknown";
}

std::string to_string(const Error& error) {
  return std::string(to_string(error.code)) + ": " + error.element + ", bit " +
         std::to_string(error.bit_offset);
}

}  // namespace slf
