// SPDX-License-Identifier: Apache-2.0
// Descriptions of cameras: transforms.json, cameras.json, those of Bundler, Metashape and openMVG,
// each as the others too, and the split files of a directory.
#include <array>

#include "capture/importer.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const slf::fuzz::Directory directory;
  const auto parts = slf::fuzz::parts_of({data, size});
  directory.write("transforms.json", parts[0]);
  directory.write("cameras.json", parts[0]);
  directory.write("transforms_train.json", parts[0]);
  directory.write("transforms_test.json", parts.back());
  directory.write("bundle.out", parts[0]);
  directory.write("list.txt", parts.back());
  constexpr std::array<std::uint8_t, 11> kPicture{'P',  '5', '\n', '4', ' ', '4',
                                                  '\n', '2', '5',  '5', '\n'};
  directory.write("a.png", kPicture);  // its size is all that is asked for
  slf::fuzz::accept(slf::import_bundler(directory.path() / "bundle.out"));
  slf::fuzz::accept(slf::import_metashape(directory.path() / "bundle.out"));
  slf::fuzz::accept(slf::import_openmvg(directory.path() / "bundle.out"));
  slf::fuzz::accept(slf::import_transforms_json(directory.path() / "transforms.json"));
  slf::fuzz::accept(slf::import_cameras_json(directory.path() / "cameras.json"));
  (void)slf::import_transforms_splits(directory.path());
  return 0;
}
