// SPDX-License-Identifier: Apache-2.0
// Arrays of a decoded field, copied to the caller's.
#include <algorithm>
#include <array>
#include <cstring>

#include "bindings/c/failure.h"
#include "bindings/c/handles.h"
#include "bindings/c/sized.h"
#include "lightfield/directions.h"
#include "lightfield/view_planes.h"

namespace slf::capi {
namespace {

/// Where rows of `row` bytes go.
struct Rows {
  std::uint64_t first, count;
  void* to;
  std::size_t stride;
};

slf_code check_rows(const slf_field* field, const Rows& rows, std::size_t row, slf_error* error) {
  if (field == nullptr) return invalid(error, "field");
  const std::uint64_t points = field->field.num_points();
  if (rows.first > points || rows.count > points - rows.first) return invalid(error, "first");
  if (rows.stride != 0 && rows.stride < row) return invalid(error, "stride");
  if (rows.to == nullptr && rows.count > 0 && row > 0) return invalid(error, "to");
  return SLF_OK;
}

/// write(p, place) for every point.
template <class Write>
void each_row(const Rows& rows, std::size_t row, const Write& write) {
  auto* to = static_cast<char*>(rows.to);
  const std::size_t stride = rows.stride != 0 ? rows.stride : row;
  for (std::uint64_t i = 0; i < rows.count; ++i, to += stride)
    write(static_cast<std::size_t>(rows.first + i), to);
}

/// Copies rows of `source` ([P][width]).
template <class Value>
void copy_rows(const Rows& rows, const Value* source, std::size_t width) {
  const std::size_t bytes = width * sizeof(Value);
  if (bytes == 0) return;
  each_row(rows, bytes,
           [&](std::size_t p, char* to) { std::memcpy(to, source + p * width, bytes); });
}

const std::vector<std::array<float, 3>>& mirror_normals_of(const slf_field& field) {
  const LightFieldHeader& header = field.field.header;
  return field.mirror_normals.get([&] {
    return mirror_normals(header.has_basis ? header.directions : Directions::kWorld,
                          field.field.positions, header.normal_cell_log2, field.threads);
  });
}

const SurfelCloud& discs_of(const slf_field& field) {
  return field.discs.get([&] {
    return surfel_cloud(field.field.header.grid, field.field.positions, field.field.normals, 0,
                        field.threads);
  });
}

bool is_reflected(const slf_field& field) {
  return field.has_basis() && field.field.header.directions == Directions::kReflected;
}

/// W without working anything out.
std::size_t num_weights(const slf_field& field) {
  if (!field.has_basis()) return 0;
  const LightFieldHeader& header = field.field.header;
  return static_cast<std::size_t>(needs_view_planes(header) ? header.num_view_functions()
                                                            : header.num_components());
}

slf_shape shape_of(const slf_field& field) {
  const LightFieldHeader& header = field.field.header;
  slf_shape out{};
  out.components = static_cast<std::uint32_t>(header.num_components());
  out.points = field.field.num_points();
  out.levels = static_cast<std::uint32_t>(header.grid.bits);
  out.partial = field.field.partial;
  std::copy(header.grid.origin.begin(), header.grid.origin.end(), out.origin);
  out.step = header.grid.step;
  out.weights = static_cast<std::uint32_t>(num_weights(field));
  out.directions = static_cast<std::uint32_t>(header.directions);
  out.transfer = static_cast<std::uint32_t>(header.transfer);
  out.has_normals = field.field.normals.bits > 0;
  out.gamma_min = header.gamma_min_q7 / 127.0;
  out.gamma_max = header.gamma_max_q7 / 127.0;
  out.has_splats = field.has_splats();
  return out;
}

/// [count][width] floats of the discs.
template <class Source>
slf_code read_discs(const slf_field* field, const Rows& rows, std::size_t width, slf_error* error,
                    const Source& source) {
  if (const slf_code code = check_rows(field, rows, width * sizeof(float), error); code != SLF_OK)
    return code;
  if (!field->field.header.grid.fits_floats()) return invalid(error, "grid");
  return guarded(error, [&] {
    copy_rows(rows, source(discs_of(*field)), width);
    return slf_code{SLF_OK};
  });
}

/// [count][width] floats of the splats; `name` is the array's.
template <class Source>
slf_code read_splats(const slf_field* field, const Rows& rows, std::size_t width, const char* name,
                     slf_error* error, const Source& source) {
  if (const slf_code code = check_rows(field, rows, width * sizeof(float), error); code != SLF_OK)
    return code;
  if (!field->has_splats()) return invalid(error, name);
  if (!field->field.header.grid.fits_floats()) return invalid(error, "grid");
  return guarded(error, [&] {
    const SplatShapes& splats =
        field->splats.get([&] { return splat_shapes(field->field, field->threads); });
    copy_rows(rows, source(splats), width);
    return slf_code{SLF_OK};
  });
}

}  // namespace
}  // namespace slf::capi

using namespace slf::capi;

slf_code slf_get_shape(const slf_field* field, slf_shape* shape, slf_error* error) {
  if (field == nullptr) return invalid(error, "field");
  if (shape == nullptr) return invalid(error, "shape");
  give(shape_of(*field), shape);
  return SLF_OK;
}

slf_code slf_read_positions(const slf_field* field, uint64_t first, uint64_t count, uint32_t* to,
                            size_t stride, slf_error* error) {
  const Rows rows{first, count, to, stride};
  if (const slf_code code = check_rows(field, rows, sizeof(slf::Voxel), error); code != SLF_OK)
    return code;
  if (count > 0) copy_rows(rows, field->field.positions.data()->data(), 3);
  return SLF_OK;
}

