// SPDX-License-Identifier: Apache-2.0
// A sphere coded as a base and slices.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <span>
#include <string>

#include "field_support.h"
#include "slf/decoder.h"
#include "slf/encoder.h"

namespace slf {

inline std::string start_name(SliceStart start) {
  constexpr const char* kNames[] = {"shared", "from_base", "apart"};
  return kNames[static_cast<std::size_t>(start)];
}
inline void PrintTo(SliceStart start, std::ostream* out) { *out << start_name(start); }

}  // namespace slf

namespace slf::test {

inline std::vector<std::uint8_t> packed(const LightField& field,
                                        const CodingParameters& parameters) {
  auto stream = pack(field, parameters);
  EXPECT_TRUE(stream) << (stream ? "" : stream.error().message);
  return stream ? *stream : std::vector<std::uint8_t>{};
}

inline LightField decoded(std::span<const std::uint8_t> stream, const DecodeOptions& options = {}) {
  auto field = decode(stream, options);
  EXPECT_TRUE(field) << (field ? "" : to_string(field.error()));
  return field ? *field : LightField{};
}

struct Shape {
  int base_levels;
  std::uint32_t slice_points;
  SliceStart start;
};

inline std::string name_of(const Shape& s) {
  return "base_" + (s.base_levels < 0 ? "auto" : std::to_string(s.base_levels)) + "_points_" +
         std::to_string(s.slice_points) + "_" + start_name(s.start);
}
inline void PrintTo(const Shape& shape, std::ostream* out) { *out << name_of(shape); }

inline CodingParameters parameters_of(const Shape& shape, int functions, std::uint32_t step) {
  CodingParameters p;
  p.step.assign(static_cast<std::size_t>(functions), {step, step, step});
  for (int k = 0; k < functions; ++k) p.group.push_back(k == 0 ? 0 : k < 3 ? 1 : 2);
  p.base_levels = shape.base_levels;
  p.max_slice_points = shape.slice_points;
  p.slice_start = shape.start;
  return p;
}

inline constexpr int kBits = 6, kFunctions = 5;

inline LightField sphere() {
  LightField field = test::make_field(test::sphere_cloud(kBits), kBits, kFunctions);
  field.normals.bits = 6;
  for (std::size_t p = 0; p < field.num_points(); ++p)
    field.normals.octahedral.push_back(
        {static_cast<std::uint16_t>(p / 3 % 64), static_cast<std::uint16_t>(p % 64)});
  return field;
}

/// Several slices and more than one level range above and below the base.
inline std::vector<std::uint8_t> scene(SliceStart start, bool normals = true) {
  LightField field = sphere();
  if (!normals) field.normals = {};
  CodingParameters p = parameters_of({3, 1500, start}, kFunctions, 12);
  p.geometry_level_ends = {2, 5, 6};
  p.coefficient_level_ends = {2, 5, 6};
  return packed(field, p);
}

}  // namespace slf::test
