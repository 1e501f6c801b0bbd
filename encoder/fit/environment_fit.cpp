// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/environment_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "base/signed_index.h"
#include "encoder/fit/lane_products.h"
#include "lightfield/directions.h"
#include "lightfield/harmonics.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr double kLightPenalty = 0.8, kGrowth = 1.3;  // as the blocks of the hierarchical fit have
constexpr std::size_t kMostTriedViews = 30000;
/// Half the object's longest side is 1; the last is as good as infinite.
constexpr std::array<double, 9> kRadii = {2, 2.5, 3.2, 4, 5, 6.5, 9, 16, 1000};
constexpr double kLeastLightGain = 0.02;
constexpr int kTriedDegree = 10;  // tells radii apart as well as 16, at a fifth of the time

std::size_t functions(int degree) { return static_cast<std::size_t>((degree + 1) * (degree + 1)); }

/// Views as rows of numbers: the functions at the place where each ends, then the three channels of
/// its colour, and zeros up to whole lanes.
struct ViewRows {
  explicit ViewRows(int degree) : size(functions(degree)), width(padded(size + 3)) {}

  std::size_t count() const { return values.size() / width; }

  std::size_t size, width;
  std::vector<float> values;  // [count][width]
};

/// One more row for each view of point p.
void append_views(const ReflectedViews& views, std::size_t p, double radius,
                  const Harmonics& harmonics, ViewRows& rows) {
  const std::size_t first = views.first[p], count = views.first[p + 1] - first;
  const std::size_t stride = padded(count), at = rows.values.size();
  std::vector<Vec3> places;
  for (std::size_t j = first; j < first + count; ++j)
    places.push_back(place_on_sphere(views.position[p], views.reflected[j], radius));
  std::vector<float> columns(rows.size * stride);
  harmonics.evaluate_columns(places, columns.data(), stride);
  rows.values.resize(at + count * rows.width, 0.0f);
  for (std::size_t k = 0; k < rows.size; ++k)
    for (std::size_t m = 0; m < count; ++m)
      rows.values[at + m * rows.width + k] = columns[k * stride + m];
  for (std::size_t m = 0; m < count; ++m)
    std::copy_n(views.colour[first + m].begin(), 3, &rows.values[at + m * rows.width + rows.size]);
}

/// Normal equations of functions and colours less their means over a point.
struct Normal {
  explicit Normal(const ViewRows& rows)
      : size(rows.size), width(rows.width), products(width * width, 0.0f) {}

  void add(std::size_t count, const float* rows) {
    add_square(count, rows, width, products.data());
    views += count;
  }

  Normal& operator+=(const Normal& other) {
    for (std::size_t i = 0; i < products.size(); ++i) products[i] += other.products[i];
    views += other.views;
    return *this;
  }

  /// [K][3]; the constant, which is less its mean, has none.
  Eigen::MatrixXf solve(const EnvironmentSettings& settings) const {
    const Eigen::Index n = index(size) - 1;
    const auto product = [&](Eigen::Index i, Eigen::Index j) {
      return double{products[static_cast<std::size_t>(i) * width + static_cast<std::size_t>(j)]};
    };
    Eigen::MatrixXd m(n, n), right(n, 3);
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index i = j; i < n; ++i) m(i, j) = product(i + 1, j + 1);
      for (Eigen::Index c = 0; c < 3; ++c) right(j, c) = product(n + 1 + c, j + 1);
      m(j, j) += settings.strength * static_cast<double>(views) * kLightPenalty *
                 std::pow(kGrowth, std::floor(std::sqrt(static_cast<double>(j + 1))));
    }
    Eigen::MatrixXf light = Eigen::MatrixXf::Zero(n + 1, 3);
    light.bottomRows(n) = Eigen::LLT<Eigen::MatrixXd, Eigen::Lower>(m).solve(right).cast<float>();
    return light;
  }

  std::size_t size, width, views = 0;
  std::vector<float> products;  // [width][width], lower triangle
};

/// What one fold of cameras saw, rows less the means of their points.
struct FoldRows {
  explicit FoldRows(int degree) : own(degree), shifts(degree), tested(degree) {}

  ViewRows own;
  /// By how much the means of points without the fold are others, times the root of the number of
  /// views they are of: the products of rows less those are products of rows less these.
  ViewRows shifts;
  ViewRows tested;  ///< own, less the mean without the fold, where there is one
};

