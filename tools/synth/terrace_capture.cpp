// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/terrace_capture.h"

#include "tools/synth/capture_files.h"
#include "tools/synth/ply_stream.h"
#include "tools/synth/terrace.h"
#include "tools/synth/terrace_points.h"
#include "tools/synth/terrace_views.h"

namespace slf::synth {
namespace {

constexpr int kHouses = 12, kCameras = 120, kPoints = 1'000'000;

void append(PointCloud& all, const PointCloud& piece) {
  const auto add = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  add(all.positions, piece.positions);
  add(all.normals, piece.normals);
  add(all.colours, piece.colours);
}

Result<Done, InputError> write_terrace_points(const Terrace& terrace, const SynthSettings& settings,
                                              const std::filesystem::path& directory,
                                              const Progress& progress) {
  const int points = settings.points > 0 ? settings.points : kPoints;
  const double step = terrace_step(terrace, points, settings.threads);
  const bool disturbed = settings.disturb.any();
  PlyStream file(directory / (disturbed ? "exact.ply" : "points.ply"));
  PointCloud all;
  sample_terrace(terrace, step, settings.threads, [&](const PointCloud& piece, double done) {
    file.append(piece);
    if (disturbed) append(all, piece);
    if (progress) progress("points", done);
  });
  SLF_CHECK(file.finish());
  if (!disturbed) return Done{};
  disturb(all, step, settings.disturb);
  return write_ply(directory / "points.ply", all);
}

}  // namespace

Result<Done, InputError> synthesise_terrace(const SynthSettings& settings,
                                            const std::filesystem::path& directory,
                                            const Progress& progress) {
  const Terrace terrace(settings.houses > 0 ? settings.houses : kHouses, settings.disturb.seed);
  const Rings views =
      make_terrace_views(terrace.plan(), settings.cameras > 0 ? settings.cameras : kCameras,
                         settings.width, settings.height);
  return write_capture(directory, settings.scene, settings.force,
                       [&]() -> Result<Done, InputError> {
                         SLF_CHECK(write_terrace_points(terrace, settings, directory, progress));
                         SLF_CHECK(write_images(terrace, views, {settings.supersampling},
                                                settings.threads, directory, progress));
                         return write_cameras(directory, settings.scene, views);
                       });
}

}  // namespace slf::synth
