// SPDX-License-Identifier: Apache-2.0
#include "capture/ply_body.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

namespace slf {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 18;
constexpr std::size_t kLongestNumber = 1024;  // characters

}  // namespace

bool PlyBody::fill(std::size_t bytes) {
  if (ended_) return false;
  std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(at_), bytes_.end(), bytes_.begin());
  const std::size_t kept = left();
  at_ = 0;
  bytes_.resize(std::max(kBlock, bytes));
  const auto count = file_.read(std::span(bytes_).subspan(kept));
  ended_ = !count || *count < bytes_.size() - kept;  // a disk that fails is a file that is cut off
  bytes_.resize(kept + (count ? *count : 0));
  return left() >= bytes;
}

bool PlyBody::list_length(const PlyProperty& property, std::uint64_t& items) {
  double count = 0;
  if (!value(property.count_type, count)) return false;
  if (!(count >= 0 && count < 4294967296.0) || count != std::floor(count)) return false;
  items = static_cast<std::uint64_t>(count);
  return true;
}

bool PlyBody::skip_list(const PlyProperty& property) {
  std::uint64_t items = 0;
  if (!list_length(property, items)) return false;
  if (format_ != PlyFormat::kAscii) return skip(items * size_of(property.type));
  double ignored = 0;
  for (std::uint64_t i = 0; i < items; ++i)
    if (!text(ignored)) return false;
  return true;
}

bool PlyBody::skip(std::uint64_t bytes) {
  while (bytes > left()) {
    bytes -= left();
    at_ = bytes_.size();
    if (!fill(1)) return false;
  }
  at_ += static_cast<std::size_t>(bytes);
  return true;
}

bool PlyBody::skip_element(const PlyElement& element) {
  if (element.properties.empty()) return true;  // its rows take no bytes, whatever their count
  if (format_ != PlyFormat::kAscii && !element.has_lists())
    return skip(element.count * element.min_row_bytes(format_));  // bounded by the file's size
  double ignored = 0;
  for (std::uint64_t i = 0; i < element.count; ++i)
    for (const auto& property : element.properties)
      if (!(property.is_list ? skip_list(property) : value(property.type, ignored))) return false;
  return true;
}

bool PlyBody::binary(PlyType type, double& out) {
  const std::size_t size = size_of(type);
  if (!has(size)) return false;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t from = format_ == PlyFormat::kBigEndian ? i : size - 1 - i;
    bits = bits << 8 | bytes_[at_ + from];
  }
  at_ += size;
  switch (type) {
    case PlyType::kInt8:
      out = static_cast<std::int8_t>(bits);
      break;
    case PlyType::kInt16:
      out = static_cast<std::int16_t>(bits);
      break;
    case PlyType::kInt32:
      out = static_cast<std::int32_t>(bits);
      break;
    case PlyType::kUint8:
    case PlyType::kUint16:
    case PlyType::kUint32:
      out = static_cast<double>(bits);
      break;
    case PlyType::kFloat:
      out = static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
      break;
    case PlyType::kDouble:
      out = std::bit_cast<double>(bits);
      break;
  }
  return true;
}

// Rows of an ascii file are lines, but only white space is relied on.
bool PlyBody::text(double& out) {
  const auto is_space = [](std::uint8_t c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
  while (has(1) && is_space(bytes_[at_])) ++at_;
  has(kLongestNumber);
  std::size_t end = at_;
  while (end < bytes_.size() && !is_space(bytes_[end])) ++end;
  if (end - at_ > 1 && bytes_[at_] == '+') ++at_;  // from_chars does not know it
  const char* data = reinterpret_cast<const char*>(bytes_.data());
  const auto [stop, error] = std::from_chars(data + at_, data + end, out);
  if (error != std::errc() || stop != data + end) return false;
  at_ = end;
  return true;
}

}  // namespace slf
