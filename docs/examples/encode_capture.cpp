// SPDX-License-Identifier: Apache-2.0
// Encodes a capture (docs/captures.md) with the default preset, a little coarser.
//
//   encode_capture CAPTURE OUTPUT
#include <cstdio>

#include "slf/capture.h"
#include "slf/encoder.h"

namespace {

// Everything that reads a person's files returns a Result; this chain stops at the first error.
slf::Result<std::size_t, slf::InputError> encode_capture(const char* input, const char* output) {
  SLF_TRY(const slf::Capture capture, slf::load_capture(input, {.points = {}, .points_needed = false}));
  SLF_TRY(const auto cameras, slf::split_cameras(capture, ""));  // what is not held out

  slf::EncoderSettings settings = slf::settings_of(slf::Preset::kDefault);
  settings.grid_bits = 8;
  settings.q = 24;
  SLF_TRY(const slf::Encoded encoded, slf::encode(capture, cameras, settings));
  SLF_CHECK(slf::write_file(output, encoded.stream.data(), encoded.stream.size()));
  return encoded.stream.size();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: encode_capture CAPTURE OUTPUT\n");
    return 2;
  }
  const auto bytes = encode_capture(argv[1], argv[2]);
  if (!bytes) {
    std::fprintf(stderr, "%s\n", bytes.error().message.c_str());
    return 4;
  }
  std::printf("%s: %zu bytes\n", argv[2], *bytes);
  return 0;
}
