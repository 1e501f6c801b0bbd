// SPDX-License-Identifier: Apache-2.0
// Points with a shape and an opacity, as splats. Spec 6.8.
#include "slf/gaussians.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include "lightfield/float_origin.h"
#include "lightfield/gaussian_values.h"
#include "lightfield/symmetric3.h"
#include "lightfield/view_planes.h"
#include "slf/given_planes.h"
#include "slf/parallel.h"
#include "slf/view_map.h"

namespace slf {
namespace {

constexpr std::size_t kSplatsPerRange = 1024;
constexpr int kMostDegree = 4;
constexpr float kUnitTolerance = 0.01F;   // of a quaternion's square
constexpr double kMostCoordinate = 1e15;  // squares of differences stay finite in floats

/// Coefficients of harmonics on the unit sphere, towards the splat.
void put_harmonics(const PointValues& value, const Matrix3x3& to_rgb, int degree, float* out) {
  const double unit = std::sqrt(4 * std::numbers::pi) / 255;
  for (int l = 0, k = 0; l <= degree; ++l)
    for (; k < (l + 1) * (l + 1); ++k)
      for (std::size_t c = 0; c < 3; ++c) {
        double sum = k == 0 ? -127.5 : 0;
        for (std::size_t d = 0; d < 3; ++d) sum += to_rgb[c][d] * value(k, static_cast<int>(d));
        *out++ = static_cast<float>((l % 2 == 0 ? unit : -unit) * sum);
      }
}

InputError wrong(const std::string& what) { return {Errc::kInvalidInput, "splats: " + what}; }

Result<Done, InputError> check_count(const char* name, std::size_t count, std::size_t expected) {
  if (count == expected) return Done{};
  return wrong(std::string(name) + ": " + std::to_string(count) + " entries in place of " +
               std::to_string(expected));
}

/// @param values  [splats][n]
Result<Done, InputError> check_finite(const char* name, std::span<const float> values,
                                      std::size_t n) {
  const auto bad =
      std::find_if_not(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
  if (bad == values.end()) return Done{};
  return wrong(std::string(name) + ": splat " +
               std::to_string(std::size_t(bad - values.begin()) / n) +
               " has a value that is not finite");
}

template <std::size_t N>
std::span<const float> flat(const std::vector<std::array<float, N>>& rows) {
  return {rows.empty() ? nullptr : rows.front().data(), rows.size() * N};
}

/// Are all functions of an attribute there, and coded?
bool has_attribute(const LightFieldHeader& header, AttributeId id, int functions) {
  const int first = first_function(header, id);
  if (first >= header.num_functions) return false;
  const auto coded = [&](int k) {
    return header.coded.empty() ||
           std::binary_search(header.coded.begin(), header.coded.end(), std::uint16_t(k));
  };
  for (int k = first; k < first + functions; ++k)
    if (!coded(k)) return false;
  return true;
}

}  // namespace

Result<Done, InputError> check_gaussians(const Gaussians& g) {
  if (g.degree < 0 || g.degree > kMostDegree)
    return wrong("degree " + std::to_string(g.degree) + ", of 0 to 4");
  const std::size_t size = g.size(), of_harmonics = 3 * g.num_harmonics();
  SLF_CHECK(check_count("log_deviations", g.log_deviations.size(), size));
  SLF_CHECK(check_count("rotations", g.rotations.size(), size));
  SLF_CHECK(check_count("logits", g.logits.size(), size));
  SLF_CHECK(check_count("harmonics", g.harmonics.size(), size * of_harmonics));
  for (const double x : g.origin)
    if (!std::isfinite(x)) return wrong("origin: a value that is not finite");
  SLF_CHECK(check_finite("positions", flat(g.positions), 3));
  SLF_CHECK(check_finite("log_deviations", flat(g.log_deviations), 3));
  SLF_CHECK(check_finite("rotations", flat(g.rotations), 4));
  SLF_CHECK(check_finite("logits", g.logits, 1));
  SLF_CHECK(check_finite("harmonics", g.harmonics, of_harmonics));
  for (std::size_t p = 0; p < size; ++p) {
    float squares = 0;
    for (const float x : g.rotations[p]) squares += x * x;
    if (!(std::abs(squares - 1) <= kUnitTolerance))
      return wrong("rotations: that of splat " + std::to_string(p) + " is no unit quaternion");
  }
  return Done{};
}

bool has_gaussians(const LightFieldHeader& header) {
  return header.has_basis && header.basis.id == BasisId::kHarmonics &&
         header.basis.degree <= kMostDegree && header.directions == Directions::kWorld &&
         header.transfer == Transfer::kDisplay && has_attribute(header, AttributeId::kOpacity, 1) &&
         has_attribute(header, AttributeId::kShape, 2);
}

Result<Gaussians, InputError> gaussians_of(const LightField& field, int threads) {
  const LightFieldHeader& header = field.header;
  if (!has_gaussians(header))
    return InputError{Errc::kInvalidInput, "has no shape and opacity for every point"};
  const double reach = std::ldexp(header.grid.step, header.grid.bits);
  for (const double coordinate : header.grid.origin)
    if (!(std::abs(coordinate) + reach < kMostCoordinate))
      return InputError{Errc::kInvalidInput, "its splats lie beyond what floats hold"};
  const SplatFunctions functions = splat_functions(header);
  const std::vector<std::int32_t> planes = given_planes(field, threads);
  const std::vector<double> units = plane_units(header);
  const auto to_rgb = colour_matrix(header.colour);
  Gaussians out;
  out.degree = header.basis.degree;
  out.up = header.up;
  out.origin = float_origin(header.grid);
  const std::size_t points = field.num_points(), row = 3 * out.num_harmonics();
  out.positions.resize(points);
  out.log_deviations.resize(points);
  out.rotations.resize(points);
  out.logits.resize(points);
  out.harmonics.resize(points * row);
  parallel_ranges(points, kSplatsPerRange, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const PointValues value(units, &planes[p * 3 * units.size()]);
      const Vec3 at = header.grid.world(field.positions[p]);
      for (std::size_t i = 0; i < 3; ++i)
        out.positions[p][i] = static_cast<float>(at[i] - out.origin[i]);
      out.logits[p] = static_cast<float>(logit_of(value, functions));
      const Axes3 axes = shape_axes(header, value, functions);
      for (std::size_t i = 0; i < 3; ++i)
        out.log_deviations[p][i] = static_cast<float>(axes.value[i]);
      const auto turn = quaternion_of(axes.axis);
      for (std::size_t i = 0; i < 4; ++i) out.rotations[p][i] = static_cast<float>(turn[i]);
      put_harmonics(value, to_rgb, out.degree, &out.harmonics[p * row]);
    }
  });
  return out;
}

void keep_degree(Gaussians& gaussians, int degree) {
  const std::size_t from = 3 * gaussians.num_harmonics();
  gaussians.degree = std::min(gaussians.degree, degree);
  const std::size_t to = 3 * gaussians.num_harmonics();
  for (std::size_t p = 0; to < from && p < gaussians.size(); ++p)
    std::copy_n(gaussians.harmonics.begin() + static_cast<std::ptrdiff_t>(p * from), to,
                gaussians.harmonics.begin() + static_cast<std::ptrdiff_t>(p * to));
  gaussians.harmonics.resize(gaussians.size() * to);
}

}  // namespace slf
