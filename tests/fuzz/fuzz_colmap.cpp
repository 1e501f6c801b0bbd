// SPDX-License-Identifier: Apache-2.0
// COLMAP models, as text and as binary: cameras, images, points.
#include "capture/importer.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const slf::fuzz::Directory directory;
  const auto parts = slf::fuzz::parts_of({data, size});
  for (const char* kind : {".txt", ".bin"}) {
    std::size_t i = 0;
    for (const char* name : {"cameras", "images", "points3D"}) {
      directory.write(std::string(name) + kind,
                      i < parts.size() ? parts[i] : std::span<const std::uint8_t>());
      ++i;
    }
  }
  slf::fuzz::accept(slf::import_colmap_text(directory.path()));
  slf::fuzz::accept(slf::import_colmap_binary(directory.path()));
  return 0;
}
