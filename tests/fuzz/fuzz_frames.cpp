// SPDX-License-Identifier: Apache-2.0
// Any bytes are an error or frames, each an error or a light field; fewer levels too, and in
// pieces.
#include <algorithm>
#include <span>

#include "slf/frame_reader.h"
#include "slf/frames.h"
#include "tests/fuzz/fuzz.h"

namespace {

/// Frames that are looked at of an input.
constexpr std::size_t kMostFrames = 6;

void decode_frames(const std::vector<std::uint8_t>& stream, const slf::DecodeOptions& options) {
  auto decoder = slf::FrameDecoder::open(stream, options);
  if (!decoder) return;
  const std::size_t frames = std::min(decoder->frames().size(), kMostFrames);
  for (std::size_t frame = 0; frame < frames; ++frame) slf::fuzz::accept(decoder->decode(frame));
}

/// The same as it arrives, in pieces of a length that the input says.
void read_frames(std::span<const std::uint8_t> stream, const slf::DecodeOptions& options) {
  auto reader = slf::FrameReader::open(options);
  if (!reader || stream.empty()) return;
  const std::size_t piece = 1 + std::size_t{stream.back()} * 16;
  for (std::size_t at = 0; at < stream.size(); at += piece) {
    (void)reader->push(stream.subspan(at, std::min(piece, stream.size() - at)));
    const bool halfway = at < stream.size() / 2 && at + piece >= stream.size() / 2;
    if (halfway && !reader->frames().empty()) (void)reader->decode(0);
  }
  (void)reader->finish();
  const std::size_t frames = std::min(reader->frames().size(), kMostFrames);
  for (std::size_t frame = 0; frame < frames; ++frame) (void)reader->decode(frame);
  if (frames == 0) return;
  reader->drop_before(frames - 1);
  if (reader->seek(stream.back() % frames)) (void)reader->push(stream);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto stream = slf::fuzz::with_sound_crcs_of_frames({data, size});
  (void)slf::list_frames(stream);
  slf::DecodeOptions options;
  options.limits = slf::fuzz::small_limits();
  decode_frames(stream, options);
  read_frames({data, size}, options);
  read_frames(stream, options);
  options.levels = 3;
  options.groups = 1;
  decode_frames(stream, options);
  return 0;
}
