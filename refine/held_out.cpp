#include "refine/held_out.h"

#include <array>
#include <cmath>
#include <numeric>

#include "lightfield/frame.h"
#include "lightfield/observe_camera.h"
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
                                                  int threads) {
  ObserveSettings settings;
  settings.delta_degrees = 10;
  settings.threads = threads;
  const ObservedPoints observed{points.positions, points.normals};
  SLF_TRY(const Observations seen,
          observe(capture, cameras, observed, points.positions, spacing, settings));
  std::vector<std::uint8_t> held(capture.cameras.size(), 0);
  for (const int camera : split_for_mending(cameras).held_out) held[std::size_t(camera)] = 1;
  HeldOutErrors errors;
  errors.squares.assign(points.size(), 0);
  errors.views.assign(points.size(), 0);
  errors.seen.assign(points.size(), 0);
  parallel_ranges(points.size(), 1024, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      errors.seen[p] = seen.first[p] < seen.first[p + 1];
      Equations equations;
      const auto row_of = [&](std::uint64_t i, double& cosine) {
        const Vec3 d = vector_of(seen.direction[i]);
        cosine = 0;
        for (std::size_t a = 0; a < 3; ++a) cosine += d[a] * double(points.normals[p][a]);
        // Relative to the normal, whose direction is about the middle of all.
        return Row{1, d[0] - double(points.normals[p][0]), d[1] - double(points.normals[p][1]),
                   d[2] - double(points.normals[p][2])};
      };
      double cosine = 0;
      for (std::uint64_t i = seen.first[p]; i < seen.first[p + 1]; ++i)
        if (held[seen.camera[i]] == 0) {
          const Row row = row_of(i, cosine);
          equations.add(row, seen.colour[i], std::max(cosine, 0.0));
        }
      if (equations.count < 2) continue;
      equations.solve();
      for (std::uint64_t i = seen.first[p]; i < seen.first[p + 1]; ++i) {
        if (held[seen.camera[i]] == 0) continue;
        const Row row = row_of(i, cosine);
        double squares = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          double error = -double(seen.colour[i][c]);
          for (std::size_t k = 0; k < kTerms; ++k) error += row[k] * equations.right[k][c];
          squares += error * error;
        }
        errors.squares[p] += float(std::max(cosine, 0.0) * squares / 3);
        errors.views[p] += float(std::max(cosine, 0.0));
      }
    }
  });
  return errors;
}

}  // namespace slf
