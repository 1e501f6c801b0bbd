#include "fit/environment_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "base/signed_index.h"
#include "fit/camera_folds.h"
#include "lightfield/frame.h"
#include "lightfield/harmonics.h"
#include "slf/parallel.h"

namespace slf {
namespace {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using NoNormals = std::span<const std::array<float, 3>>;
using Columns = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

constexpr double kLightPenalty = 0.8, kGrowth = 1.3;  // as the blocks of the hierarchical fit have
constexpr std::size_t kMostTriedViews = 30000;
/// Half the object's longest side is 1; the last is as good as infinite.
constexpr std::array<double, 9> kRadii = {2, 2.5, 3.2, 4, 5, 6.5, 9, 16, 1000};
constexpr double kLeastLightGain = 0.02;
constexpr int kTriedDegree = 10;  // tells radii apart as well as 16, at a fifth of the time

/// Normal equations of functions and colours less their means over a point.
struct Normal {
  Eigen::MatrixXf matrix;  // lower triangle
  Eigen::MatrixXf right;   // [K][3]
  std::size_t views = 0;

  explicit Normal(std::size_t functions)
      : matrix(Eigen::MatrixXf::Zero(index(functions), index(functions))),
        right(Eigen::MatrixXf::Zero(index(functions), 3)) {}

  void add(const Matrix& functions, const Columns& colours) {
    matrix.selfadjointView<Eigen::Lower>().rankUpdate(functions.transpose());
    right.noalias() += functions.transpose() * colours;
    views += static_cast<std::size_t>(functions.rows());
  }

