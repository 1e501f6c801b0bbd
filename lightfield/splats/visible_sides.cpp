// SPDX-License-Identifier: Apache-2.0
#include "lightfield/splats/visible_sides.h"

#include <algorithm>
#include <cmath>

#include "slf/parallel.h"

namespace slf {
namespace {

constexpr int kPixels = 512;
constexpr int kViewsOfACircle = 8;
constexpr std::array<double, 5> kElevations{-80, -40, 0, 40, 80};  // degrees
constexpr double kTolerance = 1.5;  // voxels, and this many pixels, behind what is drawn

struct Votes {
  float front = 0, back = 0;
};

/// Adds what one camera sees.
class DepthVote {
 public:
  DepthVote(const ViewMaps& maps, const Renderer& renderer, const Camera& camera)
      : grid_(maps.header().grid),
        positions_(maps.positions()),
        camera_(camera),
        eye_(camera.centre()),
        drawn_(renderer.render(camera)) {}

  bool sees(std::size_t p) const {
    double z = 0;
    const auto at = camera_.project(grid_.world(positions_[p]), &z);
    if (!at) return false;
    const auto x = static_cast<int>(std::floor((*at)[0])),
               y = static_cast<int>(std::floor((*at)[1]));
    if (x < 0 || y < 0 || x >= camera_.width || y >= camera_.height) return false;
    const float depth = drawn_.depth[std::size_t(y) * std::size_t(camera_.width) + std::size_t(x)];
    return std::isfinite(depth) && z <= double{depth} + kTolerance * (grid_.step + z / camera_.fx);
  }

  void add(std::size_t p, const std::array<float, 3>& n, Votes& votes) const {
    const Vec3 at = grid_.world(positions_[p]);
    const Vec3 w{eye_[0] - at[0], eye_[1] - at[1], eye_[2] - at[2]};
    const double length = std::sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    const auto cosine = static_cast<float>(
        (w[0] * double(n[0]) + w[1] * double(n[1]) + w[2] * double(n[2])) / length);
    (cosine > 0 ? votes.front : votes.back) += std::abs(cosine);
  }

 private:
  const Grid& grid_;
  std::span<const Voxel> positions_;
  const Camera& camera_;
  Vec3 eye_;
  Rendering drawn_;
};

std::vector<Votes> count_votes(const ViewMaps& maps,
                               const std::vector<std::array<float, 3>>& normals, int threads) {
  RenderSettings settings;
  settings.view_dependent = false;
  settings.threads = threads;
  const Renderer renderer(maps, settings);
  std::vector<Votes> votes(maps.num_points());
  for (const double elevation : kElevations)
    for (int i = 0; i < kViewsOfACircle; ++i) {
      const Camera camera =
          renderer.orbit(double(i) / kViewsOfACircle, elevation, kPixels, kPixels);
      const DepthVote vote(maps, renderer, camera);
      parallel_ranges(votes.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
          if (vote.sees(p)) vote.add(p, normals[p], votes[p]);
      });
    }
  return votes;
}

}  // namespace

std::vector<float> turn_to_visible_side(const ViewMaps& maps,
                                        std::vector<std::array<float, 3>>& normals, int threads) {
  const std::vector<Votes> votes = count_votes(maps, normals, threads);
  std::vector<float> front(normals.size(), 0.5f);
  for (std::size_t p = 0; p < normals.size(); ++p) {
    const auto [before, behind] = votes[p];
    if (behind > before)
      for (float& c : normals[p]) c = -c;
    if (before + behind > 0) front[p] = std::max(before, behind) / (before + behind);
  }
  return front;
}

}  // namespace slf