slf_code slf_read_components(const slf_field* field, uint64_t first, uint64_t count, int32_t* to,
                             size_t stride, slf_error* error) {
  const Rows rows{first, count, to, stride};
  const std::size_t width =
      field != nullptr ? static_cast<std::size_t>(field->field.num_planes()) : 0;
  if (const slf_code code = check_rows(field, rows, width * sizeof(int32_t), error); code != SLF_OK)
    return code;
  copy_rows(rows, field->field.components.data(), width);
  return SLF_OK;
}

slf_code slf_read_octahedral(const slf_field* field, uint64_t first, uint64_t count, uint16_t* to,
                             size_t stride, slf_error* error) {
  const Rows rows{first, count, to, stride};
  if (const slf_code code = check_rows(field, rows, 2 * sizeof(uint16_t), error); code != SLF_OK)
    return code;
  if (field->field.normals.bits == 0) return invalid(error, "octahedral");
  if (count > 0) copy_rows(rows, field->field.normals.octahedral.data()->data(), 2);
  return SLF_OK;
}

slf_code slf_read_weights(const slf_field* field, uint64_t first, uint64_t count, float* to,
                          size_t stride, slf_error* error) {
  const Rows rows{first, count, to, stride};
  const std::size_t row = field != nullptr ? num_weights(*field) * 3 * sizeof(float) : 0;
  if (const slf_code code = check_rows(field, rows, row, error); code != SLF_OK) return code;
  if (row == 0) return invalid(error, "weights");
  return guarded(error, [&] {
    const slf::FunctionWeights& weights = field->function_weights();
    std::vector<float> values(row / sizeof(float));
    each_row(rows, row, [&](std::size_t p, char* place) {
      weights.weights(p, values.data());
      std::memcpy(place, values.data(), row);
    });
    return slf_code{SLF_OK};
  });
}

slf_code slf_read_mean_colours(const slf_field* field, uint64_t first, uint64_t count, uint8_t* to,
                               size_t stride, slf_error* error) {
  const Rows rows{first, count, to, stride};
  if (const slf_code code = check_rows(field, rows, 3, error); code != SLF_OK) return code;
  if (!field->has_basis()) return invalid(error, "mean_colours");
  return guarded(error, [&] {
    const auto means = slf::mean_colours(field->field, field->threads);
    each_row(rows, 3, [&](std::size_t p, char* place) {
      for (std::size_t c = 0; c < 3; ++c)
        place[c] = static_cast<char>(static_cast<std::uint8_t>(means[p][c] + 0.5f));
    });
    return slf_code{SLF_OK};
  });
}

slf_code slf_read_mirror_normals(const slf_field* field, uint64_t first, uint64_t count, float* to,
                                 size_t stride, slf_error* error) {
  const Rows rows{first, count, to, stride};
  if (const slf_code code = check_rows(field, rows, 3 * sizeof(float), error); code != SLF_OK)
    return code;
  if (!is_reflected(*field)) return invalid(error, "mirror_normals");
  return guarded(error, [&] {
    const auto& normals = mirror_normals_of(*field);
    if (count > 0) copy_rows(rows, normals.data()->data(), 3);
    return slf_code{SLF_OK};
  });
}

slf_code slf_read_disc_normals(const slf_field* field, uint64_t first, uint64_t count, float* to,
                               size_t stride, slf_error* error) {
  return read_discs(field, {first, count, to, stride}, 3, error, [](const slf::SurfelCloud& discs) {
    return discs.normals.empty() ? nullptr : discs.normals.data()->data();
  });
}

slf_code slf_read_disc_centres(const slf_field* field, uint64_t first, uint64_t count, float* to,
                               size_t stride, slf_error* error) {
  const Rows rows{first, count, to, stride};
  if (const slf_code code = check_rows(field, rows, 3 * sizeof(float), error); code != SLF_OK)
    return code;
  if (!field->field.header.grid.fits_floats()) return invalid(error, "grid");
  return guarded(error, [&] {
    const slf::Grid& grid = field->field.header.grid;
    const slf::SurfelCloud& discs = discs_of(*field);
    each_row(rows, 3 * sizeof(float), [&](std::size_t p, char* place) {
      std::array<float, 3> centre;
      for (std::size_t k = 0; k < 3; ++k)
        centre[k] = static_cast<float>((discs.centres[p][k] - grid.origin[k]) / grid.step);
      std::memcpy(place, centre.data(), sizeof centre);
    });
    return slf_code{SLF_OK};
  });
}

slf_code slf_read_disc_radii(const slf_field* field, uint64_t first, uint64_t count, float* to,
                             size_t stride, slf_error* error) {
  return read_discs(field, {first, count, to, stride}, 1, error,
                    [](const slf::SurfelCloud& discs) { return discs.radii.data(); });
}

slf_code slf_read_disc_areas(const slf_field* field, uint64_t first, uint64_t count, float* to,
                             size_t stride, slf_error* error) {
  return read_discs(field, {first, count, to, stride}, 1, error,
                    [](const slf::SurfelCloud& discs) { return discs.areas.data(); });
}

slf_code slf_read_splat_covariances(const slf_field* field, uint64_t first, uint64_t count,
                                    float* to, size_t stride, slf_error* error) {
  return read_splats(field, {first, count, to, stride}, 6, "splat_covariances", error,
                     [](const slf::SplatShapes& splats) -> const float* {
                       return splats.covariances.empty() ? nullptr
                                                         : splats.covariances.data()->data();
                     });
}

slf_code slf_read_splat_opacities(const slf_field* field, uint64_t first, uint64_t count, float* to,
                                  size_t stride, slf_error* error) {
  return read_splats(field, {first, count, to, stride}, 1, "splat_opacities", error,
                     [](const slf::SplatShapes& splats) { return splats.opacities.data(); });
}
