// SPDX-License-Identifier: Apache-2.0
#include "slf/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "geometry/morton.h"
#include "lightfield/octahedral.h"
#include "lightfield/render/render_surfels.h"
#include "render_support.h"

namespace slf::render_test {
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

TEST(RenderTest, APictureThatIsGivenUpEndsAndTheNextIsWhole) {
  const LightField field = constant_light_field(test::plane(64, 0), {{200, 100, 50}}, 6);
  const ViewMaps maps(field);
  const Renderer renderer(maps);
  const Camera camera = frontal_camera(31.5, 31.5, 200, 40, 1.0);
  std::atomic<bool> ended = true;
  const Rendering none = renderer.render(camera, &ended);
  EXPECT_EQ(none.image.width, 40);
  EXPECT_TRUE(none.image.data.empty() && none.coverage.empty()) << "nothing is held for it";
  ended = false;
  EXPECT_EQ(renderer.render(camera, &ended).image.data, renderer.render(camera).image.data);
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
  for (const Directions frame : {Directions::kWorld, Directions::kReflected})
    for (const int degree : {0, 3, 8}) {
      LightField field;
      field.header.grid = {{-1, 2, 0.5}, 0.25, 5};
      field.header.basis = {BasisId::kHarmonics, 0, 0, 0};
      field.header.basis.degree = degree;
      field.header.directions = frame;
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
}  // namespace slf::render_test
