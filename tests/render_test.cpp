#include "slf/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "geometry/morton.h"
#include "lightfield/octahedral.h"
#include "lightfield/render_surfels.h"
#include "lightfield/splat_weights.h"
#include "lightfield/surfel_cloud.h"
#include "tests/render_support.h"

namespace slf {
namespace {

using test::constant_light_field;
using test::frontal_camera;

std::size_t pixel(const Rendering& rendering, int x, int y) {
  return std::size_t(y) * std::size_t(rendering.image.width) + std::size_t(x);
}

std::array<int, 3> colour(const Rendering& rendering, int x, int y) {
  const std::uint8_t* p = &rendering.image.data[3 * pixel(rendering, x, y)];
  return {p[0], p[1], p[2]};
}

TEST(OctahedralTest, LevelsOfEveryBitDepthGiveUnitVectorsThatQuantiseBackToThemselves) {
  for (const int bits : {4, 8, 12}) {
    const int levels = 1 << bits, stride = bits == 12 ? 61 : 1;
    for (int a = 0; a < levels; a += stride)
      for (int b = 0; b < levels; b += stride) {
        const std::array<std::uint16_t, 2> q{std::uint16_t(a), std::uint16_t(b)};
        const auto v = dequantise_normal(q, bits);
        ASSERT_NEAR(v[0] * v[0] + v[1] * v[1] + v[2] * v[2], 1, 1e-12);
        const auto back = dequantise_normal(quantise_normal(v, bits), bits);
        // On the border of the square two levels stand for one vector, so vectors are compared.
        for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(back[k], v[k], 1e-9) << a << ' ' << b;
      }
  }
}

TEST(OctahedralTest, HandComputedValues) {
  const auto up =
      quantise_normal({0, 0, 1}, 8);  // the middle of the square lies between two levels
  EXPECT_EQ(up, (std::array<std::uint16_t, 2>{128, 128}));
  EXPECT_EQ(quantise_normal({1, 0, 0}, 8)[0], 255);
  EXPECT_EQ(quantise_normal({0, -1, 0}, 8)[1], 0);
  const auto folded = octahedral_from_vector({1, 1, -2});  // x + y + |z| = 4: (1/4, 1/4) -> 3/4
  EXPECT_DOUBLE_EQ(folded[0], 0.75);
  EXPECT_DOUBLE_EQ(folded[1], 0.75);
}

TEST(SurfelTest, NormalsOfAVoxelisedSphereAreRadial) {
  const auto voxels = test::sphere(64, 40);
  const Surfels surfels = estimate_surfels(voxels, 2);
  double worst = 1;
  for (std::size_t p = 0; p < voxels.size(); ++p) {
    double along = 0, length = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      along += (voxels[p][k] - 64) * double{surfels.normals[p][k]};
      length += (voxels[p][k] - 64.0) * (voxels[p][k] - 64.0);
    }
    worst = std::min(worst, std::abs(along) / std::sqrt(length));
    ASSERT_GE(surfels.radii[p], 0.9f);
    ASSERT_LT(surfels.radii[p], 2.0f);  // neighbours are one voxel apart
  }
  EXPECT_GT(worst, std::cos(15 * 3.14159265 / 180));  // quantisation tilts a patch of 5 voxels
}

TEST(SurfelTest, RadiusFollowsTheSpacingOfASparseCloud) {
  std::vector<Voxel> voxels;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) voxels.push_back({x * 8, y * 8, 100});
  const Surfels surfels = estimate_surfels(voxels, 1);
  for (std::size_t p = 0; p < voxels.size(); ++p) {
    ASSERT_NEAR(std::abs(surfels.normals[p][2]), 1, 1e-5);
    ASSERT_GT(surfels.radii[p], 8 / std::sqrt(2.0f));  // half the diagonal: no hole
    ASSERT_LT(surfels.radii[p], 24);
  }
}

TEST(SurfelTest, ADenseClusterBesideScatteredPointsHasItsOwnScale) {
  // As many points in a solid cube as in a lattice 1,000 times coarser: with one cell size for both
  // every point of the cube would look at the whole cube, 10^11 pairs, which no test outlasts.
  std::vector<Voxel> voxels;
  for (int z = 0; z < 64; ++z)
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        voxels.push_back({x, y, z});
        if (x + y + z > 0) voxels.push_back({1000 * x, 1000 * y, 1000 * z});
      }
  const Surfels surfels = estimate_surfels(voxels, 2);
  for (std::size_t p = 0; p < voxels.size(); ++p) {
    const Voxel& v = voxels[p];
    const int nearest = std::min({v[0], v[1], v[2]}), farthest = std::max({v[0], v[1], v[2]});
    if (nearest > 8 && farthest < 56) {
      ASSERT_LT(surfels.radii[p], 3);
    } else if (nearest >= 1000) {
      ASSERT_GT(surfels.radii[p], 500);
    }
  }
}

