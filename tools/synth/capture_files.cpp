// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/capture_files.h"

#include <charconv>
#include <fstream>
#include <optional>

#include "slf/parallel.h"
#include "tools/synth/exposure_drift.h"
#include "tools/synth/trace.h"

namespace slf::synth {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = "\"renderer\": \"slf synth\"";  // how we know a capture of ours

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

Result<Done, InputError> write_json(const fs::path& directory, const std::string& json) {
  return write_file(directory / "cameras.json", json.data(), json.size());
}

}  // namespace

Result<Done, InputError> prepare_capture(const fs::path& directory, const std::string& scene,
                                         bool force) {
  std::error_code error;
  const bool exists = fs::exists(directory, error);
  if (exists && !fs::is_directory(directory, error))
    return InputError{Errc::kUnwritable, directory.string() + ": is not a directory"};
  const bool ours = exists && is_synthetic(directory);
  if (exists && !ours && !force && !fs::is_empty(directory, error))
    return InputError{Errc::kUnwritable,
                      directory.string() + ": is neither empty nor a synthetic capture"};
  if (ours) fs::remove_all(directory / "images", error);
  if (ours) fs::remove(directory / "exact.ply", error);
  fs::create_directories(directory / "images", error);
  if (error) return InputError{Errc::kUnwritable, directory.string() + ": " + error.message()};
  return write_json(directory, cameras_json(scene, {}));
}

Result<Done, InputError> write_capture(const fs::path& directory, const std::string& scene,
                                       bool force,
                                       const std::function<Result<Done, InputError>()>& write) {
  std::error_code error;
  const bool existed = fs::exists(directory, error);
  const bool foreign = existed && !is_synthetic(directory) && !fs::is_empty(directory, error);
  auto written = prepare_capture(directory, scene, force);
  if (written) written = write();
  if (written || foreign) return written;
  fs::remove_all(directory / "images", error);
  for (const char* name : {"cameras.json", "points.ply", "exact.ply", "mesh.obj"})
    fs::remove(directory / name, error);
  if (!existed) fs::remove(directory, error);
  return written;
}

Result<Done, InputError> write_images(const Subject& subject, const Rings& rings,
                                      const PhotographSettings& settings, int threads,
                                      const fs::path& directory, const Progress& progress) {
  const std::size_t count = rings.cameras.size();
  std::vector<std::optional<InputError>> errors(count);
  parallel_ranges(
      count, 1, threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const Camera& camera = rings.cameras[i];
          Image image = trace_image(subject, camera, settings.supersampling);
          if (settings.exposure_drift > 0)
            expose(image, drawn_gains(settings.seed, i, settings.exposure_drift));
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

Result<Done, InputError> write_cameras(const fs::path& directory, const std::string& scene,
                                       const Rings& rings) {
  return write_json(directory, cameras_json(scene, rings));
}

}  // namespace slf::synth
