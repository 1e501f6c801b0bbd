// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/synth.h"

#include <cstdio>
#include <optional>

#include "tools/synth/capture_files.h"
#include "tools/synth/rings.h"
#include "tools/synth/sample_points.h"
#include "tools/synth/terrace_capture.h"

namespace slf::synth {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTerrace = "terrace";

InputError refused(const std::string& message) { return {Errc::kInvalidArgument, message}; }

struct Range {
  const char* name;
  int value, low, high;
};

std::optional<InputError> check(const SynthSettings& s) {
  const bool terrace = s.scene == kTerrace;
  for (const Range& r :
       {Range{"width", s.width, 8, 4096},
        {"height", s.height, 8, 4096},
        {"circles", s.circles, 1, 99},
        {"per_circle", s.per_circle, 1, 360},
        {"supersampling", s.supersampling, 1, 8},
        {"points", s.points == 0 ? 100 : s.points, 100, terrace ? 100'000'000 : 10'000'000},
        {"houses", s.houses == 0 ? 1 : s.houses, 1, 10'000},
        {"cameras", s.cameras == 0 ? 2 : s.cameras, 2, 10'000}})
    if (r.value < r.low || r.value > r.high)
      return refused(std::string(r.name) + " " + std::to_string(r.value) + " is outside " +
                     std::to_string(r.low) + " .. " + std::to_string(r.high));
  const DisturbSettings& d = s.disturb;
  if (!(d.noise >= 0 && d.noise <= 10)) return refused("noise: 0 to 10 point spacings");
  if (!(d.noise_scale >= 0 && d.noise_scale <= 1000))
    return refused("noise scale: 0 to 1000 point spacings");
  if (!(d.hull >= 0 && d.hull <= 20)) return refused("hull: 0 to 20 point spacings");
  if (!(s.exposure_drift >= 0 && s.exposure_drift <= 0.5))
    return refused("exposure drift: 0 to 0.5");
  if (terrace && s.exposure_drift > 0) return refused("the terrace has no exposure drift");
  if (!terrace && (s.houses != 0 || s.cameras != 0))
    return refused("houses and cameras are of the terrace; can, die and vase have circles");
  if (terrace && s.mesh) return refused("the terrace has no mesh; can and vase have one");
  return std::nullopt;
}

/// mesh.obj, a normal for every vertex.
Result<Done, InputError> write_mesh(const Scene& scene, const fs::path& directory) {
  const Mesh mesh = scene.mesh();
  if (mesh.triangles.empty())
    return InputError{Errc::kInvalidArgument, "this scene has no mesh; can and vase have one"};
  std::string obj;
  char line[128];
  for (const auto& p : mesh.vertices.positions)
    obj.append(line,
               static_cast<std::size_t>(std::snprintf(line, sizeof line, "v %.7g %.7g %.7g\n",
                                                      double{p[0]}, double{p[1]}, double{p[2]})));
  for (const auto& n : mesh.vertices.normals)
    obj.append(line,
               static_cast<std::size_t>(std::snprintf(line, sizeof line, "vn %.5f %.5f %.5f\n",
                                                      double{n[0]}, double{n[1]}, double{n[2]})));
  for (const auto& t : mesh.triangles)
    obj.append(line, static_cast<std::size_t>(
                         std::snprintf(line, sizeof line, "f %u//%u %u//%u %u//%u\n", t[0] + 1,
                                       t[0] + 1, t[1] + 1, t[1] + 1, t[2] + 1, t[2] + 1)));
  return write_file(directory / "mesh.obj", obj.data(), obj.size());
}

Result<Done, InputError> write_points(const Scene& scene, const SynthSettings& settings,
                                      const fs::path& directory) {
  double step = 0;
  PointCloud cloud = sample_points(scene, settings.points, settings.threads, &step);
  if (settings.disturb.any()) {
    SLF_CHECK(write_ply(directory / "exact.ply", cloud));
    disturb(cloud, step, settings.disturb);
  }
  return write_ply(directory / "points.ply", cloud);
}

}  // namespace

std::unique_ptr<Scene> make_scene(const std::string& name) {
  if (name == "can") return make_can();
  if (name == "die") return make_die();
  if (name == "vase") return make_vase();
  return nullptr;
}

std::string scene_names() { return "can, die, vase, terrace"; }

Result<Done, InputError> synthesise(const SynthSettings& settings, const fs::path& directory,
                                    const Progress& progress) {
  if (const auto error = check(settings)) return *error;
  if (settings.scene == kTerrace) return synthesise_terrace(settings, directory, progress);
  const auto scene = make_scene(settings.scene);
  if (!scene)
    return InputError{Errc::kInvalidArgument, "scene " + settings.scene + " is none of " +
                                                  scene_names() +
                                                  ", nor of those that move (slf synth --list)"};
  const Rings rings = make_rings(settings.circles, settings.per_circle, settings.width,
                                 settings.height, scene->bounds().radius);
  return write_capture(
      directory, settings.scene, settings.force, [&]() -> Result<Done, InputError> {
        SLF_CHECK(write_points(*scene, settings, directory));
        if (settings.mesh) SLF_CHECK(write_mesh(*scene, directory));
        SLF_CHECK(write_images(
            *scene, rings, {settings.supersampling, settings.exposure_drift, settings.disturb.seed},
            settings.threads, directory, progress));
        return write_cameras(directory, settings.scene, rings);
      });
}

}  // namespace slf::synth
