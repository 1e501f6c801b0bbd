// SPDX-License-Identifier: Apache-2.0
// The fit to pictures against a dense solve of its definition (encoder/fit/picture_system.h).
#define EIGEN_MPL2_ONLY
#include "encoder/fit/fit_pictures.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "encoder/fit/direction_kernel.h"
#include "encoder/fit/picture_views.h"
#include "lightfield/directions.h"
#include "lightfield/render/splat_weights.h"
#include "lightfield/render/surfel_cloud.h"
#include "slf/view_map.h"
#include "tests/codec/field_support.h"

namespace slf::fit_pictures_test {
namespace {

using Matrix = Eigen::MatrixXd;

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

/// A patch of a plane that three cameras see from different sides; colours of grey noise.
struct Scene {
  Grid grid{{0, 0, 0}, 1, 4};
  std::vector<Voxel> positions;
  CodedNormals normals;
  Capture capture;
  std::vector<int> cameras{0, 1, 2};

  Scene() {
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 6; ++x) positions.push_back({x, y, 4});
    positions = test::sorted_distinct(positions);
    std::mt19937 random(7);
    std::uniform_int_distribution<int> grey(100, 150);
    for (const double turn : {-0.4, 0.0, 0.5}) {
      Camera camera;
      camera.name = std::to_string(capture.cameras.size());
      camera.width = camera.height = 12;
      camera.fx = camera.fy = 30;
      camera.cx = camera.cy = 6;
      const double c = std::cos(turn), s = std::sin(turn);
      camera.rotation = {{{c, 0, s}, {0, -1, 0}, {s, 0, -c}}};  // looks down on the patch
      const Vec3 middle{2.5, 2.5, 4};
      for (std::size_t k = 0; k < 3; ++k) {
        double along = 0;
        for (std::size_t a = 0; a < 3; ++a) along += camera.rotation[k][a] * middle[a];
        camera.translation[k] = (k == 2 ? 20 : 0) - along;
      }
      Image image{12, 12, 3, {}};
      for (int i = 0; i < 12 * 12 * 3; ++i)
        image.data.push_back(static_cast<std::uint8_t>(grey(random)));
      capture.cameras.push_back(camera);
      capture.image_files.emplace_back();
      capture.images.push_back(image);
    }
  }

  PictureFitInput input() const {
    return {capture, cameras, {}, grid, positions, normals, Transfer::kDisplay, {-1, 1}};
  }

