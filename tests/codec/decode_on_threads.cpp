// SPDX-License-Identifier: Apache-2.0
// Decodes files on four threads, whole, in part, and with a byte changed in every unit: for the
// thread sanitizer (.ci/threads.sh).
#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

#include "slf/decoder.h"
#include "tests/fuzz/fuzz.h"

namespace {

using Bytes = std::vector<std::uint8_t>;

void decode_all(const Bytes& stream) {
  slf::DecodeOptions options;
  options.threads = 4;
  const auto whole = slf::decode(stream, options);
  options.max_bytes = stream.size() * 2 / 3;
  (void)slf::decode(stream, options);
  options.max_bytes = 0;
  options.levels = 3;
  options.region = slf::VoxelBox{{0, 0, 0}, {3, 3, 3}};
  (void)slf::decode(stream, options);
  const auto info = slf::read_info(stream);
  if (!info) return;
  for (const auto& unit : info->units) {
    Bytes damaged = stream;
    damaged[unit.offset + unit.bytes - 5] ^= 0x10;
    slf::DecodeOptions plain;
    plain.threads = 4;
    (void)slf::decode(slf::fuzz::with_sound_crcs(damaged), plain);
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    std::ifstream in(argv[i], std::ios::binary);
    const std::vector<char> text((std::istreambuf_iterator<char>(in)), {});
    if (text.size() < 200000) decode_all({text.begin(), text.end()});
  }
  std::printf("%d streams\n", argc - 1);
}
