// SPDX-License-Identifier: Apache-2.0
#include "lightfield/function_table.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/multiversion.h"
#include "lightfield/directions.h"
#include "lightfield/nodes.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kWidth = 8;  // of vectors: rows are whole ones
constexpr std::size_t kDirections = 64;

/// [K][stride]: 2^-shift M, or 2^-shift alone for functions without a transform.
std::vector<float> function_matrix(const LightFieldHeader& header, std::size_t stride) {
  const auto functions = static_cast<std::size_t>(header.num_functions);
  std::vector<float> matrix(functions * stride, 0);
  const auto unit = [&](std::size_t k) {
    return std::ldexp(1.0, k < header.shift.size() ? -header.shift[k] : 0);
  };
  for (std::size_t r = 0; r < static_cast<std::size_t>(header.num_components()); ++r) {
    const std::size_t k = header.coded.empty() ? r : header.coded[r];
    matrix[k * stride + r] = static_cast<float>(unit(k));
  }
  for (const PlaneTransform& t : header.transforms) {
    assert(t.lanes == 3);
    for (std::size_t c = 0; c < t.components.size(); ++c)
      for (std::size_t i = 0; i < t.functions.size(); ++i)
        matrix[t.functions[i] * stride + t.components[c]] = static_cast<float>(
            std::ldexp(t.matrix[c * t.rows() + i], -PlaneTransform::kFractionBits) *
            unit(t.functions[i]));
  }
  return matrix;
}

/// Rows of basis functions to rows of spline nodes.
std::vector<float> node_matrix(const Basis& basis, const std::vector<float>& matrix,
                               std::size_t stride) {
  const NodeMap<float> map(basis);
  const std::size_t functions = matrix.size() / stride;
  std::vector<float> nodes(matrix.size()), triple(map.size()), to(map.size()), scratch(map.size());
  for (std::size_t r = 0; r < stride; r += 3) {
    const std::size_t count = std::min<std::size_t>(3, stride - r);
    for (std::size_t k = 0; k < functions; ++k)
      std::copy_n(&matrix[k * stride + r], count, &triple[3 * k]);
    map.to_nodes(triple.data(), to.data(), scratch.data());
    for (std::size_t k = 0; k < functions; ++k)
      std::copy_n(&to[3 * k], count, &nodes[k * stride + r]);
  }
  return nodes;
}

void add_row(float* __restrict sum, const float* __restrict row, float weight, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) sum[i] += weight * row[i];
}

/// Samples at whole numbers to coefficients of cubic B-splines there, in place, vectors of `size`
/// values `step` apart. The ends are mirrored: what that is wrong by fades by 0.27 a sample.
void to_spline(float* samples, int count, std::size_t step, std::size_t size) {
  const float pole = std::sqrt(3.0f) - 2;
  const auto at = [&](int i) { return samples + static_cast<std::size_t>(i) * step; };
  float power = 1;
  std::vector<float> first(size, 0);
  for (int i = 0; i < std::min(count, 16); ++i, power *= pole)
    add_row(first.data(), at(i), power, size);
  std::copy(first.begin(), first.end(), at(0));
  for (int i = 1; i < count; ++i) add_row(at(i), at(i - 1), pole, size);
  const float last = pole / (pole * pole - 1);
  for (std::size_t j = 0; j < size; ++j)
    at(count - 1)[j] = last * (at(count - 1)[j] + pole * at(count - 2)[j]);
  for (int i = count - 2; i >= 0; --i)
    for (std::size_t j = 0; j < size; ++j) at(i)[j] = pole * (at(i + 1)[j] - at(i)[j]);
  for (int i = 0; i < count; ++i)
    for (std::size_t j = 0; j < size; ++j) at(i)[j] *= 6;
}

/// Weights of the four B-splines that are not zero u behind a knot, 0 <= u <= 1.
std::array<float, 4> cubic_weights(float u) {
  const float v = 1 - u;
  return {v * v * v / 6, (4 + 3 * u * u * (u - 2)) / 6, (4 + 3 * v * v * (v - 2)) / 6,
          u * u * u / 6};
}

/// Rows of 4 x 4 places to their weighted sum.
/// @param below  elements from a place to that of the next line
SLF_MULTIVERSION
void interpolate(const float* first, std::size_t stride, std::size_t below,
                 const std::array<std::array<float, 4>, 2>& weight, float* __restrict row) {
  std::fill_n(row, stride, 0.0f);
  for (std::size_t y = 0; y < 4; ++y, first += below) {
    const float w0 = weight[1][y] * weight[0][0], w1 = weight[1][y] * weight[0][1],
                w2 = weight[1][y] * weight[0][2], w3 = weight[1][y] * weight[0][3];
    const float *a = first, *b = a + stride, *c = b + stride, *d = c + stride;
    for (std::size_t r = 0; r < stride; ++r)
      row[r] += (w0 * a[r] + w1 * b[r]) + (w2 * c[r] + w3 * d[r]);
  }
}

}  // namespace

