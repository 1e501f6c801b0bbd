// Observation with known answers: one camera that looks along +z at points in front of it.
#include "slf/fit.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>

#include "lightfield/colour.h"
#include "lightfield/observe_camera.h"

namespace slf {
namespace {

constexpr std::array<float, 3> kTowards{0, 0, -1};  // a normal that faces the camera
using Points = std::vector<std::array<float, 3>>;

/// 8 x 6 pixels, focal length 10, principal point at the middle, at the origin.
Camera small_camera() {
  Camera camera;
  camera.name = "a";
  camera.width = 8;
  camera.height = 6;
  camera.fx = camera.fy = 10;
  camera.cx = 4;
  camera.cy = 3;
  return camera;
}

/// Red 10 x, green 20 y, blue 7 at pixel (x, y).
Image ramp(int channels = 3) {
  Image image{8, 6, channels, {}};
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x) {
      for (const int value : {10 * x, 20 * y, 7})
        image.data.push_back(static_cast<std::uint8_t>(value));
      if (channels == 4) image.data.push_back(255);
    }
  return image;
}

/// The point that projects to (u, v) at a depth.
std::array<float, 3> at(double u, double v, double depth) {
  return {static_cast<float>((u - 4) / 10 * depth), static_cast<float>((v - 3) / 10 * depth),
          static_cast<float>(depth)};
}

std::vector<Sighting> see(const ObservedPoints& points, const Points& occluders,
                          const ObserveSettings& settings, const Image& image = ramp(),
                          double spacing = 0.1) {
  return CameraObserver(points, occluders, spacing, settings)
      .observe(small_camera(), image)
      .sightings;
}

bool sees(const std::array<float, 3>& point, const Points& occluders,
          const ObserveSettings& settings, const std::array<float, 3>& normal = kTowards) {
  return !see({{point}, {normal}}, occluders, settings).empty();
}

TEST(Observe, SamplesBilinearlyWithPixelCentresAtOneHalf) {
  // (2.5, 3.5) is the centre of pixel (2, 3); (3.25, 1.75) lies 3/4 from 2 to 3 and 1/4 from 1
  // to 2.
  const auto seen = see({{at(2.5, 3.5, 2), at(3.25, 1.75, 2)}, {kTowards, kTowards}}, {}, {});
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_NEAR(seen[0].colour[0], 20, 1e-4);  // corner-based sampling would give 25, floor 30
  EXPECT_NEAR(seen[0].colour[1], 60, 1e-4);
  EXPECT_NEAR(seen[1].colour[0], 27.5, 1e-4);
  EXPECT_NEAR(seen[1].colour[1], 25, 1e-4);
  EXPECT_NEAR(seen[1].colour[2], 7, 1e-5);
}

TEST(Observe, RepeatsTheEdgeWithinTheOuterHalfPixelAndNothingOutside) {
  const auto corner = see({{at(0.1, 5.9, 2)}, {kTowards}}, {}, {});
  ASSERT_EQ(corner.size(), 1u);
  EXPECT_NEAR(corner[0].colour[0], 0, 1e-4);
  EXPECT_NEAR(corner[0].colour[1], 100, 1e-4);
  EXPECT_FALSE(sees(at(-0.1, 3, 2), {}, {}));
  EXPECT_FALSE(sees(at(8.1, 3, 2), {}, {}));
  EXPECT_FALSE(sees(at(4, 6.1, 2), {}, {}));
  EXPECT_FALSE(sees({0, 0, -2}, {}, {}, {0, 0, 1}));  // behind the camera, facing it
}

TEST(Observe, DirectionPointsFromThePointToTheCamera) {
  const auto seen = see({{{0, 3, 4}}, {{0, -0.6f, -0.8f}}}, {}, {});
  EXPECT_TRUE(seen.empty());  // v = 3 + 7.5 is outside
  const auto inside = see({{{0.3f, 0.4f, 12}}, {kTowards}}, {}, {});
  ASSERT_EQ(inside.size(), 1u);
  const double length = std::sqrt(0.25 + 144);
  EXPECT_NEAR(inside[0].direction[0], std::atan2(-0.4, -0.3), 1e-6);
  EXPECT_NEAR(inside[0].direction[1], -12 / length, 1e-6);
}

TEST(Observe, TheConeEndsAtNinetyDegreesMinusDelta) {
  const auto tilted = [](double degrees) {
    const double a = degrees * std::numbers::pi / 180;
    return std::array<float, 3>{static_cast<float>(std::sin(a)), 0,
                                static_cast<float>(-std::cos(a))};
  };
  ObserveSettings settings;
  settings.delta_degrees = 10;
  EXPECT_TRUE(sees({0, 0, 2}, {}, settings, tilted(79.99)));
  EXPECT_FALSE(sees({0, 0, 2}, {}, settings, tilted(80.01)));
  settings.delta_degrees = 0;
  EXPECT_TRUE(sees({0, 0, 2}, {}, settings, tilted(89.99)));
  EXPECT_FALSE(sees({0, 0, 2}, {}, settings, tilted(90.01)));
  EXPECT_FALSE(sees({0, 0, 2}, {}, settings, {0, 0, 1}));
}

TEST(Observe, AnOccluderHidesWhatIsDeeperThanTheTolerance) {
  ObserveSettings settings;  // 2.5 spacings; the spacing is 0.1, a pixel at depth 2 is 0.2 wide
  const Points occluder{{0, 0, 2}};
  EXPECT_TRUE(sees({0, 0, 2}, occluder, settings));
  EXPECT_TRUE(sees({0, 0, 2.3f}, occluder, settings));
  EXPECT_FALSE(sees({0, 0, 3}, occluder, settings));
  EXPECT_TRUE(sees({0, 0, 1.5f}, occluder, settings));     // in front
  EXPECT_TRUE(sees(at(6.5, 4.5, 3), occluder, settings));  // beside
}

TEST(Observe, ASlantedSurfaceDoesNotHideItself) {
  // Seen at 70 degrees: depth changes by 2.7 spacings from point to point.
  const double slope = std::tan(70 * std::numbers::pi / 180);
  Points surface;
  for (int i = -30; i <= 30; ++i)
    for (int j = -8; j <= 8; ++j)
      surface.push_back({static_cast<float>(0.02 * i), static_cast<float>(0.02 * j),
                         static_cast<float>(4 + 0.02 * i * slope)});
  const double a = 70 * std::numbers::pi / 180;
  const std::array<float, 3> normal{static_cast<float>(std::sin(a)), 0,
                                    static_cast<float>(-std::cos(a))};
  const ObservedPoints points{surface, Points(surface.size(), normal)};
  EXPECT_EQ(see(points, surface, {}, ramp(), 0.02).size(), surface.size());
  ObserveSettings strict;
  strict.depth_tolerance = 0;
  EXPECT_LT(see(points, surface, strict, ramp(), 0.02).size(), surface.size() / 2);
}

TEST(Observe, SplatsLeaveNoHolesInASurfaceSparserThanThePixels) {
  // Points every 2.5 pixels; a surface behind them must not be seen through the gaps.
  Points front, behind;
  for (float x = -10; x <= 10; x += 0.5f)
    for (float y = -10; y <= 10; y += 0.5f) front.push_back({x, y, 20});
  for (double u = 0.05; u < 8; u += 0.31)
    for (double v = 0.05; v < 6; v += 0.31) behind.push_back(at(u, v, 40));
  const Points normals(behind.size(), kTowards);
  ObserveSettings fine;
  fine.occlusion_resolution = 8;
  EXPECT_TRUE(see({behind, normals}, front, fine, ramp(), 0.5).empty());
}

TEST(Observe, WithoutToleranceTheNearestPointOfAPixelWins) {
  ObserveSettings strict;
  strict.depth_tolerance = 0;
  const Points pair{at(2.2, 2.2, 2), at(2.8, 2.8, 2.001)};  // one pixel
  const auto seen = see({pair, {kTowards, kTowards}}, pair, strict);
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0].point, 0u);
  const Points apart{at(2.2, 2.2, 2), at(3.2, 2.8, 2.001)};
  EXPECT_EQ(see({apart, {kTowards, kTowards}}, apart, strict).size(), 2u);
}

