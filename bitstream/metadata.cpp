#include "bitstream/metadata.h"

#include <algorithm>
#include <string>

#include "bitstream/bit_reader.h"
#include "bitstream/bit_writer.h"
#include "bitstream/zlib_adapter.h"

namespace slf {
namespace {

constexpr std::uint64_t kMaxBytes = 1u << 20;

/// Key or value: up to the next zero byte.
std::string take_string(std::span<const std::uint8_t>& text) {
  std::size_t length = 0;
  while (length < text.size() && text[length] != 0) ++length;
  std::string s(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(length));
  text = text.subspan(std::min(length + 1, text.size()));
  return s;
}

}  // namespace

Result<Metadata> parse_metadata(std::span<const std::uint8_t> payload) {
  BitReader in(payload);
  const std::uint64_t size = in.ue("metadata_bytes");
  const auto deflated = in.align_and_rest("metadata_bytes");
  if (!in.ok()) return in.error();
  if (size > kMaxBytes) return Error{Errc::kOutOfRange, "metadata_bytes", 0};
  SLF_TRY(const auto text, inflate(deflated, static_cast<std::size_t>(size), "metadata_deflated"));
  if (size > 0 && text.back() != 0) return Error{Errc::kOutOfRange, "metadata_text", 0};
  Metadata metadata;
  for (std::span<const std::uint8_t> rest = text; !rest.empty();) {
    std::string key = take_string(rest);
    // A key without a name, or without a value.
    if (key.empty() || rest.empty()) return Error{Errc::kOutOfRange, "metadata_text", 0};
    metadata.emplace_back(std::move(key), take_string(rest));
  }
  return metadata;
}

std::vector<std::uint8_t> write_metadata(const Metadata& metadata) {
  std::vector<std::uint8_t> text;
  for (const auto& [key, value] : metadata)
    for (const std::string* s : {&key, &value}) {
      text.insert(text.end(), s->begin(), s->end());
      text.push_back(0);
    }
  BitWriter out;
  out.ue(text.size());
  out.append(deflate(text));
  return out.take();
}

}  // namespace slf
