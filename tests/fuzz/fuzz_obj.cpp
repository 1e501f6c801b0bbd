// SPDX-License-Identifier: Apache-2.0
// OBJ and STL meshes.
#include "capture/mesh_formats.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (auto mesh = slf::parse_obj("fuzz.obj", {data, size}))
    slf::fuzz::accept(slf::check_mesh("fuzz.obj", *mesh));
  if (auto mesh = slf::parse_stl("fuzz.stl", {data, size}))
    slf::fuzz::accept(slf::check_mesh("fuzz.stl", *mesh));
  return 0;
}
