// SPDX-License-Identifier: Apache-2.0
// Streams of several frames, as their bytes come.
#include <algorithm>
#include <span>

#include "bindings/c/failure.h"
#include "bindings/c/handles.h"
#include "bindings/c/options.h"
#include "bindings/c/sized.h"

namespace slf::capi {
namespace {

bool has(const slf_frames& frames, std::size_t place) {
  return place < frames.reader.frames().size();
}

slf_code result_code(slf_error* error, const Result<Done>& result) {
  return result ? slf_code{SLF_OK} : fail(error, result.error());
}

slf_code decode_frame(slf_frames& frames, std::size_t place, slf_field** out, slf_error* error) {
  auto field = frames.reader.decode(place);
  if (!field) return fail(error, field.error());
  *out = frames.allocator.make<slf_field>(frames.allocator, *std::move(field), frames.threads);
  return *out != nullptr ? slf_code{SLF_OK} : fail(error, SLF_OUT_OF_MEMORY, "memory");
}

slf_frame frame_of(const FrameInfo& info) {
  slf_frame out{};
  out.number = info.number;
  out.time = info.time;
  out.offset = info.offset;
  out.bytes = info.bytes;
  out.predicted = info.predicted;
  out.lost = info.lost;
  out.arriving = info.arriving;
  return out;
}

}  // namespace
}  // namespace slf::capi

using namespace slf::capi;

slf_code slf_open_frames(const slf_options* options, const slf_allocator* allocator,
                         slf_frames** frames, slf_error* error) {
  if (frames == nullptr) return invalid(error, "frames");
  *frames = nullptr;
  if (!is_usable(allocator)) return invalid(error, "allocator");
  return guarded(error, [&] {
    const slf::DecodeOptions asked = options_of(take(options));
    auto reader = slf::FrameReader::open(asked);
    if (!reader) return fail(error, reader.error());
    const Allocator own(take(allocator));
    *frames = own.make<slf_frames>(own, *std::move(reader), asked.threads);
    return *frames != nullptr ? slf_code{SLF_OK} : fail(error, SLF_OUT_OF_MEMORY, "memory");
  });
}

void slf_release_frames(slf_frames* frames) { Allocator::destroy(frames); }

slf_code slf_frames_push(slf_frames* frames, const void* bytes, size_t size, slf_error* error) {
  if (frames == nullptr) return invalid(error, "frames");
  if (bytes == nullptr && size > 0) return invalid(error, "bytes");
  return guarded(error, [&] {
    return result_code(error, frames->reader.push({static_cast<const std::uint8_t*>(bytes), size}));
  });
}

slf_code slf_frames_finish(slf_frames* frames, slf_error* error) {
  if (frames == nullptr) return invalid(error, "frames");
  return guarded(error, [&] { return result_code(error, frames->reader.finish()); });
}

size_t slf_frames_count(const slf_frames* frames) {
  if (frames == nullptr || frames->reader.frames().empty()) return 0;
  const auto& list = frames->reader.frames();
  return list.size() - (list.back().arriving ? 1 : 0);
}

uint64_t slf_frames_held_bytes(const slf_frames* frames) {
  return frames == nullptr ? 0 : frames->reader.held_bytes();
}

slf_code slf_frames_get(const slf_frames* frames, size_t place, slf_frame* frame,
                        slf_error* error) {
  if (frames == nullptr) return invalid(error, "frames");
  if (frame == nullptr) return invalid(error, "frame");
  if (!has(*frames, place)) return invalid(error, "place");
  give(frame_of(frames->reader.frames()[place]), frame);
  return SLF_OK;
}

slf_code slf_frames_get_bytes(const slf_frames* frames, size_t place, const void** bytes,
                              size_t* size, slf_error* error) {
  if (bytes != nullptr) *bytes = nullptr;
  if (frames == nullptr) return invalid(error, "frames");
  if (bytes == nullptr) return invalid(error, "bytes");
  if (size == nullptr) return invalid(error, "size");
  if (!has(*frames, place)) return invalid(error, "place");
  const auto held = frames->reader.bytes_of(place);
  if (held.empty()) return fail(error, SLF_READ_FAILED, "place");
  *bytes = held.data();
  *size = held.size();
  return SLF_OK;
}

slf_code slf_frames_decode(slf_frames* frames, size_t place, slf_field** field, slf_error* error) {
  if (field == nullptr) return invalid(error, "field");
  *field = nullptr;
  if (frames == nullptr) return invalid(error, "frames");
  if (!has(*frames, place)) return invalid(error, "place");
  return guarded(error, [&] { return decode_frame(*frames, place, field, error); });
}

slf_code slf_frames_set_options(slf_frames* frames, const slf_options* options, slf_error* error) {
  if (frames == nullptr) return invalid(error, "frames");
  return guarded(error, [&] {
    const slf::DecodeOptions asked = options_of(take(options));
    const auto set = frames->reader.set_options(asked);
    if (set) frames->threads = asked.threads;
    return result_code(error, set);
  });
}

slf_code slf_frames_drop_before(slf_frames* frames, size_t place, slf_error* error) {
  if (frames == nullptr) return invalid(error, "frames");
  if (!has(*frames, place)) return invalid(error, "place");
  frames->reader.drop_before(place);
  return SLF_OK;
}

slf_code slf_frames_seek(slf_frames* frames, size_t place, slf_error* error) {
  if (frames == nullptr) return invalid(error, "frames");
  if (!has(*frames, place) || !frames->reader.seek(place)) return invalid(error, "place");
  return SLF_OK;
}
