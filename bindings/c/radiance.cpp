// SPDX-License-Identifier: Apache-2.0
// Colours along directions, and the functions they are sums of.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "bindings/c/failure.h"
#include "bindings/c/handles.h"
#include "bindings/c/sized.h"
#include "lightfield/directions.h"
#include "lightfield/render/reference_kernel.h"
#include "slf/view_map.h"

namespace slf::capi {
namespace {

constexpr std::uint32_t kMostSide = 1024;

/// The direction at unit length; (1, 0, 0) for what has none.
Vec3 unit(const float* v) {
  const Vec3 d{double{v[0]}, double{v[1]}, double{v[2]}};
  const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  if (!(square > 0) || !std::isfinite(square)) return {1, 0, 0};
  const double scale = 1 / std::sqrt(square);
  return {d[0] * scale, d[1] * scale, d[2] * scale};
}

Vec3 to_frame_of(const slf_field& field, std::size_t p, const float* world) {
  const Vec3 direction = unit(world);
  const LightFieldHeader& header = field.field.header;
  if (!header.has_basis || header.directions == Directions::kWorld) return direction;
  const auto& normals = field.mirror_normals.get([&] {
    return mirror_normals(header.directions, field.field.positions, header.normal_cell_log2,
                          field.threads);
  });
  return mirrored(normals[p], direction);
}

/// The functions along the directions of a cube, in layers of four.
void fill_cube(const FunctionWeights& functions, std::uint32_t side, float* to) {
  const std::size_t size = functions.size(), layers = (size + 3) / 4;
  const std::size_t texels = std::size_t{side} * side;
  std::vector<float> row(functions.stride());
  for (std::size_t face = 0; face < 6; ++face)
    for (std::size_t i = 0; i < texels; ++i) {
      const auto place = [side](std::size_t n) {
        return 2.0 * static_cast<double>(n) / (side - 1) - 1;
      };
      functions.functions(cube_direction(face, place(i % side), place(i / side)), row.data());
      for (std::size_t r = 0; r < 4 * layers; ++r)
        to[(((r / 4) * 6 + face) * texels + i) * 4 + r % 4] = r < size ? row[r] : 0.0f;
    }
}

slf_code check_directions(const slf_field* field, const void* from, const void* to,
                          std::uint64_t count, slf_error* error) {
  if (field == nullptr) return invalid(error, "field");
  if (!field->has_basis()) return invalid(error, "functions");
  if (count > 0 && from == nullptr) return invalid(error, "directions");
  if (count > 0 && to == nullptr) return invalid(error, "to");
  return SLF_OK;
}

/// Are all directions of a length that is not 0? [count][3]
bool are_directions(const float* directions, std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i, directions += 3) {
    const float length = std::hypot(directions[0], directions[1], directions[2]);
    if (!(length > 0) || !std::isfinite(length)) return false;
  }
  return true;
}

}  // namespace
}  // namespace slf::capi

using namespace slf::capi;

slf_code slf_read_functions(const slf_field* field, uint64_t count, const float* directions,
                            float* to, size_t stride, slf_error* error) {
  if (const slf_code code = check_directions(field, directions, to, count, error); code != SLF_OK)
    return code;
  if (!are_directions(directions, count)) return invalid(error, "directions");
  return guarded(error, [&] {
    const slf::FunctionWeights& functions = field->function_weights();
    const std::size_t bytes = functions.size() * sizeof(float);
    if (stride != 0 && stride < bytes) return invalid(error, "stride");
    std::vector<float> row(functions.stride());
    auto* place = reinterpret_cast<char*>(to);
    for (std::uint64_t i = 0; i < count; ++i, place += stride != 0 ? stride : bytes) {
      functions.functions(unit(directions + 3 * i), row.data());
      std::memcpy(place, row.data(), bytes);
    }
    return slf_code{SLF_OK};
  });
}

slf_code slf_read_function_cube(const slf_field* field, uint32_t side, float* to, size_t capacity,
                                slf_error* error) {
  if (const slf_code code = check_directions(field, to, to, 1, error); code != SLF_OK) return code;
  if (side < 2 || side > kMostSide) return invalid(error, "side");
  return guarded(error, [&] {
    const slf::FunctionWeights& functions = field->function_weights();
    const std::uint64_t floats = (functions.size() + 3) / 4 * 24 * std::uint64_t{side} * side;
    if (floats > capacity) return invalid(error, "capacity");
    fill_cube(functions, side, to);
    return slf_code{SLF_OK};
  });
}

slf_code slf_local_direction(const slf_field* field, uint64_t p, const float* world, float* to,
                             slf_error* error) {
  if (field == nullptr) return invalid(error, "field");
  if (world == nullptr) return invalid(error, "world");
  if (to == nullptr) return invalid(error, "to");
  if (p >= field->field.num_points()) return invalid(error, "p");
  if (!are_directions(world, 1)) return invalid(error, "world");
  return guarded(error, [&] {
    const slf::Vec3 v = to_frame_of(*field, static_cast<std::size_t>(p), world);
    for (std::size_t k = 0; k < 3; ++k) to[k] = static_cast<float>(v[k]);
    return slf_code{SLF_OK};
  });
}

slf_code slf_read_radiance(const slf_field* field, uint64_t count, const uint32_t* points,
                           const float* directions, float* to, slf_error* error) {
  if (const slf_code code = check_directions(field, directions, to, count, error); code != SLF_OK)
    return code;
  if (count > 0 && points == nullptr) return invalid(error, "points");
  const bool known = std::all_of(points, points + count,
                                 [&](uint32_t p) { return p < field->field.num_points(); });
  if (!known) return invalid(error, "points");
  if (!are_directions(directions, count)) return invalid(error, "directions");
  return guarded(error, [&] {
    const slf::FunctionWeights& source = field->function_weights();
    std::vector<float> row(source.stride()), weights(3 * source.size());
    for (std::uint64_t i = 0; i < count; ++i) {
      source.functions(to_frame_of(*field, points[i], directions + 3 * i), row.data());
      source.weights(points[i], weights.data());
      for (std::size_t c = 0; c < 3; ++c) {
        float sum = 0;
        for (std::size_t r = 0; r < source.size(); ++r) sum += row[r] * weights[3 * r + c];
        to[3 * i + c] = std::clamp(sum, 0.0f, 255.0f);
      }
    }
    return slf_code{SLF_OK};
  });
}

slf_code slf_get_kernel(slf_kernel* kernel, slf_error* error) {
  if (kernel == nullptr) return invalid(error, "kernel");
  const slf::ReferenceKernel& k = slf::kReferenceKernel;
  slf_kernel out{};
  out.version = k.version;
  out.filter_pixels = k.filter_pixels;
  out.exponent = k.exponent;
  out.spacing_reach = k.spacing_reach;
  out.least_reach = k.least_reach;
  out.most_reach = k.most_reach;
  out.smallest = k.smallest;
  out.core = k.core;
  out.band = k.band;
  out.steepest = k.steepest;
  out.flattest = k.flattest;
  out.disc_share = k.disc_share;
  out.density_gain = k.density_gain;
  out.density_offset = k.density_offset;
  give(out, kernel);
  return SLF_OK;
}
