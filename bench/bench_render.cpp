// Median time of an image from a light field: bench_render [FILE.slf] [--size N] [--threads N].
// Without a file: the synthetic can on an 8-bit grid, 128 functions per point.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "slf/capture.h"
#include "slf/decoder.h"
#include "slf/render.h"
#include "slf/view_map.h"
#include "tools/synth/sample_points.h"
#include "tools/synth/scene.h"

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The can in its diffuse colours, with some of everything in the other functions.
slf::Result<slf::LightField, slf::InputError> synthetic_light_field(int threads) {
  const auto scene = slf::synth::make_scene("can");
  SLF_TRY(const slf::VoxelCloud cloud,
          slf::voxelise(slf::synth::sample_points(*scene, 0, threads), 8));
  slf::LightField field;
  field.header.grid = cloud.grid;
  field.header.num_functions = field.header.basis.num_functions();
  field.header.shift.assign(std::size_t(field.header.num_functions), 4);
  field.positions = cloud.positions;
  std::uint32_t state = 1;
  for (const auto& colour : cloud.colours)
    for (int k = 0; k < field.header.num_functions; ++k)
      for (const float c : colour) {
        state = state * 1664525u + 1013904223u;
        field.components.push_back(k == 0 ? static_cast<std::int32_t>(16 * c)
                                          : static_cast<std::int32_t>(state >> 27) - 16);
      }
  return field;
}

int run(const char* file, int size, int threads) {
  slf::LightField field;
  if (file) {
    const auto bytes = slf::read_file(file);
    if (!bytes) return std::fprintf(stderr, "%s\n", bytes.error().message.c_str()), 3;
    auto decoded = slf::decode(*bytes);
    if (!decoded) return std::fprintf(stderr, "%s\n", to_string(decoded.error()).c_str()), 4;
    field = *std::move(decoded);
  } else {
    auto made = synthetic_light_field(threads);
    if (!made) return std::fprintf(stderr, "%s\n", made.error().message.c_str()), 4;
    field = *std::move(made);
  }
  auto start = std::chrono::steady_clock::now();
  const slf::ViewMaps maps(field, threads);
  const double seconds_maps = seconds_since(start);
  start = std::chrono::steady_clock::now();
  slf::RenderSettings settings;
  settings.threads = threads;
  const slf::Renderer renderer(maps, settings);
  const double seconds_prepare = seconds_since(start);
  constexpr int kImages = 21;
  std::vector<double> seconds;
  for (int i = 0; i < kImages; ++i) {
    const slf::Camera camera = renderer.orbit(double(i) / kImages, 20, size, size);
    start = std::chrono::steady_clock::now();
    const auto rendering = renderer.render(camera);
    seconds.push_back(seconds_since(start));
  }
  std::sort(seconds.begin(), seconds.end());
  std::printf("points %zu, %d x %d, threads %d (0: all)\n", maps.num_points(), size, size, threads);
  std::printf("nodes %.3f s, surfels %.3f s, image median %.4f s (%.4f .. %.4f)\n", seconds_maps,
              seconds_prepare, seconds[kImages / 2], seconds.front(), seconds.back());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const char* file = nullptr;
  int size = 800, threads = 0;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--size") == 0 && i + 1 < argc)
      size = std::atoi(argv[++i]);
    else if (std::strcmp(argv[i], "--threads") == 0 && i + 1 < argc)
      threads = std::atoi(argv[++i]);
    else
      file = argv[i];
  }
  return run(file, std::clamp(size, 1, 8192), threads);
}
