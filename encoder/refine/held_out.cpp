// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/held_out.h"

#include <array>
#include <cmath>
#include <numeric>

#include "encoder/fit/observe_camera.h"
#include "lightfield/directions.h"
#include "slf/fit.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kEvery = 4;  // cameras: one of so many is held out
constexpr std::size_t kTerms = 4;  // mean and three components of the direction
constexpr double kRidge = 0.5;     // observations' worth of pull to the mean

using Row = std::array<double, kTerms>;

/// Normal equations of one point, three channels.
struct Equations {
  std::array<Row, kTerms> left{};
  std::array<std::array<double, 3>, kTerms> right{};
  double count = 0;

  void add(const Row& row, const std::array<float, 3>& colour, double weight) {
    for (std::size_t i = 0; i < kTerms; ++i) {
      for (std::size_t j = 0; j <= i; ++j) left[i][j] += weight * row[i] * row[j];
      for (std::size_t c = 0; c < 3; ++c) right[i][c] += weight * row[i] * double(colour[c]);
    }
    ++count;
  }

  /// Coefficients into `right`, by Cholesky.
  void solve() {
    for (std::size_t i = 0; i < kTerms; ++i) left[i][i] += i == 0 ? 1e-6 : kRidge;
    for (std::size_t j = 0; j < kTerms; ++j) {
      for (std::size_t k = 0; k < j; ++k) left[j][j] -= left[j][k] * left[j][k];
      left[j][j] = std::sqrt(std::max(left[j][j], 1e-9));
      for (std::size_t i = j + 1; i < kTerms; ++i) {
        for (std::size_t k = 0; k < j; ++k) left[i][j] -= left[i][k] * left[j][k];
        left[i][j] /= left[j][j];
      }
    }
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < kTerms; ++i) {
        for (std::size_t k = 0; k < i; ++k) right[i][c] -= left[i][k] * right[k][c];
        right[i][c] /= left[i][i];
      }
      for (std::size_t i = kTerms; i-- > 0;) {
        for (std::size_t k = i + 1; k < kTerms; ++k) right[i][c] -= left[k][i] * right[k][c];
        right[i][c] /= left[i][i];
      }
    }
  }
};

ObservedPoints every_nth(const SurfacePoints& points, std::size_t every) {
  ObservedPoints some;
  for (std::size_t p = 0; p < points.size(); p += every) {
    some.positions.push_back(points.positions[p]);
    some.normals.push_back(points.normals[p]);
  }
  return some;
}

/// An observation's terms, and the cosine between normal and view.
struct HeldOutView {
  Row row{};
  double cosine = 0;
};

HeldOutView view_of(const std::array<float, 2>& direction, const Float3& normal) {
  const Vec3 d = vector_of(direction);
  HeldOutView view;
  view.row[0] = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    view.cosine += d[a] * double(normal[a]);
    // Relative to the normal, whose direction is about the middle of all.
    view.row[1 + a] = d[a] - double(normal[a]);
  }
  view.cosine = std::max(view.cosine, 0.0);
  return view;
}

struct PointError {
  float squares = 0, views = 0;
};

/// @param held  by camera, whether it is predicted from the others
PointError error_of(const Observations& seen, std::size_t p, const Float3& normal,
                    const std::vector<std::uint8_t>& held) {
  PointError sum;
  Equations equations;
  for (std::uint64_t i = seen.first[p]; i < seen.first[p + 1]; ++i)
    if (held[seen.camera[i]] == 0) {
      const HeldOutView view = view_of(seen.direction[i], normal);
      equations.add(view.row, seen.colour[i], view.cosine);
    }
  if (equations.count < 2) return sum;
  equations.solve();
  for (std::uint64_t i = seen.first[p]; i < seen.first[p + 1]; ++i) {
    if (held[seen.camera[i]] == 0) continue;
    const HeldOutView view = view_of(seen.direction[i], normal);
    double squares = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      double error = -double(seen.colour[i][c]);
      for (std::size_t k = 0; k < kTerms; ++k) error += view.row[k] * equations.right[k][c];
      squares += error * error;
    }
    sum.squares += float(view.cosine * squares / 3);
    sum.views += float(view.cosine);
  }
  return sum;
}

}  // namespace

double HeldOutErrors::squares_sum() const {
  return std::accumulate(squares.begin(), squares.end(), 0.0);
}

double HeldOutErrors::mean() const { return mean_of(*this, {}); }

double mean_of(const HeldOutErrors& a, const HeldOutErrors& b) {
  const double weight = std::accumulate(a.views.begin(), a.views.end(), 0.0) +
                        std::accumulate(b.views.begin(), b.views.end(), 0.0);
  return weight > 0 ? (a.squares_sum() + b.squares_sum()) / weight : 0;
}

CameraParts split_for_mending(std::span<const int> cameras) {
  CameraParts parts;
  for (std::size_t i = 0; i < cameras.size(); ++i)
    (i % kEvery == kEvery / 2 ? parts.held_out : parts.matched).push_back(cameras[i]);
  return parts;
}

Result<HeldOutErrors, InputError> held_out_errors(const Capture& capture,
                                                  std::span<const int> cameras,
                                                  const SurfacePoints& points, double spacing,
                                                  int threads, std::size_t every) {
  ObserveSettings settings;
  settings.delta_degrees = 10;
  settings.threads = threads;
  const ObservedPoints looked_at = every_nth(points, every);
  SLF_TRY(const Observations seen,
          observe(capture, cameras, looked_at, points.positions, spacing, settings));
  std::vector<std::uint8_t> held(capture.cameras.size(), 0);
  for (const int camera : split_for_mending(cameras).held_out) held[std::size_t(camera)] = 1;
  HeldOutErrors errors;
  errors.squares.assign(points.size(), 0);
  errors.views.assign(points.size(), 0);
  errors.seen.assign(points.size(), 0);
  const auto weight = float(every);
  parallel_ranges(looked_at.positions.size(), 1024, threads,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin; i < end; ++i) {
                      const PointError error = error_of(seen, i, looked_at.normals[i], held);
                      errors.squares[i * every] = weight * error.squares;
                      errors.views[i * every] = weight * error.views;
                      errors.seen[i * every] = seen.first[i] < seen.first[i + 1];
                    }
                  });
  return errors;
}

}  // namespace slf
