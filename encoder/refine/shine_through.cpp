// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/shine_through.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "encoder/fit/observe_camera.h"
#include "encoder/fit/observe_depth.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr double kOutline = 3;        // spacings, and pixels: nearer to the outline nothing counts
constexpr float kLeastCosine = 0.3f;  // of a view that counts
constexpr double kLeastShare = 0.1;   // of the views of a point
constexpr double kSide = 4;           // spacings: of the cubes that are kept whole

using Pixel = std::array<double, 2>;

/// Whether any point is drawn there.
bool covered_in_picture(const DepthBuffer& buffer, const Camera& camera, const Pixel& at) {
  if (!(at[0] >= 0 && at[0] < camera.width && at[1] >= 0 && at[1] < camera.height)) return false;
  return buffer.hides(at, 1e30, 1);
}

bool inside_outline(const DepthBuffer& buffer, const Camera& camera, const Pixel& at,
                    double pixels) {
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      if (!covered_in_picture(buffer, camera, {at[0] + pixels * x, at[1] + pixels * y}))
        return false;
  return true;
}

struct View {
  std::vector<std::uint32_t> seen, torn;  // points
};

View look(const Camera& camera, const SurfacePoints& before, const SurfacePoints& after,
          double spacing) {
  View view;
  const DepthSettings depth{0.5, spacing, 2.5};
  const DepthBuffer was(camera, before.positions, depth), is(camera, after.positions, depth);
  const Vec3 centre = camera.centre();
  const double focal = std::max(camera.fx, camera.fy);
  for (std::size_t p = 0; p < before.size(); ++p) {
    const Float3& position = before.positions[p];
    const double cosine = view_cosine(position, before.normals[p], centre);
    if (!(cosine >= double(kLeastCosine))) continue;
    double z = 0;
    const auto at = camera.project({position[0], position[1], position[2]}, &z);
    if (!at || !covered_in_picture(was, camera, *at) || was.hides(*at, z, cosine)) continue;
    view.seen.push_back(std::uint32_t(p));
    if (covered_in_picture(is, camera, *at)) continue;
    if (inside_outline(was, camera, *at, kOutline * std::max(2.0, spacing * focal / z)))
      view.torn.push_back(std::uint32_t(p));
  }
  return view;
}

}  // namespace

std::vector<std::uint8_t> shines_through(const Capture& capture, std::span<const int> cameras,
                                         const SurfacePoints& before, const SurfacePoints& after,
                                         double spacing, int threads) {
  std::vector<View> views(cameras.size());
  parallel_ranges(cameras.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      views[i] = look(capture.cameras[std::size_t(cameras[i])], before, after, spacing);
  });
  std::vector<std::uint32_t> seen(before.size(), 0), torn(before.size(), 0);
  for (const View& view : views) {
    for (const std::uint32_t p : view.seen) ++seen[p];
    for (const std::uint32_t p : view.torn) ++torn[p];
  }
  std::set<std::array<std::int32_t, 3>> cubes;
  const auto cube_of = [&](std::size_t p) {
    std::array<std::int32_t, 3> cube{};
    for (std::size_t a = 0; a < 3; ++a)
      cube[a] = std::int32_t(std::floor(double(before.positions[p][a]) / (kSide * spacing)));
    return cube;
  };
  for (std::size_t p = 0; p < before.size(); ++p)
    if (torn[p] > 0 && double(torn[p]) >= kLeastShare * double(seen[p])) cubes.insert(cube_of(p));
  std::vector<std::uint8_t> marked(before.size());
  for (std::size_t p = 0; p < before.size(); ++p) marked[p] = cubes.count(cube_of(p)) > 0;
  return marked;
}

}  // namespace slf
