// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/moving_views.h"

#include <algorithm>
#include <span>
#include <utility>

#include "slf/parallel.h"
#include "tools/synth/plenoptic.h"

namespace slf::synth {
namespace {

constexpr std::size_t kVoxelsAtOnce = 1024;

/// A voxel and one of its samples.
using Member = std::pair<std::uint64_t, std::uint32_t>;

/// In the order of voxels, and of samples within each.
std::vector<Member> members_of(const MovingScene& scene, const FrameGrid& grid,
                               const std::vector<MaterialSample>& samples, int frame, int threads) {
  std::vector<Member> members(samples.size());
  parallel_ranges(samples.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto number = static_cast<std::uint32_t>(i);
      members[i] = {voxel_of(scene, grid, samples[i], frame, number), number};
    }
  });
  std::sort(members.begin(), members.end());
  return members;
}

/// The own colour, then that of each view.
void colour_voxel(const MovingScene& scene, std::span<const Member> members,
                  const std::vector<MaterialSample>& samples, int frame,
                  std::span<const Vec3> views, std::uint64_t number, std::uint8_t* colours) {
  std::vector<Vec3> sum(views.size(), Vec3{0, 0, 0});
  std::vector<double> count(views.size());
  for (const Member& member : members) {
    const MaterialSample& sample = samples[member.second];
    const MovingPart& part = scene.parts[sample.part];
    const SurfacePoint now = placed(part, sample.at_rest, frame);
    for (std::size_t v = 0; v < views.size(); ++v) {
      const Vec3 to_view = normalised(views[v] - now.position);
      if (!sees(to_view, now.normal)) continue;
      const Colour light = shade(now, sample.albedo, to_view, part.material, scene.lamps);
      for (std::size_t c = 0; c < 3; ++c) sum[v][c] += srgb_from_linear(std::min(1.0, light[c]));
      ++count[v];
    }
  }
  std::vector<std::optional<Vec3>> seen(views.size());
  for (std::size_t v = 0; v < views.size(); ++v)
    if (count[v] > 0) seen[v] = (1 / count[v]) * sum[v];
  const Colour& albedo = samples[members.front().second].albedo;
  const Vec3 unseen{srgb_from_linear(albedo[0]), srgb_from_linear(albedo[1]),
                    srgb_from_linear(albedo[2])};
  write_views(seen, unseen, number, colours);
}

}  // namespace

PlenopticCloud voxel_views(const MovingScene& scene, const FrameGrid& grid,
                           const std::vector<MaterialSample>& samples, int frame, int views,
                           int threads) {
  const std::vector<Member> members = members_of(scene, grid, samples, frame, threads);
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < members.size(); ++i)
    if (i == 0 || members[i].first != members[i - 1].first) first.push_back(i);
  const std::size_t count = first.size();
  first.push_back(members.size());
  const std::vector<Vec3> places = view_places(views);
  PlenopticCloud cloud = cloud_of_views(places, {grid.low, grid.low, grid.low}, grid.step);
  const std::size_t row = 3 * cloud.num_colours();
  cloud.positions.resize(count);
  cloud.colours.resize(count * row);
  parallel_ranges(count, kVoxelsAtOnce, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < 3; ++k)
        cloud.positions[i][k] =
            static_cast<std::int32_t>(members[first[i]].first >> 21 * k & 0x1fffff);
      const auto of_voxel = std::span(members).subspan(first[i], first[i + 1] - first[i]);
      colour_voxel(scene, of_voxel, samples, frame, places,
                   i + (std::uint64_t{static_cast<std::uint32_t>(frame) + 1} << 40),
                   &cloud.colours[i * row]);
    }
  });
  return cloud;
}

}  // namespace slf::synth
