// SPDX-License-Identifier: Apache-2.0
#include "capture/frame_names.h"

#include <charconv>

namespace slf {

namespace {

constexpr std::size_t kMostDigits = 9;  // of kMostFrameNumber

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

std::string FramePattern::name_of(std::uint32_t number) const {
  const std::string digits = std::to_string(number);
  return before + std::string(digits.size() < width ? width - digits.size() : 0, '0') + digits +
         behind;
}

std::string FramePattern::text() const {
  std::string out = before + '%';
  if (width > 1) out.append("0").append(std::to_string(width));
  return out + 'd' + behind;
}

std::optional<std::uint32_t> FramePattern::number_of(std::string_view name) const {
  if (name.size() <= before.size() + behind.size() || !name.starts_with(before) ||
      !name.ends_with(behind))
    return std::nullopt;
  const std::string_view digits =
      name.substr(before.size(), name.size() - before.size() - behind.size());
  if (digits.size() < width || digits.size() > kMostDigits) return std::nullopt;
  for (const char c : digits)
    if (!is_digit(c)) return std::nullopt;
  if (digits.size() > width && digits.front() == '0') return std::nullopt;
  std::uint32_t number = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return number;
}

std::optional<FramePattern> parse_pattern(std::string_view name) {
  const std::size_t at = name.find('%');
  if (at == std::string_view::npos) return std::nullopt;
  FramePattern pattern{std::string(name.substr(0, at)), {}, 1};
  std::size_t next = at + 1;
  if (next < name.size() && name[next] == '0') ++next;
  if (next < name.size() && name[next] >= '1' && name[next] <= '9')
    pattern.width = static_cast<std::size_t>(name[next++] - '0');
  if (next >= name.size() || name[next] != 'd') return std::nullopt;
  pattern.behind = name.substr(next + 1);
  if (pattern.behind.find('%') != std::string::npos) return std::nullopt;
  return pattern;
}

std::optional<FramePattern> pattern_of(std::string_view stem, std::string_view extension) {
  std::size_t digits = 0;
  while (digits < stem.size() && is_digit(stem[stem.size() - 1 - digits])) ++digits;
  if (digits == 0 || digits > kMostDigits) return std::nullopt;
  // A number without zeros in front says nothing of its padding.
  const bool padded = stem[stem.size() - digits] == '0';
  return FramePattern{std::string(stem.substr(0, stem.size() - digits)), std::string(extension),
                      padded ? digits : 1};
}

}  // namespace slf
