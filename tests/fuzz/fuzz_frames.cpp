// Any bytes are an error or frames, each an error or a light field; fewer levels too.
#include "slf/frames.h"
#include "tests/fuzz/fuzz.h"

namespace {

/// Frames that are looked at of an input.
constexpr std::size_t kMostFrames = 6;

void decode_frames(const std::vector<std::uint8_t>& stream, const slf::DecodeOptions& options) {
  auto decoder = slf::FrameDecoder::open(stream, options);
  if (!decoder) return;
  const std::size_t frames = std::min(decoder->frames().size(), kMostFrames);
  for (std::size_t frame = 0; frame < frames; ++frame) (void)decoder->decode(frame);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto stream = slf::fuzz::with_sound_crcs_of_frames({data, size});
  (void)slf::list_frames(stream);
  slf::DecodeOptions options;
  options.limits = slf::fuzz::small_limits();
  decode_frames(stream, options);
  options.levels = 3;
  options.groups = 1;
  decode_frames(stream, options);
  return 0;
}
