// SPDX-License-Identifier: Apache-2.0
// Photographs: PNG (its CRCs are not checked while fuzzing where libpng is built so), JPEG, PPM.
#include "capture/image_formats.h"
#include "capture/netpbm.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const slf::Bytes file(data, size);
  const auto png = slf::png_size(file), jpeg = slf::jpeg_size(file);
  (void)slf::png_header(file);
  (void)slf::jpeg_header(file);
  const auto small = [](const auto& s) { return s && s->width <= 512 && s->height <= 512; };
  if (slf::is_png(file) && small(png)) slf::fuzz::accept(slf::decode_png("fuzz.png", file));
  if (slf::is_jpeg(file) && small(jpeg)) {
    slf::ImageSize read;
    for (int r = 0; r <= slf::kMostJpegReduction; ++r)
      slf::fuzz::accept(slf::decode_jpeg("fuzz.jpg", file, r, read));
  }
  if (slf::is_netpbm(file) && small(slf::netpbm_size(file)))
    slf::fuzz::accept(slf::decode_netpbm("fuzz.ppm", file));
  return 0;
}
