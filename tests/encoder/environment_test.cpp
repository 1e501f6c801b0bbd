// SPDX-License-Identifier: Apache-2.0
// What is reflected: its model, how it is found, and what it is worth between cameras.
#include "encoder/fit/environment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "encoder/fit/camera_folds.h"
#include "encoder/fit/environment_fit.h"
#include "encoder/fit/environment_projection.h"
#include "lightfield/directions.h"
#include "lightfield/harmonics.h"
#include "slf/fit.h"
#include "slf/view_map.h"
#include "tests/codec/field_support.h"

namespace slf::environment_test {
namespace {

constexpr double kLampRadius = 4;  // halves of the object's side

Vec3 unit(const Vec3& v) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return {v[0] / length, v[1] / length, v[2] / length};
}

/// A lamp on the sphere of that radius, wide enough for degree 8.
float lamp(const Vec3& position, const Vec3& reflected) {
  const Vec3 place = place_on_sphere(position, reflected, kLampRadius);
  return static_cast<float>(120 * std::exp(12 * (0.6 * place[0] + 0.8 * place[2] - 1)));
}

struct Scene {
  std::vector<Voxel> positions = test::sphere_cloud(5);
  std::vector<std::array<float, 3>> normals =
      mirror_normals(Directions::kReflected, positions, 0, 1);
  std::vector<Vec3> cameras;

  Scene() {  // rings about the vertical axis, with gaps between them
    for (const double height : {-0.6, 0.0, 0.6})
      for (int i = 0; i < 9; ++i) {
        const double turn = 2 * 3.14159265 * i / 9, r = std::sqrt(1 - height * height);
        cameras.push_back({r * std::cos(turn), r * std::sin(turn), height});
      }
    const ObjectBox box(positions);
    for (std::size_t p = 0; p < positions.size(); ++p) {
      const Vec3 at = box(positions[p]);  // the object is a sphere about the origin
      double outward = 0;
      for (std::size_t a = 0; a < 3; ++a) outward += double(normals[p][a]) * at[a];
      if (outward < 0)
        for (float& x : normals[p]) x = -x;
    }
  }

