// SPDX-License-Identifier: Apache-2.0
// An HEVC stream of the pictures that a texture has. The first byte is their number and depth.
#include "attributes/video/hevc_decoder.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const slf::HevcFormat format = {64, 64, 8 + 2 * (data[0] >> 2 & 1), slf::ChromaFormat::k400,
                                  std::size_t{1} + (data[0] & 3u)};
  slf::fuzz::accept(
      slf::decode_hevc({data + 1, size - 1}, format, [](std::size_t, const slf::Picture&) {}));
  return 0;
}
