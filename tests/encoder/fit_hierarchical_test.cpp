// SPDX-License-Identifier: Apache-2.0
// The hierarchical fit against naive dense solves of its definition (slf/fit.h).
#define EIGEN_MPL2_ONLY
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "lightfield/directions.h"
#include "slf/fit.h"
#include "slf/view_map.h"
#include "tests/codec/field_support.h"

namespace slf::fit_hierarchical_test {
namespace {

using Matrix = Eigen::MatrixXd;

constexpr double kBlockPenalty = 0.8;  // of the definition

Observations random_views(std::size_t points, std::size_t views, bool last_unseen) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> theta(-3.14f, 3.14f), gamma(-0.99f, 0.99f), grey(0, 255);
  Observations seen;
  seen.first.push_back(0);
  for (std::size_t p = 0; p < points; ++p) {
    for (std::size_t n = 0; n < views && !(last_unseen && p + 1 == points); ++n) {
      seen.direction.push_back({theta(random), gamma(random)});
      seen.colour.push_back({grey(random), grey(random), 100});
      seen.camera.push_back(static_cast<std::uint16_t>(n));
    }
    seen.first.push_back(seen.direction.size());
  }
  return seen;
}

Matrix design(const Basis& basis, const Observations& seen, std::size_t p) {
  const auto norms = basis_norms(basis);
  Matrix g(static_cast<Eigen::Index>(seen.first[p + 1] - seen.first[p]), basis.num_functions());
  for (Eigen::Index j = 0; j < g.rows(); ++j)
    for (Eigen::Index k = 0; k < g.cols(); ++k) {
      const auto& d = seen.direction[seen.first[p] + static_cast<std::size_t>(j)];
      g(j, k) = basis_value(basis, static_cast<int>(k), static_cast<double>(d[0]),
                            static_cast<double>(d[1])) /
                norms[static_cast<std::size_t>(k)];
    }
  return g;
}

Matrix colours(const Observations& seen, std::size_t p) {
  Matrix c(static_cast<Eigen::Index>(seen.first[p + 1] - seen.first[p]), 3);
  for (Eigen::Index j = 0; j < c.rows(); ++j)
    for (Eigen::Index channel = 0; channel < 3; ++channel)
      c(j, channel) = static_cast<double>(seen.colour[seen.first[p] + static_cast<std::size_t>(j)]
                                                     [static_cast<std::size_t>(channel)]);
  return c;
}

/// Solves a block of side 2, level by level: all points, then those of the block.
Matrix dense_block(const std::vector<Voxel>& positions, const Observations& seen,
                   const FitSettings& s, const std::vector<int>& fineness, const Voxel& block) {
  const Eigen::Index unknowns = s.basis.num_functions() - 1;
  Matrix prior = Matrix::Zero(unknowns, 3);
  for (const bool whole : {true, false}) {
    Matrix a = Matrix::Zero(unknowns, unknowns), r = Matrix::Zero(unknowns, 3);
    double n = 0;
    for (std::size_t p = 0; p < positions.size(); ++p) {
      const Voxel& v = positions[p];
      if (!whole && (v[0] >> 1 != block[0] || v[1] >> 1 != block[1] || v[2] >> 1 != block[2]))
        continue;
      const Matrix g = design(s.basis, seen, p), c = colours(seen, p);
      const Matrix gc = (g.rowwise() - g.colwise().mean()).rightCols(unknowns);
      const Matrix cc = c.rowwise() - c.colwise().mean();
      a += gc.transpose() * gc;
      r += gc.transpose() * cc;
      n += static_cast<double>(g.rows());
    }
    Matrix m = a;
    for (Eigen::Index k = 0; k < unknowns; ++k)
      m(k, k) += s.hierarchy.strength * n * kBlockPenalty *
                 std::pow(s.hierarchy.growth, fineness[static_cast<std::size_t>(k + 1)]);
    prior += m.ldlt().solve(r - a * prior);
  }
  return prior;
}

/// Between the blocks of side 2 that have points: tents as wide as two blocks.
Matrix dense_prior(const std::vector<Voxel>& positions, const Observations& seen,
                   const FitSettings& s, const std::vector<int>& fineness, const Voxel& v) {
  const std::set<Voxel> blocks = [&] {
    std::set<Voxel> occupied;
    for (const Voxel& p : positions) occupied.insert({p[0] >> 1, p[1] >> 1, p[2] >> 1});
    return occupied;
  }();
  Matrix prior = Matrix::Zero(s.basis.num_functions() - 1, 3);
  double sum = 0;
  for (const Voxel& block : blocks) {
    double weight = 1;
    for (std::size_t axis = 0; axis < 3; ++axis)
      weight *= std::max(0.0, 1 - std::abs(v[axis] + 0.5 - (2 * block[axis] + 1)) / 2);
    if (weight > 0) prior += weight * dense_block(positions, seen, s, fineness, block);
    sum += weight;
  }
  return prior / sum;
}

struct Case {
  const char* name;
  Basis basis;
  std::vector<int> fineness;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class HierarchicalFit : public testing::TestWithParam<Case> {};

TEST_P(HierarchicalFit, AgreesWithTheDenseSolvesOfTheDefinition) {
  FitSettings s;
  s.method = FitMethod::kHierarchical;
  s.basis = GetParam().basis;
  s.hierarchy = {1, 0.2, 1.4, 3, 1.6};
  s.environment.degree = 0;
  // Eight blocks of side 2 in a cube of side 4: two levels.
  std::vector<Voxel> positions;
  for (std::int32_t i = 0; i < 64; i += 5) positions.push_back({i & 3, i >> 2 & 3, i >> 4});
  positions = test::sorted_distinct(positions);
  const Observations seen = random_views(positions.size(), 12, false);
  const auto fitted = fit_view_maps(seen, positions, s);
  ASSERT_TRUE(fitted) << fitted.error().message;
  const auto norms = basis_norms(s.basis);
  const auto functions = static_cast<std::size_t>(s.basis.num_functions());
  for (std::size_t p = 0; p < positions.size(); ++p) {
    const Voxel& v = positions[p];
    Matrix prior = Matrix::Zero(static_cast<Eigen::Index>(functions), 3);
    prior.bottomRows(prior.rows() - 1) = dense_prior(positions, seen, s, GetParam().fineness, v);
    const Matrix g = design(s.basis, seen, p), c = colours(seen, p);
    Matrix m = g.transpose() * g;
    for (std::size_t k = 1; k < functions; ++k)
      m(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)) +=
          s.hierarchy.point_penalty * std::pow(s.hierarchy.point_growth, GetParam().fineness[k]);
    const Matrix expected = prior + m.ldlt().solve(g.transpose() * (c - g * prior));
    for (std::size_t k = 0; k < functions; ++k)
      for (std::size_t channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(static_cast<double>((*fitted)[(p * functions + k) * 3 + channel]) * norms[k],
                    expected(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(channel)),
                    0.02)
            << "point " << p << " function " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Bases, HierarchicalFit,
    testing::Values(
        Case{"harmonics", {BasisId::kHarmonics, 2, 0, 0, 2}, {0, 1, 1, 1, 2, 2, 2, 2, 2}},
        Case{"bspline", {BasisId::kBspline, 2, 2, 1}, {0, 1, 2, 2, 1, 2, 3, 3}}),
    [](const auto& test) { return std::string(test.param.name); });

FitSettings harmonics_settings(Directions frame) {
  FitSettings s;
  s.method = FitMethod::kHierarchical;
  s.basis = {BasisId::kHarmonics, 2, 0, 0, 4};
  s.directions = frame;
  s.environment.degree = 0;  // tests/encoder/environment_test.cpp
  return s;
}

TEST(HierarchicalFitProperties, AConstantColourIsKeptAlsoWhereNothingWasSeen) {
  const auto positions = test::sphere_cloud(4);
  Observations seen = random_views(positions.size(), 6, true);
  for (auto& colour : seen.colour) colour = {10, 100, 250};
  const auto fitted = fit_view_maps(seen, positions, harmonics_settings(Directions::kWorld));
  ASSERT_TRUE(fitted) << fitted.error().message;
  for (std::size_t i = 0; i < fitted->size(); ++i) {
    const std::size_t k = i / 3 % 25;
    const double expected = k > 0 ? 0 : i % 3 == 0 ? 10 : i % 3 == 1 ? 100 : 250;
    EXPECT_NEAR(static_cast<double>((*fitted)[i]), expected, 1e-2);
  }
}

TEST(HierarchicalFitProperties, DoesNotDependOnTheNumberOfThreads) {
  const auto positions = test::sphere_cloud(5);
  const Observations seen = random_views(positions.size(), 7, false);
  FitSettings s = harmonics_settings(Directions::kWorld);
  s.threads = 1;
  const auto one = fit_view_maps(seen, positions, s);
  s.threads = 5;
  EXPECT_EQ(*one, *fit_view_maps(seen, positions, s));
}

/// Blocks do not show: on a plane whose reflections change along it, a point that is pulled to its
/// prior differs from its neighbour across the border of two blocks no more than from others.
TEST(HierarchicalFitProperties, ABlockEndsWithoutAStep) {
  std::vector<Voxel> positions;
  for (std::int32_t y = 0; y < 8; ++y)
    for (std::int32_t x = 0; x < 64; ++x) positions.push_back({x, y, 0});
  positions = test::sorted_distinct(positions);
  Observations seen = random_views(1, 40, false);
  const std::vector<std::array<float, 2>> directions = seen.direction;
  seen = {};
  seen.first.push_back(0);
  for (const Voxel& v : positions) {
    for (std::size_t n = 0; n < directions.size(); ++n) {
      const auto grey = 100 + static_cast<float>(v[0]) * directions[n][1];
      seen.direction.push_back(directions[n]);
      seen.colour.push_back({grey, grey, grey});
      seen.camera.push_back(static_cast<std::uint16_t>(n));
    }
    seen.first.push_back(seen.direction.size());
  }
  FitSettings s = harmonics_settings(Directions::kWorld);
  s.hierarchy.point_penalty = 1e6;
  const auto fitted = *fit_view_maps(seen, positions, s);
  std::vector<double> row(64);  // of the harmonic that is gamma
  for (std::size_t p = 0; p < positions.size(); ++p)
    if (positions[p][1] == 3)
      row[static_cast<std::size_t>(positions[p][0])] =
          static_cast<double>(fitted[(p * 25 + 2) * 3]);
  double inside = 0, across = 0;
  for (std::size_t x = 8; x + 8 < 64; ++x) {
    double& most = (x + 1) % 8 == 0 ? across : inside;
    most = std::max(most, std::abs(row[x + 1] - row[x]));
  }
  EXPECT_GT(inside, 0.1);
  EXPECT_LE(across, 1.001 * inside);
}

/// A highlight that is one function of the reflected direction is found where no camera looked.
TEST(HierarchicalFitProperties, WhatASurfaceReflectsIsSharedAlongIt) {
  const auto positions = test::sphere_cloud(5);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto normals = mirror_normals(Directions::kReflected, positions, 0, 1);
  const auto shade = [](const std::array<float, 2>& reflected) {
    const Vec3 r = vector_of(reflected);
    return static_cast<float>(100 + 80 * std::max(0.0, 0.6 * r[0] + 0.8 * r[2]));
  };
  Observations seen;
  seen.first.push_back(0);
  std::vector<std::array<float, 2>> held_out;
  for (std::size_t p = 0; p < positions.size(); ++p) {
    for (int n = 0; n < 4; ++n) {
      const auto direction = direction_of({unit(random), unit(random), unit(random)});
      const float grey = shade(to_local(normals, p, direction));
      if (n == 3) {
        held_out.push_back(direction);
        continue;
      }
      seen.direction.push_back(direction);
      seen.colour.push_back({grey, grey, grey});
      seen.camera.push_back(static_cast<std::uint16_t>(n));
    }
    seen.first.push_back(seen.direction.size());
  }
  const auto error = [&](Directions frame) {
    const FitSettings s = harmonics_settings(frame);
    const auto fitted = *fit_view_maps(in_local(seen, frame, positions, 0, 1), positions, s);
    double sum = 0;
    for (std::size_t p = 0; p < positions.size(); ++p) {
      const auto at =
          frame == Directions::kReflected ? to_local(normals, p, held_out[p]) : held_out[p];
      double value = 0;
      for (int k = 0; k < 25; ++k)
        value += static_cast<double>(fitted[(p * 25 + static_cast<std::size_t>(k)) * 3]) *
                 basis_value(s.basis, k, static_cast<double>(at[0]), static_cast<double>(at[1]));
      const double e = value - static_cast<double>(shade(to_local(normals, p, held_out[p])));
      sum += e * e;
    }
    return std::sqrt(sum / static_cast<double>(positions.size()));
  };
  const double reflected = error(Directions::kReflected), global = error(Directions::kWorld);
  EXPECT_LT(reflected, 4);
  EXPECT_LT(2 * reflected, global);
}

TEST(HierarchicalFitProperties, SettingsOutOfRangeAreRefused) {
  const auto positions = test::sphere_cloud(3);
  const Observations seen = random_views(positions.size(), 3, false);
  const auto refused = [&](auto edit) {
    FitSettings s = harmonics_settings(Directions::kWorld);
    edit(s);
    return !fit_view_maps(seen, positions, s);
  };
  EXPECT_TRUE(refused([](FitSettings& s) { s.basis.degree = 11; }));
  EXPECT_TRUE(refused([](FitSettings& s) { s.hierarchy.block_log2 = -1; }));
  EXPECT_TRUE(refused([](FitSettings& s) { s.hierarchy.strength = 0; }));
  EXPECT_TRUE(refused([](FitSettings& s) { s.hierarchy.growth = 0.5; }));
  EXPECT_TRUE(refused([](FitSettings& s) { s.hierarchy.point_penalty = std::nan(""); }));
  EXPECT_TRUE(refused([](FitSettings& s) { s.environment.degree = 17; }));
  EXPECT_TRUE(refused([](FitSettings& s) { s.environment.radius = 1; }));
  EXPECT_TRUE(refused([](FitSettings& s) { s.environment.strength = 0; }));
  EXPECT_TRUE(refused([](FitSettings& s) { s.method = FitMethod::kPaper; }));
}

}  // namespace
}  // namespace slf::fit_hierarchical_test