  std::array<float, 2> direction(const FitSettings& settings, std::size_t p, int camera) const {
    const Vec3 at = grid.world(positions[p]);
    const Vec3 eye = capture.cameras[static_cast<std::size_t>(camera)].centre();
    return to_local(mirror_normals(settings.directions, positions, 0, 1), p,
                    direction_of({eye[0] - at[0], eye[1] - at[1], eye[2] - at[2]}));
  }
};

FitSettings settings_of(const Basis& basis, Directions frame) {
  FitSettings settings = FitSettings::hierarchical();
  settings.basis = basis;
  settings.directions = frame;
  settings.threads = 1;
  settings.pictures = {
      .rounds = 1, .steps = 100, .mean_penalty = 0.3, .penalty = 2, .growth = 1.5, .outlier = 1e6};
  return settings;
}

/// The minimum over all coefficients of all points at once, from c0 = 125 for the mean.
Matrix dense_solution(const Scene& scene, const FitSettings& settings,
                      const std::vector<int>& fineness) {
  const auto k = static_cast<std::size_t>(settings.basis.num_functions());
  const std::size_t points = scene.positions.size();
  const auto norms = basis_norms(settings.basis);
  const SurfelCloud cloud = surfel_cloud(scene.grid, scene.positions, scene.normals, 0, 1);
  Matrix normal = Matrix::Zero(index(points * k), index(points * k));
  Matrix right = Matrix::Zero(index(points * k), 3);
  for (std::size_t i = 0; i < points * k; ++i)
    normal(index(i), index(i)) =
        fineness[i % k] == 0
            ? settings.pictures.mean_penalty
            : settings.pictures.penalty * std::pow(settings.pictures.growth, fineness[i % k]);
  for (const int c : scene.cameras) {
    const Camera& camera = scene.capture.cameras[static_cast<std::size_t>(c)];
    const auto weights =
        splat_weights(project_surfels(cloud, camera, 1), camera.width, camera.height, 1);
    for (std::size_t i = 0; i < weights.coverage.size(); ++i) {
      if (weights.coverage[i] < 0.99f) continue;
      Matrix row = Matrix::Zero(1, index(points * k));
      for (auto j = weights.first[i]; j < weights.first[i + 1]; ++j) {
        const std::size_t p = weights.point[j];
        const auto d = scene.direction(settings, p, c);
        for (std::size_t f = 0; f < k; ++f)
          row(0, index(p * k + f)) +=
              double(weights.weight[j]) *
              basis_value(settings.basis, int(f), double(d[0]), double(d[1])) / norms[f];
      }
      normal += row.transpose() * row;
      for (int channel = 0; channel < 3; ++channel)
        right.col(channel) +=
            row.transpose() *
            (scene.capture.images[static_cast<std::size_t>(c)].data[3 * i + std::size_t(channel)] -
             125.0);
    }
  }
  Matrix change = normal.ldlt().solve(right);
  for (std::size_t i = 0; i < points * k; ++i) {
    change.row(index(i)) /= norms[i % k];
    if (i % k == 0) change.row(index(i)).array() += 125;
  }
  return change;
}

std::vector<float> grey(const Scene& scene, std::size_t functions) {
  std::vector<float> coefficients(scene.positions.size() * functions * 3, 0.0f);
  for (std::size_t i = 0; i < coefficients.size(); i += 3 * functions)
    for (std::size_t c = 0; c < 3; ++c) coefficients[i + c] = 125;
  return coefficients;
}

struct Case {
  const char* name;
  Basis basis;
  Directions frame;
  std::vector<int> fineness;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class PictureFitTest : public testing::TestWithParam<Case> {};

TEST_P(PictureFitTest, ReachesTheMinimumOfItsDefinition) {
  const Scene scene;
  const FitSettings settings = settings_of(GetParam().basis, GetParam().frame);
  const auto functions = static_cast<std::size_t>(settings.basis.num_functions());
  auto coefficients = grey(scene, functions);
  const auto report = fit_to_pictures(scene.input(), settings, false, coefficients);
  ASSERT_TRUE(report);
  EXPECT_GT(report->psnr_after, report->psnr_before);
  const Matrix expected = dense_solution(scene, settings, GetParam().fineness);
  for (std::size_t i = 0; i < coefficients.size(); ++i)  // floats, colours up to 150
    ASSERT_NEAR(double(coefficients[i]), expected(index(i / 3), index(i % 3)), 0.02) << i;
}

INSTANTIATE_TEST_SUITE_P(Bases, PictureFitTest,
                         testing::Values(Case{"harmonics",
                                              {BasisId::kHarmonics, 2, 0, 0, 2},
                                              Directions::kReflected,
                                              {0, 1, 1, 1, 2, 2, 2, 2, 2}},
                                         Case{"harmonics_global",
                                              {BasisId::kHarmonics, 2, 0, 0, 1},
                                              Directions::kWorld,
                                              {0, 1, 1, 1}},
                                         Case{"bsplines",
                                              {BasisId::kBspline, 2, 1, 1, 0},
                                              Directions::kWorld,
                                              {0, 1, 1, 2}}),
                         [](const auto& of) { return of.param.name; });

TEST(PictureFit, IsTheSameForAnyThreadCount) {
  const Scene scene;
  FitSettings settings = settings_of({BasisId::kHarmonics, 2, 0, 0, 3}, Directions::kReflected);
  settings.pictures.rounds = 2;
  settings.pictures.steps = 5;
  auto one = grey(scene, 16), four = one;
  ASSERT_TRUE(fit_to_pictures(scene.input(), settings, false, one));
  settings.threads = 4;
  ASSERT_TRUE(fit_to_pictures(scene.input(), settings, false, four));
  EXPECT_EQ(one, four);
}

TEST(PictureFit, APixelFarOffTheOthersHardlyCounts) {
  Scene scene;
  FitSettings settings = settings_of({BasisId::kHarmonics, 2, 0, 0, 1}, Directions::kWorld);
  settings.pictures.outlier = 20;
  auto clean = grey(scene, 4), spoilt = clean;
  ASSERT_TRUE(fit_to_pictures(scene.input(), settings, false, clean));
  for (int x = 5; x < 8; ++x)  // another object in front
    for (std::size_t c = 0; c < 3; ++c)
      scene.capture.images[1].data[3 * (6 * 12 + std::size_t(x)) + c] = 0;
  ASSERT_TRUE(fit_to_pictures(scene.input(), settings, false, spoilt));
  double most = 0;
  for (std::size_t i = 0; i < clean.size(); i += 12)
    most = std::max(most, std::abs(double(clean[i]) - double(spoilt[i])));
  EXPECT_LT(most, 12.5);  // a tenth of what the pixels are off
}

TEST(PictureFit, PointsThatNoPictureShowsStayWhatTheyAre) {
  Scene scene;
  scene.cameras = {1};
  for (Voxel v : {Voxel{0, 0, 15}, Voxel{15, 15, 15}}) scene.positions.push_back(v);
  const FitSettings settings = settings_of({BasisId::kHarmonics, 2, 0, 0, 1}, Directions::kWorld);
  auto coefficients = grey(scene, 4);
  ASSERT_TRUE(fit_to_pictures(scene.input(), settings, false, coefficients));
  EXPECT_EQ(coefficients[coefficients.size() - 12], 125);
}

TEST(DirectionKernel, KernelOfHarmonicsIsASumOverTheirRows) {
  const Basis basis{BasisId::kHarmonics, 2, 0, 0, 10};
  const DirectionRows rows(basis);
  std::vector<double> penalty;
  for (const int l : rows.fineness()) penalty.push_back(0.5 + l * l);
  const DirectionKernel kernel(basis, rows, penalty);
  const std::vector<std::array<float, 3>> world = {
      {0, 0, 1}, {0.6f, 0, 0.8f}, {-0.36f, 0.48f, -0.8f}};
  for (std::size_t j = 0; j < 3; ++j) {
    std::vector<Colour4> unit(3), out(3);
    unit[j] = {1, 2, -1, 0};
    kernel.apply(world, {}, unit, out);
    for (std::size_t i = 0; i < 3; ++i) {
      std::vector<float> a(rows.size()), b(rows.size());
      const auto along = [&](std::size_t d) {
        return direction_of({double(world[d][0]), double(world[d][1]), double(world[d][2])});
      };
      rows.evaluate(along(i), a.data());
      rows.evaluate(along(j), b.data());
      double sum = 0;
      for (std::size_t k = 0; k < a.size(); ++k) sum += double(a[k]) * double(b[k]) / penalty[k];
      EXPECT_NEAR(double(out[i][0]), sum, 1e-3) << i << ' ' << j;
      EXPECT_NEAR(double(out[i][1]), 2 * sum, 2e-3);
    }
  }
}

TEST(DirectionRows, RowsOfManyDirectionsAreThoseOfEach) {
  constexpr std::size_t kCount = 11, kStride = 16;
  for (const Basis& basis : {Basis{BasisId::kHarmonics, 2, 0, 0, 10}, Basis{}}) {
    const DirectionRows rows(basis);
    std::vector<std::array<float, 2>> directions;
    std::vector<Vec3> vectors;
    for (std::size_t i = 0; i < kCount; ++i) {
      directions.push_back(
          {-3 + 0.55f * static_cast<float>(i), -0.95f + 0.19f * static_cast<float>(i)});
      vectors.push_back(vector_of(directions.back()));
    }
    std::vector<float> columns(kStride * rows.size()), of_vectors(kCount * rows.size()),
        one(rows.size());
    rows.evaluate_columns(directions, columns.data(), kStride);
    rows.evaluate(vectors, of_vectors.data());
    for (std::size_t i = 0; i < kStride; ++i) {
      rows.evaluate(directions[std::min(i, kCount - 1)], one.data());
      for (std::size_t k = 0; k < one.size(); ++k) {
        EXPECT_NEAR(columns[k * kStride + i], one[k], 2e-4f) << i << ' ' << k;
        if (i >= kCount) continue;
        EXPECT_NEAR(of_vectors[i * one.size() + k], one[k], 2e-4f) << i << ' ' << k;
      }
    }
  }
}

TEST(PictureView, TellsPointsApartWhereTheyAreMoreThan16BitsCount) {
  PictureView view;
  for (const std::uint32_t points : {65536u, 65537u, 200000u}) {
    view.points.resize(points);
    const std::vector<std::uint32_t> local = {0, 65535, points - 1, 65535, points / 2};
    view.set_local(local);
    for (std::size_t j = 0; j < local.size(); ++j) EXPECT_EQ(view.local(j), local[j]);
  }
}

}  // namespace
}  // namespace slf::fit_pictures_test
