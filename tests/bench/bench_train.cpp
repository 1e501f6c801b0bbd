// SPDX-License-Identifier: Apache-2.0
// Surfels trained on a capture's photographs: bench_train CAPTURE [POINTS [ITERATIONS [SURFELS
// [SPLATS.ply]]]]. SURFELS 0: as many as the photographs resolve.
// Seconds by stage; photographs that were held out, as the surfels themselves show them.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <utility>

#include "base/stopwatch.h"
#include "capture/spacing.h"
#include "encoder/measure/captured_view.h"
#include "encoder/train/draw_surfels.h"
#include "encoder/train/fuse_surfels.h"
#include "encoder/train/train_gaussians.h"
#include "encoder/train/train_surfels.h"
#include "slf/capture.h"
#include "slf/gaussian_files.h"

namespace {

using namespace slf;

struct Errors {
  double squares = 0, count = 0;
  double decibels() const { return -10 * std::log10(squares / std::max(count, 1.0)); }
};

struct HeldOut {
  Errors inside, all;
};

/// As `slf eval` tells the object from the rest.
bool add_view(const Capture& capture, const CapturedSurface& surface, const TrainedSurfels& surfels,
              const TrainingView& view, HeldOut& sums) {
  const auto image = load_image(capture, view.index);
  if (!image) return false;
  const Camera& camera = capture.cameras[std::size_t(view.index)];
  const CapturedView seen = captured_view(capture, surface, camera, *image, 2.5);
  DrawnSurfels drawn;
  draw_surfels(tile_surfels(surfels, view.camera, 0), view, 0, drawn);
  for (std::size_t i = 0; i < view.picture.pixels(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const double error =
          double(std::clamp(drawn.picture.plane(c)[i], 0.0f, 1.0f) - view.picture.plane(c)[i]);
      sums.all.squares += error * error, ++sums.all.count;
      if (seen.object[i] && drawn.transparency[i] <= 0.5f)
        sums.inside.squares += error * error, ++sums.inside.count;
    }
  return true;
}

bool write_splats(const char* file, Gaussians splats) {
  const auto bytes = gaussian_file(std::move(splats), SplatFormat::kPly);
  if (!bytes) return std::fprintf(stderr, "%s\n", bytes.error().message.c_str()), false;
  const std::span<const std::byte> pieces[] = {std::as_bytes(std::span(*bytes))};
  const auto written = write_file(file, pieces);
  if (!written) std::fprintf(stderr, "%s\n", written.error().message.c_str());
  return bool(written);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  CaptureOptions options;
  if (argc > 2) options.points = argv[2];
  const auto capture = load_capture(argv[1], options);
  if (!capture) return std::fprintf(stderr, "%s\n", capture.error().message.c_str()), 1;
  const auto input = split_cameras(*capture, "default"),
             held = split_cameras(*capture, "evaluation");
  if (!input || !held) return 1;
  const CapturedSurface surface = captured_surface(*capture, 0);
  const SurfacePoints points{capture->cloud.positions, surface.normals, {}};
  TrainSettings settings;
  if (argc > 3) settings.iterations = std::atoi(argv[3]);
  Stopwatch watch;
  auto views = load_training_views(*capture, *input, points, surface.spacing, 0, 0);
  if (!views) return 1;
  const bool gaussian = argc > 5;  // as those who read the PLY draw them
  if (gaussian) settings.together = settings.decided = settings.spread = 0;
  for (TrainingView& view : *views) view.camera.gaussian = gaussian;
  settings.surfels = argc > 4 && std::atoi(argv[4]) > 0
                         ? std::size_t(std::atoi(argv[4]))
                         : surfels_for(points, training_pixel(*views));
  TrainedSurfels surfels =
      start_surfels(points, surface.spacing, *views, settings.surfels / 2, kSolidOpacity, 0);
  std::printf("%zu points, %zu photographs, %zu of at most %zu surfels at first: %.1f s\n",
              points.size(), views->size(), surfels.size(), settings.surfels, watch.lap());
  if (!train_surfels(*views, settings, surfels)) return 1;
  std::printf("%zu surfels, %d iterations: %.1f s\n", surfels.size(), settings.iterations,
              watch.lap());
  if (argc > 5)
    if (!write_splats(argv[5], gaussians_of(surfels))) return 1;
  Lattice lattice;
  lattice.step = 1.6 * training_pixel(*views);
  const SurfacePoints fused = fuse_surfels(surfels, *views, lattice, {});
  std::printf("%zu points in one layer: %.1f s\n", fused.size(), watch.lap());
  auto test = load_training_views(*capture, *held, points, surface.spacing, 0, 0);
  if (!test) return 1;
  for (TrainingView& view : *test) view.camera.gaussian = gaussian;
  HeldOut sums;
  for (const TrainingView& view : *test)
    if (!add_view(*capture, surface, surfels, view, sums)) return 1;
  std::printf("held out: inside %.2f dB, all pixels %.2f dB\n", sums.inside.decibels(),
              sums.all.decibels());
  return 0;
}
