#include "lightfield/environment_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "lightfield/frame.h"
#include "lightfield/harmonics.h"
#include "slf/parallel.h"

namespace slf {
namespace {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Columns = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

constexpr double kPenalty = 0.8, kGrowth = 1.3;  // as the blocks of the hierarchical fit have
constexpr std::size_t kMostViews = 200000, kMostTriedViews = 30000;
constexpr int kFolds = 4;
/// Half the object's longest side is 1; the last is as good as infinite.
constexpr std::array<double, 9> kRadii = {2, 2.5, 3.2, 4, 5, 6.5, 9, 16, 1000};
constexpr double kLeastGain = 0.02;
constexpr int kTriedDegree = 10;  // tells radii apart as well as 16, at a fifth of the time

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

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
      m(k, k) += settings.strength * static_cast<double>(views) * kPenalty *
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
  std::vector<float> row(unknowns(degree) + 1);
  Matrix out(index(views.first[end] - first), index(unknowns(degree)));
  for (std::size_t p = begin; p < end; ++p)
    for (std::size_t j = views.first[p]; j < views.first[p + 1]; ++j) {
      harmonics.evaluate(place_on_sphere(views.position[p], views.reflected[j], radius),
                         row.data());
      std::copy(row.begin() + 1, row.end(), out.row(index(j - first)).data());
    }
  return out;
}

Columns colours_of(const ReflectedViews& views, std::size_t begin, std::size_t end) {
  return Eigen::Map<const Columns>(views.colour.front().data() + 3 * views.first[begin],
                                   index(views.first[end] - views.first[begin]), 3);
}

/// Squared error on the views of each fold, of light fitted to the others. [0] without any light.
std::array<double, 2> held_out_error(const ReflectedViews& views, std::span<const int> fold,
                                     double radius, const EnvironmentSettings& settings) {
  const std::size_t points = views.position.size();
  const Matrix functions = functions_of(views, 0, points, radius, settings.degree);
  const Columns colours = colours_of(views, 0, points);
  std::array<double, 2> error{0, 0};
  for (int held_out = 0; held_out < kFolds; ++held_out) {
    // Rows less the mean over those of the same point that are not held out.
    Matrix f = functions;
    Columns c = colours;
    std::vector<Eigen::Index> kept, tested;
    for (std::size_t p = 0; p < points; ++p) {
      std::vector<Eigen::Index> of_point;
      for (std::size_t j = views.first[p]; j < views.first[p + 1]; ++j)
        if (fold[views.camera[j]] != held_out) of_point.push_back(index(j));
      if (of_point.empty()) continue;
      const Eigen::RowVectorXf f_mean = functions(of_point, Eigen::all).colwise().mean();
      const Eigen::RowVector3f c_mean = colours(of_point, Eigen::all).colwise().mean();
      for (std::size_t j = views.first[p]; j < views.first[p + 1]; ++j) {
        f.row(index(j)) -= f_mean;
        c.row(index(j)) -= c_mean;
        if (fold[views.camera[j]] == held_out) tested.push_back(index(j));
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

Vec3 world_of(std::span<const std::array<float, 3>> normals, std::size_t p, FrameId frame,
              const std::array<float, 2>& direction) {
  return vector_of(frame == FrameId::kReflected ? to_frame(normals, p, direction) : direction);
}

}  // namespace

ReflectedViews reflected_views(const Observations& observations, std::span<const Voxel> positions,
                               std::span<const std::array<float, 3>> normals, FrameId frame,
                               std::size_t most) {
  const std::size_t every =
      std::max<std::size_t>(1, (observations.direction.size() + most - 1) / most);
  const ObjectBox box(positions);
  ReflectedViews views;
  views.first.push_back(0);
  for (std::size_t p = 0; p < positions.size(); p += every) {
    if (observations.first[p] == observations.first[p + 1]) continue;
    for (auto j = observations.first[p]; j < observations.first[p + 1]; ++j) {
      const auto& d = observations.direction[j];
      views.reflected.push_back(
          vector_of(frame == FrameId::kReflected ? d : to_frame(normals, p, d)));
      views.colour.push_back(observations.colour[j]);
      views.camera.push_back(observations.camera[j]);
    }
    views.position.push_back(box(positions[p]));
    views.first.push_back(views.colour.size());
  }
  return views;
}

std::vector<int> camera_folds(std::span<const Vec3> towards_camera) {
  const std::size_t cameras = towards_camera.size();
  const std::size_t clusters =
      std::min(cameras, std::clamp<std::size_t>(cameras / 5, std::size_t{kFolds}, 32));
  const auto cosine = [&](std::size_t a, std::size_t b) {
    const Vec3 &x = towards_camera[a], &y = towards_camera[b];
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
  };
  // Seeds as far from each other as they can be, one after the other; then the nearest seed.
  std::vector<int> cluster(cameras, 0);
  std::vector<double> nearest(cameras, -2);
  std::size_t seed = 0;
  for (std::size_t k = 0; k < clusters; ++k) {
    for (std::size_t i = 0; i < cameras; ++i)
      if (cosine(i, seed) > nearest[i]) {
        nearest[i] = cosine(i, seed);
        cluster[i] = static_cast<int>(k) % kFolds;
      }
    seed = static_cast<std::size_t>(std::min_element(nearest.begin(), nearest.end()) -
                                    nearest.begin());
  }
  return cluster;
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

std::optional<double> choose_radius(const ReflectedViews& views, std::span<const int> fold,
                                    const EnvironmentSettings& settings, int threads) {
  if (*std::max_element(fold.begin(), fold.end()) < 2) return std::nullopt;
  EnvironmentSettings tried = settings;
  tried.degree = std::min(settings.degree, kTriedDegree);
  std::array<std::array<double, 2>, kRadii.size()> error{};
  parallel_ranges(kRadii.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      error[i] = held_out_error(views, fold, kRadii[i], tried);
  });
  const auto best = std::min_element(error.begin(), error.end(),
                                     [](const auto& a, const auto& b) { return a[1] < b[1]; });
  if (!((*best)[1] < (1 - kLeastGain) * (*best)[0])) return std::nullopt;
  return kRadii[static_cast<std::size_t>(best - error.begin())];
}

std::optional<Environment> fit_environment(const Observations& observations,
                                           std::span<const Voxel> positions,
                                           std::span<const std::array<float, 3>> normals,
                                           const FitSettings& settings) {
  const EnvironmentSettings& e = settings.environment;
  if (e.degree == 0 || observations.direction.empty()) return std::nullopt;
  double radius = e.radius;
  if (radius == 0) {
    ReflectedViews few =
        reflected_views(observations, positions, normals, settings.frame, kMostTriedViews);
    std::map<std::uint16_t, Vec3> towards;
    for (std::size_t p = 0; p < positions.size(); ++p)
      for (auto j = observations.first[p]; j < observations.first[p + 1]; ++j) {
        const Vec3 w = world_of(normals, p, settings.frame, observations.direction[j]);
        Vec3& sum = towards[observations.camera[j]];
        for (std::size_t a = 0; a < 3; ++a) sum[a] += w[a];
      }
    std::vector<Vec3> directions;
    std::map<std::uint16_t, std::uint16_t> number;
    for (const auto& [camera, sum] : towards) {
      const double length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) + 1e-30;
      number[camera] = static_cast<std::uint16_t>(directions.size());
      directions.push_back({sum[0] / length, sum[1] / length, sum[2] / length});
    }
    for (auto& camera : few.camera) camera = number[camera];
    const auto chosen = choose_radius(few, camera_folds(directions), e, settings.threads);
    if (!chosen) return std::nullopt;
    radius = *chosen;
  }
  const ReflectedViews views =
      reflected_views(observations, positions, normals, settings.frame, kMostViews);
  return Environment(radius, e.degree, solve_environment(views, radius, e, settings.threads),
                     settings.threads);
}

}  // namespace slf
