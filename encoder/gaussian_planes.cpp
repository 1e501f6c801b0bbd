// SPDX-License-Identifier: Apache-2.0
#include "encoder/gaussian_planes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "base/input_error.h"
#include "encoder/component_planes.h"
#include "geometry/morton.h"
#include "lightfield/symmetric3.h"
#include "slf/parallel.h"
#include "slf/view_map.h"

namespace slf {
namespace {

constexpr std::size_t kSplatGrain = 1024;
constexpr int kMostBits = 21;

/// Ascending codes made different: a repeated one moves up to the next that is free, and at the end
/// of the grid down. False: the grid has fewer voxels.
bool spread(std::vector<std::uint64_t>& codes, int bits) {
  const std::uint64_t voxels = std::uint64_t{1} << 3 * bits;
  if (codes.size() > voxels) return false;
  for (std::size_t i = 1; i < codes.size(); ++i) codes[i] = std::max(codes[i], codes[i - 1] + 1);
  std::uint64_t most = voxels - 1;
  for (std::size_t i = codes.size(); i-- > 0 && codes[i] > most; --most) codes[i] = most;
  return true;
}

/// The planes of one splat, all K.
void put_planes(const Gaussians& splats, std::size_t p, std::int32_t* to) {
  const double unit = std::ldexp(255 / std::sqrt(4 * std::numbers::pi), kHarmonicsShift);
  const auto rounded = [](double value) {
    constexpr double kMost = 1 << 26;
    return static_cast<std::int32_t>(std::lround(std::clamp(value, -kMost, kMost)));
  };
  const auto to_rgb = colour_matrix(ColourTransform::kOpponent);  // orthonormal
  const float* harmonics = &splats.harmonics[p * 3 * splats.num_harmonics()];
  for (int l = 0, k = 0; l <= splats.degree; ++l)
    for (; k < (l + 1) * (l + 1); ++k, harmonics += 3)
      for (std::size_t d = 0; d < 3; ++d) {
        double sum = 0;
        for (std::size_t c = 0; c < 3; ++c)
          sum += to_rgb[c][d] * ((l % 2 == 0 ? unit : -unit) * double{harmonics[c]} +
                                 (k == 0 ? std::ldexp(127.5, kHarmonicsShift) : 0.0));
        *to++ = rounded(sum);
      }
  *to++ = rounded(
      std::ldexp(std::clamp(double{splats.logits[p]}, -kLogitBound, kLogitBound), kOpacityShift));
  *to++ = 0;
  *to++ = 0;
  Axes3 axes{rotation_of(splats.rotations[p]), {}};
  for (std::size_t i = 0; i < 3; ++i)
    axes.value[i] =
        std::clamp(double{splats.log_deviations[p][i]}, -kShapeBound / 2, kShapeBound / 2);
  for (const double value : shape_values(matrix_of(axes)))
    *to++ = rounded(std::ldexp(value, kShapeShift));
}

}  // namespace

std::vector<std::uint64_t> codes_of(const Gaussians& splats, const Grid& grid) {
  std::vector<std::uint64_t> codes(splats.size());
  for (std::size_t p = 0; p < codes.size(); ++p) {
    Voxel v;
    for (std::size_t k = 0; k < 3; ++k)
      v[k] = static_cast<std::int32_t>(
          std::clamp(std::lround((double{splats.positions[p][k]} - grid.origin[k]) / grid.step), 0L,
                     (1L << grid.bits) - 1));
    codes[p] = morton(v);
  }
  return codes;
}

std::array<Vec3, 2> bounds_of(const Gaussians& splats) {
  Vec3 low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const auto& at : splats.positions)
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], double{at[k]});
      high[k] = std::max(high[k], double{at[k]});
    }
  return {low, high};
}

Result<Done, InputError> check_drawn(const Grid& grid) {
  if (grid.fits_floats()) return Done{};
  return invalid_input("splats: beyond 1e12, or all within 1e-12: no picture can be drawn");
}

Result<Grid, InputError> grid_around(const std::array<Vec3, 2>& bounds, double step,
                                     std::size_t splats) {
  const auto& [low, high] = bounds;
  double extent = 0;
  for (std::size_t k = 0; k < 3; ++k) extent = std::max(extent, high[k] - low[k]);
  if (!std::isfinite(extent)) return invalid_input("splats: their extent is not finite");
  Grid grid{low, std::max(step, extent / ((1 << kMostBits) - 1)), 1};
  if (!(grid.step > 0)) grid.step = 1;
  while ((1 << grid.bits) - 1 < std::lround(extent / grid.step)) ++grid.bits;
  SLF_CHECK(check_drawn(grid));
  while (std::uint64_t{1} << 3 * grid.bits < splats) ++grid.bits;
  return grid;
}

LightFieldHeader header_of_splats(const Grid& grid, int degree, UpAxis up) {
  LightFieldHeader header;
  header.grid = grid;
  header.basis = {BasisId::kHarmonics, 2, 0, 0, degree};
  header.colour = ColourTransform::kOpponent;
  header.up = up;
  header.attributes = {{AttributeId::kOpacity, 1}, {AttributeId::kShape, 2}};
  const int harmonics = header.basis.num_functions();
  header.num_functions = harmonics + 3;
  header.shift.assign(static_cast<std::size_t>(harmonics), kHarmonicsShift);
  header.shift.insert(header.shift.end(), {kOpacityShift, kShapeShift, kShapeShift});
  return header;
}

Result<LightField, InputError> light_field_on(const Gaussians& splats, const Grid& grid,
                                              int threads) {
  LightField field;
  field.header = header_of_splats(grid, splats.degree, splats.up);
  std::vector<std::uint64_t> codes = codes_of(splats, grid);
  std::vector<std::uint32_t> order(splats.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
  std::sort(codes.begin(), codes.end());
  if (!spread(codes, grid.bits))
    return invalid_input("splats: there are more than the grid has voxels");
  field.positions.reserve(codes.size());
  for (const std::uint64_t code : codes) field.positions.push_back(from_morton(code));
  const std::size_t row = 3 * static_cast<std::size_t>(field.header.num_functions);
  field.components.resize(splats.size() * row);
  parallel_ranges(splats.size(), kSplatGrain, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      put_planes(splats, order[p], &field.components[p * row]);
  });
  return field;
}

Result<LightField, InputError> light_field_of(const Gaussians& splats, double step, int threads) {
  if (splats.size() == 0) return invalid_input("splats: there are none");
  SLF_TRY(const Grid grid, grid_around(bounds_of(splats), step, splats.size()));
  return light_field_on(splats, grid, threads);
}

}  // namespace slf
