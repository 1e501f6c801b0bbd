// SPDX-License-Identifier: Apache-2.0
// Points to splats: discs from normals and spacing, harmonics from colours along directions.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lightfield/float_origin.h"
#include "lightfield/harmonics.h"
#include "lightfield/render/surfel_cloud.h"
#include "lightfield/splats/splat_axes.h"
#include "lightfield/splats/splat_directions.h"
#include "lightfield/splats/visible_sides.h"
#include "slf/parallel.h"
#include "slf/splats.h"

namespace slf {
namespace {

constexpr std::size_t kDirections =
    256;  // half of them above a surface: 8 for each of 16 harmonics
constexpr std::size_t kPointsPerRange = 256;
constexpr std::size_t kMost = 16;  // harmonics
/// Curvature against squared error of the mean: what no direction shows stays flat, and
/// coefficients small, since formats clamp them.
constexpr double kSmoothness = 3e-5;

/// Weighted least squares for the harmonics of one point after the other.
class HarmonicsFit {
 public:
  HarmonicsFit(std::span<const Vec3> directions, const AxisRows& axes, int degree)
      : directions_(directions),
        count_(std::size_t(degree + 1) * std::size_t(degree + 1)),
        rows_(directions.size()) {
    const Harmonics harmonics(degree);
    for (std::size_t j = 0; j < directions.size(); ++j) {
      const Vec3 v = turned(axes, directions[j]);  // splats have the opposite: from the eye
      harmonics.evaluate(Vec3{-v[0], -v[1], -v[2]}, rows_[j].data());
    }
  }

  /// @param colours  [directions] 0 .. 255
  /// @param out      [count][3] receives coefficients of orthonormal harmonics
  void fit(const std::array<float, 3>& normal, float front, const std::array<float, 3>* colours,
           float* out) const {
    std::array<std::array<double, kMost>, kMost> matrix{};
    std::array<std::array<double, 3>, kMost> right{};
    double total = 0;
    for (std::size_t j = 0; j < rows_.size(); ++j) {
      const double weight = double{weight_of(normal, front, directions_[j])};
      if (weight == 0) continue;
      total += weight;
      add(rows_[j], weight, colours[j], matrix, right);
    }
    for (std::size_t l = 0, k = 0; k < count_; ++l)
      for (; k < std::min(count_, (l + 1) * (l + 1)); ++k)
        matrix[k][k] += kSmoothness * total * double(l * (l + 1) * l * (l + 1));
    solve(matrix, right);
    const double orthonormal = std::sqrt(4 * std::numbers::pi);
    for (std::size_t k = 0; k < count_; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        out[3 * k + c] = static_cast<float>(right[k][c] * orthonormal);
  }

 private:
  void add(const std::array<double, kMost>& row, double weight, const std::array<float, 3>& colour,
           std::array<std::array<double, kMost>, kMost>& matrix,
           std::array<std::array<double, 3>, kMost>& right) const {
    for (std::size_t a = 0; a < count_; ++a) {
      const double scaled = weight * row[a];
      for (std::size_t b = 0; b <= a; ++b) matrix[a][b] += scaled * row[b];
      for (std::size_t c = 0; c < 3; ++c) right[a][c] += scaled * (double{colour[c]} / 255 - 0.5);
    }
  }

  /// By Cholesky, in place; the lower half of the matrix counts. Function 0 has a weight, the
  /// others the smoothness: it is positive definite.
  void solve(std::array<std::array<double, kMost>, kMost>& m,
             std::array<std::array<double, 3>, kMost>& x) const {
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = m[i][j];
        for (std::size_t k = 0; k < j; ++k) sum -= m[i][k] * m[j][k];
        m[i][j] = i == j ? std::sqrt(std::max(sum, 1e-12)) : sum / m[j][j];
      }
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t k = 0; k < i; ++k) x[i][c] -= m[i][k] * x[k][c];
        x[i][c] /= m[i][i];
      }
    }
    for (std::size_t i = count_; i-- > 0;)
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t k = i + 1; k < count_; ++k) x[i][c] -= m[k][i] * x[k][c];
        x[i][c] /= m[i][i];
      }
  }

  std::span<const Vec3> directions_;
  std::size_t count_;
  std::vector<std::array<double, kMost>> rows_;
};

