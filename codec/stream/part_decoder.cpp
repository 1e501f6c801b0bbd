// SPDX-License-Identifier: Apache-2.0
// Parts of a stream read where the index says they lie. Spec 7.7.
#include "slf/part_decoder.h"

#include <algorithm>

#include "codec/stream/stream_pieces.h"

namespace slf {
namespace {

/// Little: what is read beyond the beginning is read again where it is needed, and damage in it is
/// seen although nobody asked for it.
constexpr std::uint64_t kFirstRead = 256;

/// The share of the memory, 1/4, that the beginning may take: a filler unit in it can be as long as
/// the file.
constexpr std::uint64_t kShareOfBeginning = 4;

Error unreadable(std::uint64_t offset) { return {Errc::kUnreadable, "stream", 8 * offset}; }

/// Makes `begin` the first `bytes` of the stream: what it has is not read again.
Result<Done> grow(const StreamSource& source, std::uint64_t bytes, const DecodeLimits& limits,
                  std::vector<std::uint8_t>& begin) {
  if (bytes > limits.max_memory) return Error{Errc::kLimitExceeded, "max_memory"};
  const std::size_t had = begin.size();
  if (bytes <= had) return Done{};
  begin.resize(static_cast<std::size_t>(bytes));
  if (!source.read(had, std::span(begin).subspan(had))) return unreadable(had);
  return Done{};
}

/// The bytes of the ranges, one behind the other.
Result<std::vector<std::uint8_t>> read_ranges(const StreamSource& source, const ReadPlan& plan) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(plan.bytes()));
  std::span<std::uint8_t> rest = bytes;
  for (const ByteRange& range : plan.ranges) {
    const auto size = static_cast<std::size_t>(range.bytes);
    if (!source.read(range.offset, rest.first(size))) return unreadable(range.offset);
    rest = rest.subspan(size);
  }
  return bytes;
}

std::vector<StreamPiece> pieces_of(const ReadPlan& plan, std::span<const std::uint8_t> bytes) {
  std::vector<StreamPiece> pieces;
  for (const ByteRange& range : plan.ranges) {
    const auto size = static_cast<std::size_t>(range.bytes);
    pieces.push_back({range.offset, bytes.first(size)});
    bytes = bytes.subspan(size);
  }
  return pieces;
}

}  // namespace

Result<std::optional<StreamBeginning>> read_beginning(const StreamSource& source,
                                                      const DecodeLimits& limits) {
  if (source.bytes > limits.max_stream_bytes) return Error{Errc::kLimitExceeded, "stream"};
  StreamBeginning beginning;
  std::vector<std::uint8_t>& bytes = beginning.bytes;
  std::optional<StreamHead> head;
  for (std::uint64_t size = kFirstRead; !head; size *= 4) {
    if (bytes.size() == source.bytes) return std::optional<StreamBeginning>();
    const std::uint64_t next = std::min(size, source.bytes);
    if (next > kFirstRead && next > limits.max_memory / kShareOfBeginning)
      return std::optional<StreamBeginning>();
    SLF_CHECK(grow(source, next, limits, bytes));
    SLF_TRY(head, find_head(bytes, source.bytes, limits.max_memory));
  }
  if (!head->complete) return std::optional<StreamBeginning>();
  SLF_CHECK(grow(source, head->bytes, limits, bytes));
  bytes.resize(static_cast<std::size_t>(head->bytes));
  SLF_TRY(beginning.info, read_info(bytes, limits));
  beginning.info.complete = true;
  return std::optional(std::move(beginning));
}

Result<std::optional<LightField>> decode_part(const StreamSource& source,
                                              const StreamBeginning& beginning,
                                              const DecodeOptions& options) {
  if (source.bytes > options.limits.max_stream_bytes) return Error{Errc::kLimitExceeded, "stream"};
  const std::span<const std::uint8_t> head = beginning.bytes;
  if (options.max_bytes > 0 && options.max_bytes < head.size()) return std::optional<LightField>();
  SLF_TRY(const ReadPlan plan, plan_read(head, source.bytes, options));
  if (plan.whole || !plan.partial) return std::optional<LightField>();
  if (head.size() + plan.bytes() > options.limits.max_memory)
    return Error{Errc::kLimitExceeded, "max_memory"};
  SLF_TRY(const std::vector<std::uint8_t> bytes, read_ranges(source, plan));
  SLF_TRY(LightField field, decode_pieces(head, plan, pieces_of(plan, bytes), options));
  return std::optional(std::move(field));
}

}  // namespace slf
