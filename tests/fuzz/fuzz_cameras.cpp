// SPDX-License-Identifier: Apache-2.0
// Descriptions of cameras: transforms.json and cameras.json, each as the other too, and the split
// files of a directory.
#include "capture/importer.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const slf::fuzz::Directory directory;
  const auto parts = slf::fuzz::parts_of({data, size});
  directory.write("transforms.json", parts[0]);
  directory.write("cameras.json", parts[0]);
  directory.write("transforms_train.json", parts[0]);
  directory.write("transforms_test.json", parts.back());
  slf::fuzz::accept(slf::import_transforms_json(directory.path() / "transforms.json"));
  slf::fuzz::accept(slf::import_cameras_json(directory.path() / "cameras.json"));
  (void)slf::import_transforms_splits(directory.path());
  return 0;
}
