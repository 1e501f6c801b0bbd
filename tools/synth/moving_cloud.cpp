// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/moving_cloud.h"

#include "slf/parallel.h"
#include "tools/synth/noise.h"

namespace slf::synth {
namespace {

constexpr double kMargin = 1.01;    // of the grid around the scene's sphere, for --noise
constexpr Vec3 kEye{3.2, -3.6, 2};  // colours are as seen from here
constexpr std::size_t kSamplesAtOnce = 4096;

struct Sampled {
  std::uint64_t voxel;  ///< z, y, x from the most significant bits
  std::array<float, 3> colour;
};

Sampled sampled(const MovingScene& scene, const FrameGrid& grid, const MaterialSample& sample,
                int frame, std::uint32_t number) {
  const MovingPart& part = scene.parts[sample.part];
  const SurfacePoint now = placed(part, sample.at_rest, frame);
  const Colour light =
      shade(now, sample.albedo, normalised(kEye - now.position), part.material, scene.lamps);
  Sampled result{voxel_of(scene, grid, sample, frame, number), {}};
  for (std::size_t k = 0; k < 3; ++k)
    result.colour[k] = static_cast<float>(255 * srgb_from_linear(light[k]));
  return result;
}

}  // namespace

FrameGrid frame_grid(const MovingScene& scene, int bits) {
  const double half = kMargin * scene.radius;
  return {-half, 2 * half / static_cast<double>(1 << bits), bits};
}

std::uint64_t voxel_of(const MovingScene& scene, const FrameGrid& grid,
                       const MaterialSample& sample, int frame, std::uint32_t number) {
  const SurfacePoint now = placed(scene.parts[sample.part], sample.at_rest, frame);
  // The scanner's noise moves points, and not the surface whose colours are seen.
  const double away = scene.noise * (2 * unit(static_cast<std::uint32_t>(frame), number) - 1);
  const Vec3 at = now.position + (away * grid.step) * now.normal;
  std::uint64_t voxel = 0;
  for (std::size_t k = 3; k-- > 0;) {
    const double cell = std::floor((at[k] - grid.low) / grid.step);
    const double most = static_cast<double>((1 << grid.bits) - 1);
    voxel = voxel << 21 | static_cast<std::uint64_t>(std::clamp(cell, 0.0, most));
  }
  return voxel;
}

PointCloud voxel_frame(const MovingScene& scene, const FrameGrid& grid,
                       const std::vector<MaterialSample>& samples, int frame, int threads) {
  std::vector<Sampled> all(samples.size());
  parallel_ranges(samples.size(), kSamplesAtOnce, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      all[i] = sampled(scene, grid, samples[i], frame, static_cast<std::uint32_t>(i));
  });
  // Stable, so that sums of floats have one order.
  std::stable_sort(all.begin(), all.end(),
                   [](const Sampled& a, const Sampled& b) { return a.voxel < b.voxel; });
  PointCloud cloud;
  for (std::size_t i = 0; i < all.size();) {
    Vec3 sum{0, 0, 0};
    const std::size_t begin = i;
    for (; i < all.size() && all[i].voxel == all[begin].voxel; ++i)
      for (std::size_t k = 0; k < 3; ++k) sum[k] += double{all[i].colour[k]};
    auto& position = cloud.positions.emplace_back();
    auto& colour = cloud.colours.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      position[k] = static_cast<float>(all[begin].voxel >> 21 * k & 0x1fffff);
      colour[k] = static_cast<std::uint8_t>(std::lround(sum[k] / static_cast<double>(i - begin)));
    }
  }
  return cloud;
}

}  // namespace slf::synth
