// SPDX-License-Identifier: Apache-2.0
#include "tools/failure.h"

#include <string_view>

#include "slf/frames.h"

namespace slf::tools {
namespace {

const char* cause_of(Errc code) {
  switch (code) {
    case Errc::kNotSlf:
      return "not an .slf file";
    case Errc::kTruncated:
      return "truncated";
    case Errc::kChecksum:
      return "damaged: a checksum does not match";
    case Errc::kOutOfRange:
      return "damaged: a value is out of range";
    case Errc::kReserved:
      return "damaged, or from a newer version: a reserved value is in use";
    case Errc::kUnsupported:
      return "not supported by this slf";
    case Errc::kLimitExceeded:
      return "larger than the decoder's limits";
    case Errc::kInvalidArgument:
      return "the file does not have that many";
    case Errc::kCancelled:
      return "cancelled";
    default:
      return "cannot be used";
  }
}

}  // namespace

Failure failure_of(const InputError& error, const std::string& file) {
  const bool names_itself = file.empty() || error.code == Errc::kInvalidArgument ||
                            error.message.find(file) != std::string::npos;
  return {exit_code_of(error.code), names_itself ? error.message : file + ": " + error.message};
}

Failure failure_of(const Error& error, const std::string& file) {
  if (std::string_view(error.element) == kOneLightField)
    return {exit_code_of(error.code),
            file + ": " + kOneLightField + ": this takes one light field"};
  if (std::string_view(error.element) == kEveryLevel)
    return {exit_code_of(error.code), file + ": " + kEveryLevel};
  return {exit_code_of(error.code), file + ": " + cause_of(error.code) + " (" + where(error) + ")"};
}

std::string input_name(const std::string& file) { return file == "-" ? "standard input" : file; }
std::string output_name(const std::string& file) { return file == "-" ? "standard output" : file; }

}  // namespace slf::tools