/// @param of_point  the views of one point, less their mean
/// @param fold  [views]
void divide(const ViewRows& of_point, std::span<const int> fold, std::vector<FoldRows>& folds) {
  const std::size_t width = of_point.width;
  std::vector<float> sum(width);
  for (std::size_t f = 0; f < folds.size(); ++f) {
    const std::size_t held_out =
        static_cast<std::size_t>(std::count(fold.begin(), fold.end(), static_cast<int>(f)));
    if (held_out == 0) continue;
    const auto kept = static_cast<float>(fold.size() - held_out);
    std::fill(sum.begin(), sum.end(), 0.0f);
    const auto each_row = [&](const auto& body) {
      for (std::size_t m = 0; m < fold.size(); ++m)
        if (fold[m] == static_cast<int>(f)) body(&of_point.values[m * width]);
    };
    each_row([&](const float* row) {
      folds[f].own.values.insert(folds[f].own.values.end(), row, row + width);
      for (std::size_t i = 0; i < width; ++i) sum[i] += row[i];
    });
    if (kept == 0) continue;
    for (const float x : sum) folds[f].shifts.values.push_back(x / std::sqrt(kept));
    each_row([&](const float* row) {
      for (std::size_t i = 0; i < width; ++i)
        folds[f].tested.values.push_back(row[i] + sum[i] / kept);
    });
  }
}

/// Squared colours of rows, without and with light.
std::array<double, 2> squared_errors(const ViewRows& rows, const Eigen::MatrixXf& light) {
  std::array<double, 2> error{0, 0};
  for (std::size_t m = 0; m < rows.count(); ++m) {
    const float* row = &rows.values[m * rows.width];
    const Eigen::Map<const Eigen::RowVectorXf> values(row, index(rows.size));
    const Eigen::Map<const Eigen::RowVector3f> colour(row + rows.size);
    error[0] += static_cast<double>(colour.squaredNorm());
    error[1] += static_cast<double>((colour - values * light).squaredNorm());
  }
  return error;
}

/// Squared error on the views of each fold, of light fitted to the others. [0] without any light.
std::array<double, 2> held_out_error(const ReflectedViews& views, const CameraFolds& folds,
                                     double radius, const EnvironmentSettings& settings) {
  const Harmonics harmonics(settings.degree);
  std::vector<FoldRows> rows(static_cast<std::size_t>(folds.count), FoldRows(settings.degree));
  ViewRows of_point(settings.degree);
  std::vector<float> mean(of_point.width);
  std::vector<int> fold;
  for (std::size_t p = 0; p < views.position.size(); ++p) {
    of_point.values.clear();
    append_views(views, p, radius, harmonics, of_point);
    centre_rows(of_point.count(), of_point.values.data(), of_point.width, mean.data());
    fold.clear();
    for (std::size_t j = views.first[p]; j < views.first[p + 1]; ++j)
      fold.push_back(folds.of_camera[views.camera[j]]);
    divide(of_point, fold, rows);
  }
  Normal all(of_point);
  std::vector<Normal> without(rows.size(), all);  // first what is taken away
  for (std::size_t f = 0; f < rows.size(); ++f) {
    without[f].add(rows[f].own.count(), rows[f].own.values.data());
    all += without[f];
    add_square(rows[f].shifts.count(), rows[f].shifts.values.data(), of_point.width,
               without[f].products.data());
  }
  std::array<double, 2> error{0, 0};
  for (std::size_t f = 0; f < rows.size(); ++f) {
    if (rows[f].tested.values.empty()) continue;
    without[f].views = all.views - without[f].views;
    for (std::size_t i = 0; i < all.products.size(); ++i)
      without[f].products[i] = all.products[i] - without[f].products[i];
    const auto of_fold = squared_errors(rows[f].tested, without[f].solve(settings));
    for (std::size_t i = 0; i < 2; ++i) error[i] += of_fold[i];
  }
  return error;
}

}  // namespace

MirrorPoints mirror_points(std::span<const Voxel> positions, int cell_log2, int threads,
                           const KnownLight& known) {
  MirrorPoints points;
  const ObjectBox box = known.half > 0 ? ObjectBox(known.centre, known.half) : ObjectBox(positions);
  for (const Voxel& v : positions) points.position.push_back(box(v));
  points.normal = mirror_normals(Directions::kReflected, positions, cell_log2, threads);
  return points;
}