FunctionTable::FunctionTable(const LightFieldHeader& header, int threads)
    : basis_(header.basis),
      threads_(threads),
      size_(static_cast<std::size_t>(header.num_components())),
      stride_((size_ + kWidth - 1) / kWidth * kWidth),
      matrix_(function_matrix(header, stride_)) {
  if (basis_.id == BasisId::kHarmonics) {
    harmonics_ = std::make_unique<const Harmonics>(basis_.degree);
  } else {
    matrix_ = node_matrix(basis_, matrix_, stride_);
  }
}

void FunctionTable::evaluate(const std::array<float, 2>& direction, float* row) const {
  std::fill_n(row, stride_, 0.0f);
  if (harmonics_) {
    std::array<float, Harmonics::kMost> values;
    harmonics_->evaluate(vector_of(direction), values.data());
    for (std::size_t k = 0; k < static_cast<std::size_t>(harmonics_->size()); ++k)
      add_row(row, &matrix_[k * stride_], values[k], stride_);
    return;
  }
  const NodeTaps taps =
      node_taps(basis_, static_cast<double>(direction[0]), static_cast<double>(direction[1]));
  for (std::size_t t = 0; t < taps.count; ++t)
    add_row(row, &matrix_[taps.node[t] * stride_], static_cast<float>(taps.weight[t]), stride_);
}

void FunctionTable::make_faces() const {
  constexpr int kMargin = 5, kSamples = kSide + 2 * kMargin;
  constexpr auto kAll = static_cast<std::size_t>(kSamples) * kSamples;
  faces_.resize(std::size_t{6} * kSide * kSide * stride_);
  std::vector<float> samples(kAll * stride_);
  for (std::size_t face = 0; face < 6; ++face) {
    const std::size_t axis = face / 2;
    parallel_ranges(kAll, kDirections, threads_, [&](std::size_t begin, std::size_t end) {
      std::array<float, Harmonics::kMost> values;
      for (std::size_t i = begin; i < end; ++i) {
        const auto place = [](std::size_t j) {  // the first of a face's splines is one before it
          return 2.0 * (static_cast<double>(j) - kMargin - 1) / kCells - 1;
        };
        std::array<double, 3> v{};
        v[axis] = face % 2 == 0 ? 1 : -1;
        v[(axis + 1) % 3] = place(i % kSamples);
        v[(axis + 2) % 3] = place(i / kSamples);
        const double length = std::hypot(v[0], v[1], v[2]);
        for (double& x : v) x /= length;
        harmonics_->evaluate(v, values.data());
        float* row = &samples[i * stride_];
        std::fill_n(row, stride_, 0.0f);
        for (std::size_t k = 0; k < static_cast<std::size_t>(harmonics_->size()); ++k)
          add_row(row, &matrix_[k * stride_], values[k], stride_);
      }
    });
    for (std::size_t y = 0; y < kSamples; ++y)
      to_spline(&samples[y * kSamples * stride_], kSamples, stride_, stride_);
    to_spline(samples.data(), kSamples, kSamples * stride_, kSamples * stride_);
    for (std::size_t y = 0; y < kSide; ++y)
      std::copy_n(&samples[((y + kMargin) * kSamples + kMargin) * stride_], kSide * stride_,
                  &faces_[(face * kSide + y) * kSide * stride_]);
  }
}

void FunctionTable::look_up(const std::array<float, 3>& direction, float* row) const {
  std::call_once(once_, [this] { make_faces(); });
  const std::array<float, 3> size{std::abs(direction[0]), std::abs(direction[1]),
                                  std::abs(direction[2])};
  const std::size_t axis = size[0] >= size[1] && size[0] >= size[2] ? 0
                           : size[1] >= size[2]                     ? 1
                                                                    : 2;
  const std::size_t face = 2 * axis + (direction[axis] < 0 ? 1 : 0);
  std::array<std::size_t, 2> cell;
  std::array<std::array<float, 4>, 2> weight;
  for (std::size_t i = 0; i < 2; ++i) {
    const float x = (direction[(axis + 1 + i) % 3] / size[axis] + 1) * (kCells / 2.0f);
    cell[i] = static_cast<std::size_t>(std::clamp(x, 0.0f, kCells - 1.0f));
    weight[i] = cubic_weights(x - static_cast<float>(cell[i]));
  }
  const float* first = &faces_[((face * kSide + cell[1]) * kSide + cell[0]) * stride_];
  interpolate(first, stride_, kSide * stride_, weight, row);
}

}  // namespace slf
