// SPDX-License-Identifier: Apache-2.0
// Well-known text, as far as it is told from what is none: what it means is for others.
#include <algorithm>
#include <array>
#include <string_view>

#include "capture/wkt.h"
#include "slf/capture.h"

namespace slf {
namespace {

constexpr std::uint64_t kMostBytesOfCrs = std::uint64_t{1} << 16;

/// Words for all that a text may be about, in both versions.
constexpr std::array<std::string_view, 18> kKeywords{
    "GEOGCS",  "PROJCS",   "GEOCCS",      "COMPD_CS",     "VERT_CS",     "LOCAL_CS",
    "GEODCRS", "GEOGCRS",  "PROJCRS",     "GEODETICCRS",  "VERTCRS",     "GEOGRAPHICCRS",
    "ENGCRS",  "BOUNDCRS", "COMPOUNDCRS", "PROJECTEDCRS", "VERTICALCRS", "ENGINEERINGCRS"};

}  // namespace

bool is_wkt(std::string_view text) {
  const std::size_t end = text.find_first_of("[(");
  if (end == std::string_view::npos) return false;
  const std::string_view keyword = text.substr(0, end);
  if (std::find(kKeywords.begin(), kKeywords.end(), keyword) == kKeywords.end()) return false;
  bool quoted = false;
  int open = 0;
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\r' && c != '\t') return false;
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    open += (c == '[' || c == '(') - (c == ']' || c == ')');
    if (open < 0) return false;
  }
  return open == 0 && !quoted;
}

Result<std::string, InputError> read_crs(const std::filesystem::path& file) {
  SLF_TRY(const auto bytes, read_file(file, kMostBytesOfCrs));
  std::string text(bytes.begin(), bytes.end());
  constexpr const char* kSpace = " \t\r\n";
  text.erase(0, text.find_first_not_of(kSpace));
  text.erase(text.find_last_not_of(kSpace) + 1);
  if (is_wkt(text)) return text;
  return InputError{Errc::kInvalidInput,
                    file.string() + ": not the well-known text of a coordinate system"};
}

}  // namespace slf