ReflectedViews reflected_views(const PointwiseObservations& observations,
                               const MirrorPoints& points, Directions directions,
                               std::size_t most) {
  const std::size_t every = std::max<std::size_t>(1, (observations.count() + most - 1) / most);
  ReflectedViews views;
  views.first.push_back(0);
  SeenRoom room;
  for (std::size_t p = 0; p < points.position.size(); p += every) {
    const SeenPoint seen = observations.of(p, room);
    if (seen.count() == 0) continue;
    for (const auto& d : seen.direction)
      views.reflected.push_back(
          vector_of(directions == Directions::kReflected ? d : to_local(points.normal, p, d)));
    views.colour.insert(views.colour.end(), seen.colour.begin(), seen.colour.end());
    views.camera.insert(views.camera.end(), seen.camera.begin(), seen.camera.end());
    views.position.push_back(points.position[p]);
    views.first.push_back(views.colour.size());
  }
  return views;
}

std::vector<float> solve_environment(const ReflectedViews& views, double radius,
                                     const EnvironmentSettings& settings, int threads) {
  constexpr std::size_t kParts = 8;  // whatever the number of threads: the sum is the same
  const std::size_t points = views.position.size();
  const Harmonics harmonics(settings.degree);
  ViewRows rows(settings.degree);
  std::vector<Normal> parts(kParts, Normal(rows));
  parallel_ranges(kParts, 1, threads, [&](std::size_t begin, std::size_t) {
    constexpr std::size_t kRows = 256;  // at a time
    ViewRows some(settings.degree);
    std::vector<float> mean(some.width);
    const std::size_t last = (begin + 1) * points / kParts;
    for (std::size_t p = begin * points / kParts; p < last; ++p) {
      const std::size_t at = some.count();
      append_views(views, p, radius, harmonics, some);
      centre_rows(some.count() - at, &some.values[at * some.width], some.width, mean.data());
      if (some.count() < kRows && p + 1 < last) continue;
      parts[begin].add(some.count(), some.values.data());
      some.values.clear();
    }
  });
  for (std::size_t i = 1; i < kParts; ++i) parts[0] += parts[i];
  const Eigen::MatrixXf solution = parts[0].solve(settings);
  std::vector<float> light(3 * rows.size);
  for (std::size_t i = 0; i < rows.size; ++i)
    for (std::size_t c = 0; c < 3; ++c) light[3 * i + c] = solution(index(i), index(c));
  return light;
}

EnvironmentSettings with_radius(const PointwiseObservations& observations,
                                const MirrorPoints& points, const FitSettings& settings,
                                const CameraFolds& folds) {
  EnvironmentSettings chosen = settings.environment;
  if (chosen.degree == 0 || chosen.radius != 0) return chosen;
  const auto none = [&] {
    chosen.degree = 0;
    return chosen;
  };
  if (folds.count < 3) return none();
  const auto views = reflected_views(observations, points, settings.directions, kMostTriedViews);
  if (views.colour.empty()) return none();
  EnvironmentSettings tried = settings.environment;
  tried.degree = std::min(tried.degree, kTriedDegree);
  std::array<std::array<double, 2>, kRadii.size()> error{};
  parallel_ranges(kRadii.size(), 1, settings.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      error[i] = held_out_error(views, folds, kRadii[i], tried);
  });
  const auto best = std::min_element(error.begin(), error.end(),
                                     [](const auto& a, const auto& b) { return a[1] < b[1]; });
  if (!((*best)[1] < (1 - kLeastLightGain) * (*best)[0])) return none();
  chosen.radius = kRadii[static_cast<std::size_t>(best - error.begin())];
  return chosen;
}

std::optional<Environment> fit_environment(const PointwiseObservations& observations,
                                           const MirrorPoints& points, const FitSettings& settings,
                                           std::size_t most_views) {
  const EnvironmentSettings& given = settings.environment;
  if (given.known.half > 0)
    return Environment(given.radius, given.degree, given.known.light, settings.threads);
  EnvironmentSettings e = given;
  if (e.degree > 0 && e.radius == 0)
    e = with_radius(observations, points, settings,
                    camera_folds(observations, points.normals(settings.directions)));
  if (e.degree == 0) return std::nullopt;
  const auto views = reflected_views(observations, points, settings.directions, most_views);
  if (views.colour.empty()) return std::nullopt;
  return Environment(e.radius, e.degree, solve_environment(views, e.radius, e, settings.threads),
                     settings.threads);
}

KnownLight known_light(const PointwiseObservations& observations, std::span<const Voxel> positions,
                       const FitSettings& settings) {
  const EnvironmentSettings& e = settings.environment;
  if (e.degree == 0 || observations.count() == 0) return {};
  const MirrorPoints points = mirror_points(positions, settings.normal_cell_log2, settings.threads);
  const auto views = reflected_views(observations, points, settings.directions, kMostLightViews);
  if (views.colour.empty()) return {};
  const ObjectBox box(positions);
  return {box.centre(), box.half(), solve_environment(views, e.radius, e, settings.threads)};
}

}  // namespace slf
