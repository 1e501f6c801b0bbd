// SPDX-License-Identifier: Apache-2.0
// The fit against naive dense solves written from the paper's equations.
#include "slf/fit.h"

#define EIGEN_MPL2_ONLY
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "encoder/fit/fit_neighbours.h"
#include "random_sightings.h"
#include "slf/view_map.h"

namespace slf::fit_test {
namespace {

using Matrix = Eigen::MatrixXd;

Matrix design(const Basis& basis, const Observations& seen, std::size_t p) {
  const auto rows = static_cast<Eigen::Index>(seen.first[p + 1] - seen.first[p]);
  Matrix g(rows, basis.num_functions());
  for (Eigen::Index j = 0; j < rows; ++j)
    for (Eigen::Index k = 0; k < g.cols(); ++k) {
      const auto& direction = seen.direction[seen.first[p] + static_cast<std::size_t>(j)];
      g(j, k) = basis_value(basis, static_cast<int>(k), static_cast<double>(direction[0]),
                            static_cast<double>(direction[1]));
    }
  return g;
}

Matrix colours(const Observations& seen, std::size_t p) {
  const auto rows = static_cast<Eigen::Index>(seen.first[p + 1] - seen.first[p]);
  Matrix c(rows, 3);
  for (Eigen::Index j = 0; j < rows; ++j)
    for (Eigen::Index channel = 0; channel < 3; ++channel)
      c(j, channel) = static_cast<double>(seen.colour[seen.first[p] + static_cast<std::size_t>(j)]
                                                     [static_cast<std::size_t>(channel)]);
  return c;
}

/// (G^T G + lambda I + beta I)^-1 (G^T c + beta mean), the paper's Eq. 3; Eq. 2 with beta = 0.
/// Where function 0 is not penalised its diagonal elements are zero.
Matrix dense_solve(const Matrix& g, const Matrix& c, double lambda, double beta, bool penalise_dc,
                   const Matrix& mean) {
  Matrix ridge = (lambda + beta) * Matrix::Identity(g.cols(), g.cols());
  Matrix pull = beta * mean;
  if (!penalise_dc) {
    ridge(0, 0) = 0;
    pull.row(0).setZero();
  }
  return (g.transpose() * g + ridge).fullPivLu().solve(g.transpose() * c + pull);
}

/// The k nearest of points on the x axis, ties by index.
std::vector<std::size_t> nearest(const std::vector<Voxel>& positions, std::size_t p,
                                 std::size_t k) {
  std::vector<std::pair<int, std::size_t>> order;
  for (std::size_t q = 0; q < positions.size(); ++q)
    if (q != p) order.push_back({std::abs(positions[q][0] - positions[p][0]), q});
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < std::min(k, order.size()); ++i) found.push_back(order[i].second);
  return found;
}

std::vector<Matrix> reference_fit(const RandomSightings& scene, const FitSettings& settings) {
  const std::size_t points = scene.positions.size();
  const auto k = static_cast<std::size_t>(settings.neighbours);
  const Matrix zero = Matrix::Zero(settings.basis.num_functions(), 3);
  std::vector<Matrix> designs;
  for (std::size_t p = 0; p < points; ++p) designs.push_back(design(settings.basis, scene.seen, p));
  std::vector<Matrix> now(points, zero);
  const auto observed = [&](std::size_t p) {
    return scene.seen.first[p] != scene.seen.first[p + 1];
  };
  const auto solve_all = [&](double beta, const std::vector<Matrix>& before) {
    std::vector<Matrix> after(points, zero);
    for (std::size_t p = 0; p < points; ++p) {
      if (!observed(p)) continue;
      Matrix mean = zero;
      const auto around = nearest(scene.positions, p, k);
      if (beta > 0)
        for (const std::size_t q : around) mean += before[q] / static_cast<double>(around.size());
      after[p] = dense_solve(designs[p], colours(scene.seen, p), settings.lambda, beta,
                             settings.penalise_dc, mean);
    }
    for (std::size_t p = 0; p < points; ++p) {
      if (observed(p)) continue;
      std::vector<std::size_t> donors;
      for (const std::size_t q : nearest(scene.positions, p, k))
        if (observed(q)) donors.push_back(q);
      for (const std::size_t q : nearest(scene.positions, p, points))
        if (donors.empty() && observed(q)) donors.push_back(q);
      for (const std::size_t q : donors) after[p] += after[q] / static_cast<double>(donors.size());
    }
    return after;
  };
  now = solve_all(0, now);
  for (int t = 0; t < settings.iterations; ++t) now = solve_all(settings.beta, now);
  return now;
}

/// Basis functions (columns) along 100 directions all over the sphere.
Matrix many_directions(const Basis& basis) {
  Matrix g(100, basis.num_functions());
  for (Eigen::Index j = 0; j < g.rows(); ++j)
    for (Eigen::Index k = 0; k < g.cols(); ++k)
      g(j, k) = basis_value(basis, static_cast<int>(k), 2.4 * static_cast<double>(j),
                            -0.99 + 0.02 * static_cast<double>(j));
  return g;
}

/// Largest difference of the fitted colours along these directions, grey levels.
double largest_difference(const Matrix& directions, const Matrix& a, std::span<const float> b) {
  Matrix difference = a;
  for (Eigen::Index k = 0; k < a.rows(); ++k)
    for (Eigen::Index c = 0; c < 3; ++c)
      difference(k, c) -= static_cast<double>(b[static_cast<std::size_t>(3 * k + c)]);
  return (directions * difference).cwiseAbs().maxCoeff();
}

struct Case {
  const char* name;
  Basis basis;
  double lambda, beta;
  int iterations;
  bool penalise_dc;
  std::vector<int> counts;  // observations of each point
  double tolerance = 1e-3;  // grey levels: what 8-bit colour and steps >= 0.05 cannot see
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

class FitTest : public testing::TestWithParam<Case> {};

TEST_P(FitTest, AgreesWithTheDenseSolveOfTheEquations) {
  const Case& test = GetParam();
  const RandomSightings scene = random_sightings(test.counts);
  FitSettings settings = paper_fit(test.basis, 2);
  settings.lambda = test.lambda;
  settings.beta = test.beta;
  settings.iterations = test.iterations;
  settings.neighbours = 3;
  settings.penalise_dc = test.penalise_dc;
  const auto fitted = fit_view_maps(scene.seen, scene.positions, settings);
  ASSERT_TRUE(fitted) << fitted.error().message;
  const auto expected = reference_fit(scene, settings);
  const std::size_t size = 3 * static_cast<std::size_t>(test.basis.num_functions());
  const Matrix directions = many_directions(test.basis);
  ASSERT_EQ(fitted->size(), size * scene.positions.size());
  for (std::size_t p = 0; p < expected.size(); ++p)
    EXPECT_LT(
        largest_difference(directions, expected[p], std::span(*fitted).subspan(p * size, size)),
        test.tolerance)
        << "point " << p << " with " << test.counts[p] << " observations";
}

const Basis kPaper{};                            // o = 2, 128 functions
const Basis kSmall{BasisId::kBspline, 2, 2, 1};  // 8 functions
const std::vector<int> kFew{47, 1, 60, 2, 127}, kMany{128, 300, 200}, kMixed{20, 5, 8, 7, 1, 60};
const std::vector<int> kGaps{20, 0, 9, 0, 0, 0, 0, 0, 0, 30};

INSTANTIATE_TEST_SUITE_P(
    Eq2And3, FitTest,
    testing::Values(
        Case{"paper_dual_initialisation", kPaper, 0.8, 1.3, 0, true, kFew},
        Case{"paper_dual_sweeps", kPaper, 0.8, 1.3, 3, true, kFew},
        Case{"paper_primal_initialisation", kPaper, 0.8, 1.3, 0, true, kMany},
        Case{"paper_primal_sweeps", kPaper, 0.8, 1.3, 3, true, kMany},
        Case{"dc_free_dual_initialisation", kPaper, 0.8, 1.3, 0, false, kFew},
        Case{"dc_free_dual_sweeps", kPaper, 0.8, 1.3, 3, false, kFew},
        Case{"dc_free_primal_sweeps", kPaper, 0.8, 1.3, 3, false, kMany},
        Case{"dual_and_primal_points", kSmall, 0.8, 1.3, 3, true, kMixed},
        Case{"dc_free_dual_and_primal_points", kSmall, 0.8, 1.3, 3, false, kMixed},
        Case{"points_without_observations", kSmall, 0.8, 1.3, 2, true, kGaps},
        Case{"dc_free_without_observations", kSmall, 0.8, 1.3, 2, false, kGaps},
        Case{"order_1", {BasisId::kBspline, 1, 4, 3}, 0.8, 1.3, 2, false, kFew},
        Case{"order_3", {BasisId::kBspline, 3, 4, 3}, 0.8, 1.3, 2, false, kFew},
        Case{"order_4", {BasisId::kBspline, 4, 3, 3}, 0.8, 1.3, 2, true, kFew},
        Case{"one_function", {BasisId::kBspline, 2, 0, 0}, 0.8, 1.3, 2, true, kMixed},
        Case{"dc_free_one_function", {BasisId::kBspline, 2, 0, 0}, 0.8, 1.3, 2, false, kMixed},
        Case{"no_beta", kPaper, 0.8, 0, 3, true, kFew},
        Case{"float_at_its_smallest_penalty", kPaper, 0.5, 0, 0, true, kFew},
        Case{"dc_free_float_at_its_smallest_penalty", kPaper, 0.5, 0, 0, false, kFew},
        Case{"primal_at_its_smallest_penalty", kPaper, 0.5, 0, 0, false, kMany},
        Case{"small_penalty_in_double", kPaper, 1e-4, 1e-3, 2, true, kFew},
        Case{"dc_free_small_penalty_in_double", kPaper, 1e-4, 1e-3, 2, false, kFew}),
    [](const auto& test_case) { return test_case.param.name; });

class LeastNormTest : public testing::TestWithParam<bool> {};  // penalise_dc

TEST_P(LeastNormTest, LambdaZeroInterpolatesWithTheSmallestCoefficients) {
  const RandomSightings scene = random_sightings({10});
  FitSettings settings;
  settings.lambda = settings.beta = 0;
  settings.penalise_dc = GetParam();
  const auto fitted = fit_view_maps(scene.seen, scene.positions, settings);
  ASSERT_TRUE(fitted);
  // The limit of the ridge as lambda goes to zero; at 1e-9 it is that within 1e-4.
  const Matrix expected = dense_solve(design(settings.basis, scene.seen, 0), colours(scene.seen, 0),
                                      1e-9, 0, settings.penalise_dc, Matrix::Zero(128, 3));
  EXPECT_LT(largest_difference(many_directions(settings.basis), expected, *fitted), 1e-2);
}

TEST_P(LeastNormTest, LambdaZeroWithManyObservationsIsLeastSquares) {
  const RandomSightings scene = random_sightings({60});
  FitSettings settings = paper_fit(kSmall, 1);
  settings.lambda = settings.beta = 0;
  settings.penalise_dc = GetParam();
  const auto fitted = fit_view_maps(scene.seen, scene.positions, settings);
  ASSERT_TRUE(fitted);
  const Matrix expected =
      design(kSmall, scene.seen, 0).colPivHouseholderQr().solve(colours(scene.seen, 0));
  EXPECT_LT(largest_difference(many_directions(kSmall), expected, *fitted), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(PenaliseDc, LeastNormTest, testing::Bool());

}  // namespace
}  // namespace slf::fit_test
