// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/photo_consistency.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "encoder/fit/observe_camera.h"
#include "encoder/fit/observe_depth.h"
#include "encoder/refine/patches.h"
#include "slf/parallel.h"

namespace slf {
namespace {

/// A view that may compare a point.
struct Facing {
  std::uint16_t view;
  float cosine;
};

/// The views that every so many-th point faces, ascending.
struct FacingViews {
  std::vector<std::uint64_t> first;  ///< [chosen + 1]
  std::vector<Facing> facing;

  std::span<const Facing> of(std::size_t chosen) const {
    const auto from = std::size_t(first[chosen]);
    return std::span(facing).subspan(from, std::size_t(first[chosen + 1]) - from);
  }
};

struct Chosen {
  std::uint32_t point;  ///< among those that are chosen
  float cosine;
};

std::vector<Chosen> seen_by(const PhotoView& view, const SurfacePoints& points, double spacing,
                            const ConsistencySettings& settings, std::size_t every) {
  std::vector<Chosen> seen;
  const Camera& camera = *view.camera;
  const DepthBuffer buffer(camera, points.positions, {0.5, spacing, settings.tolerance / spacing});
  for (std::size_t p = 0; p < points.size(); p += every) {
    const double cosine = view_cosine(points.positions[p], points.normals[p], view.centre);
    if (!(cosine >= settings.least_cosine)) continue;
    double z = 0;
    const Float3& at = points.positions[p];
    const auto image = camera.project({at[0], at[1], at[2]}, &z);
    if (!image || !((*image)[0] >= 0 && (*image)[0] < camera.width && (*image)[1] >= 0 &&
                    (*image)[1] < camera.height))
      continue;
    if (!buffer.hides(*image, z, 1)) seen.push_back({std::uint32_t(p / every), float(cosine)});
  }
  return seen;
}

FacingViews facing_views(std::span<const PhotoView> views, const SurfacePoints& points,
                         double spacing, const ConsistencySettings& settings, std::size_t every) {
  std::vector<std::vector<Chosen>> each(views.size());
  parallel_ranges(views.size(), 1, settings.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      each[v] = seen_by(views[v], points, spacing, settings, every);
  });
  FacingViews all;
  all.first.assign((points.size() + every - 1) / every + 1, 0);
  for (const auto& list : each)
    for (const Chosen& seen : list) ++all.first[seen.point + 1];
  for (std::size_t p = 1; p < all.first.size(); ++p) all.first[p] += all.first[p - 1];
  all.facing.resize(std::size_t(all.first.back()));
  std::vector<std::uint64_t> next(all.first.begin(), all.first.end() - 1);
  for (std::size_t v = 0; v < views.size(); ++v)
    for (const Chosen& seen : each[v])
      all.facing[std::size_t(next[seen.point]++)] = {std::uint16_t(v), seen.cosine};
  return all;
}

void tangents(const Float3& n, Float3& a, Float3& b) {
  const Float3 axis = std::abs(n[0]) < 0.6f ? Float3{1, 0, 0} : Float3{0, 1, 0};
  a = {n[1] * axis[2] - n[2] * axis[1], n[2] * axis[0] - n[0] * axis[2],
       n[0] * axis[1] - n[1] * axis[0]};
  const float length = std::sqrt(dot(a, a));
  for (float& x : a) x /= length;
  b = {n[1] * a[2] - n[2] * a[1], n[2] * a[0] - n[0] * a[2], n[0] * a[1] - n[1] * a[0]};
}

/// Some of the views that face a point, from the best facing to the least.
std::vector<PatchSampler> samplers_of(std::span<const PhotoView> views,
                                      std::span<const Facing> seen, const Float3& position,
                                      const Float3& normal, const ConsistencySettings& settings) {
  std::vector<Facing> facing(seen.begin(), seen.end());
  std::stable_sort(facing.begin(), facing.end(),
                   [](const Facing& a, const Facing& b) { return a.cosine > b.cosine; });
  Float3 a, b;
  tangents(normal, a, b);
  std::vector<PatchSampler> samplers;
  const std::size_t taken = std::min(facing.size(), settings.cameras);
  for (std::size_t i = 0; i < taken; ++i) {
    const PhotoView& view = views[facing[i * facing.size() / taken].view];
    if (const auto path = patch_path(view, position, normal, a, b, settings.spacing))
      samplers.emplace_back(view, *path, float(settings.spacing), float(settings.noise));
  }
  return samplers;
}

/// How much what the photographs show at an offset differs.
float cost_at(std::span<const PatchSampler> samplers, float offset) {
  PatchValues sum{};
  float own = 0;
  std::size_t good = 0;
  for (const PatchSampler& sampler : samplers)
    if (const auto squared = sampler.add(offset, sum)) {
      own += *squared;
      ++good;
    }
  return disagreement(sum, own, good);
}

}  // namespace

std::vector<float> photo_costs(std::span<const PhotoView> views, const SurfacePoints& points,
                               double spacing, const OffsetRange& range,
                               const ConsistencySettings& settings, std::size_t every) {
  const FacingViews facing = facing_views(views, points, spacing, settings, every);
  const std::size_t chosen = facing.first.size() - 1;
  std::vector<float> costs(chosen * range.count);
  parallel_ranges(chosen, 64, settings.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto samplers = samplers_of(views, facing.of(i), points.positions[i * every],
                                        points.normals[i * every], settings);
      for (std::size_t l = 0; l < range.count; ++l)
        costs[i * range.count + l] = cost_at(samplers, range.at(l));
    }
  });
  return costs;
}

}  // namespace slf
