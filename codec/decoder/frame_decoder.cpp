// SPDX-License-Identifier: Apache-2.0
// Any frame of a stream: those before it that it needs, and it. Spec 8.12.
#include <utility>

#include "codec/decoder/frame_walk.h"
#include "slf/frames.h"

namespace slf {

struct FrameDecoder::Impl {
  std::span<const std::uint8_t> stream;
  DecodeOptions options;
  std::vector<FrameUnits> frames;
  std::vector<FrameInfo> infos;
  FrameWalk walk;
};

namespace {

std::vector<FrameInfo> infos_of(const std::vector<FrameUnits>& frames) {
  std::vector<FrameInfo> infos;
  infos.reserve(frames.size());
  for (const FrameUnits& f : frames)
    infos.push_back(
        {f.header.frame_number, f.header.frame_time, f.header.predicted(), f.offset, f.bytes});
  return infos;
}

}  // namespace

Result<std::vector<FrameInfo>> list_frames(std::span<const std::uint8_t> stream,
                                           const DecodeLimits& limits) {
  SLF_TRY(const auto frames, split_frames(stream, limits.max_memory));
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
  return self.walk.decode(self.infos, frame, self.options,
                          [&self](std::size_t place) -> Result<FrameBytes> {
                            return FrameBytes{self.stream, &self.frames[place]};
                          });
}

const std::vector<FrameInfo>& FrameDecoder::frames() const { return impl_->infos; }
FrameDecoder::FrameDecoder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FrameDecoder::FrameDecoder(FrameDecoder&&) noexcept = default;
FrameDecoder& FrameDecoder::operator=(FrameDecoder&&) noexcept = default;
FrameDecoder::~FrameDecoder() = default;

}  // namespace slf
