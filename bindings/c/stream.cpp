// SPDX-License-Identifier: Apache-2.0
// Opening of streams, and what their headers say.
#include <algorithm>
#include <string>

#include "bindings/c/failure.h"
#include "bindings/c/handles.h"
#include "bindings/c/options.h"
#include "bindings/c/sized.h"
#include "bitstream/parameter_sets.h"
#include "codec/stream/stream_pieces.h"

namespace slf::capi {
namespace {

constexpr std::uint64_t kFirstRead = std::uint64_t{1} << 16;

slf_code out_of_memory(slf_error* error) { return fail(error, SLF_OUT_OF_MEMORY, "memory"); }

/// Reads the first `bytes` bytes.
slf_code read_head(slf_stream& stream, std::uint64_t bytes, slf_error* error) {
  const std::size_t size = static_cast<std::size_t>(bytes);
  if (size != bytes || !stream.block.resize(size)) return out_of_memory(error);
  if (size > 0 &&
      stream.reader.read_at(stream.reader.user, 0, stream.block.bytes().data(), size) != 0)
    return fail(error, SLF_READ_FAILED, "read_at");
  stream.head = stream.block.bytes();
  return SLF_OK;
}

/// As much of the beginning as it takes to choose what else to read.
slf_code read_beginning(slf_stream& stream, slf_error* error) {
  for (std::uint64_t bytes = std::min(kFirstRead, stream.size);;
       bytes = std::min(4 * bytes, stream.size)) {
    if (const slf_code code = read_head(stream, bytes, error); code != SLF_OK) return code;
    if (bytes == stream.size) return SLF_OK;
    const auto head = find_head(stream.head, stream.size, DecodeLimits{}.max_memory);
    if (!head) return fail(error, head.error());
    if (!*head) continue;
    if ((*head)->bytes > bytes)
      if (const slf_code code = read_head(stream, (*head)->bytes, error); code != SLF_OK)
        return code;
    stream.head = stream.head.first(static_cast<std::size_t>((*head)->bytes));
    stream.complete = (*head)->complete;
    return SLF_OK;
  }
}

/// Headers, and of a stream that is in memory the checksums of all units.
slf_code read_headers(slf_stream& stream, slf_error* error) {
  DecodeLimits limits;
  limits.max_stream_bytes = ~std::uint64_t{0};
  auto info = read_info(stream.head, limits);
  if (!info) return fail(error, info.error());
  stream.info = *std::move(info);
  return SLF_OK;
}

slf_info info_of(const slf_stream& stream) {
  const StreamInfo& info = stream.info;
  const LightFieldHeader& header = info.header;
  slf_info out{};
  out.format_version = static_cast<std::uint32_t>(info.version_major << 16 | info.version_minor);
  out.bytes = stream.size;
  out.points = info.num_points;
  out.slices = static_cast<std::uint32_t>(info.num_slices);
  out.groups = static_cast<std::uint32_t>(info.num_groups);
  out.levels = static_cast<std::uint32_t>(header.grid.bits);
  for (const int layers : info.layers)
    out.layers = std::max(out.layers, static_cast<std::uint32_t>(layers));
  out.functions = static_cast<std::uint32_t>(header.num_functions);
  out.components = out.functions;
  for (const TransformInfo& t : info.transforms)
    out.components -= static_cast<std::uint32_t>(t.functions - t.coded_functions);
  std::copy(header.grid.origin.begin(), header.grid.origin.end(), out.origin);
  out.step = header.grid.step;
  out.metres_per_unit = header.metres_per_unit;
  out.up = static_cast<std::uint32_t>(header.up);
  out.left_handed = !header.right_handed;
  out.has_basis = header.has_basis && header.num_functions > 0;
  out.basis = static_cast<std::uint32_t>(header.basis.id);
  out.directions = static_cast<std::uint32_t>(header.directions);
  out.transfer = static_cast<std::uint32_t>(header.transfer);
  out.gamma_min = header.gamma_min_q7 / 127.0;
  out.gamma_max = header.gamma_max_q7 / 127.0;
  out.complete = info.complete || stream.complete;
  out.metadata_pairs = static_cast<std::uint32_t>(info.metadata.size());
  out.profile = static_cast<std::uint32_t>(info.profile);
  out.normal_bits = static_cast<std::uint32_t>(info.normal_bits);
  out.has_index = std::any_of(info.units.begin(), info.units.end(),
                              [](const UnitInfo& unit) { return unit.type == "index"; });
  out.has_splats = has_gaussians(header);
  return out;
}

/// Opens what `begin` has made ready.
template <class Begin>
slf_code open(const slf_allocator* given, slf_stream** out, slf_error* error, const Begin& begin) {
  *out = nullptr;
  const Allocator allocator(take(given));
  auto* stream = allocator.make<slf_stream>(allocator, slf_reader{}, std::uint64_t{0},
                                            std::span<const std::uint8_t>(), Block(allocator));
  if (stream == nullptr) return out_of_memory(error);
  const slf_code code = guarded(error, [&] {
    const slf_code begun = begin(*stream);
    return begun == SLF_OK ? read_headers(*stream, error) : begun;
  });
  if (code == SLF_OK) {
    *out = stream;
  } else {
    Allocator::destroy(stream);
  }
  return code;
}

}  // namespace
}  // namespace slf::capi

using namespace slf::capi;

slf_code slf_open(const void* bytes, size_t size, const slf_allocator* allocator,
                  slf_stream** stream, slf_error* error) {
  if (stream == nullptr) return invalid(error, "stream");
  *stream = nullptr;
  if (bytes == nullptr) return invalid(error, "bytes");
  if (!is_usable(allocator)) return invalid(error, "allocator");
  return open(allocator, stream, error, [&](slf_stream& s) {
    s.head = {static_cast<const std::uint8_t*>(bytes), size};
    s.size = size;
    return SLF_OK;
  });
}

slf_code slf_open_reader(const slf_reader* reader, const slf_allocator* allocator,
                         slf_stream** stream, slf_error* error) {
  if (stream == nullptr) return invalid(error, "stream");
  *stream = nullptr;
  const slf_reader given = take(reader);
  if (given.read_at == nullptr) return invalid(error, "reader");
  if (!is_usable(allocator)) return invalid(error, "allocator");
  return open(allocator, stream, error, [&](slf_stream& s) {
    s.reader = given;
    s.size = given.stream_bytes;
    return read_beginning(s, error);
  });
}

void slf_release_stream(slf_stream* stream) { Allocator::destroy(stream); }

slf_code slf_get_info(const slf_stream* stream, slf_info* info, slf_error* error) {
  if (stream == nullptr) return invalid(error, "stream");
  if (info == nullptr) return invalid(error, "info");
  give(info_of(*stream), info);
  return SLF_OK;
}

slf_code slf_get_metadata(const slf_stream* stream, uint32_t i, const char** key,
                          const char** value, slf_error* error) {
  if (key != nullptr) *key = nullptr;
  if (value != nullptr) *value = nullptr;
  if (stream == nullptr) return invalid(error, "stream");
  if (key == nullptr) return invalid(error, "key");
  if (value == nullptr) return invalid(error, "value");
  if (i >= stream->info.metadata.size()) return invalid(error, "i");
  *key = stream->info.metadata[i].first.c_str();
  *value = stream->info.metadata[i].second.c_str();
  return SLF_OK;
}
