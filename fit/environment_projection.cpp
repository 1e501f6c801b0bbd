#include "fit/environment_projection.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/signed_index.h"
#include "lightfield/frame.h"
#include "slf/parallel.h"

namespace slf {
namespace {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Columns = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

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

}  // namespace

std::vector<float> project_environment(const Environment& environment,
                                       std::span<const Vec3> positions,
                                       std::span<const std::array<float, 3>> normals, FrameId frame,
                                       const DirectionRows& basis, int threads) {
  const std::size_t k = basis.size(), count = 4 * k;
  const auto directions = spread_directions(count);
  std::vector<Vec3> vectors;
  Matrix rows(index(count), index(k));
  for (std::size_t q = 0; q < count; ++q) {
    vectors.push_back(vector_of(directions[q]));
    basis.evaluate(directions[q], rows.row(index(q)).data());
  }
  const auto bins = bins_of(normals);
  std::vector<float> out(positions.size() * k * 3);
  parallel_ranges(bins.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const auto& n = normals[bins[b].front()];
      Matrix weighted = rows;
      for (std::size_t q = 0; q < count; ++q)
        if (dot(n, vectors[q]) <= kLeastCosine) weighted.row(index(q)) *= kBehind;
      Eigen::MatrixXf gram = rows.transpose() * weighted / static_cast<float>(count);
      gram.diagonal().tail(index(k - 1)).array() += kRidge;
      const Eigen::MatrixXf solver =
          Eigen::LLT<Eigen::MatrixXf>(gram).solve(weighted.transpose()) / static_cast<float>(count);
      Columns light(index(count), 3);
      for (const std::size_t p : bins[b]) {
        const Vec3& at = positions[p];
        for (std::size_t q = 0; q < count; ++q) {
          const auto seen = environment(at, frame == FrameId::kReflected
                                                ? vectors[q]
                                                : vector_of(to_frame(normals, p, directions[q])));
          for (std::size_t c = 0; c < 3; ++c) light(index(q), index(c)) = seen[c];
        }
        Eigen::Map<Columns>(out.data() + p * k * 3, index(k), 3).noalias() = solver * light;
      }
    }
  });
  return out;
}

}  // namespace slf
