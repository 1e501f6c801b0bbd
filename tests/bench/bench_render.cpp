// SPDX-License-Identifier: Apache-2.0
// One frame on one thread, by stage: bench_render FILE.slf [SIZE [FRAMES]]. User seconds, mean over
// cameras of an orbit that fills the picture.
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>

#include "lightfield/render/render_splats.h"
#include "lightfield/render/splat_weights.h"
#include "lightfield/render/surfel_cloud.h"
#include "slf/capture.h"
#include "slf/decoder.h"
#include "slf/render.h"

namespace {

using namespace slf;

double user_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_utime.tv_sec) + 1e-6 * double(usage.ru_utime.tv_usec);
}

template <class Work>
void add_seconds(double& sum, Work work) {
  const double start = user_seconds();
  work();
  sum += user_seconds() - start;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_render FILE.slf [SIZE [FRAMES]]\n");
    return 2;
  }
  const int size = argc > 2 ? std::atoi(argv[2]) : 800, frames = argc > 3 ? std::atoi(argv[3]) : 20;
  const auto bytes = read_file(argv[1]);
  if (!bytes || size < 1 || frames < 1) return 1;
  const auto field = decode(*bytes);
  if (!field || !field->header.has_basis) return 1;
  const ViewMaps maps(*field, 1);
  RenderSettings settings;
  settings.threads = 1;
  double prepare = 0, whole = 0, project = 0, colour = 0, blend = 0, weigh = 0;
  std::unique_ptr<const Renderer> renderer;
  add_seconds(prepare, [&] { renderer = std::make_unique<const Renderer>(maps, settings); });
  const SurfelCloud cloud =
      surfel_cloud(field->header.grid, field->positions, field->normals, 0, 1);
  std::size_t shown = 0, entries = 0;
  for (int i = 0; i < frames; ++i) {
    const Camera camera = renderer->orbit((i + 0.5) / frames, 30, size, size);
    add_seconds(whole, [&] { (void)renderer->render(camera); });
    std::vector<Splat> splats;
    add_seconds(project, [&] { splats = project_surfels(cloud, camera, 1); });
    const ColourSource source = [&](std::span<const std::uint32_t> points,
                                    std::span<std::array<float, 3>> colours) {
      add_seconds(colour, [&] { maps.radiances(camera.centre(), points, colours); });
      shown += points.size();
    };
    add_seconds(blend, [&] { (void)rasterise(splats, size, size, 1, source); });
    add_seconds(weigh, [&] { entries += splat_weights(splats, size, size, 1).point.size(); });
  }
  const double ms = 1000.0 / frames;
  std::printf("%zu points, %zu shown, %d x %d: %.1f ms a frame (%.1f frames/s)\n",
              maps.num_points(), shown / std::size_t(frames), size, size, whole * ms,
              frames / whole);
  std::printf("  projection %.1f, colours %.1f, rasterisation %.1f ms; once %.0f ms\n",
              project * ms, colour * ms, (blend - colour) * ms, 1000 * prepare);
  std::printf("  weights for a fit %.1f ms, %zu entries\n", (project + weigh) * ms,
              entries / std::size_t(frames));
}
