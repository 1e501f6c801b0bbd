// SPDX-License-Identifier: Apache-2.0
// The colour of points averaged over all directions, from the components that have a part in it.
#include <algorithm>
#include <cmath>

#include "slf/parallel.h"
#include "slf/view_map.h"

namespace slf {
namespace {

constexpr std::size_t kPointsPerRange = 4096;

using Matrix3 = std::array<std::array<double, 3>, 3>;

Matrix3 product(const Matrix3& a, const Matrix3& b) {
  Matrix3 c{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) c[i][j] += a[i][k] * b[k][j];
  return c;
}

/// Component r, and what its channels give of R, G, B of function 0: every other has no mean.
struct Part {
  std::size_t r;
  Matrix3 to_rgb;
};

/// Function 0 in a transform.
void add_parts(const PlaneTransform& t, const Matrix3& to_rgb, std::vector<Part>& parts) {
  const auto found = std::find(t.functions.begin(), t.functions.end(), 0);
  if (found == t.functions.end()) return;
  const auto row = static_cast<std::size_t>(found - t.functions.begin());
  for (std::size_t j = 0; j < t.components.size(); ++j) {
    Matrix3 part{};  // of the channels of the component, those of function 0
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t d = 0; d < 3; ++d)
        part[c][d] = t.lanes == 3
                         ? std::ldexp(double(t.matrix[j * t.rows() + row]) * t.colour[c][d],
                                      -PlaneTransform::kColourBits)
                         : t.matrix[(3 * j + d) * t.rows() + 3 * row + c];
    for (auto& line : part)
      for (double& entry : line) entry = std::ldexp(entry, -PlaneTransform::kFractionBits);
    parts.push_back({t.components[j], product(to_rgb, part)});
  }
}

std::vector<Part> parts_of_mean(const LightFieldHeader& header) {
  Matrix3 to_rgb = colour_matrix(header.colour);
  const int shift = header.shift.empty() ? 0 : header.shift[0];
  for (auto& line : to_rgb)
    for (double& entry : line) entry = std::ldexp(entry, -shift);
  std::vector<Part> parts;
  for (const PlaneTransform& t : header.transforms) add_parts(t, to_rgb, parts);
  const bool coded = header.coded.empty() || header.coded[0] == 0;
  if (parts.empty() && coded) parts.push_back({0, to_rgb});
  return parts;
}

}  // namespace

std::vector<std::array<float, 3>> mean_colours(const LightField& field, int threads) {
  const std::vector<Part> parts = parts_of_mean(field.header);
  const std::size_t row = 3 * static_cast<std::size_t>(field.header.num_components());
  std::vector<std::array<float, 3>> means(field.num_points());
  parallel_ranges(means.size(), kPointsPerRange, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      std::array<double, 3> rgb{};
      for (const Part& part : parts) {
        const std::int32_t* component = &field.components[p * row + 3 * part.r];
        for (std::size_t c = 0; c < 3; ++c)
          for (std::size_t d = 0; d < 3; ++d) rgb[c] += part.to_rgb[c][d] * component[d];
      }
      for (std::size_t c = 0; c < 3; ++c)
        means[p][c] = std::clamp(static_cast<float>(rgb[c]), 0.0f, 255.0f);
    }
  });
  return means;
}

}  // namespace slf
