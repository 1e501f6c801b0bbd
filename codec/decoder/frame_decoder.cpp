// SPDX-License-Identifier: Apache-2.0
// Any frame of a stream: those before it that it needs, and it. Spec 8.12.
#include <optional>
#include <utility>

#include "codec/decoder/frame_chain.h"
#include "slf/frames.h"

namespace slf {

struct FrameDecoder::Impl {
  std::span<const std::uint8_t> stream;
  DecodeOptions options;
  std::vector<FrameUnits> frames;
  std::vector<FrameInfo> infos;
  FrameChain chain;
  std::optional<std::size_t> at;  // place of the frame that was decoded last

  Result<LightField> decode_next(std::size_t place) {
    at.reset();
    auto field = chain.decode(stream, frames[place], options);
    if (field) at = place;
    return field;
  }
};

namespace {

std::vector<FrameInfo> infos_of(const std::vector<FrameUnits>& frames) {
  std::vector<FrameInfo> infos;
  for (const FrameUnits& f : frames)
    infos.push_back(
        {f.header.frame_number, f.header.frame_time, f.header.predicted(), f.offset, f.bytes});
  return infos;
}

}  // namespace

Result<std::vector<FrameInfo>> list_frames(std::span<const std::uint8_t> stream) {
  SLF_TRY(const auto frames, split_frames(stream));
  return infos_of(frames);
}

Result<FrameDecoder> FrameDecoder::open(std::span<const std::uint8_t> stream,
                                        const DecodeOptions& options) {
  if (stream.size() > options.limits.max_stream_bytes) return Error{Errc::kLimitExceeded, "stream"};
  if (options.max_bytes > 0) return Error{Errc::kInvalidArgument, "max_bytes"};
  auto impl = std::make_unique<Impl>();
  impl->stream = stream;
  impl->options = options;
  SLF_TRY(impl->frames, split_frames(stream, options.limits.max_memory));
  impl->infos = infos_of(impl->frames);
  return FrameDecoder(std::move(impl));
}

Result<LightField> FrameDecoder::decode(std::size_t frame) {
  Impl& self = *impl_;
  if (frame >= self.frames.size()) return Error{Errc::kInvalidArgument, "frame"};
  std::size_t first = frame;
  while (self.frames[first].header.predicted()) --first;
  if (self.at && *self.at >= first && *self.at < frame) first = *self.at + 1;
  for (; first < frame; ++first) SLF_CHECK(self.decode_next(first));
  return self.decode_next(frame);
}

const std::vector<FrameInfo>& FrameDecoder::frames() const { return impl_->infos; }
FrameDecoder::FrameDecoder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FrameDecoder::FrameDecoder(FrameDecoder&&) noexcept = default;
FrameDecoder& FrameDecoder::operator=(FrameDecoder&&) noexcept = default;
FrameDecoder::~FrameDecoder() = default;

}  // namespace slf
