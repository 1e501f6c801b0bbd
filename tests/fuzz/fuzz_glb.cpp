// SPDX-License-Identifier: Apache-2.0
// GLB meshes. Lengths of the file and of its first chunk are made right.
#include "capture/mesh_formats.h"
#include "tests/fuzz/fuzz.h"

namespace {

void put_length(std::vector<std::uint8_t>& file, std::size_t at, std::size_t length) {
  for (std::size_t i = 0; i < 4; ++i) file[at + i] = static_cast<std::uint8_t>(length >> (8 * i));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint8_t> file(data, data + size);
  if (size >= 12) put_length(file, 8, size);
  std::vector<std::string> warnings;
  if (auto mesh = slf::parse_glb("fuzz.glb", file, &warnings))
    slf::fuzz::accept(slf::check_mesh("fuzz.glb", *mesh));
  return 0;
}
