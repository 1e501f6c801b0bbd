// SPDX-License-Identifier: Apache-2.0
#include "bindings/c/failure.h"

#include <array>
#include <cstddef>
#include <cstring>

#include "bindings/c/sized.h"
#include "bindings/c/text.h"

namespace slf::capi {
namespace {

slf_code code_of(Errc code) {
  switch (code) {
    case Errc::kNotSlf:
      return SLF_NOT_SLF;
    case Errc::kTruncated:
      return SLF_TRUNCATED;
    case Errc::kChecksum:
      return SLF_CHECKSUM;
    case Errc::kOutOfRange:
      return SLF_OUT_OF_RANGE;
    case Errc::kReserved:
      return SLF_RESERVED;
    case Errc::kUnsupported:
      return SLF_UNSUPPORTED;
    case Errc::kLimitExceeded:
      return SLF_LIMIT_EXCEEDED;
    case Errc::kInvalidArgument:
      return SLF_INVALID_ARGUMENT;
    case Errc::kUnreadable:
      return SLF_READ_FAILED;
    case Errc::kCancelled:
      return SLF_CANCELLED;
    case Errc::kInvalidInput:
    case Errc::kUnwritable:
      break;
  }
  return SLF_INTERNAL;
}

slf_code fail(slf_error* to, slf_code code, const Error& from) {
  if (to == nullptr) return code;
  slf_error error = SLF_ERROR_INIT;
  error.code = code;
  error.bit_offset = from.bit_offset;
  Text(error.element) << from.element;
  Text(error.unit) << from.unit;
  Text text(error.message);
  text << slf_code_name(code) << ": " << from.element;
  if (*from.unit != 0) text << " in the " << from.unit << " unit";
  if (has_place(from)) text << ", bit " << from.bit_offset;
  give(error, to);
  return code;
}

}  // namespace

slf_code fail(slf_error* to, slf_code code, const char* argument) {
  return fail(to, code, Error{Errc::kInvalidArgument, argument});
}

slf_code fail(slf_error* to, const Error& error) { return fail(to, code_of(error.code), error); }

}  // namespace slf::capi

const char* slf_code_name(slf_code code) {
  static constexpr std::array<const char*, 13> kNames = {"SLF_OK",
                                                         "SLF_NOT_SLF",
                                                         "SLF_TRUNCATED",
                                                         "SLF_CHECKSUM",
                                                         "SLF_OUT_OF_RANGE",
                                                         "SLF_RESERVED",
                                                         "SLF_UNSUPPORTED",
                                                         "SLF_LIMIT_EXCEEDED",
                                                         "SLF_INVALID_ARGUMENT",
                                                         "SLF_OUT_OF_MEMORY",
                                                         "SLF_CANCELLED",
                                                         "SLF_READ_FAILED",
                                                         "SLF_INTERNAL"};
  const auto i = static_cast<std::size_t>(code);
  return i < kNames.size() ? kNames[i] : "SLF_UNKNOWN";
}