  /// Far cameras: all points see one along the same direction. Directions are reflected.
  Observations observe(const std::vector<Vec3>& from) const {
    const ObjectBox box(positions);
    Observations seen;
    seen.first.push_back(0);
    for (std::size_t p = 0; p < positions.size(); ++p) {
      for (std::size_t i = 0; i < from.size(); ++i) {
        double cosine = 0;
        for (std::size_t a = 0; a < 3; ++a) cosine += double(normals[p][a]) * from[i][a];
        if (cosine < 0.17) continue;
        const auto d = to_local(normals, p, direction_of(from[i]));
        const float grey = 60 + lamp(box(positions[p]), vector_of(d));
        seen.direction.push_back(d);
        seen.colour.push_back({grey, grey, grey});
        seen.camera.push_back(static_cast<std::uint16_t>(i));
      }
      seen.first.push_back(seen.direction.size());
    }
    return seen;
  }
};

MirrorPoints mirrors(const Scene& scene) { return mirror_points(scene.positions, 0, 2); }

FitSettings settings_with(int environment_degree) {
  FitSettings s;
  s.method = FitMethod::kHierarchical;
  s.basis = {BasisId::kHarmonics, 2, 0, 0, 8};
  s.directions = Directions::kReflected;
  s.environment.degree = environment_degree;
  s.threads = 2;
  return s;
}

TEST(EnvironmentModel, ARayMeetsTheSphereWhereItShould) {
  const Vec3 place = place_on_sphere({0.5, 0, 0}, {0, 0, 1}, 2);
  EXPECT_NEAR(place[0], 0.25, 1e-12);
  EXPECT_NEAR(place[0] * place[0] + place[1] * place[1] + place[2] * place[2], 1, 1e-12);
  const Vec3 far = place_on_sphere({0.5, 0.5, 0.5}, unit({1, 2, -1}), 1e6);
  EXPECT_NEAR(far[1], unit({1, 2, -1})[1], 1e-5);
}

TEST(EnvironmentModel, TheTableAgreesWithTheHarmonics) {
  constexpr int kDegree = 16;
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<float> light(3 * (kDegree + 1) * (kDegree + 1));
  for (float& x : light) x = static_cast<float>(normal(random));
  const Environment environment(3, kDegree, light, 2);
  const Harmonics harmonics(kDegree);
  std::vector<double> row(light.size() / 3);
  for (int i = 0; i < 200; ++i) {
    const Vec3 d = unit({normal(random), normal(random), normal(random)});
    harmonics.evaluate(place_on_sphere({0.1, -0.3, 0.5}, d, 3), row.data());
    double expected = 0;
    for (std::size_t k = 1; k < row.size(); ++k) expected += row[k] * double(light[3 * k + 1]);
    // The curvature between samples: (16 pi / 512)^2 of a root mean square of 17.
    EXPECT_NEAR(double(environment({0.1, -0.3, 0.5}, d)[1]), expected, 0.17);
  }
}

TEST(EnvironmentFit, HeldOutCamerasHaveTheirNeighboursHeldOutToo) {
  const Scene scene;
  const auto fold = camera_folds(scene.cameras);
  EXPECT_EQ(std::set<int>(fold.begin(), fold.end()), (std::set<int>{0, 1, 2, 3}));
  // In a ring every ninth of a turn, a camera's nearest ones mostly share its fold.
  int together = 0;
  for (std::size_t i = 0; i < fold.size(); ++i) {
    double best = -2;
    std::size_t nearest = 0;
    for (std::size_t j = 0; j < fold.size(); ++j) {
      const double c = scene.cameras[i][0] * scene.cameras[j][0] +
                       scene.cameras[i][1] * scene.cameras[j][1] +
                       scene.cameras[i][2] * scene.cameras[j][2];
      if (j != i && c > best) {
        best = c;
        nearest = j;
      }
    }
    together += fold[i] == fold[nearest];
  }
  EXPECT_GE(together, static_cast<int>(fold.size()) / 2);
}

TEST(EnvironmentFit, FindsHowFarTheLampIs) {
  const Scene scene;
  const auto light =
      fit_environment(scene.observe(scene.cameras), mirrors(scene), settings_with(16));
  ASSERT_TRUE(light);
  EXPECT_GE(light->radius(), 3.2);
  EXPECT_LE(light->radius(), 5);
}

TEST(EnvironmentFit, IsLeftOutWhereNothingIsReflectedOrCamerasAreTooFew) {
  const Scene scene;
  Observations seen = scene.observe(scene.cameras);
  std::mt19937 random(3);
  std::normal_distribution<float> noise(100, 5);
  for (auto& colour : seen.colour) colour = {noise(random), noise(random), noise(random)};
  EXPECT_FALSE(fit_environment(seen, mirrors(scene), settings_with(16)));
  const Observations two = scene.observe({scene.cameras[0], scene.cameras[1]});
  EXPECT_FALSE(fit_environment(two, mirrors(scene), settings_with(16)));
}

TEST(EnvironmentFit, DoesNotDependOnTheNumberOfThreadsOrTheFrame) {
  const Scene scene;
  const Observations seen = scene.observe(scene.cameras);
  FitSettings s = settings_with(6);
  s.environment.radius = 4;
  const auto two = fit_view_maps(seen, scene.positions, s);
  s.threads = 1;
  EXPECT_EQ(*two, *fit_view_maps(seen, scene.positions, s));
  // The same views with world directions.
  Observations world = seen;
  for (std::size_t p = 0; p < scene.positions.size(); ++p)
    for (auto j = seen.first[p]; j < seen.first[p + 1]; ++j)
      world.direction[j] = to_local(scene.normals, p, seen.direction[j]);
  const auto a = *fit_environment(seen, mirrors(scene), s);
  s.directions = Directions::kWorld;
  const auto b = *fit_environment(world, mirrors(scene), s);
  EXPECT_NEAR(double(a({0, 0, 1}, {0.6, 0, 0.8})[0]), double(b({0, 0, 1}, {0.6, 0, 0.8})[0]), 0.05);
}

/// The purpose: a lamp is seen between the rings of cameras.
TEST(EnvironmentFit, ViewsBetweenTheCamerasAreBetterWithIt) {
  const Scene scene;
  const Observations seen = scene.observe(scene.cameras);
  std::vector<Vec3> between;
  for (int i = 0; i < 12; ++i)
    between.push_back({0.95 * std::cos(i * 0.52), 0.95 * std::sin(i * 0.52), 0.31});
  for (Vec3& c : between) c = unit(c);
  const Observations held_out = scene.observe(between);
  const auto error = [&](int degree) {
    const FitSettings s = settings_with(degree);
    const auto fitted = *fit_view_maps(seen, scene.positions, s);
    double sum = 0;
    for (std::size_t p = 0; p < scene.positions.size(); ++p)
      for (auto j = held_out.first[p]; j < held_out.first[p + 1]; ++j) {
        double value = 0;
        for (std::size_t k = 0; k < 81; ++k)
          value += double(fitted[(p * 81 + k) * 3]) * basis_value(s.basis, static_cast<int>(k),
                                                                  double(held_out.direction[j][0]),
                                                                  double(held_out.direction[j][1]));
        const double e = value - double(held_out.colour[j][0]);
        sum += e * e;
      }
    return std::sqrt(sum / static_cast<double>(held_out.direction.size()));
  };
  EXPECT_LT(error(16), 0.8 * error(0));
}

}  // namespace
}  // namespace slf::environment_test