/// What the camera sees of points behind a triangle.
bool sees_behind(const Mesh& mesh, const std::array<float, 3>& point) {
  const ObservedPoints points{{point}, {kTowards}};
  return !CameraObserver(points, {}, 0.1, {}, &mesh)
              .observe(small_camera(), ramp())
              .sightings.empty();
}

TEST(Observe, ATriangleHidesWhatIsBehindItAndNothingBesideIt) {
  Mesh mesh;
  mesh.vertices.positions = {at(1, 1, 2), at(5, 1, 2), at(1, 5, 4)};  // slanted
  for (const auto& triangle : {std::array<std::uint32_t, 3>{0, 1, 2}, {2, 1, 0}}) {
    mesh.triangles = {triangle};
    EXPECT_FALSE(sees_behind(mesh, at(1.5, 1.5, 5)));
    EXPECT_FALSE(sees_behind(mesh, at(3.4, 1.5, 5)));
    EXPECT_TRUE(sees_behind(mesh, at(5.5, 1.5, 5)));
    EXPECT_TRUE(sees_behind(mesh, at(3.5, 3.5, 5)));
    EXPECT_TRUE(sees_behind(mesh, at(1.5, 1.5, 2.3))) << "within the tolerance";
    EXPECT_TRUE(sees_behind(mesh, at(1.5, 1.5, 1.5)));
  }
}

