// SPDX-License-Identifier: Apache-2.0
// A light field that decodes can be drawn, whatever is in it, and no depth is NaN.
#include <cstdlib>

#include "slf/render.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  slf::DecodeOptions options;
  options.limits = slf::fuzz::small_limits();
  options.limits.max_points = 1 << 11;
  const auto field = slf::decode(slf::fuzz::with_sound_crcs({data, size}), options);
  if (!field || !field->header.has_basis || field->header.num_functions == 0) return 0;
  const slf::ViewMaps maps(*field, 1);
  slf::RenderSettings settings;
  settings.threads = 1;
  const slf::Renderer renderer(maps, settings);
  const slf::Rendering picture = renderer.render(renderer.orbit(0.1, 20, 24, 24));
  for (const float depth : picture.depth)
    if (!(depth > 0)) std::abort();  // NaN is not, infinity is
  slf::fuzz::accept(true);
  return 0;
}
