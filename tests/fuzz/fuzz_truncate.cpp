// SPDX-License-Identifier: Apache-2.0
// What truncate makes of a stream that decodes, decodes: with the same options to the same.
#include <cstdlib>

#include "slf/truncate.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const auto stream = slf::fuzz::with_sound_crcs({data + 2, size - 2});
  slf::DecodeOptions options;
  options.limits = slf::fuzz::small_limits();
  options.levels = data[0] % 8;
  options.groups = data[1] % 4;
  if (data[0] & 0x80) options.region = slf::VoxelBox{{0, 0, 0}, {data[1], data[1], 3}};
  const auto cut = slf::truncate(stream, options);
  if (!cut) return 0;
  slf::fuzz::accept(true);
  const auto asked = slf::decode(stream, options);
  if (!asked) return 0;
  const auto same = slf::decode(*cut, options);
  if (!same || same->positions != asked->positions || same->components != asked->components ||
      same->normals.octahedral != asked->normals.octahedral)
    std::abort();
  options.levels = options.groups = 0;
  options.region.reset();
  // Damage in a unit that was asked for in part is in the cut, too.
  if (slf::decode(stream, options) && !slf::decode(*cut, options)) std::abort();
  return 0;
}
