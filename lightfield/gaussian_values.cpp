// SPDX-License-Identifier: Apache-2.0
#include "lightfield/gaussian_values.h"

#include <algorithm>
#include <cmath>

#include "slf/gaussians.h"
#include "slf/given_planes.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kShapesPerRange = 1024;

/// Points that are spread evenly over a voxel have 1/12. Half of it closes gaps, and blurs little
/// of what stood alone: docs/decisions/074.
constexpr double kVoxelVariance = 1.0 / 24;

/// e^(2 L), in the order of rows.
std::array<float, 6> covariance_of(Axes3 axes) {
  for (double& value : axes.value) value = std::exp(2 * value);
  const Symmetric3 m = matrix_of(axes);
  std::array<float, 6> rows;
  for (std::size_t i = 0; i < 6; ++i) {
    constexpr std::array<std::size_t, 6> kFrom{0, 3, 4, 1, 5, 2};
    rows[i] = static_cast<float>(m[kFrom[i]]);
  }
  return rows;
}

}  // namespace

int first_function(const LightFieldHeader& header, AttributeId id) {
  int function = header.num_view_functions();
  for (const Attribute& attribute : header.attributes) {
    if (attribute.id == id) return function;
    function += attribute.num_functions;
  }
  return header.num_functions;
}

SplatFunctions splat_functions(const LightFieldHeader& header) {
  return {first_function(header, AttributeId::kOpacity),
          first_function(header, AttributeId::kShape)};
}

std::vector<double> plane_units(const LightFieldHeader& header) {
  std::vector<double> units(static_cast<std::size_t>(header.num_functions), 1);
  for (std::size_t k = 0; k < header.shift.size(); ++k)
    units[k] = std::ldexp(1.0, -header.shift[k]);
  return units;
}

double logit_of(const PointValues& value, const SplatFunctions& functions) {
  return std::clamp(value(functions.opacity, 0), -kLogitBound, kLogitBound);
}

Symmetric3 log_shape_of(const PointValues& value, const SplatFunctions& functions) {
  std::array<double, 6> v;
  for (int i = 0; i < 6; ++i)
    v[static_cast<std::size_t>(i)] =
        std::clamp(value(functions.shape + i / 3, i % 3), -kShapeBound, kShapeBound);
  return from_shape_values(v);
}

Axes3 shape_axes(const LightFieldHeader& header, const PointValues& value,
                 const SplatFunctions& functions) {
  Axes3 axes = eigen_axes(log_shape_of(value, functions));
  if (header.levels_left_out == 0) return axes;
  const double blur = kVoxelVariance * header.grid.step * header.grid.step;
  for (double& deviation : axes.value) deviation = 0.5 * std::log(std::exp(2 * deviation) + blur);
  return axes;
}

SplatShapes splat_shapes(const LightField& field, int threads) {
  const LightFieldHeader& header = field.header;
  const SplatFunctions functions = splat_functions(header);
  const std::vector<std::int32_t> planes = given_planes(field, threads);
  const std::vector<double> units = plane_units(header);
  const std::size_t points = field.num_points();
  SplatShapes out{std::vector<std::array<float, 6>>(points), std::vector<float>(points)};
  parallel_ranges(points, kShapesPerRange, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const PointValues value(units, &planes[p * 3 * units.size()]);
      out.covariances[p] = covariance_of(shape_axes(header, value, functions));
      out.opacities[p] = static_cast<float>(1 / (1 + std::exp(-logit_of(value, functions))));
    }
  });
  return out;
}

}  // namespace slf
