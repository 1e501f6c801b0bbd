// SPDX-License-Identifier: Apache-2.0
#include "capture/gltf_buffers.h"

#include <string>
#include <utility>

#include "capture/importer.h"

namespace slf {

namespace {

constexpr std::uint64_t kMostBufferBytes = std::uint64_t{1} << 31;  // all of them

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;  // of URLs: - and _
  if (c == '/' || c == '_') return 63;
  return -1;
}

/// "%20" as exporters write spaces.
std::string unescaped(const std::string& uri) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    const char small = static_cast<char>(c | 0x20);
    return small >= 'a' && small <= 'f' ? small - 'a' + 10 : -1;
  };
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? digit(uri[i + 1]) : -1;
    const int low = high >= 0 ? digit(uri[i + 2]) : -1;
    out += low >= 0 ? static_cast<char>(16 * high + low) : uri[i];
    if (low >= 0) i += 2;
  }
  return out;
}

}  // namespace

std::optional<std::vector<std::uint8_t>> from_base64(std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) return std::nullopt;
    bits = (bits << 6 | static_cast<std::uint32_t>(digit)) & 0xFFFF;
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> held));
  }
  return bytes;
}

Result<GltfBuffers, InputError> GltfBuffers::load(const JsonItems& buffers,
                                                  std::span<const std::uint8_t> binary,
                                                  const std::filesystem::path& folder) {
  GltfBuffers result;
  result.binary_ = binary;
  result.own_.resize(buffers.size());
  result.in_chunk_.resize(buffers.size());
  std::uint64_t left = kMostBufferBytes;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const auto uri_json = buffers[i].find("uri");
    result.in_chunk_[i] = i == 0 && !uri_json;
    if (!uri_json) continue;
    SLF_TRY(const std::string uri, uri_json->string());
    if (uri.starts_with("data:")) {
      const std::size_t comma = uri.find(',');
      const bool base64 = comma != std::string::npos && uri.substr(0, comma).ends_with(";base64");
      if (base64) result.own_[i] = from_base64(std::string_view(uri).substr(comma + 1));
      if (!result.own_[i]) return uri_json->error("a data URI that is no base64, or damaged");
    } else if (!folder.empty()) {
      SLF_TRY(const auto file,
              path_inside(folder, unescaped(uri), buffers[i].error("uri").message));
      SLF_TRY(result.own_[i], read_file(file, left));
      left -= result.own_[i]->size();
    }
  }
  return result;
}

std::optional<std::span<const std::uint8_t>> GltfBuffers::of(std::size_t buffer) const {
  if (buffer >= own_.size()) return std::nullopt;
  if (in_chunk_[buffer]) return binary_;
  if (own_[buffer]) return std::span<const std::uint8_t>(*own_[buffer]);
  return std::nullopt;
}

std::size_t GltfBuffers::bytes() const {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < own_.size(); ++i)
    if (const auto buffer = of(i)) sum += buffer->size();
  return sum;
}

}  // namespace slf
