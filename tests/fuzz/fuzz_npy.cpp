// SPDX-License-Identifier: Apache-2.0
// Arrays as slf pack reads them.
#include "tests/fuzz/fuzz.h"
#include "tools/npy.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto array = slf::tools::parse_npy({data, data + size});
  if (array) slf::fuzz::accept(slf::tools::int32_values(*array));
  return 0;
}
