// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/direction_kernel.h"

#include <algorithm>
#include <cstring>

#include "base/multiversion.h"

namespace slf {
namespace {

constexpr std::size_t kLanes = 8;
using Lanes8 [[gnu::vector_size(kLanes * sizeof(float))]] = float;

/// Coefficients of sum_l (2 l + 1) P_l(x) / penalty of degree l.
std::array<float, kMaxDegree + 1> zonal_polynomial(int degree, std::span<const double> penalty) {
  using Polynomial = std::array<double, kMaxDegree + 2>;
  Polynomial sum{}, before{}, legendre{1};
  for (int l = 0; l <= degree; ++l) {
    const double weight = (2 * l + 1) / penalty[static_cast<std::size_t>(l * l)];
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * legendre[i];
    Polynomial next{};
    for (std::size_t i = 0; i < next.size(); ++i)
      next[i] = ((i > 0 ? (2 * l + 1) * legendre[i - 1] : 0) - l * before[i]) / (l + 1);
    before = legendre;
    legendre = next;
  }
  std::array<float, kMaxDegree + 1> polynomial{};
  std::transform(sum.begin(), sum.end() - 1, polynomial.begin(),
                 [](double c) { return static_cast<float>(c); });
  return polynomial;
}

/// Not a return value: vectors have no way of their own to be returned on every machine.
void load(const float* from, Lanes8& lanes) { std::memcpy(&lanes, from, sizeof lanes); }

/// The order of the sum is the same on every machine, its rounding is not: some fuse.
float sum(const Lanes8& v) {
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

/// @param columns  [6][stride]: x, y, z of the directions, then the three channels, padded by zeros
SLF_MULTIVERSION_ALL void apply_zonal(const std::array<float, kMaxDegree + 1>& polynomial,
                                      const float* columns, std::size_t stride,
                                      std::span<Colour4> out) {
  const float *x = columns, *y = x + stride, *z = y + stride, *r = z + stride, *g = r + stride,
              *b = g + stride;
  for (std::size_t i = 0; i < out.size(); ++i) {
    Lanes8 red{}, green{}, blue{};
    for (std::size_t j = 0; j < stride; j += kLanes) {
      Lanes8 xs, ys, zs, rs, gs, bs;
      load(x + j, xs);
      load(y + j, ys);
      load(z + j, zs);
      load(r + j, rs);
      load(g + j, gs);
      load(b + j, bs);
      const Lanes8 cosine = x[i] * xs + y[i] * ys + z[i] * zs;
      Lanes8 value = Lanes8{} + polynomial[kMaxDegree];
      for (int d = kMaxDegree - 1; d >= 0; --d)
        value = value * cosine + polynomial[static_cast<std::size_t>(d)];
      red += value * rs;
      green += value * gs;
      blue += value * bs;
    }
    out[i] = {sum(red), sum(green), sum(blue), 0};
  }
}

}  // namespace

DirectionKernel::DirectionKernel(const Basis& basis, const DirectionRows& rows,
                                 std::span<const double> penalty)
    : rows_(rows), zonal_(basis.id == BasisId::kHarmonics) {
  for (const double p : penalty) inverse_.push_back(static_cast<float>(1 / p));
  if (zonal_) polynomial_ = zonal_polynomial(basis.degree, penalty);
}

void DirectionKernel::apply(std::span<const std::array<float, 3>> world,
                            std::span<const Vec3> in_local, std::span<const Colour4> x,
                            std::span<Colour4> out) const {
  if (!zonal_) return apply_rows(in_local, x, out);
  const std::size_t m = world.size(), stride = (m + kLanes - 1) / kLanes * kLanes;
  static thread_local std::vector<float> columns;
  columns.assign(6 * stride, 0.0f);
  for (std::size_t i = 0; i < m; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      columns[c * stride + i] = world[i][c];
      columns[(3 + c) * stride + i] = x[i][c];
    }
  apply_zonal(polynomial_, columns.data(), stride, out);
}

void DirectionKernel::apply_rows(std::span<const Vec3> in_local, std::span<const Colour4> x,
                                 std::span<Colour4> out) const {
  const std::size_t m = in_local.size(), size = rows_.size();
  std::vector<float> rows(m * size);
  std::vector<Colour4> sums(size);  // B^T x, then P^-1 of it
  rows_.evaluate(in_local, rows.data());
  for (std::size_t i = 0; i < m; ++i)
    for (std::size_t k = 0; k < size; ++k)
      for (std::size_t c = 0; c < 4; ++c) sums[k][c] += rows[i * size + k] * x[i][c];
  for (std::size_t k = 0; k < size; ++k)
    for (float& c : sums[k]) c *= inverse_[k];
  for (std::size_t i = 0; i < m; ++i) {
    out[i] = {};
    for (std::size_t k = 0; k < size; ++k)
      for (std::size_t c = 0; c < 4; ++c) out[i][c] += rows[i * size + k] * sums[k][c];
  }
}

}  // namespace slf
