// SPDX-License-Identifier: Apache-2.0
// PLY of splats: scales as logarithms, opacity as a logit, quaternions w first, harmonics channel
// by channel (Kerbl et al. 2023, scene/gaussian_model.py). Variants: names that other trainers use,
// colours of bytes in place of harmonics, two scales of a disc (Huang et al. 2024), and the filter
// that Yu et al. 2024 (mip-splatting) keep beside size and opacity.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/vec3.h"
#include "capture/exact_positions.h"
#include "lightfield/splats/gaussian_readers.h"
#include "lightfield/splats/ply_rows.h"

namespace slf {
namespace {

constexpr float kFlat = 5;  // exp(-5) of the lesser radius: what a disc without thickness gets

/// Where a splat's values are in a row.
struct Columns {
  std::array<std::size_t, 3> position{}, colour{};
  std::array<std::size_t, 4> rotation{};
  std::vector<std::size_t> scales;  // 2 or 3
  std::vector<std::size_t> rest;    // channel by channel
  std::size_t opacity = 0;
  std::optional<std::size_t> filter;
  bool harmonic_colour = true;  // else of bytes, or of 0 .. 1
  float colour_scale = 1;
  int degree = 0;
};

/// All of a list of columns, each of several names; false where one is missing.
template <std::size_t N>
bool find(const PlyElement& vertex, const std::array<std::initializer_list<std::string>, N>& names,
          std::array<std::size_t, N>& out) {
  for (std::size_t i = 0; i < N; ++i) {
    const auto column = column_of(vertex, names[i]);
    if (!column) return false;
    out[i] = *column;
  }
  return true;
}

/// Everything but what is of degree 1 and more.
std::optional<Columns> columns_of(const PlyElement& vertex) {
  Columns to;
  if (!find<3>(vertex, {{{"x"}, {"y"}, {"z"}}}, to.position)) return std::nullopt;
  if (!find<4>(vertex,
               {{{"rot_0", "rotation_0", "rot_w", "qw"},
                 {"rot_1", "rotation_1", "rot_x", "qx"},
                 {"rot_2", "rotation_2", "rot_y", "qy"},
                 {"rot_3", "rotation_3", "rot_z", "qz"}}},
               to.rotation))
    return std::nullopt;
  for (const auto& names : {std::initializer_list<std::string>{"scale_0", "scaling_0", "scale_x"},
                            {"scale_1", "scaling_1", "scale_y"},
                            {"scale_2", "scaling_2", "scale_z"}})
    if (const auto column = column_of(vertex, names)) to.scales.push_back(*column);
  const auto opacity = column_of(vertex, {"opacity", "opacity_0", "opacities"});
  if (to.scales.size() < 2 || !opacity) return std::nullopt;
  to.opacity = *opacity;
  to.filter = column_of(vertex, {"filter_3D"});
  if (find<3>(
          vertex,
          {{{"f_dc_0", "features_dc_0"}, {"f_dc_1", "features_dc_1"}, {"f_dc_2", "features_dc_2"}}},
          to.colour))
    return to;
  to.harmonic_colour = false;
  if (!find<3>(vertex, {{{"red", "r"}, {"green", "g"}, {"blue", "b"}}}, to.colour))
    return std::nullopt;
  if (vertex.properties[to.colour[0]].type == PlyType::kUint8) to.colour_scale = 1.0f / 255;
  return to;
}

bool is_numbered(std::string_view name, std::string_view of) {
  return name.starts_with(of) && name.size() > of.size() &&
         name.find_first_not_of("0123456789", of.size()) == name.npos;
}

/// Columns of higher degrees, which are numbered without a gap.
Result<Done, InputError> find_rest(const std::string& name, const PlyElement& vertex, Columns& to) {
  for (;;) {
    const std::string number = std::to_string(to.rest.size());
    const auto column = column_of(vertex, {"f_rest_" + number, "features_rest_" + number});
    if (!column) break;
    to.rest.push_back(*column);
  }
  for (const PlyProperty& property : vertex.properties)
    for (const std::string_view of : {"f_rest_", "features_rest_"})
      if (is_numbered(property.name, of) &&
          std::strtoull(property.name.c_str() + of.size(), nullptr, 10) >= to.rest.size())
        return InputError{Errc::kInvalidInput,
                          std::string(name)
                              .append(": PLY element 'vertex' has the property ")
                              .append(property.name)
                              .append(", and no ")
                              .append(of)
                              .append(std::to_string(to.rest.size()))};
  to.degree = to.rest.size() % 3 == 0 ? degree_of_rest(to.rest.size() / 3) : -1;
  if (to.degree < 0)
    return InputError{Errc::kInvalidInput, name + ": PLY element 'vertex' has " +
                                               std::to_string(to.rest.size()) +
                                               " properties f_rest_: 0, 9, 24, 45 or 72 are "
                                               "expected"};
  return Done{};
}

/// Yu et al. 2024: a splat is widened by the filter and loses opacity in proportion.
void widen(float filter, RawGaussian& raw) {
  float lost = 0;  // logarithm of the volume before, over that after
  for (float& size : raw.log_deviations) {
    const float square = std::exp(2 * size), wider = square + filter * filter;
    lost += 0.5f * (std::log(square) - std::log(wider));
    size = 0.5f * std::log(wider);
  }
  raw.logit = logit_of(std::exp(lost) / (1 + std::exp(-raw.logit)));
}

Vec3 place_of(const Columns& from, std::span<const double> row) {
  return {row[from.position[0]], row[from.position[1]], row[from.position[2]]};
}

/// From where floats keep the digits of a file of doubles.
Result<Vec3, InputError> origin_of(const PlyRows& rows, const PlyElement& vertex,
                                   const Columns& from) {
  if (vertex.properties[from.position[0]].type != PlyType::kDouble) return Vec3{0, 0, 0};
  std::vector<Vec3> places;
  SLF_CHECK(rows.for_each(vertex, [&](std::span<const double> row) {
    const Vec3 at = place_of(from, row);
    if (std::all_of(at.begin(), at.end(), [](double x) { return std::isfinite(float(x)); }))
      places.push_back(at);
  }));
  PointCloud cloud;
  set_positions(places, cloud);
  return cloud.origin;
}

/// One row.
void take_row(const Columns& from, std::span<const double> row, const Vec3& origin,
              std::vector<float>& harmonics, GaussianCollector& to) {
  const auto at = [&](std::size_t column) { return static_cast<float>(row[column]); };
  RawGaussian raw;
  raw.position = to_float(minus(place_of(from, row), origin));
  for (std::size_t k = 0; k < from.scales.size(); ++k) raw.log_deviations[k] = at(from.scales[k]);
  if (from.scales.size() == 2)
    raw.log_deviations[2] = std::min(raw.log_deviations[0], raw.log_deviations[1]) - kFlat;
  for (std::size_t k = 0; k < 4; ++k) raw.rotation[k] = at(from.rotation[k]);
  raw.logit = at(from.opacity);
  if (from.filter) widen(at(*from.filter), raw);
  const std::size_t rest = from.rest.size() / 3;
  for (std::size_t c = 0; c < 3; ++c) {
    const float colour = at(from.colour[c]);
    harmonics[c] = from.harmonic_colour ? colour : harmonic_of_colour(from.colour_scale * colour);
    for (std::size_t k = 0; k < rest; ++k) harmonics[3 * (k + 1) + c] = at(from.rest[c * rest + k]);
  }
  to.add(raw, harmonics);
}

}  // namespace

bool is_gaussian_ply(FileBytes head, std::uint64_t size) {
  if (head.size() < 4 || head[0] != 'p' || head[1] != 'l' || head[2] != 'y') return false;
  const auto header = parse_ply_header("", head, size);
  if (!header) return false;
  for (const PlyElement& element : header->elements)
    if (element.name == "vertex") return columns_of(element).has_value();
  return false;
}

Result<GaussianFile, InputError> read_gaussian_ply(const std::string& name, FileBytes bytes) {
  SLF_TRY(const PlyRows rows, PlyRows::open(name, bytes));
  const PlyElement* vertex = rows.element("vertex");
  auto columns = vertex == nullptr ? std::nullopt : columns_of(*vertex);
  if (!columns)
    return InputError{Errc::kInvalidInput,
                      name +
                          ": PLY without the properties of splats: x, y, z, f_dc_0 to 2, "
                          "opacity, scale_0 to 2, rot_0 to 3"};
  SLF_CHECK(find_rest(name, *vertex, *columns));
  SLF_TRY(const Vec3 origin, origin_of(rows, *vertex, *columns));
  GaussianCollector collector(columns->degree, UpAxis::kMinusY,
                              static_cast<std::size_t>(vertex->count));
  std::vector<float> harmonics(columns->rest.size() + 3);
  SLF_CHECK(rows.for_each(*vertex, [&](std::span<const double> row) {
    take_row(*columns, row, origin, harmonics, collector);
  }));
  SLF_TRY(GaussianFile file, std::move(collector).take(name, "PLY"));
  file.gaussians.origin = origin;
  return file;
}

}  // namespace slf