TEST(RenderTest, APlaneSampledAtThePixelRateHasNoHoleAndItsColour) {
  const LightField field = constant_light_field(test::plane(64, 0), {{200, 100, 50}}, 6);
  const ViewMaps maps(field);
  // 0.999 pixels per voxel would be denser; offsets put centres between and onto pixel centres.
  for (const double offset : {0.0, 0.25, 0.5}) {
    const auto rendering =
        Renderer(maps).render(frontal_camera(31.5 + offset, 31.5 + offset, 200, 40, 1.0));
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x) {
        ASSERT_EQ(rendering.coverage[pixel(rendering, x, y)], 255) << x << ' ' << y;
        const auto c = colour(rendering, x, y);
        ASSERT_NEAR(c[0], 200, 1);
        ASSERT_NEAR(c[1], 100, 1);
        ASSERT_NEAR(c[2], 50, 1);
      }
  }
}

TEST(RenderTest, ATiltedPlaneHasNoHoleEither) {
  const LightField field = constant_light_field(test::plane(64, 0), {{200, 100, 50}}, 6);
  const ViewMaps maps(field);
  Camera camera = frontal_camera(0, 0, 200, 40, 1.0);
  const double c = std::cos(1.2), s = std::sin(1.2);  // 69 degrees about y
  camera.rotation = {{{c, 0, -s}, {0, 1, 0}, {s, 0, c}}};
  camera.translation = {-31.5 * c, -31.5, 200 - 31.5 * s};
  const auto rendering = Renderer(maps).render(camera);
  for (int y = 1; y < 39; ++y)
    for (int x = 12; x < 28; ++x) EXPECT_EQ(rendering.coverage[pixel(rendering, x, y)], 255);
}

TEST(RenderTest, BackgroundIsExactWhereNothingIsAndDepthIsInfinite) {
  const LightField field = constant_light_field(test::plane(8, 0), {{255, 0, 0}}, 3);
  const ViewMaps maps(field);
  RenderSettings settings;
  settings.background = {17, 130, 201};
  const auto rendering = Renderer(maps, settings).render(frontal_camera(3.5, 3.5, 50, 64, 2));
  for (const auto& [x, y] : {std::pair{0, 0}, {63, 63}, {20, 32}, {32, 45}}) {
    EXPECT_EQ(colour(rendering, x, y), (std::array<int, 3>{17, 130, 201}));
    EXPECT_EQ(rendering.coverage[pixel(rendering, x, y)], 0);
    EXPECT_EQ(rendering.depth[pixel(rendering, x, y)], std::numeric_limits<float>::infinity());
  }
}

TEST(RenderTest, ASphereHasAnAntialiasedOutlineOfTheRightSize) {
  const LightField field = constant_light_field(test::sphere(64, 40), {{255, 255, 255}}, 7);
  const ViewMaps maps(field);
  RenderSettings settings;
  settings.background = {0, 0, 0};
  const double distance = 400, pixels = 1.5;
  Camera camera = frontal_camera(64, 64, distance, 160, pixels);
  camera.translation[2] = distance - 64;
  const auto rendering = Renderer(maps, settings).render(camera);
  double area = 0;
  int partial = 0;
  for (const std::uint8_t c : rendering.coverage) {
    area += c / 255.0;
    partial += c > 0 && c < 255;
  }
  // Outline of a sphere: tan(asin(r / d)) times the focal length.
  const double outline = std::tan(std::asin(40 / distance)) * pixels * distance;
  const double measured = std::sqrt(area / 3.14159265358979);
  EXPECT_NEAR(measured, outline, 0.75);  // half a voxel
  EXPECT_GT(partial, 100);               // of about 2 pi r = 377 outline pixels
  EXPECT_LT(partial, 1000);
}

TEST(RenderTest, DepthIsThatOfTheSurfaceWithinAVoxel) {
  const LightField field = constant_light_field(test::sphere(64, 40), {{90, 90, 90}}, 7);
  const ViewMaps maps(field);
  Camera camera = frontal_camera(64, 64, 400, 160, 1.5);
  camera.translation[2] = 400 - 64;
  const auto rendering = Renderer(maps).render(camera);
  for (int y = 40; y < 120; y += 5)
    for (int x = 40; x < 120; x += 5) {
      const double dx = (x + 0.5 - 80) / camera.fx, dy = (y + 0.5 - 80) / camera.fy;
      // (t dx)^2 + (t dy)^2 + (t - 400)^2 = 40^2, the nearer root
      const double a = dx * dx + dy * dy + 1, b = -400, c = 400 * 400 - 40 * 40;
      const double expected = (-b - std::sqrt(b * b - a * c)) / a;
      EXPECT_NEAR(rendering.depth[pixel(rendering, x, y)], expected, 1.0) << x << ' ' << y;
    }
}

