// SPDX-License-Identifier: Apache-2.0
// Image-plus-geometry files, with the calibration that the seeds were made with: cameras named
// images/N.png, of 32 x 32 pixels.
#include "tests/fuzz/fuzz.h"
#include "tools/rd/igc/igc.h"

namespace {

slf::Capture calibration() {
  slf::Capture capture;
  for (int i = 0; i < 4; ++i) {
    slf::Camera camera;
    camera.name = "images/" + std::to_string(i) + ".png";
    camera.width = camera.height = 32;
    camera.fx = camera.fy = 40;
    camera.cx = camera.cy = 16;
    camera.translation = {0.3 * i - 0.5, 0, 3};
    capture.cameras.push_back(camera);
  }
  return capture;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const slf::Capture capture = calibration();
  slf::IgcDecodeOptions options;
  options.limits = slf::fuzz::small_limits();
  options.limits.max_points = 1 << 9;
  options.estimate_normals = true;
  options.threads = 1;
  slf::fuzz::accept(slf::decode_igc({data, size}, capture, options));
  return 0;
}