  /// [K][3]
  Eigen::MatrixXf solve(const EnvironmentSettings& settings) const {
    Eigen::MatrixXd m = matrix.cast<double>();
    for (Eigen::Index k = 0; k < m.rows(); ++k)
      m(k, k) += settings.strength * static_cast<double>(views) * kLightPenalty *
                 std::pow(kGrowth, std::floor(std::sqrt(static_cast<double>(k + 1))));
    const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> factor(m);
    return factor.solve(right.cast<double>()).cast<float>();
  }
};

std::size_t unknowns(int degree) {
  return static_cast<std::size_t>((degree + 1) * (degree + 1) - 1);
}

/// The functions but for the constant, at the places where the views of points [begin, end) end.
Matrix functions_of(const ReflectedViews& views, std::size_t begin, std::size_t end, double radius,
                    int degree) {
  const Harmonics harmonics(degree);
  const std::size_t first = views.first[begin];
  std::vector<Vec3> places;
  Matrix rows, out(index(views.first[end] - first), index(unknowns(degree)));
  for (std::size_t p = begin; p < end; ++p) {
    places.clear();
    for (std::size_t j = views.first[p]; j < views.first[p + 1]; ++j)
      places.push_back(place_on_sphere(views.position[p], views.reflected[j], radius));
    rows.resize(index(places.size()), out.cols() + 1);
    harmonics.evaluate(places, rows.data());
    out.middleRows(index(views.first[p] - first), rows.rows()) = rows.rightCols(out.cols());
  }
  return out;
}

Columns colours_of(const ReflectedViews& views, std::size_t begin, std::size_t end) {
  return Eigen::Map<const Columns>(views.colour.front().data() + 3 * views.first[begin],
                                   index(views.first[end] - views.first[begin]), 3);
}

/// Squared error on the views of each fold, of light fitted to the others. [0] without any light.
std::array<double, 2> held_out_error(const ReflectedViews& views, const CameraFolds& folds,
                                     double radius, const EnvironmentSettings& settings) {
  const std::size_t points = views.position.size();
  const Matrix functions = functions_of(views, 0, points, radius, settings.degree);
  const Columns colours = colours_of(views, 0, points);
  std::array<double, 2> error{0, 0};
  for (int held_out = 0; held_out < folds.count; ++held_out) {
    // Rows less the mean over those of the same point that are not held out.
    Matrix f = functions;
    Columns c = colours;
    std::vector<Eigen::Index> kept, tested;
    for (std::size_t p = 0; p < points; ++p) {
      std::vector<Eigen::Index> of_point;
      for (std::size_t j = views.first[p]; j < views.first[p + 1]; ++j)
        if (folds.of_camera[views.camera[j]] != held_out) of_point.push_back(index(j));
      if (of_point.empty()) continue;
      const Eigen::RowVectorXf f_mean = functions(of_point, Eigen::all).colwise().mean();
      const Eigen::RowVector3f c_mean = colours(of_point, Eigen::all).colwise().mean();
      for (std::size_t j = views.first[p]; j < views.first[p + 1]; ++j) {
        f.row(index(j)) -= f_mean;
        c.row(index(j)) -= c_mean;
        if (folds.of_camera[views.camera[j]] == held_out) tested.push_back(index(j));
      }
      kept.insert(kept.end(), of_point.begin(), of_point.end());
    }
    if (kept.empty() || tested.empty()) continue;
    Normal normal(unknowns(settings.degree));
    normal.add(f(kept, Eigen::all), c(kept, Eigen::all));
    const Eigen::MatrixXf light = normal.solve(settings);
    const Columns target = c(tested, Eigen::all);
    const Columns rest = target - f(tested, Eigen::all) * light;
    error[0] += static_cast<double>(target.squaredNorm());
    error[1] += static_cast<double>(rest.squaredNorm());
  }
  return error;
}

}  // namespace

MirrorPoints mirror_points(std::span<const Voxel> positions, int cell_log2, int threads,
                           const KnownLight& known) {
  MirrorPoints points;
  const ObjectBox box = known.half > 0 ? ObjectBox(known.centre, known.half) : ObjectBox(positions);
  for (const Voxel& v : positions) points.position.push_back(box(v));
  points.normal = frame_normals(FrameId::kReflected, positions, cell_log2, threads);
  return points;
}

ReflectedViews reflected_views(const Observations& observations, const MirrorPoints& points,
                               FrameId frame, std::size_t most) {
  const std::size_t every =
      std::max<std::size_t>(1, (observations.direction.size() + most - 1) / most);
  ReflectedViews views;
  views.first.push_back(0);
  for (std::size_t p = 0; p < points.position.size(); p += every) {
    if (observations.first[p] == observations.first[p + 1]) continue;
    for (auto j = observations.first[p]; j < observations.first[p + 1]; ++j) {
      const auto& d = observations.direction[j];
      views.reflected.push_back(
          vector_of(frame == FrameId::kReflected ? d : to_frame(points.normal, p, d)));
      views.colour.push_back(observations.colour[j]);
      views.camera.push_back(observations.camera[j]);
    }
    views.position.push_back(points.position[p]);
    views.first.push_back(views.colour.size());
  }
  return views;
}

std::vector<float> solve_environment(const ReflectedViews& views, double radius,
                                     const EnvironmentSettings& settings, int threads) {
  constexpr std::size_t kParts = 8;  // whatever the number of threads: the sum is the same
  const std::size_t points = views.position.size(), k = unknowns(settings.degree);
  std::vector<Normal> parts(kParts, Normal(k));
  parallel_ranges(kParts, 1, threads, [&](std::size_t begin, std::size_t) {
    constexpr std::size_t kStride = 64;  // points at a time
    const std::size_t last = (begin + 1) * points / kParts;
    for (std::size_t from = begin * points / kParts; from < last; from += kStride) {
      const std::size_t to = std::min(from + kStride, last);
      Matrix f = functions_of(views, from, to, radius, settings.degree);
      Columns c = colours_of(views, from, to);
      for (std::size_t p = from; p < to; ++p) {
        const Eigen::Index at = index(views.first[p] - views.first[from]),
                           n = index(views.first[p + 1] - views.first[p]);
        f.middleRows(at, n).rowwise() -= f.middleRows(at, n).colwise().mean().eval();
        c.middleRows(at, n).rowwise() -= c.middleRows(at, n).colwise().mean().eval();
      }
      parts[begin].add(f, c);
    }
  });
  for (std::size_t i = 1; i < kParts; ++i) {
    parts[0].matrix += parts[i].matrix;
    parts[0].right += parts[i].right;
    parts[0].views += parts[i].views;
  }
  const Eigen::MatrixXf solution = parts[0].solve(settings);
  std::vector<float> light(3 * (k + 1), 0.0f);
  for (std::size_t i = 0; i < k; ++i)
    for (std::size_t c = 0; c < 3; ++c) light[3 * (i + 1) + c] = solution(index(i), index(c));
  return light;
}

EnvironmentSettings with_radius(const Observations& observations, const MirrorPoints& points,
                                const FitSettings& settings) {
  EnvironmentSettings chosen = settings.environment;
  if (chosen.degree == 0 || chosen.radius != 0) return chosen;
  const auto none = [&] {
    chosen.degree = 0;
    return chosen;
  };
  const bool reflected = settings.frame == FrameId::kReflected;
  const CameraFolds folds =
      camera_folds(observations, reflected ? std::span(points.normal) : NoNormals{});
  if (folds.count < 3) return none();
  const ReflectedViews views =
      reflected_views(observations, points, settings.frame, kMostTriedViews);
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

std::optional<Environment> fit_environment(const Observations& observations,
                                           const MirrorPoints& points, const FitSettings& settings,
                                           std::size_t most_views) {
  const EnvironmentSettings& given = settings.environment;
  if (given.known.half > 0)
    return Environment(given.radius, given.degree, given.known.light, settings.threads);
  const EnvironmentSettings e = with_radius(observations, points, settings);
  if (e.degree == 0) return std::nullopt;
  const ReflectedViews views = reflected_views(observations, points, settings.frame, most_views);
  if (views.colour.empty()) return std::nullopt;
  return Environment(e.radius, e.degree, solve_environment(views, e.radius, e, settings.threads),
                     settings.threads);
}

KnownLight known_light(const Observations& observations, std::span<const Voxel> positions,
                       const FitSettings& settings) {
  const EnvironmentSettings& e = settings.environment;
  if (e.degree == 0 || observations.colour.empty()) return {};
  const MirrorPoints points = mirror_points(positions, settings.normal_cell_log2, settings.threads);
  const ReflectedViews views = reflected_views(observations, points, settings.frame, kMostViews);
  if (views.colour.empty()) return {};
  const ObjectBox box(positions);
  return {box.centre(), box.half(), solve_environment(views, e.radius, e, settings.threads)};
}

}  // namespace slf
