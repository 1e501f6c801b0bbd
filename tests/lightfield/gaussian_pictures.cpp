// SPDX-License-Identifier: Apache-2.0
// Pictures of a file of splats with their cameras, for a renderer that is not ours to compare:
// tests/lightfield/gaussian_reference_test.py.
//   gaussian_pictures FILE OUT      writes OUT0.ppm, OUT0.json, ...
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "slf/gaussian_files.h"
#include "slf/gaussian_renderer.h"

namespace slf {
namespace {

constexpr int kViews = 2, kWidth = 320, kHeight = 240;
constexpr double kReferenceNearest = 0.25;  // the reference draws nothing in front of 0.2

nlohmann::json described(const Camera& c) {
  return {{"width", c.width},
          {"height", c.height},
          {"K", {{c.fx, 0, c.cx}, {0, c.fy, c.cy}, {0, 0, 1}}},
          {"R", c.rotation},
          {"t", c.translation}};
}

/// Farther away with as much longer a lens, so that all of a small scene is drawn by both.
Camera moved_back(Camera camera, double radius) {
  const double more = std::max(0.0, kReferenceNearest + 2 * radius - camera.translation[2]);
  const double scale = (camera.translation[2] + more) / camera.translation[2];
  camera.translation[2] += more;
  camera.fx *= scale;
  camera.fy *= scale;
  return camera;
}

int write(const std::string& file, const std::string& out) {
  const auto read = read_gaussians(file);
  if (!read) {
    std::fprintf(stderr, "%s\n", read.error().message.c_str());
    return 1;
  }
  RenderSettings settings;
  settings.background = {0, 0, 0};
  const GaussianRenderer renderer(read->gaussians, settings);
  for (int i = 0; i < kViews; ++i) {
    const Camera orbit = renderer.orbit(0.15 + double(i) / kViews, 15, kWidth, kHeight);
    // At 30 degrees the distance is 4 radii.
    const Camera camera = moved_back(orbit, 0.3 * orbit.translation[2]);
    const Rendering rendering = renderer.render(camera);
    std::string text = "P6 " + std::to_string(kWidth) + " " + std::to_string(kHeight) + " 255\n";
    text.append(rendering.image.data.begin(), rendering.image.data.end());
    const std::string json = described(camera).dump(), name = out + std::to_string(i);
    if (!write_file(name + ".ppm", text.data(), text.size()) ||
        !write_file(name + ".json", json.data(), json.size()))
      return 1;
  }
  return 0;
}

}  // namespace
}  // namespace slf

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("gaussian_pictures FILE OUT\n", stderr);
    return 2;
  }
  return slf::write(argv[1], argv[2]);
}
