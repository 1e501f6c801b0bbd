// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/environment_projection.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "encoder/fit/fit_cholesky.h"
#include "encoder/fit/lane_products.h"
#include "lightfield/directions.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr double kLeastCosine = 0.1;  // between normal and view, in front
constexpr float kBehind = 0.1f, kRidge = 0.001f;
constexpr int kBins = 24;  // of normals, per axis

/// Directions spread evenly: a spiral of golden turns.
std::vector<std::array<float, 2>> spread_directions(std::size_t count) {
  constexpr double kTurn = 2.399963229728653;  // pi (3 - sqrt 5)
  std::vector<std::array<float, 2>> directions;
  for (std::size_t q = 0; q < count; ++q)
    directions.push_back(
        {static_cast<float>(std::remainder(kTurn * static_cast<double>(q), 2 * std::numbers::pi)),
         static_cast<float>(1 - (2 * static_cast<double>(q) + 1) / static_cast<double>(count))});
  return directions;
}

/// Points with about the same normal share a factorisation.
std::vector<std::vector<std::size_t>> bins_of(std::span<const std::array<float, 3>> normals) {
  std::map<int, std::vector<std::size_t>> bins;
  for (std::size_t p = 0; p < normals.size(); ++p) {
    int key = 0;
    for (const float x : normals[p])
      key = key * kBins + std::clamp(static_cast<int>((x + 1) / 2 * kBins), 0, kBins - 1);
    bins[key].push_back(p);
  }
  std::vector<std::vector<std::size_t>> out;
  for (auto& [key, points] : bins) out.push_back(std::move(points));
  return out;
}

double dot(const std::array<float, 3>& n, const Vec3& v) {
  return double(n[0]) * v[0] + double(n[1]) * v[1] + double(n[2]) * v[2];
}

/// The weighted least squares that points with about the same normal have in common.
class Projection {
 public:
  explicit Projection(const DirectionRows& basis)
      : size_(basis.size()),
        width_(padded(size_)),
        directions_(spread_directions(4 * size_)),
        rows_(directions_.size() * width_, 0.0f),
        square_(width_ * width_, 0.0f) {
    for (std::size_t q = 0; q < directions_.size(); ++q) {
      vectors_.push_back(vector_of(directions_[q]));
      basis.evaluate(directions_[q], &rows_[q * width_]);
    }
    add_square(directions_.size(), rows_.data(), width_, square_.data());
  }

  /// Points worked on together.
  static constexpr std::size_t kPoints = 5, kColumns = 16;  // three each; the last is not used

  std::size_t count() const { return directions_.size(); }
  const std::array<float, 2>& direction(std::size_t q) const { return directions_[q]; }
  const Vec3& vector(std::size_t q) const { return vectors_[q]; }

  /// [count] by the normal.
  std::vector<float> weights(const std::array<float, 3>& normal) const {
    std::vector<float> weights;
    for (const Vec3& v : vectors_) weights.push_back(dot(normal, v) > kLeastCosine ? 1 : kBehind);
    return weights;
  }

  /// Packed factor of the weighted products of the functions, over the number of directions.
  std::vector<float> factor(std::span<const float> weights) const {
    std::vector<float> front, of_front(width_ * width_, 0.0f), factor(packed_size(size_));
    for (std::size_t q = 0; q < count(); ++q)
      if (weights[q] == 1)
        front.insert(front.end(), rows_.begin() + static_cast<std::ptrdiff_t>(q * width_),
                     rows_.begin() + static_cast<std::ptrdiff_t>((q + 1) * width_));
    add_square(front.size() / width_, front.data(), width_, of_front.data());
    const float share = 1 / static_cast<float>(count());
    for (std::size_t j = 0; j < size_; ++j) {
      float* column = factor.data() + packed_column(size_, j);
      for (std::size_t i = j; i < size_; ++i) {
        const std::size_t at = i * width_ + j;
        column[i - j] = share * (kBehind * square_[at] + (1 - kBehind) * of_front[at]);
      }
      if (j > 0) column[0] += kRidge;
    }
    cholesky_factorise(factor.data(), size_, kRidge);
    return factor;
  }

  /// @param light  [count][kColumns] weighted, point by point
  /// @param out  [K][3] of each point
  void solve(const std::vector<float>& factor, const std::vector<float>& light,
             std::span<float* const> out) const {
    std::vector<float> products(kColumns * width_, 0.0f);
    add_products(count(), light.data(), kColumns, kColumns, rows_.data(), width_, width_,
                 products.data());
    std::vector<ManyLanes> x(size_);
    for (std::size_t k = 0; k < size_; ++k)
      for (std::size_t i = 0; i < kColumns; ++i)
        x[k].c[i] = products[i * width_ + k] / static_cast<float>(count());
    cholesky_solve(factor.data(), size_, x.data());
    for (std::size_t i = 0; i < out.size(); ++i)
      for (std::size_t k = 0; k < size_; ++k) std::copy_n(&x[k].c[3 * i], 3, out[i] + 3 * k);
  }

 private:
  std::size_t size_, width_;                      // K, up to whole lanes
  std::vector<std::array<float, 2>> directions_;  // that the basis takes
  std::vector<Vec3> vectors_;
  std::vector<float> rows_;    // [count][width_]
  std::vector<float> square_;  // [width_][width_] products of all
};

}  // namespace

void project_environment(const Environment& environment, std::span<const Vec3> positions,
                         std::span<const std::array<float, 3>> normals, Directions directions,
                         const DirectionRows& basis, int threads, FittedRows& rows) {
  constexpr std::size_t kPoints = Projection::kPoints, kColumns = Projection::kColumns;
  const Projection projection(basis);
  const auto bins = bins_of(normals);
  parallel_ranges(bins.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<float> light(projection.count() * kColumns, 0.0f);
    for (std::size_t b = begin; b < end; ++b) {
      const auto weights = projection.weights(normals[bins[b].front()]);
      const auto factor = projection.factor(weights);
      for (std::size_t first = 0; first < bins[b].size(); first += kPoints) {
        std::vector<float*> solved;
        for (std::size_t i = first; i < std::min(first + kPoints, bins[b].size()); ++i) {
          const std::size_t p = bins[b][i];
          for (std::size_t q = 0; q < projection.count(); ++q) {
            const auto seen = environment(
                positions[p], directions == Directions::kReflected
                                  ? projection.vector(q)
                                  : vector_of(to_local(normals, p, projection.direction(q))));
            for (std::size_t c = 0; c < 3; ++c)
              light[q * kColumns + 3 * (i - first) + c] = weights[q] * seen[c];
          }
          solved.push_back(rows.of(p));
        }
        projection.solve(factor, light, solved);
      }
    }
  });
}

}  // namespace slf
