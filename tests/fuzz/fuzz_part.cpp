// SPDX-License-Identifier: Apache-2.0
// Parts of a scene: one alone, and two files as parts of one.
#include "slf/scene.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<slf::PartStream> parts;
  for (const auto part : slf::fuzz::parts_of({data, size}))
    parts.push_back({"part", slf::fuzz::with_sound_crcs(part)});
  slf::fuzz::accept(slf::merge_parts(parts, true, 1));
  return 0;
}
