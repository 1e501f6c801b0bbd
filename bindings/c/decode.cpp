// SPDX-License-Identifier: Apache-2.0
// Decoding through the C interface.
#include <algorithm>
#include <vector>

#include "bindings/c/failure.h"
#include "bindings/c/handles.h"
#include "bindings/c/options.h"
#include "bindings/c/sized.h"
#include "codec/stream/stream_pieces.h"

namespace slf::capi {
namespace {

/// The head is all that is needed of the stream's bytes to tell.
Result<ReadPlan> plan_of(const slf_stream& stream, const DecodeOptions& options) {
  if (stream.size > options.limits.max_stream_bytes) return Error{Errc::kLimitExceeded, "stream"};
  return plan_read(stream.head, stream.size, options);
}

std::vector<ByteRange> ranges_of(const slf_stream& stream, const ReadPlan& plan) {
  if (stream.in_memory()) return {};
  return plan.whole ? std::vector<ByteRange>{{stream.head.size(), stream.size - stream.head.size()}}
                    : plan.ranges;
}

slf_estimate estimate_of(const slf_stream& stream, const ReadPlan& plan) {
  slf_estimate out{};
  out.components = static_cast<std::uint32_t>(plan.components);
  out.points = plan.points;
  for (const ByteRange& range : ranges_of(stream, plan)) out.read_bytes += range.bytes;
  const std::uint64_t normal = plan.set.sps_normal_bits > 0 ? 4 : 0;
  out.field_bytes = plan.points * (sizeof(Voxel) + 12 * plan.components + normal);
  out.memory_bytes = plan.cost.memory_most + out.read_bytes + stream.block.bytes().size();
  return out;
}

slf_code check_memory(const slf_options& options, const slf_estimate& estimate, slf_error* error) {
  const std::uint64_t limit = options.max_memory_bytes;
  const bool addressable = estimate.memory_bytes <= ~std::size_t{0};
  if (addressable && (limit == 0 || estimate.memory_bytes <= limit)) return SLF_OK;
  return fail(error, SLF_LIMIT_EXCEEDED, "max_memory_bytes");
}

/// The pieces of a stream that were asked for, read one behind the other.
struct Pieces {
  explicit Pieces(const Allocator& allocator) : block(allocator) {}
  Block block;
  std::vector<StreamPiece> pieces;
};

slf_code read_pieces(const slf_stream& stream, std::span<const ByteRange> ranges, Pieces& to,
                     slf_error* error) {
  std::uint64_t bytes = 0;
  for (const ByteRange& range : ranges) {
    if (range.offset > stream.size || range.bytes > stream.size - range.offset)
      return fail(error, Error{Errc::kTruncated, "unit_payload", stream.size * 8});
    bytes += range.bytes;
  }
  if (!to.block.resize(static_cast<std::size_t>(bytes)))
    return fail(error, SLF_OUT_OF_MEMORY, "memory");
  std::span<std::uint8_t> rest = to.block.bytes();
  for (const ByteRange& range : ranges) {
    const auto piece = rest.first(static_cast<std::size_t>(range.bytes));
    if (stream.reader.read_at(stream.reader.user, range.offset, piece.data(), piece.size()) != 0)
      return fail(error, SLF_READ_FAILED, "read_at");
    to.pieces.push_back({range.offset, piece});
    rest = rest.subspan(piece.size());
  }
  return SLF_OK;
}

/// All of a stream that is read through a reader.
slf_code read_whole(const slf_stream& stream, Block& block, slf_error* error) {
  if (!block.resize(static_cast<std::size_t>(stream.size)))
    return fail(error, SLF_OUT_OF_MEMORY, "memory");
  const auto to = block.bytes();
  std::copy(stream.head.begin(), stream.head.end(), to.begin());
  const auto rest = to.subspan(stream.head.size());
  if (stream.reader.read_at(stream.reader.user, stream.head.size(), rest.data(), rest.size()) != 0)
    return fail(error, SLF_READ_FAILED, "read_at");
  return SLF_OK;
}

/// @param field  receives the result where there is one
slf_code decode_into(const slf_stream& stream, const DecodeOptions& options, const ReadPlan& plan,
                     std::optional<LightField>& field, slf_error* error) {
  const auto keep = [&](Result<LightField> decoded) {
    if (!decoded) return fail(error, decoded.error());
    field = *std::move(decoded);
    return slf_code{SLF_OK};
  };
  if (stream.in_memory()) return keep(decode(stream.head, options));
  if (plan.whole) {
    Block block(stream.allocator);
    if (const slf_code code = read_whole(stream, block, error); code != SLF_OK) return code;
    return keep(decode(std::as_const(block).bytes(), options));
  }
  Pieces read(stream.allocator);
  if (const slf_code code = read_pieces(stream, plan.ranges, read, error); code != SLF_OK)
    return code;
  return keep(decode_pieces(stream.head, plan, read.pieces, options));
}

slf_code decode_stream(const slf_stream& stream, const slf_options& given, slf_field** out,
                       slf_error* error) {
  const DecodeOptions options = options_of(given);
  const auto plan = plan_of(stream, options);
  if (!plan) return fail(error, plan.error());
  if (const slf_code code = check_memory(given, estimate_of(stream, *plan), error); code != SLF_OK)
    return code;
  std::optional<LightField> field;
  if (const slf_code code = decode_into(stream, options, *plan, field, error); code != SLF_OK)
    return code;
  *out = stream.allocator.make<slf_field>(stream.allocator, *std::move(field), options.threads);
  return *out != nullptr ? slf_code{SLF_OK} : fail(error, SLF_OUT_OF_MEMORY, "memory");
}

}  // namespace
}  // namespace slf::capi

using namespace slf::capi;

slf_code slf_preflight(const slf_stream* stream, const slf_options* options, slf_estimate* estimate,
                       slf_error* error) {
  if (stream == nullptr) return invalid(error, "stream");
  if (estimate == nullptr) return invalid(error, "estimate");
  return guarded(error, [&] {
    const auto plan = plan_of(*stream, options_of(take(options)));
    if (!plan) return fail(error, plan.error());
    give(estimate_of(*stream, *plan), estimate);
    return slf_code{SLF_OK};
  });
}

slf_code slf_get_ranges(const slf_stream* stream, const slf_options* options, slf_range* ranges,
                        size_t capacity, size_t* count, slf_error* error) {
  if (stream == nullptr) return invalid(error, "stream");
  if (count == nullptr || (ranges == nullptr && capacity > 0)) return invalid(error, "ranges");
  return guarded(error, [&] {
    const auto plan = plan_of(*stream, options_of(take(options)));
    if (!plan) return fail(error, plan.error());
    const auto all = ranges_of(*stream, *plan);
    for (std::size_t i = 0; i < std::min(capacity, all.size()); ++i)
      ranges[i] = {all[i].offset, all[i].bytes};
    *count = all.size();
    return slf_code{SLF_OK};
  });
}

slf_code slf_decode(const slf_stream* stream, const slf_options* options, slf_field** field,
                    slf_error* error) {
  if (field == nullptr) return invalid(error, "field");
  *field = nullptr;
  if (stream == nullptr) return invalid(error, "stream");
  return guarded(error, [&] { return decode_stream(*stream, take(options), field, error); });
}

void slf_release_field(slf_field* field) { Allocator::destroy(field); }
