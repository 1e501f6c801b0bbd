// SPDX-License-Identifier: Apache-2.0
// Writes ball.ply, ball.glb, ball.spz and expected.json to a directory, for a reader that is not
// ours: tests/readers/read_splats.mjs. What is expected comes from the light field, not from
// splats.
//   splat_files DIRECTORY
#include <cstdio>
#include <nlohmann/json.hpp>

#include "lightfield/splats/splat_axes.h"
#include "slf/capture.h"
#include "splats_support.h"

namespace slf {
namespace {

/// What some points have: where they are, and colours along directions from which they are seen.
nlohmann::json expected(const ViewMaps& maps, const SplatCloud& splats) {
  auto points = nlohmann::json::array();
  for (std::size_t p = 0; p < splats.size(); p += 29) {
    const auto& n = splats.normals[p];
    auto views = nlohmann::json::array();
    for (const Vec3& tilt : {Vec3{0, 0, 0}, {0.5, 0.1, -0.3}, {-0.2, 0.4, 0.6}}) {
      Vec3 v{double{n[0]} + tilt[0], double{n[1]} + tilt[1], double{n[2]} + tilt[2]};
      const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      for (double& x : v) x /= length;
      const auto [theta, gamma] = direction_of(turned_back(splats.axes, v));
      views.push_back({{"towards_eye", v}, {"rgb", maps.radiance(p, theta, gamma)}});
    }
    points.push_back({{"index", p},
                      {"position", splats.positions[p]},
                      {"normal", n},
                      {"deviation", splats.deviations[p]},
                      {"views", views}});
  }
  return {{"count", splats.size()}, {"points", points}};
}

int write(const std::filesystem::path& directory) {
  const ViewMaps maps(test::harmonic_ball(Directions::kReflected, 5));
  nlohmann::json all;
  for (const auto& [name, format, axes] :
       {std::tuple{"ball.ply", SplatFormat::kPly, SplatAxes::kYDown},
        {"ball.glb", SplatFormat::kGlb, SplatAxes::kYUp},
        {"ball.spz", SplatFormat::kSpz, SplatAxes::kYUp}}) {
    const auto splats = make_splats(maps, {.axes = axes});
    if (!splats) return 1;
    const auto bytes = splat_file(*splats, format);
    if (!bytes || !write_file(directory / name, bytes->data(), bytes->size())) return 1;
    all[name] = expected(maps, *splats);
  }
  const std::string text = all.dump();
  return write_file(directory / "expected.json", text.data(), text.size()) ? 0 : 1;
}

}  // namespace
}  // namespace slf

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("splat_files DIRECTORY\n", stderr);
    return 2;
  }
  std::filesystem::create_directories(argv[1]);
  return slf::write(argv[1]);
}
