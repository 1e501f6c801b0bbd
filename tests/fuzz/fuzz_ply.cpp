// SPDX-License-Identifier: Apache-2.0
// PLY clouds, meshes and plenoptic clouds.
#include "capture/ply_reader.h"
#include "slf/plenoptic.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const slf::fuzz::MemoryFile file({data, size});
  std::vector<std::string> warnings;
  slf::fuzz::accept(slf::read_ply_mesh(file.path(), false, &warnings));
  slf::fuzz::accept(slf::read_ply_mesh(file.path(), true, &warnings));
  if (slf::count_plenoptic_views(file.path()) > 0)
    slf::fuzz::accept(slf::read_plenoptic(file.path(), {{}, 0}, &warnings));
  return 0;
}
