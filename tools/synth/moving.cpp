// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/moving.h"

#include <fstream>
#include <numbers>
#include <optional>

#include "tools/synth/capture_files.h"
#include "tools/synth/moving_views.h"

namespace slf::synth {
namespace {

namespace fs = std::filesystem;

constexpr int kFirstFrame = 1;
constexpr const char* kMovingMark = "\"renderer\": \"slf synth --frames\"";
constexpr int kDefaultBits = 8, kDefaultPoints = 40'000, kDefaultCircles = 3, kDefaultPerCircle = 8;
// Samples are so far apart, in voxels: hardly any voxel that the surface runs through has none.
constexpr double kSampleSpacing = 0.32;

InputError not_allowed(const std::string& message) { return {Errc::kInvalidArgument, message}; }

std::optional<InputError> check_moving(const MovingSettings& s, bool cloud) {
  struct Allowed {
    const char* name;
    int value, low, high;
  };
  for (const Allowed& a : {Allowed{"frames", s.frames, 1, 9999},
                           {"bits", s.bits == 0 ? 8 : s.bits, 5, 12},
                           {"views", s.views == 0 ? 2 : s.views, 2, 254},
                           {"width", s.width, 8, 4096},
                           {"height", s.height, 8, 4096},
                           {"points", s.points == 0 ? 100 : s.points, 100, 10'000'000},
                           {"circles", s.circles == 0 ? 1 : s.circles, 1, 99},
                           {"per_circle", s.per_circle == 0 ? 2 : s.per_circle, 1, 360},
                           {"supersampling", s.supersampling, 1, 8}})
    if (a.value < a.low || a.value > a.high)
      return not_allowed(std::string(a.name) + " " + std::to_string(a.value) + " is outside " +
                         std::to_string(a.low) + " .. " + std::to_string(a.high));
  if (!(std::abs(s.camera_turn) <= 180)) return not_allowed("camera turn: -180 to 180 degrees");
  if (cloud && (s.points != 0 || s.circles != 0 || s.per_circle != 0 || s.camera_turn != 0))
    return not_allowed(s.scene + " is a cloud on a grid of --bits: it has no --points, no cameras");
  if (!cloud && s.views != 0)
    return not_allowed(s.scene + " is a capture: --plenoptic is of clouds");
  if (!cloud && s.bits != 0)
    return not_allowed(s.scene + " is a capture: it has --points, bits are of clouds");
  return std::nullopt;
}

std::string moving_json(const MovingSettings& s, int written) {
  return "{\"name\": \"" + s.scene + "\", " + kMovingMark +
         ", \"frames\": " + std::to_string(written) + "}\n";
}

bool is_moving(const fs::path& directory) {
  std::ifstream file(directory / "moving.json", std::ios::binary);
  std::string head(256, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.find(kMovingMark) != std::string::npos;
}

/// As frame_name() makes them, with or without ".ply".
bool is_frame_entry(const fs::path& entry) {
  const std::string stem = entry.stem().string(), extension = entry.extension().string();
  return stem.size() == 10 && stem.starts_with("frame_") &&
         stem.find_first_not_of("0123456789", 6) == std::string::npos &&
         (extension.empty() || extension == ".ply");
}

Result<Done, InputError> write_mark(const MovingSettings& s, const fs::path& directory,
                                    int written) {
  const std::string json = moving_json(s, written);
  return write_file(directory / "moving.json", json.data(), json.size());
}

/// Empty of our frames, and marked as ours.
Result<Done, InputError> prepare_frames(const MovingSettings& s, const fs::path& directory) {
  std::error_code error;
  const bool exists = fs::exists(directory, error);
  if (exists && !fs::is_directory(directory, error))
    return InputError{Errc::kUnwritable, directory.string() + ": is not a directory"};
  const bool ours = exists && is_moving(directory);
  if (exists && !ours && !s.force && !fs::is_empty(directory, error))
    return InputError{Errc::kUnwritable,
                      directory.string() + ": is neither empty nor a synthetic moving scene"};
  if (ours) {
    std::vector<fs::path> old;
    for (const auto& entry : fs::directory_iterator(directory, error))
      if (is_frame_entry(entry.path())) old.push_back(entry.path());
    for (const fs::path& path : old) fs::remove_all(path, error);
  }
  fs::create_directories(directory, error);
  if (error) return InputError{Errc::kUnwritable, directory.string() + ": " + error.message()};
  return write_mark(s, directory, 0);
}

/// All cameras go about the upright axis: the world is turned the other way before each sees it.
Rings turned_rings(Rings rings, double angle) {
  for (Camera& camera : rings.cameras)
    for (Vec3& row : camera.rotation) row = turned(row, {0, 0, 1}, angle);
  return rings;
}

/// The progress of one frame as a part of that of all.
Progress part_of(const Progress& progress, int done, int frames) {
  if (!progress) return {};
  return [=](const char* stage, double fraction) { progress(stage, (done + fraction) / frames); };
}

Result<Done, InputError> write_clouds(const MovingSettings& s, const MovingScene& scene,
                                      const fs::path& directory, const Progress& progress) {
  const FrameGrid grid = frame_grid(scene, s.bits == 0 ? kDefaultBits : s.bits);
  const auto samples = material_samples(scene, kSampleSpacing * grid.step);
  for (int i = 0; i < s.frames; ++i) {
    if (progress) progress("frames", static_cast<double>(i) / s.frames);
    const fs::path file = directory / (frame_name(i + kFirstFrame) + ".ply");
    SLF_CHECK(s.views > 0
                  ? write_plenoptic(file, voxel_views(scene, grid, samples, i, s.views, s.threads))
                  : write_ply(file, voxel_frame(scene, grid, samples, i, s.threads)));
  }
  return Done{};
}

Result<Done, InputError> write_captures(const MovingSettings& s, const MovingScene& scene,
                                        const fs::path& directory, const Progress& progress) {
  const Rings rings = make_even_rings(s.circles == 0 ? kDefaultCircles : s.circles,
                                      s.per_circle == 0 ? kDefaultPerCircle : s.per_circle, s.width,
                                      s.height, scene.radius);
  if (rings.cameras.size() < 2) return not_allowed("one camera is not enough for a capture");
  const auto samples =
      material_samples(scene, spacing_of(scene, s.points == 0 ? kDefaultPoints : s.points));
  for (int i = 0; i < s.frames; ++i) {
    const fs::path place = directory / frame_name(i + kFirstFrame);
    SLF_CHECK(prepare_capture(place, s.scene, s.force));
    SLF_CHECK(write_ply(place / "points.ply", moved_cloud(scene, samples, i, s.threads)));
    const MovingFrame frame(scene, i, s.threads);
    const Rings now = turned_rings(rings, s.camera_turn * i * std::numbers::pi / 180);
    SLF_CHECK(write_images(frame, now, {s.supersampling}, s.threads, place,
                           part_of(progress, i, s.frames)));
    SLF_CHECK(write_cameras(place, s.scene, now));
  }
  return Done{};
}

}  // namespace

std::string frame_name(int number) {
  const std::string digits = std::to_string(number);
  return "frame_" + std::string(digits.size() < 4 ? 4 - digits.size() : 0, '0') + digits;
}

Result<Done, InputError> synthesise_moving(const MovingSettings& settings,
                                           const fs::path& directory, const Progress& progress) {
  const auto scene = make_moving_scene(settings.scene);
  if (!scene)
    return not_allowed("scene " + settings.scene +
                       " is none of those that move: " + moving_scene_names());
  if (const auto error = check_moving(settings, scene->cloud)) return *error;
  SLF_TRY([[maybe_unused]] const Done prepared, prepare_frames(settings, directory));
  SLF_TRY([[maybe_unused]] const Done frames,
          scene->cloud ? write_clouds(settings, *scene, directory, progress)
                       : write_captures(settings, *scene, directory, progress));
  return write_mark(settings, directory, settings.frames);
}

}  // namespace slf::synth
