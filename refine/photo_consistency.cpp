#include "refine/photo_consistency.h"

#include <algorithm>
#include <cmath>

#include "lightfield/observe_camera.h"
#include "lightfield/observe_depth.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kLeastCameras = 3;  // fewer say nothing
constexpr std::size_t kMostSamples = 49;

/// The views that may compare a point, best facing first.
struct Facing {
  std::uint16_t view;
  float cosine;
};

std::vector<std::vector<Facing>> facing_views(std::span<const PhotoView> views,
                                              const SurfacePoints& points, double spacing,
                                              const ConsistencySettings& settings) {
  std::vector<std::vector<Facing>> facing(points.size());
  DepthSettings depth{0.5, spacing, settings.tolerance / spacing};
  std::vector<std::vector<std::pair<std::uint32_t, float>>> each(views.size());
  parallel_ranges(views.size(), 1, settings.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const PhotoView& view = views[v];
      const DepthBuffer buffer(*view.camera, points.positions, depth);
      for (std::size_t p = 0; p < points.size(); ++p) {
        const double cosine = view_cosine(points.positions[p], points.normals[p], view.centre);
        if (!(cosine >= settings.least_cosine)) continue;
        double z = 0;
        const Float3& at = points.positions[p];
        const auto image = view.camera->project({at[0], at[1], at[2]}, &z);
        if (!image || !((*image)[0] >= 0 && (*image)[0] < view.camera->width && (*image)[1] >= 0 &&
                        (*image)[1] < view.camera->height))
          continue;
        if (buffer.hides(*image, z, 1)) continue;
        each[v].push_back({std::uint32_t(p), float(cosine)});
      }
    }
  });
  for (std::size_t v = 0; v < views.size(); ++v)
    for (const auto& [p, cosine] : each[v]) facing[p].push_back({std::uint16_t(v), cosine});
  for (auto& list : facing)
    std::stable_sort(list.begin(), list.end(),
                     [](const Facing& a, const Facing& b) { return a.cosine > b.cosine; });
  return facing;
}

void tangents(const Float3& n, Float3& a, Float3& b) {
  const Float3 axis = std::abs(n[0]) < 0.6f ? Float3{1, 0, 0} : Float3{0, 1, 0};
  a = {n[1] * axis[2] - n[2] * axis[1], n[2] * axis[0] - n[0] * axis[2],
       n[0] * axis[1] - n[1] * axis[0]};
  const float length = std::sqrt(dot(a, a));
  for (float& x : a) x /= length;
  b = {n[1] * a[2] - n[2] * a[1], n[2] * a[0] - n[0] * a[2], n[0] * a[1] - n[1] * a[0]};
}

struct Patch {
  std::array<float, kMostSamples> value;
};

/// Samples of a patch, without mean, of length at most 1 (less where noise drowns them).
bool take_patch(const PhotoView& view, const PatchPath& path, float offset, int radius,
                float spacing, float noise, Patch& patch) {
  const double w = path.at[2] + double(offset) * path.step[2];
  if (!(w > 0)) return false;
  const auto u = float((path.at[0] + double(offset) * path.step[0]) / w);
  const auto v = float((path.at[1] + double(offset) * path.step[1]) / w);
  std::size_t n = 0;
  float sum = 0;
  for (int i = -radius; i <= radius; ++i)
    for (int j = -radius; j <= radius; ++j, ++n) {
      const float a = spacing * float(i), b = spacing * float(j);
      patch.value[n] = view.sample(u + a * path.tangent[0] + b * path.tangent[2],
                                   v + a * path.tangent[1] + b * path.tangent[3]);
      sum += patch.value[n];
    }
  if (!std::isfinite(sum)) return false;
  const float mean = sum / float(n);
  float squares = float(n) * noise * noise;
  for (std::size_t i = 0; i < n; ++i) {
    patch.value[i] -= mean;
    squares += patch.value[i] * patch.value[i];
  }
  const float scale = 1 / std::sqrt(squares);
  for (std::size_t i = 0; i < n; ++i) patch.value[i] *= scale;
  return true;
}

/// 1 - mean correlation of all pairs of patches, by the length of their sum.
float disagreement(std::span<const Patch> patches, std::size_t samples) {
  const std::size_t count = patches.size();
  if (count < kLeastCameras) return 1;
  float all = 0, own = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    float sum = 0;
    for (const Patch& patch : patches) {
      sum += patch.value[i];
      own += patch.value[i] * patch.value[i];
    }
    all += sum * sum;
  }
  return 1 - (all - own) / float(count * (count - 1));
}

}  // namespace

std::vector<float> photo_costs(std::span<const PhotoView> views, const SurfacePoints& points,
                               double spacing, const OffsetRange& range,
                               const ConsistencySettings& settings, std::size_t every) {
  const auto facing = facing_views(views, points, spacing, settings);
  const std::size_t most = settings.cameras;
  const auto samples = std::size_t((2 * settings.radius + 1) * (2 * settings.radius + 1));
  const std::size_t chosen = (points.size() + every - 1) / every;
  std::vector<float> costs(chosen * range.count, 1);
  parallel_ranges(chosen, 64, settings.threads, [&](std::size_t begin, std::size_t end) {
    std::vector<Patch> patches;
    std::vector<std::pair<const PhotoView*, PatchPath>> paths;
    for (std::size_t i_chosen = begin; i_chosen < end; ++i_chosen) {
      const std::size_t p = i_chosen * every;
      Float3 a, b;
      tangents(points.normals[p], a, b);
      paths.clear();
      const std::size_t seen = facing[p].size(), taken = std::min(seen, most);
      for (std::size_t i = 0; i < taken; ++i) {
        const PhotoView& view = views[facing[p][i * seen / taken].view];
        if (const auto path =
                patch_path(view, points.positions[p], points.normals[p], a, b, settings.spacing))
          paths.push_back({&view, *path});
      }
      for (std::size_t l = 0; l < range.count; ++l) {
        patches.resize(paths.size());
        std::size_t good = 0;
        for (const auto& [view, path] : paths)
          good += take_patch(*view, path, range.at(l), settings.radius, float(settings.spacing),
                             float(settings.noise), patches[good]);
        costs[i_chosen * range.count + l] = disagreement({patches.data(), good}, samples);
      }
    }
  });
  return costs;
}

}  // namespace slf
