// SPDX-License-Identifier: Apache-2.0
// What every point is worth in every pixel: what the renderer draws with. Spec annex E.
#include "lightfield/render/splat_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "lightfield/render/surfel_cloud.h"
#include "render_support.h"
#include "slf/render.h"

namespace slf::splat_weights_test {
namespace {

using test::constant_light_field;

TEST(SplatWeightsTest, WeightedColoursAreTheRenderedPicture) {
  std::vector<std::array<int, 3>> colours;
  for (int i = 0; i < 97; ++i) colours.push_back({(i * 37) % 256, (i * 91) % 256, (i * 53) % 256});
  const LightField field = constant_light_field(test::sphere(64, 40), colours, 7);
  const ViewMaps maps(field);
  const Renderer renderer(maps);
  const Camera camera = renderer.orbit(0.3, 20, 61, 53);
  const Rendering rendering = renderer.render(camera);
  const SurfelCloud cloud = surfel_cloud(field.header.grid, field.positions, field.normals, 0, 2);
  const SplatWeights weights =
      splat_weights(project_surfels(cloud, camera, 2), camera.width, camera.height, 2);
  ASSERT_EQ(weights.first.size(), rendering.coverage.size() + 1);
  ASSERT_EQ(weights.first.back(), weights.point.size());
  EXPECT_EQ(weights.depth, rendering.depth);
  std::size_t shown = 0;
  for (std::size_t i = 0; i < rendering.coverage.size(); ++i) {
    float sum = 0;
    std::array<float, 3> blend{};
    for (std::uint32_t e = weights.first[i]; e < weights.first[i + 1]; ++e) {
      ASSERT_GT(weights.weight[e], 0);
      sum += weights.weight[e];
      const auto own = maps.mean(weights.point[e]);
      for (std::size_t k = 0; k < 3; ++k) blend[k] += weights.weight[e] * own[k];
    }
    if (weights.first[i] < weights.first[i + 1]) {
      ASSERT_NEAR(sum, 1, 1e-5);  // a few roundings of float
      ++shown;
    }
    const float cover = weights.coverage[i];
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_NEAR(rendering.image.data[3 * i + k], cover * blend[k] + (1 - cover) * 128, 0.51);
  }
  EXPECT_GT(shown, 1000u);
}

// Spec E.4 and E.5 written out pixel by pixel, from the splats.
TEST(SplatWeightsTest, TheyAreThoseOfAnnexEAtEveryPixel) {
  const LightField field = constant_light_field(test::sphere(64, 40), {{90, 90, 90}}, 7);
  const ViewMaps maps(field);
  const Camera camera = Renderer(maps).orbit(0.3, 20, 61, 53);  // no multiple of any block
  const SurfelCloud cloud = surfel_cloud(field.header.grid, field.positions, field.normals, 0, 1);
  const auto splats = project_surfels(cloud, camera, 1);
  const SplatWeights weights = splat_weights(splats, camera.width, camera.height, 1);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      struct Here {
        double r2, inverse, gradient, square;
      };
      std::vector<std::pair<const Splat*, Here>> discs;
      double nearest = 0;
      for (const Splat& s : splats) {
        const double du = x + 0.5 - s.u, dv = y + 0.5 - s.v;
        const double gu = s.a * du + s.b * dv, gv = s.b * du + s.c * dv;
        const Here here{du * gu + dv * gv,
                        s.inverse_depth + s.inverse_depth_du * du + s.inverse_depth_dv * dv,
                        std::hypot(gu, gv), du * du + dv * dv};
        if (here.r2 >= 1) continue;
        discs.push_back({&s, here});
        if (here.r2 < 0.4) nearest = std::max(nearest, here.inverse);
      }
      double sum = 0, cover = 0;
      for (const auto& [s, here] : discs) {
        const double near = 1 - std::max(0.0, (nearest - here.inverse) * s->fade);
        if (near > 0) sum += s->weight * std::pow(1 - here.r2, 4) * near * near;
        const double distance = std::sqrt(here.square);
        if (!(distance > 0.01)) {
          cover = 1;
          continue;
        }
        const double reach = std::sqrt(std::max(0.0, here.square / here.r2 - 1));
        cover =
            std::max(cover, 0.5 + (0.85 * reach - distance) * here.r2 / (distance * here.gradient));
      }
      const std::size_t i = std::size_t(y) * std::size_t(camera.width) + std::size_t(x);
      cover = std::clamp(std::max(cover, 2 * 5 / std::numbers::pi * sum - 0.5), 0.0, 1.0);
      ASSERT_NEAR(weights.coverage[i], sum > 1e-6 ? cover : 0, 2e-3) << x << ' ' << y;
      ASSERT_EQ(weights.first[i + 1] > weights.first[i], sum > 1e-12) << x << ' ' << y;
    }
}

TEST(SplatWeightsTest, TheResultDoesNotDependOnThreads) {
  const LightField field = constant_light_field(test::sphere(64, 40), {{90, 90, 90}}, 7);
  const ViewMaps maps(field);
  const Camera camera = Renderer(maps).orbit(0.3, 20, 61, 53);
  std::vector<SplatWeights> each;
  for (const int threads : {1, 2, 7}) {
    const SurfelCloud cloud =
        surfel_cloud(field.header.grid, field.positions, field.normals, 0, threads);
    each.push_back(splat_weights(project_surfels(cloud, camera, threads), camera.width,
                                 camera.height, threads));
  }
  for (const SplatWeights& other : each) {
    EXPECT_EQ(other.first, each[0].first);
    EXPECT_EQ(other.point, each[0].point);
    EXPECT_EQ(other.weight, each[0].weight);
    EXPECT_EQ(other.coverage, each[0].coverage);
    EXPECT_EQ(other.depth, each[0].depth);
  }
}

}  // namespace
}  // namespace slf::splat_weights_test