TEST(Observe, ATriangleThatReachesBehindTheCameraHidesWithItsPartInFront) {
  Mesh mesh;  // a floor below the camera
  mesh.vertices.positions = {{-90, 1, -9}, {90, 1, -9}, {0, 1, 300}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_FALSE(sees_behind(mesh, at(4.5, 5.5, 30)));
  EXPECT_TRUE(sees_behind(mesh, at(4.5, 5.5, 3)));   // above the floor
  EXPECT_TRUE(sees_behind(mesh, at(4.5, 0.5, 30)));  // above the horizon
}

TEST(Observe, TrianglesBehindTheCameraOrWithoutAreaHideNothing) {
  Mesh mesh;
  mesh.vertices.positions = {{-9, -9, -2}, {9, -9, -2}, {0, 9, -2}, at(1, 1, 2), at(3, 3, 2)};
  mesh.triangles = {{0, 1, 2}, {3, 4, 4}, {3, 3, 3}};
  EXPECT_TRUE(sees_behind(mesh, at(2.5, 2.5, 5)));
}

TEST(Observe, AMaskedPixelInTheFootprintDropsTheSample) {
  Image image = ramp(4);
  image.data[4 * (3 * 8 + 2) + 3] = 0;  // pixel (2, 3)
  const auto seen_at = [&](double u, double v) {
    return !see({{at(u, v, 2)}, {kTowards}}, {}, {}, image).empty();
  };
  EXPECT_FALSE(seen_at(2.5, 3.5));
  EXPECT_FALSE(seen_at(3.4, 3.5));
  EXPECT_FALSE(seen_at(1.6, 2.6));
  EXPECT_TRUE(seen_at(3.6, 3.5));
  EXPECT_TRUE(seen_at(2.5, 4.6));
}

TEST(Observe, LinearTransferIsTakenBeforeTheMixture) {
  Image image{2, 1, 3, {0, 0, 0, 255, 255, 188}};
  std::array<float, 256> linear{};
  for (int i = 0; i < 256; ++i)
    linear[static_cast<std::size_t>(i)] = static_cast<float>(255 * srgb_to_linear(i / 255.0));
  std::array<float, 3> colour{};
  ASSERT_TRUE(sample_bilinear(image, 1.0, 0.5, linear, colour));
  EXPECT_NEAR(colour[0], 127.5, 1e-4);
  EXPECT_NEAR(colour[2], 255 * 0.5028865 / 2, 1e-3);  // ((188/255 + 0.055) / 1.055)^2.4

  ObserveSettings settings;
  settings.transfer = Transfer::kLinear;
  const auto seen = see({{at(2.5, 3.5, 2)}, {kTowards}}, {}, settings);
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_NEAR(seen[0].colour[0], 255 * srgb_to_linear(20 / 255.0), 1e-4);
}

TEST(TransferCurve, HasThePublishedValuesAndInverse) {
  EXPECT_NEAR(srgb_to_linear(0.5), 0.2140411, 1e-7);
  EXPECT_NEAR(srgb_to_linear(0.04), 0.04 / 12.92, 1e-12);
  for (const double v : {0.0, 0.002, 0.03, 0.5, 1.0})
    EXPECT_NEAR(linear_to_srgb(srgb_to_linear(v)), v, 1e-9);
}

/// Two cameras on disk, one unit to the left and to the right of the origin, looking along +z.
class ObserveCaptureTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("slf_observe_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    for (const double x : {-0.2, 0.2}) {
      Camera camera = small_camera();
      camera.name = x < 0 ? "left" : "right";
      camera.translation = {-x, 0, 0};
      capture_.cameras.push_back(camera);
      capture_.image_files.push_back(folder_ / (camera.name + ".png"));
      ASSERT_TRUE(write_png(capture_.image_files.back(), ramp()));
    }
    for (int i = 0; i < 40; ++i) {
      points_.positions.push_back(at(0.3 + 0.19 * i, 3.1, 2 + 0.01 * i));
      points_.normals.push_back(kTowards);
    }
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
  Capture capture_;
  ObservedPoints points_;
};

