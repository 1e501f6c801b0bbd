// SPDX-License-Identifier: Apache-2.0
#include "lightfield/harmonics.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/multiversion.h"

namespace slf {

Harmonics::Harmonics(int degree) : degree_(degree) {
  for (int m = 0; m <= degree; ++m)
    for (int l = m; l <= degree; ++l) {
      double ratio = 1;  // (l + m)! / (l - m)!
      for (int i = l - m + 1; i <= l + m; ++i) ratio *= i;
      const double norm = std::sqrt((m == 0 ? 1 : 2) * (2 * l + 1) / ratio);
      const double next = l - m + 1;
      steps_.push_back({m % 2 == 0 ? norm : -norm, (2 * l + 1) / next, (l + m) / next});
    }
}

template <class Real>
void Harmonics::evaluate(const std::array<double, 3>& direction, Real* row) const {
  const auto [x, y, z] = direction;
  // sin^m cos(m phi) and sin^m sin(m phi); Legendre functions without their factor sin^m.
  double cosine = 1, sine = 0, diagonal = 1;
  const Step* step = steps_.data();
  for (int m = 0; m <= degree_; ++m) {
    double before = 0, legendre = diagonal;
    for (int l = m; l <= degree_; ++l, ++step) {
      Real* middle = row + l * l + l;
      middle[m] = static_cast<Real>(step->norm * legendre * cosine);
      if (m > 0) middle[-m] = static_cast<Real>(step->norm * legendre * sine);
      const double next = step->from_this * z * legendre - step->from_before * before;
      before = legendre;
      legendre = next;
    }
    diagonal *= 2 * m + 1;
    const double turned = cosine * x - sine * y;
    sine = sine * x + cosine * y;
    cosine = turned;
  }
}

template void Harmonics::evaluate(const std::array<double, 3>&, float*) const;
template void Harmonics::evaluate(const std::array<double, 3>&, double*) const;

SLF_MULTIVERSION_ALL void Harmonics::evaluate(
    const std::array<std::array<float, kLanes>, 3>& directions,
    std::array<float, kLanes>* rows) const {
  const auto& [x, y, z] = directions;
  std::array<float, kLanes> cosine, sine{}, before, legendre;
  cosine.fill(1);
  float diagonal = 1;
  const Step* step = steps_.data();
  for (int m = 0; m <= degree_; ++m) {
    before.fill(0);
    legendre.fill(diagonal);
    for (int l = m; l <= degree_; ++l, ++step) {
      const auto norm = static_cast<float>(step->norm);
      const auto from_this = static_cast<float>(step->from_this);
      const auto from_before = static_cast<float>(step->from_before);
      auto& plus = rows[l * l + l + m];
      auto& minus = rows[l * l + l - m];
      for (std::size_t i = 0; i < kLanes; ++i) {
        const float scaled = norm * legendre[i];
        const float next = from_this * z[i] * legendre[i] - from_before * before[i];
        minus[i] = scaled * sine[i];
        plus[i] = scaled * cosine[i];  // last: one of both where m = 0
        before[i] = legendre[i];
        legendre[i] = next;
      }
    }
    diagonal *= static_cast<float>(2 * m + 1);
    for (std::size_t i = 0; i < kLanes; ++i) {
      const float turned = cosine[i] * x[i] - sine[i] * y[i];
      sine[i] = sine[i] * x[i] + cosine[i] * y[i];
      cosine[i] = turned;
    }
  }
}

void Harmonics::evaluate_columns(std::span<const std::array<double, 3>> directions, float* columns,
                                 std::size_t stride) const {
  std::array<std::array<float, kLanes>, 3> lanes;
  std::vector<std::array<float, kLanes>> values(static_cast<std::size_t>(size()));
  for (std::size_t first = 0; first < stride; first += kLanes) {
    for (std::size_t i = 0; i < kLanes; ++i)
      for (std::size_t a = 0; a < 3; ++a)
        lanes[a][i] = static_cast<float>(directions[std::min(first + i, directions.size() - 1)][a]);
    evaluate(lanes, values.data());
    for (std::size_t k = 0; k < values.size(); ++k)
      std::memcpy(columns + k * stride + first, values[k].data(), sizeof values[k]);
  }
}

void Harmonics::evaluate(std::span<const std::array<double, 3>> directions, float* rows) const {
  const auto functions = static_cast<std::size_t>(size());
  std::array<std::array<float, kLanes>, 3> lanes{};
  std::vector<std::array<float, kLanes>> values(functions);
  for (std::size_t first = 0; first < directions.size(); first += kLanes) {
    const std::size_t count = std::min(kLanes, directions.size() - first);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t a = 0; a < 3; ++a)
        lanes[a][i] = static_cast<float>(directions[first + i][a]);
    evaluate(lanes, values.data());
    for (std::size_t i = 0; i < count; ++i, rows += functions)
      for (std::size_t k = 0; k < functions; ++k) rows[k] = values[k][i];
  }
}

}  // namespace slf