TEST(RenderTest, ANearSurfaceHidesAFarOneThreeVoxelsBehindToo) {
  for (const int distance : {8, 3}) {
    std::vector<Voxel> voxels = test::plane(64, 0);
    const std::vector<Voxel> far = test::plane(64, distance);
    std::vector<std::array<int, 3>> colours(voxels.size(), {250, 10, 10});
    voxels.insert(voxels.end(), far.begin(), far.end());
    colours.resize(voxels.size(), {10, 10, 250});
    const ViewMaps maps(constant_light_field(voxels, colours, 6));
    const auto rendering = Renderer(maps).render(frontal_camera(31.5, 31.5, 100, 50, 1.0));
    for (int y = 0; y < 50; ++y)
      for (int x = 0; x < 50; ++x) {
        const auto c = colour(rendering, x, y);
        ASSERT_NEAR(c[0], 250, 1);
        ASSERT_NEAR(c[2], 10, 1);
      }
  }
}

TEST(RenderTest, TheResultDoesNotDependOnThreads) {
  std::vector<std::array<int, 3>> colours;
  for (int i = 0; i < 97; ++i) colours.push_back({(i * 37) % 256, (i * 91) % 256, (i * 53) % 256});
  const LightField field = constant_light_field(test::sphere(64, 40), colours, 7);
  const ViewMaps maps(field);
  std::vector<Rendering> renderings;
  for (const int threads : {1, 2, 7}) {
    RenderSettings settings;
    settings.threads = threads;
    const Renderer renderer(maps, settings);
    renderings.push_back(renderer.render(renderer.orbit(0.3, 20, 123, 91)));
  }
  for (const Rendering& other : renderings) {
    EXPECT_EQ(other.image.data, renderings[0].image.data);
    EXPECT_EQ(other.coverage, renderings[0].coverage);
    EXPECT_EQ(other.depth, renderings[0].depth);
  }
}

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

TEST(RenderTest, ACameraInsideOrBehindTheCloudGivesAnImage) {
  const LightField field = constant_light_field(test::sphere(64, 40), {{90, 90, 90}}, 7);
  const ViewMaps maps(field);
  const Renderer renderer(maps);
  Camera camera = frontal_camera(64, 64, 1, 64, 40);
  for (const double z :
       {-64.0, -24.0, -104.0, -104.5, -25.2, -500.0}) {  // inside, on it, behind it
    camera.translation = {-64, -64, z};
    const auto rendering = renderer.render(camera);
    EXPECT_EQ(rendering.coverage.size(), 64u * 64u);
    if (z == -64.0) {  // a closed surface around the eye
      for (const std::uint8_t c : rendering.coverage) ASSERT_EQ(c, 255);
    }
    if (z == -500.0) {
      for (const std::uint8_t c : rendering.coverage) ASSERT_EQ(c, 0);
    }
  }
}

TEST(RenderTest, NoPointAndOnePointAreRendered) {
  const ViewMaps none(constant_light_field({}, {{0, 0, 0}}, 4));
  const auto nothing = Renderer(none).render(Renderer(none).orbit(0, 0, 16, 16));
  for (const std::uint8_t c : nothing.coverage) EXPECT_EQ(c, 0);

  const ViewMaps one(constant_light_field({{3, 4, 5}}, {{10, 200, 30}}, 4));
  const Renderer renderer(one);
  const auto dot = renderer.render(renderer.orbit(0.1, 90, 17, 17));
  EXPECT_EQ(dot.coverage[pixel(dot, 8, 8)], 255);
  EXPECT_EQ(colour(dot, 8, 8), (std::array<int, 3>{10, 200, 30}));
}

TEST(RenderTest, LinearLightIsShownThroughTheSrgbCurve) {
  LightField field = constant_light_field(test::plane(32, 0), {{55, 55, 55}}, 5);
  field.header.transfer = Transfer::kLinear;
  const ViewMaps maps(field);
  const auto rendering = Renderer(maps).render(frontal_camera(15.5, 15.5, 100, 16, 1));
  // 255 * (1.055 * (55 / 255)^(1 / 2.4) - 0.055) = 128.05
  EXPECT_NEAR(colour(rendering, 8, 8)[0], 128, 1);
}