TEST_F(ObserveCaptureTest, GroupsByPointWithCamerasAscending) {
  const std::vector<int> cameras{1, 0, 1};  // order and repetition do not matter
  const auto seen = observe(capture_, cameras, points_, {}, 0.1, {});
  ASSERT_TRUE(seen) << seen.error().message;
  ASSERT_EQ(seen->first.size(), 41u);
  EXPECT_EQ(seen->first.back(), seen->camera.size());
  for (std::size_t p = 0; p < 40; ++p) {
    const double u = 0.3 + 0.19 * static_cast<double>(p),
                 shift = 2 / (2 + 0.01 * static_cast<double>(p));
    std::vector<std::uint16_t> expected;
    if (u + shift < 8) expected.push_back(0);  // the left camera sees a point further right
    if (u - shift >= 0) expected.push_back(1);
    const std::vector<std::uint16_t> found(
        seen->camera.begin() + static_cast<std::ptrdiff_t>(seen->first[p]),
        seen->camera.begin() + static_cast<std::ptrdiff_t>(seen->first[p + 1]));
    EXPECT_EQ(found, expected) << "point " << p;
  }
  EXPECT_LT(seen->gamma_max, -0.9);
  EXPECT_LE(seen->gamma_min, seen->gamma_max);
}

TEST_F(ObserveCaptureTest, DoesNotDependOnTheNumberOfThreads) {
  const std::vector<int> cameras{0, 1};
  ObserveSettings settings;
  settings.threads = 1;
  const auto one = observe(capture_, cameras, points_, points_.positions, 0.05, settings);
  settings.threads = 7;
  const auto seven = observe(capture_, cameras, points_, points_.positions, 0.05, settings);
  ASSERT_TRUE(one && seven);
  EXPECT_EQ(one->first, seven->first);
  EXPECT_EQ(one->direction, seven->direction);
  EXPECT_EQ(one->colour, seven->colour);
  EXPECT_EQ(one->camera, seven->camera);
}

TEST_F(ObserveCaptureTest, SaysWhyNothingIsSeen) {
  const std::vector<int> cameras{0, 1};
  ObservedPoints away = points_;
  for (auto& normal : away.normals) normal = {0, 0, 1};
  const auto seen = observe(capture_, cameras, away, {}, 0.1, {});
  ASSERT_FALSE(seen);
  EXPECT_EQ(seen.error().code, Errc::kInvalidInput);
  EXPECT_NE(seen.error().message.find("2 cameras x 40 points, 0 face"), std::string::npos)
      << seen.error().message;
}

TEST_F(ObserveCaptureTest, RefusesBadArgumentsAndMissingImages) {
  const std::vector<int> cameras{0, 1};
  const auto code = [&](const ObserveSettings& settings, double spacing = 0.1) {
    const auto seen = observe(capture_, cameras, points_, {}, spacing, settings);
    return seen ? Errc::kNotSlf : seen.error().code;
  };
  ObserveSettings bad;
  bad.delta_degrees = 91;
  EXPECT_EQ(code(bad), Errc::kInvalidArgument);
  bad = {};
  bad.occlusion_resolution = 9;
  EXPECT_EQ(code(bad), Errc::kInvalidArgument);
  bad = {};
  bad.depth_tolerance = NAN;
  EXPECT_EQ(code(bad), Errc::kInvalidArgument);
  EXPECT_EQ(code({}, 0), Errc::kInvalidArgument);
  const std::vector<int> foreign{0, 2};
  EXPECT_EQ(observe(capture_, foreign, points_, {}, 0.1, {}).error().code, Errc::kInvalidArgument);
  ObservedPoints no_normals = points_;
  no_normals.normals.clear();
  EXPECT_EQ(observe(capture_, cameras, no_normals, {}, 0.1, {}).error().code,
            Errc::kInvalidArgument);
  std::filesystem::remove(capture_.image_files[1]);
  EXPECT_EQ(code({}), Errc::kUnreadable);
}

}  // namespace
}  // namespace slf
