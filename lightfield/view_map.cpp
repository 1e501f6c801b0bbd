// SPDX-License-Identifier: Apache-2.0
#include "slf/view_map.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "lightfield/component_colours.h"
#include "lightfield/directions.h"
#include "lightfield/function_table.h"
#include "lightfield/harmonics.h"
#include "lightfield/nodes.h"
#include "lightfield/view_planes.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kMapsPerRange = 512;

/// The components are the coefficients of all harmonics up to a degree, or -1.
int degree_of_components(const LightFieldHeader& header) {
  if (header.basis.id != BasisId::kHarmonics || !header.transforms.empty()) return -1;
  const int count = header.num_components();
  int degree = 0;
  while ((degree + 1) * (degree + 1) < count) ++degree;
  const bool all = (degree + 1) * (degree + 1) == count;
  return all && (header.coded.empty() || header.coded.back() + 1 == count) ? degree : -1;
}

std::array<float, 3> clamp_to_display(std::array<float, 3> rgb) {
  for (float& c : rgb) c = std::clamp(c, 0.0f, 255.0f);
  return rgb;
}

}  // namespace

Result<ViewMaps, InputError> ViewMaps::of(const LightField& light_field, int threads) {
  const LightFieldHeader& header = light_field.header;
  if (!header.has_basis || header.num_view_functions() != header.basis.num_functions())
    return InputError{Errc::kInvalidArgument, "view maps: the light field has no basis"};
  const std::size_t planes = 3 * static_cast<std::size_t>(header.num_components());
  if (light_field.components.size() != light_field.num_points() * planes)
    return InputError{Errc::kInvalidArgument, "view maps: components are not those of the points"};
  return ViewMaps(light_field, threads);
}

ViewMaps::ViewMaps(const LightField& light_field, int threads)
    : ViewMaps(light_field,
               mirror_normals(light_field.header.directions, light_field.positions,
                              light_field.header.normal_cell_log2, threads),
               threads) {}

ViewMaps::ViewMaps(const LightField& light_field, std::vector<std::array<float, 3>> mirror_normals,
                   int threads)
    : header_(light_field.header),
      positions_(light_field.positions),
      normals_(light_field.normals),
      mirror_normals_(std::move(mirror_normals)),
      mean_(mean_colours(light_field, threads)) {
  assert(header_.has_basis && header_.num_view_functions() == header_.basis.num_functions());
  std::span<const std::int32_t> components = light_field.components;
  std::vector<std::int32_t> planes;
  if (needs_view_planes(header_)) {
    components = planes = view_planes(light_field, threads);
    header_ = view_header(std::move(header_));
  }
  const auto coded = static_cast<std::size_t>(header_.num_components());
  const bool spline = header_.basis.id == BasisId::kBspline && header_.transforms.empty();
  width_ = spline ? static_cast<std::size_t>(header_.num_functions) : coded;
  if (const int degree = degree_of_components(header_); degree >= 0) {
    harmonics_ = std::make_shared<const Harmonics>(degree);
  } else if (!spline) {
    table_ = std::make_shared<const FunctionTable>(header_, threads);
  }
  const NodeMap<float> map(spline ? header_.basis : Basis{BasisId::kBspline, 2, 0, 0});
  const ComponentColours colours(header_, table_ == nullptr);
  assert(components.size() == num_points() * 3 * coded);
  nodes_.resize(num_points() * 3 * width_);
  parallel_ranges(num_points(), kMapsPerRange, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<float> rgb(3 * coded), coefficients(3 * width_), scratch(3 * width_);
    for (std::size_t p = begin; p < end; ++p) {
      float* nodes = nodes_.data() + p * 3 * width_;
      colours.apply(components.data() + p * 3 * coded, rgb.data());
      if (spline) {
        for (std::size_t r = 0; r < coded; ++r)
          std::copy_n(&rgb[3 * r], 3,
                      &coefficients[3 * (header_.coded.empty() ? r : header_.coded[r])]);
        map.to_nodes(coefficients.data(), nodes, scratch.data());
      } else {
        for (std::size_t r = 0; r < coded; ++r)
          for (std::size_t c = 0; c < 3; ++c) nodes[c * coded + r] = rgb[3 * r + c];
      }
    }
  });
}

std::array<float, 3> ViewMaps::radiance(std::size_t p, float theta, float gamma) const {
  const float low = static_cast<float>(header_.gamma_min_q7) / 127.0f;
  const float high = static_cast<float>(header_.gamma_max_q7) / 127.0f;
  auto direction = to_local(mirror_normals_, p, {theta, gamma});
  direction[1] = std::min(std::max(direction[1], low), high);
  return clamp_to_display(sum_of_functions(p, direction));
}

std::array<float, 3> ViewMaps::radiance_unclamped(std::size_t p, float theta, float gamma) const {
  return sum_of_functions(p, to_local(mirror_normals_, p, {theta, gamma}));
}

std::array<float, 3> ViewMaps::sum_of_functions(std::size_t p,
                                                const std::array<float, 2>& direction) const {
  std::array<float, 3> rgb{0, 0, 0};
  const float* nodes = nodes_.data() + p * 3 * width_;
  if (harmonics_ || table_) {
    std::array<float, 4096 + 8> row;  // K at most, and what FunctionTable adds
    if (table_ && header_.basis.id == BasisId::kHarmonics) {
      const Vec3 v = vector_of(direction);
      table_->look_up({float(v[0]), float(v[1]), float(v[2])}, row.data());
    } else if (table_) {
      table_->evaluate(direction, row.data());
    } else {
      harmonics_->evaluate(vector_of(direction), row.data());
    }
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t r = 0; r < width_; ++r) rgb[c] += row[r] * nodes[c * width_ + r];
    return rgb;
  }
  const NodeTaps taps = node_taps(header_.basis, static_cast<double>(direction[0]),
                                  static_cast<double>(direction[1]));
  for (std::size_t t = 0; t < taps.count; ++t) {
    const auto weight = static_cast<float>(taps.weight[t]);
    for (std::size_t c = 0; c < 3; ++c) rgb[c] += weight * nodes[3 * taps.node[t] + c];
  }
  return rgb;
}

std::array<float, 3> ViewMaps::mean(std::size_t p) const { return mean_[p]; }

}  // namespace slf