TEST(RenderTest, CodedNormalsShapeTheDiscs) {
  // One point seen from the front: a disc whose normal lies across the view is narrow.
  LightField field = constant_light_field({{8, 8, 8}}, {{255, 255, 255}}, 4);
  const auto covered = [&](const std::array<double, 3>& normal) {
    field.normals.bits = 12;
    field.normals.octahedral = {quantise_normal(normal, 12)};
    const ViewMaps maps(field);
    RenderSettings settings;
    settings.radius = 4;
    double area = 0;
    for (const std::uint8_t c :
         Renderer(maps, settings).render(frontal_camera(8, 8, 100, 100, 5)).coverage)
      area += c / 255.0;
    return area;
  };
  EXPECT_LT(covered({1, 0, 0}), 0.4 * covered({0, 0, 1}));
  EXPECT_NEAR(covered({0, 0, 1}), covered({0, 0, -1}), 1e-9);
}

TEST(RadiancesTest, ManyPointsAtOnceHaveTheColoursOfEach) {
  for (const FrameId frame : {FrameId::kGlobal, FrameId::kReflected})
    for (const int degree : {0, 3, 8}) {
      LightField field;
      field.header.grid = {{-1, 2, 0.5}, 0.25, 5};
      field.header.basis = {BasisId::kHarmonics, 0, 0, 0};
      field.header.basis.degree = degree;
      field.header.frame = frame;
      field.header.num_functions = field.header.basis.num_functions();
      field.header.gamma_min_q7 = -40;
      field.header.gamma_max_q7 = 100;
      field.header.shift.assign(std::size_t(field.header.num_functions), 4);
      field.positions = test::sphere(10, 6);
      std::sort(field.positions.begin(), field.positions.end(),
                [](const Voxel& a, const Voxel& b) { return morton(a) < morton(b); });
      const std::size_t size = field.positions.size() * 3 * std::size_t(field.header.num_functions);
      for (std::size_t i = 0; i < size; ++i)
        field.components.push_back(static_cast<std::int32_t>(i * 7919 % 301) - 100);
      const ViewMaps maps(field);
      std::vector<std::uint32_t> points;  // not a multiple of what goes together
      for (std::uint32_t p = 0; p + 3 < field.positions.size(); p += 2) points.push_back(p);
      if (points.size() % 8 == 0) points.pop_back();
      std::vector<std::array<float, 3>> colours(points.size());
      const Vec3 eye{4, 1, 7};
      maps.radiances(eye, points, colours);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 at = field.header.grid.world(field.positions[points[i]]);
        const auto [theta, gamma] = direction_of({eye[0] - at[0], eye[1] - at[1], eye[2] - at[2]});
        const auto one = maps.radiance(points[i], theta, gamma);
        for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(colours[i][k], one[k], 0.02);
      }
    }
}

TEST(OrbitTest, TheUpAxisPointsUpInTheImageAndTheCloudFits) {
  const LightField original =
      constant_light_field({{8, 8, 8}, {12, 8, 8}, {8, 14, 8}, {8, 8, 15}}, {{255, 255, 255}}, 4);
  const std::array<std::pair<UpAxis, Vec3>, 6> axes{{{UpAxis::kPlusX, {1, 0, 0}},
                                                     {UpAxis::kMinusX, {-1, 0, 0}},
                                                     {UpAxis::kPlusY, {0, 1, 0}},
                                                     {UpAxis::kMinusY, {0, -1, 0}},
                                                     {UpAxis::kPlusZ, {0, 0, 1}},
                                                     {UpAxis::kMinusZ, {0, 0, -1}}}};
  for (const auto& [axis, up] : axes) {
    LightField field = original;
    field.header.up = axis;
    const ViewMaps maps(field);
    const Renderer renderer(maps);
    for (const double elevation : {-60.0, 0.0, 60.0})
      for (const double turn : {0.0, 0.2, 0.7}) {
        const Camera camera = renderer.orbit(turn, elevation, 200, 120);
        const auto& r = camera.rotation;
        // Down in the image is the second row; right-handed: row 0 x row 1 = row 2.
        EXPECT_LT(r[1][0] * up[0] + r[1][1] * up[1] + r[1][2] * up[2], -0.4);
        EXPECT_NEAR(r[0][0] * up[0] + r[0][1] * up[1] + r[0][2] * up[2], 0, 1e-12);
        EXPECT_NEAR(r[0][1] * r[1][2] - r[0][2] * r[1][1], r[2][0], 1e-12);
        EXPECT_NEAR(r[0][2] * r[1][0] - r[0][0] * r[1][2], r[2][1], 1e-12);
        EXPECT_NEAR(r[0][0] * r[1][1] - r[0][1] * r[1][0], r[2][2], 1e-12);
        for (const Voxel& v : field.positions) {
          const auto image = camera.project({double(v[0]), double(v[1]), double(v[2])});
          ASSERT_TRUE(image);
          EXPECT_TRUE((*image)[0] > 40 && (*image)[0] < 160 && (*image)[1] > 0 &&
                      (*image)[1] < 120);
        }
      }
  }
}

}  // namespace
}  // namespace slf
