// SPDX-License-Identifier: Apache-2.0
// Frames of a stream that is still on its way. Spec 7.13, 8.12.
#include "slf/frame_reader.h"

#include <algorithm>
#include <utility>

#include "codec/decoder/arriving_frames.h"
#include "codec/decoder/frame_walk.h"

namespace slf {

struct FrameReader::Impl {
  DecodeOptions options;
  ArrivingFrames arriving;
  FrameWalk walk;

  Result<FrameBytes> find(std::size_t place) const {
    const ArrivedFrame& frame = arriving.frames()[place];
    if (frame.lost) return *frame.lost;
    if (frame.bytes.empty()) return Error{Errc::kUnreadable, "frame"};
    return FrameBytes{frame.bytes, &frame.units, arriving.infos()[place].offset};
  }
};

Result<FrameReader> FrameReader::open(const DecodeOptions& options) {
  FrameReader reader(std::make_unique<Impl>());
  SLF_CHECK(reader.set_options(options));
  return reader;
}

Result<Done> FrameReader::set_options(const DecodeOptions& options) {
  if (options.max_bytes > 0) return Error{Errc::kInvalidArgument, "max_bytes"};
  impl_->options = options;
  impl_->walk = {};
  return Done{};
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
  return self.walk.decode(frames(), frame, self.options,
                          [&self](std::size_t place) { return self.find(place); });
}

std::size_t FrameReader::group_of(std::size_t frame) const {
  return frame < frames().size() ? slf::group_of(frames(), frame) : frames().size();
}

void FrameReader::drop_before(std::size_t frame) {
  if (frame >= frames().size()) return;
  const std::size_t first = group_of(frame);
  for (std::size_t place = 0; place < first; ++place) impl_->arriving.drop(place);
  impl_->walk.forget_before(first);
}

Result<Done> FrameReader::seek(std::size_t frame) {
  const bool known = frame < frames().size();
  if (!known || frames()[frame].predicted || frames()[frame].lost)
    return Error{Errc::kInvalidArgument, "frame"};
  impl_->walk = {};
  impl_->arriving.begin_at(frame);
  return Done{};
}

const std::vector<FrameInfo>& FrameReader::frames() const { return impl_->arriving.infos(); }
std::uint64_t FrameReader::held_bytes() const { return impl_->arriving.held_bytes(); }
std::span<const std::uint8_t> FrameReader::bytes_of(std::size_t frame) const {
  if (frame >= frames().size()) return {};
  const std::span bytes(impl_->arriving.frames()[frame].bytes);
  return bytes.first(std::min<std::uint64_t>(bytes.size(), frames()[frame].bytes));
}

FrameReader::FrameReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FrameReader::FrameReader(FrameReader&&) noexcept = default;
FrameReader& FrameReader::operator=(FrameReader&&) noexcept = default;
FrameReader::~FrameReader() = default;

}  // namespace slf
