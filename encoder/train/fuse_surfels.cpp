// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/fuse_surfels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <vector>

#include "base/multiversion.h"
#include "encoder/train/cover_views.h"
#include "encoder/train/distance_blocks.h"
#include "encoder/train/shown_surface.h"
#include "lightfield/render/lanes.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr float kFlattest = 0.1f;     // a flatter view says nothing of where a surface is
constexpr float kBeyond = 1.5f;       // times `apart`, along the ray: a plane holds no farther
constexpr float kEmptyWeight = 0.5f;  // of a pixel that shows nothing at the node, nor near it
constexpr double kMostNodes = 1e9;    // from the origin, of a lattice: beyond there is nothing

/// Keys of blocks within `apart` of what is shown, ascending.
std::vector<BlockKey> blocks_near(const ShownSurface& shown, const Lattice& lattice, double apart) {
  std::vector<BlockKey> keys;
  const double side = kBlockNodes;
  BlockKey low_before{}, high_before{-1, -1, -1};  // of the pixel before: mostly the same
  for (std::size_t pixel = 0; pixel < shown.depths.depth.size(); ++pixel) {
    if (!(shown.depths.depth[pixel] > 0)) continue;
    const Float3 at = shown.point(pixel);
    BlockKey low{}, high{};
    bool inside = true;
    for (std::size_t a = 0; a < 3; ++a) {
      const double node = (double(at[a]) - lattice.origin[a]) / lattice.step;
      inside = inside && std::abs(node) < kMostNodes;
      if (!inside) break;
      low[a] = std::int32_t(std::floor((node - apart) / side));
      high[a] = std::int32_t(std::floor((node + apart) / side));
    }
    if (!inside || (low == low_before && high == high_before)) continue;
    low_before = low;
    high_before = high;
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x) keys.push_back({x, y, z});
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

/// Sums of a node.
struct NodeSums {
  float &distance, &weight;
};

/// Distance to the plane that the node's pixel shows: at most `apart`, world units, and fading
/// behind the surface.
/// @param pixel  of the node, shows something
void add_plane(const ShownSurface& shown, const Float3& node, std::size_t pixel, float apart,
               NodeSums sums) {
  const Float3 point = shown.point(pixel), to_camera = minus(shown.camera->centre, point);
  const Float3& normal = shown.normals[shown.depths.surfel[pixel]];
  const float cosine = dot(to_camera, normal) / std::sqrt(dot(to_camera, to_camera));
  if (cosine < kFlattest) return;
  float to_plane = dot(normal, minus(node, point));
  if (to_plane <= -apart) return;
  to_plane = std::min(to_plane, apart);
  const float own = cosine * cosine;
  sums.distance += own * to_plane;
  sums.weight += own;
}

constexpr Lanes kAlong = {0, 1, 2, 3, 4, 5, 6, 7};
static_assert(kBlockNodes == 8);

/// A row of a block's nodes in a camera.
struct NodeRow {
  Lanes depth;
  std::array<std::int32_t, kBlockNodes> pixel;  // -1: it is not in the picture
};

/// @param first  in the camera
/// @param step  to the next one
[[gnu::always_inline]] inline void set_row(const TrainingCamera& camera, const Float3& first,
                                           const Float3& step, NodeRow& row) {
  row.depth = first[2] + step[2] * kAlong;
  const Lanes inverse = 1 / row.depth;
  const Lanes u = camera.fx * (first[0] + step[0] * kAlong) * inverse + camera.cx;
  const Lanes v = camera.fy * (first[1] + step[1] * kAlong) * inverse + camera.cy;
  const LaneMask inside = (row.depth > 0.0f) & (u >= 0.0f) & (v >= 0.0f) &
                          (u < float(camera.width)) & (v < float(camera.height));
  const LaneMask x = __builtin_convertvector(inside ? u : Lanes{}, LaneMask);
  const LaneMask y = __builtin_convertvector(inside ? v : Lanes{}, LaneMask);
  const LaneMask pixel = inside ? y * camera.width + x : LaneMask{} - 1;
  std::memcpy(row.pixel.data(), &pixel, sizeof pixel);
}

SLF_MULTIVERSION_ALL void add_block(const ShownSurface& shown, const DistanceBlocks& all,
                                    float apart, DistanceBlock& block) {
  const TrainingCamera& camera = *shown.camera;
  const auto lattice_step = float(all.lattice.step);
  const Float3 step = {lattice_step * camera.rotation[0][0], lattice_step * camera.rotation[1][0],
                       lattice_step * camera.rotation[2][0]};
  std::size_t i = 0;
  for (int z = 0; z < kBlockNodes; ++z)
    for (int y = 0; y < kBlockNodes; ++y) {
      NodeRow row;
      set_row(camera, camera.in_camera(all.world(block.key, 0, y, z)), step, row);
      for (int x = 0; x < kBlockNodes; ++x, ++i) {
        if (row.pixel[std::size_t(x)] < 0) continue;
        const auto pixel = std::size_t(row.pixel[std::size_t(x)]);
        const float depth = shown.depths.depth[pixel];
        if (shown.nearest[pixel] - row.depth[x] > kBeyond * apart) {
          block.distance[i] += kEmptyWeight * apart;
          block.weight[i] += kEmptyWeight;
        } else if (depth > 0 && std::abs(row.depth[x] - depth) <= kBeyond * apart) {
          add_plane(shown, all.world(block.key, x, y, z), pixel, apart,
                    {block.distance[i], block.weight[i]});
        }
      }
    }
}

/// Greatest depths of the view in squares of pixels; infinite where one shows no surface.
class FarthestDepths {
 public:
  explicit FarthestDepths(const ShownSurface& shown) : camera_(*shown.camera) {
    columns_ = (camera_.width + kSquare - 1) / kSquare;
    const int rows = (camera_.height + kSquare - 1) / kSquare;
    depth_.assign(std::size_t(columns_) * std::size_t(rows), 0);
    std::size_t pixel = 0;
    for (int y = 0; y < camera_.height; ++y)
      for (int x = 0; x < camera_.width; ++x, ++pixel) {
        float& farthest = depth_[std::size_t(y / kSquare * columns_ + x / kSquare)];
        const float depth = shown.depths.depth[pixel];
        farthest = std::max(farthest, depth > 0 ? depth : std::numeric_limits<float>::infinity());
      }
  }

  /// Whether all of a ball lies outside of the picture, or farther behind what is seen than
  /// `beyond`.
  bool hide(const Float3& centre, float radius, float beyond) const {
    const Float3 at = camera_.in_camera(centre);
    const float near = at[2] - radius;
    if (!(near > 0)) return at[2] + radius <= 0;
    const float u = camera_.fx * at[0] / at[2] + camera_.cx;
    const float v = camera_.fy * at[1] / at[2] + camera_.cy;
    const float reach = std::max(camera_.fx, camera_.fy) * radius / near * kOblique;
    const auto square = [](float x, int size) {
      return int(std::clamp(x, 0.0f, float(size - 1))) / kSquare;
    };
    if (u + reach < 0 || v + reach < 0 || u - reach > float(camera_.width) ||
        v - reach > float(camera_.height))
      return true;
    float farthest = 0;
    for (int y = square(v - reach, camera_.height); y <= square(v + reach, camera_.height); ++y)
      for (int x = square(u - reach, camera_.width); x <= square(u + reach, camera_.width); ++x)
        farthest = std::max(farthest, depth_[std::size_t(y * columns_ + x)]);
    return near - farthest > beyond;
  }

 private:
  static constexpr int kSquare = 8;
  static constexpr float kOblique = 1.5f;  // a ball is longer than wide far from the middle

  const TrainingCamera& camera_;
  int columns_ = 0;
  std::vector<float> depth_;
};

void add_distances(const ShownSurface& shown, float apart, int threads, DistanceBlocks& all) {
  const FarthestDepths farthest(shown);
  const auto radius = float(0.5 * std::sqrt(3.0) * kBlockNodes * all.lattice.step);
  parallel_ranges(all.blocks.size(), 64, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      DistanceBlock& block = all.blocks[b];
      constexpr int kMiddle = kBlockNodes / 2;
      if (farthest.hide(all.world(block.key, kMiddle, kMiddle, kMiddle), radius, kBeyond * apart))
        continue;
      add_block(shown, all, apart, block);
    }
  });
}

std::vector<BlockKey> merged(const std::vector<BlockKey>& a, const std::vector<BlockKey>& b) {
  std::vector<BlockKey> out;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out));
  return out;
}

}  // namespace

SurfacePoints fuse_surfels(const TrainedSurfels& surfels, std::span<const TrainingView> views,
                           const Lattice& lattice, const FuseSettings& settings) {
  DistanceBlocks distances;
  distances.lattice = lattice;
  std::vector<BlockKey> keys;
  for (const TrainingView& view : views)
    keys = merged(
        keys, blocks_near(shown_surface(surfels, view, settings.threads), lattice, settings.apart));
  distances.blocks.resize(keys.size());
  for (std::size_t b = 0; b < keys.size(); ++b) distances.blocks[b].key = keys[b];
  for (const TrainingView& view : views)
    add_distances(shown_surface(surfels, view, settings.threads),
                  float(settings.apart * lattice.step), settings.threads, distances);
  SurfacePoints points = zero_crossings(distances, settings.least_weight, settings.threads);
  cover_views(surfels, views, distances, settings.apart, settings.threads, points);
  const auto least = std::size_t(settings.least_part * double(points.size()));
  return without_debris(std::move(points), lattice, least);
}

}  // namespace slf