std::array<float, 3> floats(const Vec3& v) { return {float(v[0]), float(v[1]), float(v[2])}; }

/// All but the harmonics; normals in world axes.
SplatCloud discs(const ViewMaps& maps, const SplatSettings& settings) {
  const Grid& grid = maps.header().grid;
  SurfelCloud surfels = surfel_cloud(grid, maps.positions(), maps.normals(), 0, settings.threads);
  SplatCloud splats;
  splats.axes = axis_rows(maps.header(), settings.axes);
  splats.step = grid.step;
  splats.degree = settings.degree;
  splats.origin = float_origin(grid);
  for (std::size_t p = 0; p < surfels.size(); ++p) {
    Vec3 from = surfels.centres[p];
    for (std::size_t k = 0; k < 3; ++k) from[k] -= splats.origin[k];
    splats.positions.push_back(floats(turned(splats.axes, from)));
    splats.deviations.push_back(static_cast<float>(settings.size) * std::sqrt(surfels.areas[p]));
  }
  splats.normals = std::move(surfels.normals);
  splats.front = turn_to_visible_side(maps, splats.normals, settings.threads);
  return splats;
}

void fit_harmonics(const ViewMaps& maps, int threads, SplatCloud& splats) {
  const std::vector<Vec3> directions = even_directions(kDirections, 0);
  const DirectionSampler sampler(maps, directions);
  const HarmonicsFit fit(directions, splats.axes, splats.degree);
  const std::size_t row = 3 * splats.num_harmonics();
  splats.harmonics.resize(splats.size() * row);
  parallel_ranges(splats.size(), kPointsPerRange, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<std::array<float, 3>> colours;
    sampler.sample(begin, end, colours);
    for (std::size_t p = begin; p < end; ++p)
      fit.fit(splats.normals[p], splats.front[p], &colours[(p - begin) * directions.size()],
              &splats.harmonics[p * row]);
  });
}

}  // namespace

Result<SplatCloud, InputError> make_splats(const ViewMaps& maps, const SplatSettings& settings) {
  if (settings.degree < 0 || settings.degree > 3)
    return InputError{Errc::kInvalidArgument, "the degree of splats is not 0 to 3"};
  if (!(settings.size >= 0.1 && settings.size <= 4))
    return InputError{Errc::kInvalidArgument, "the size of splats is not 0.1 to 4"};
  if (maps.num_points() == 0) return InputError{Errc::kInvalidInput, "has no points"};
  if (!maps.header().grid.fits_floats())
    return InputError{Errc::kInvalidInput, "its grid lies beyond what floats of splats hold"};
  SplatCloud splats = discs(maps, settings);
  fit_harmonics(maps, settings.threads, splats);
  for (auto& n : splats.normals)
    n = floats(turned(splats.axes, {double{n[0]}, double{n[1]}, double{n[2]}}));
  return splats;
}

std::array<float, 3> radiance_of(const SplatCloud& splats, std::size_t p, const Vec3& viewing) {
  std::array<double, kMost> row;
  Harmonics(splats.degree).evaluate(viewing, row.data());
  const float* coefficient = &splats.harmonics[p * 3 * splats.num_harmonics()];
  std::array<float, 3> rgb;
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0;
    for (std::size_t k = 0; k < splats.num_harmonics(); ++k)
      sum += row[k] * double{coefficient[3 * k + c]};
    sum = 0.5 + sum / std::sqrt(4 * std::numbers::pi);
    rgb[c] = static_cast<float>(255 * std::clamp(sum, 0.0, 1.0));
  }
  return rgb;
}

}  // namespace slf
