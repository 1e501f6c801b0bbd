// SPDX-License-Identifier: Apache-2.0
#include "tools/text.h"

#include <sys/resource.h>

#include <charconv>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace slf::tools {

std::string text(const char* format, ...) {
  std::va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, arguments);
  va_end(arguments);
  std::string out(length > 0 ? static_cast<std::size_t>(length) : 0, '\0');
  std::vsnprintf(out.data(), out.size() + 1, format, again);
  va_end(again);
  return out;
}

std::string shortest(double number) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, number).ptr};
}

std::string psnr_text(double psnr) {
  return std::isnan(psnr) ? text("%6s dB", "-") : text("%6.2f dB", psnr);
}

std::string grouped(std::uint64_t number) {
  const std::string digits = std::to_string(number);
  std::string out;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) out += ',';
    out += digits[i];
  }
  return out;
}

Outcome print(const std::string& out) {
  const bool written = std::fwrite(out.data(), 1, out.size(), stdout) == out.size();
  if (!written || std::fflush(stdout) != 0)
    return Failure{kWriteFailed, "standard output: cannot be written"};
  return Done{};
}

Outcome print(const nlohmann::ordered_json& json) { return print(to_text(json)); }

void warn(const std::string& message, bool quiet) {
  if (!quiet) std::fprintf(stderr, "slf: warning: %s\n", printable(message).c_str());
}

void warn(const std::vector<std::string>& messages, bool quiet) {
  for (const std::string& message : messages) warn(message, quiet);
}

double peak_memory_mib() {
  struct rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts in KiB
}

}  // namespace slf::tools
