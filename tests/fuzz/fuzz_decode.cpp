// SPDX-License-Identifier: Apache-2.0
// Any bytes are an error or a light field; what the headers say it takes is never less than a
// decode of fewer levels or groups needs.
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto stream = slf::fuzz::with_sound_crcs({data, size});
  slf::DecodeOptions options;
  options.limits = slf::fuzz::small_limits();
  slf::fuzz::accept(slf::decode(stream, options));
  options.levels = 2;
  options.groups = 1;
  (void)slf::decode(stream, options);
  (void)slf::decode_cost(stream, options);
  (void)slf::read_info(stream, options.limits);
  return 0;
}
