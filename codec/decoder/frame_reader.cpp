// SPDX-License-Identifier: Apache-2.0
// Frames of a stream that is still on its way. Spec 7.13, 8.12.
#include "slf/frame_reader.h"

#include <optional>
#include <utility>

#include "codec/decoder/arriving_frames.h"
#include "codec/decoder/frame_chain.h"

namespace slf {

struct FrameReader::Impl {
  DecodeOptions options;
  ArrivingFrames arriving;
  FrameChain chain;
  std::optional<std::size_t> at;  // place of the frame that was decoded last

  /// What was decoded last is of no use any more.
  void forget() {
    chain = {};
    at.reset();
  }
  Result<LightField> decode_next(std::size_t place) {
    const ArrivedFrame& frame = arriving.frames()[place];
    at.reset();
    if (frame.lost) return *frame.lost;
    if (frame.bytes.empty()) return Error{Errc::kUnreadable, "frame"};
    auto field = chain.decode(frame.bytes, frame.units, options, arriving.infos()[place].offset);
    if (field) at = place;
    return field;
  }
};

Result<FrameReader> FrameReader::open(const DecodeOptions& options) {
  if (options.max_bytes > 0) return Error{Errc::kInvalidArgument, "max_bytes"};
  auto impl = std::make_unique<Impl>();
  impl->options = options;
  return FrameReader(std::move(impl));
}

Result<Done> FrameReader::push(std::span<const std::uint8_t> bytes) {
  ArrivingFrames& arriving = impl_->arriving;
  const std::uint64_t most = impl_->options.limits.max_stream_bytes, held = arriving.held_bytes();
  if (arriving.finished()) return Error{Errc::kInvalidArgument, "finish"};
  if (held > most || bytes.size() > most - held) return Error{Errc::kLimitExceeded, "stream"};
  return arriving.push(bytes);
}

Result<Done> FrameReader::finish() { return impl_->arriving.finish(); }

Result<LightField> FrameReader::decode(std::size_t frame) {
  Impl& self = *impl_;
  if (frame >= frames().size()) return Error{Errc::kInvalidArgument, "frame"};
  std::size_t first = group_of(frame);
  if (self.at && *self.at >= first && *self.at < frame) first = *self.at + 1;
  for (; first < frame; ++first) SLF_CHECK(self.decode_next(first));
  return self.decode_next(frame);
}

std::size_t FrameReader::group_of(std::size_t frame) const {
  while (frames()[frame].predicted && !frames()[frame].lost) --frame;
  return frame;
}

void FrameReader::drop_before(std::size_t frame) {
  if (frame >= frames().size()) return;
  const std::size_t first = group_of(frame);
  for (std::size_t place = 0; place < first; ++place) impl_->arriving.drop(place);
  if (impl_->at && *impl_->at < first) impl_->forget();
}

Result<Done> FrameReader::seek(std::size_t frame) {
  const bool known = frame < frames().size();
  if (!known || frames()[frame].predicted || frames()[frame].lost)
    return Error{Errc::kInvalidArgument, "frame"};
  impl_->forget();
  impl_->arriving.begin_at(frame);
  return Done{};
}

const std::vector<FrameInfo>& FrameReader::frames() const { return impl_->arriving.infos(); }
std::uint64_t FrameReader::held_bytes() const { return impl_->arriving.held_bytes(); }
std::span<const std::uint8_t> FrameReader::bytes_of(std::size_t frame) const {
  return impl_->arriving.frames()[frame].bytes;
}

FrameReader::FrameReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FrameReader::FrameReader(FrameReader&&) noexcept = default;
FrameReader& FrameReader::operator=(FrameReader&&) noexcept = default;
FrameReader::~FrameReader() = default;

}  // namespace slf
