// SPDX-License-Identifier: Apache-2.0
// Plans of scenes: what is read is written as it was read.
#include <cstdlib>

#include "slf/scene.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const slf::fuzz::MemoryFile file({data, size});
  const auto plan = slf::read_plan(file.path());
  if (!plan) return 0;
  const std::string text = slf::write_plan(*plan);
  const slf::fuzz::MemoryFile again(
      {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  const auto same = slf::read_plan(again.path());
  if (!same || slf::write_plan(*same) != text) std::abort();
  (void)slf::cost_of(*plan);
  slf::fuzz::accept(true);
  return 0;
}
