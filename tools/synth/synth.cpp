#include "tools/synth/synth.h"

#include <charconv>
#include <cstdio>
#include <fstream>
#include <optional>

#include "slf/parallel.h"
#include "tools/synth/rings.h"
#include "tools/synth/sample_points.h"
#include "tools/synth/trace.h"

namespace slf::synth {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = "\"renderer\": \"slf synth\"";  // how we know a capture of ours

std::optional<InputError> check(const SynthSettings& s) {
  const auto outside = [](const char* name, int value, int low, int high) {
    return InputError{Errc::kInvalidArgument, std::string(name) + " " + std::to_string(value) +
                                                  " is outside " + std::to_string(low) + " .. " +
                                                  std::to_string(high)};
  };
  if (s.width < 8 || s.width > 4096) return outside("width", s.width, 8, 4096);
  if (s.height < 8 || s.height > 4096) return outside("height", s.height, 8, 4096);
  if (s.points != 0 && (s.points < 100 || s.points > 10'000'000))
    return outside("points", s.points, 100, 10'000'000);
  if (s.circles < 1 || s.circles > 99) return outside("circles", s.circles, 1, 99);
  if (s.per_circle < 1 || s.per_circle > 360) return outside("per_circle", s.per_circle, 1, 360);
  if (s.supersampling < 1 || s.supersampling > 8)
    return outside("supersampling", s.supersampling, 1, 8);
  const DisturbSettings& d = s.disturb;
  if (!(d.noise >= 0 && d.noise <= 10))
    return InputError{Errc::kInvalidArgument, "noise: 0 to 10 point spacings"};
  if (!(d.noise_scale >= 0 && d.noise_scale <= 1000))
    return InputError{Errc::kInvalidArgument, "noise scale: 0 to 1000 point spacings"};
  if (!(d.hull >= 0 && d.hull <= 20))
    return InputError{Errc::kInvalidArgument, "hull: 0 to 20 point spacings"};
  return std::nullopt;
}

bool is_synthetic(const fs::path& directory) {
  std::ifstream file(directory / "cameras.json", std::ios::binary);
  std::string head(256, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.find(kMark) != std::string::npos;
}

void put(std::string& json, double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value + 0.0).ptr;  // + 0.0: no "-0"
  json.append(text, end);
}

template <std::size_t N>
void put(std::string& json, const std::array<double, N>& values) {
  json += '[';
  for (std::size_t i = 0; i < N; ++i) {
    if (i > 0) json += ", ";
    put(json, values[i]);
  }
  json += ']';
}

std::string cameras_json(const std::string& scene, const Rings& rings) {
  std::string json =
      "{\"name\": \"" + scene + "\", " + kMark + ", \"pixel_centres\": \"+0.5\", \"cameras\": [";
  for (std::size_t i = 0; i < rings.cameras.size(); ++i) {
    const Camera& c = rings.cameras[i];
    json += i == 0 ? "\n" : ",\n";
    json += "{\"image\": \"" + c.name + "\", \"width\": " + std::to_string(c.width) +
            ", \"height\": " + std::to_string(c.height) + ", \"K\": [";
    put(json, Vec3{c.fx, 0, c.cx});
    json += ", ";
    put(json, Vec3{0, c.fy, c.cy});
    json += ", [0, 0, 1]], \"R\": [";
    for (std::size_t row = 0; row < 3; ++row) {
      if (row > 0) json += ", ";
      put(json, c.rotation[row]);
    }
    json += "], \"t\": ";
    put(json, c.translation);
    json += ", \"circle\": " + std::to_string(rings.circle[i]) +
            ", \"index\": " + std::to_string(rings.index[i]) + "}";
  }
  json += "],\n\"splits\": {";
  const char* separator = "\n";
  for (const auto& [split, members] : rings.splits) {
    json += separator + ("\"" + split) + "\": [";
    for (std::size_t i = 0; i < members.size(); ++i)
      json += (i > 0 ? ", \"" : "\"") + rings.cameras[std::size_t(members[i])].name + "\"";
    json += "]";
    separator = ",\n";
  }
  return json + "}}\n";
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

Result<Done, InputError> write_cameras(const fs::path& directory, const std::string& json) {
  return write_file(directory / "cameras.json", json.data(), json.size());
}

/// Leaves an empty images/ and a cameras.json that marks the directory as ours, without cameras.
Result<Done, InputError> prepare(const fs::path& directory, const SynthSettings& settings) {
  std::error_code error;
  const bool exists = fs::exists(directory, error);
  if (exists && !fs::is_directory(directory, error))
    return InputError{Errc::kUnwritable, directory.string() + ": is not a directory"};
  const bool ours = exists && is_synthetic(directory);
  if (exists && !ours && !settings.force && !fs::is_empty(directory, error))
    return InputError{Errc::kUnwritable,
                      directory.string() + ": is neither empty nor a synthetic capture"};
  if (ours) fs::remove_all(directory / "images", error);
  if (ours) fs::remove(directory / "exact.ply", error);
  fs::create_directories(directory / "images", error);
  if (error) return InputError{Errc::kUnwritable, directory.string() + ": " + error.message()};
  return write_cameras(directory, cameras_json(settings.scene, {}));
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

Result<Done, InputError> write_images(const Scene& scene, const Rings& rings,
                                      const SynthSettings& settings, const fs::path& directory,
                                      const Progress& progress) {
  const std::size_t count = rings.cameras.size();
  std::vector<std::optional<InputError>> errors(count);
  parallel_ranges(
      count, 1, settings.threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const Camera& camera = rings.cameras[i];
          const Image image = trace_image(scene, camera, settings.supersampling);
          const auto written = write_png(directory / camera.name, image);
          if (!written) errors[i] = written.error();
        }
      },
      [&](std::size_t done) {
        if (progress) progress("images", static_cast<double>(done) / static_cast<double>(count));
      });
  for (const auto& error : errors)
    if (error) return *error;
  return Done{};
}

}  // namespace

std::unique_ptr<Scene> make_scene(const std::string& name) {
  if (name == "can") return make_can();
  if (name == "die") return make_die();
  if (name == "vase") return make_vase();
  return nullptr;
}

std::string scene_names() { return "can, die, vase"; }

Result<Done, InputError> synthesise(const SynthSettings& settings, const fs::path& directory,
                                    const Progress& progress) {
  if (const auto error = check(settings)) return *error;
  const auto scene = make_scene(settings.scene);
  if (!scene)
    return InputError{Errc::kInvalidArgument,
                      "scene " + settings.scene + " is none of " + scene_names()};
  const Rings rings = make_rings(settings.circles, settings.per_circle, settings.width,
                                 settings.height, scene->bounds().radius);
  SLF_TRY([[maybe_unused]] const Done prepared, prepare(directory, settings));
  SLF_CHECK(write_points(*scene, settings, directory));
  if (settings.mesh) SLF_CHECK(write_mesh(*scene, directory));
  SLF_TRY([[maybe_unused]] const Done images,
          write_images(*scene, rings, settings, directory, progress));
  return write_cameras(directory, cameras_json(settings.scene, rings));
}

}  // namespace slf::synth
