// SPDX-License-Identifier: Apache-2.0
// One frame of Gaussian splats, by stage: bench_gaussians [SPLATS [WIDTHxHEIGHT [THREADS
// [FRAMES]]]]. A synthetic scene: a room whose walls and some balls in it are covered with splats
// of harmonics of degree 3, sizes and opacities spread as trained scenes have them. Seconds, least
// over frames.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "base/stopwatch.h"
#include "lightfield/render/gaussian_cloud.h"
#include "lightfield/render/gaussian_tiles.h"
#include "slf/gaussian_renderer.h"

namespace {

using namespace slf;

std::array<float, 3> unit(std::mt19937& random) {
  std::normal_distribution<float> normal;
  std::array<float, 3> v{normal(random), normal(random), normal(random)};
  const float length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (float& x : v) x /= length;
  return v;
}

/// Six walls of a box of side 4, and 20 balls within.
std::array<float, 3> place(std::size_t i, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-2, 2);
  std::array<float, 3> at{uniform(random), uniform(random), uniform(random)};
  if (i % 2 == 0) {
    at[i / 2 % 3] = i / 6 % 2 == 0 ? -2.0f : 2.0f;
    return at;
  }
  std::mt19937 ball(static_cast<std::uint32_t>(i % 20));
  const auto direction = unit(random);
  for (std::size_t k = 0; k < 3; ++k) at[k] = 0.7f * uniform(ball) + 0.35f * direction[k];
  return at;
}

Gaussians synthetic(std::size_t count) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  const float spacing = 12 / std::sqrt(float(count));
  Gaussians out;
  out.degree = 3;
  out.up = UpAxis::kMinusY;
  out.harmonics.reserve(count * 48);
  for (std::size_t i = 0; i < count; ++i) {
    out.positions.push_back(place(i, random));
    const float size = std::log(spacing) + 0.8f * normal(random);
    out.log_deviations.push_back(
        {size, size + 0.5f * normal(random), size - 1.5f + 0.5f * normal(random)});
    std::array<float, 4> q{normal(random), normal(random), normal(random), normal(random)};
    const float length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (float& x : q) x /= length;
    out.rotations.push_back(q);
    out.logits.push_back(2 * normal(random));
    for (std::size_t k = 0; k < 48; ++k)
      out.harmonics.push_back((k < 3 ? 1.0f : 0.1f) * normal(random));
  }
  return out;
}

template <class Work>
void keep_least(double& least, Work work) {
  Stopwatch watch;
  work();
  least = std::min(least, watch.lap());
}

}  // namespace

int main(int argc, char** argv) {
  const auto count = std::size_t(argc > 1 ? std::atol(argv[1]) : 1000000);
  int width = 1920, height = 1080;
  if (argc > 2 && std::sscanf(argv[2], "%dx%d", &width, &height) != 2) return 2;
  const int threads = argc > 3 ? std::atoi(argv[3]) : 1, frames = argc > 4 ? std::atoi(argv[4]) : 5;
  if (count < 1 || width < 1 || height < 1 || frames < 1) return 2;
  const Gaussians gaussians = synthetic(count);
  RenderSettings settings;
  settings.threads = threads;
  double prepare = INFINITY, whole = INFINITY, project = INFINITY, bin = INFINITY;
  std::unique_ptr<const GaussianRenderer> renderer;
  keep_least(prepare, [&] { renderer = std::make_unique<GaussianRenderer>(gaussians, settings); });
  const GaussianCloud cloud = gaussian_cloud(gaussians, threads);
  const Camera camera = renderer->orbit(0.1, 20, width, height, 60);
  std::size_t shown = 0, pairs = 0;
  for (int i = 0; i < frames; ++i) {
    keep_least(whole, [&] { (void)renderer->render(camera); });
    std::vector<ProjectedGaussian> splats;
    keep_least(project,
               [&] { splats = project_gaussians(gaussians, cloud, camera, true, threads); });
    keep_least(bin, [&] { pairs = bin_gaussians(splats, width, height, threads).splats.size(); });
    shown = splats.size();
  }
  std::printf("%zu splats, %zu shown in %zu tiles, %d x %d, %d threads: %.3f s a frame\n", count,
              shown, pairs, width, height, threads, whole);
  std::printf("  projection and colours %.3f, tiles %.3f, blending %.3f s; once %.3f s\n", project,
              bin, whole - project - bin, prepare);
}
