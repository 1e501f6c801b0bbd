// SPDX-License-Identifier: Apache-2.0
// Small light fields that move, and streams of them.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <ostream>
#include <string>

#include "codec/split_frames.h"
#include "field_support.h"
#include "slf/frames.h"
#include "tests/fuzz/fuzz.h"

namespace slf::test {

using Bytes = std::vector<std::uint8_t>;

inline constexpr int kFrameBits = 6, kFrameFunctions = 4;

enum class Moves { kNothing, kShift, kTurn, kBend, kChance, kAppears };

inline std::string name_of(Moves m) {
  constexpr const char* kNames[] = {"nothing", "shift", "turn", "bend", "chance", "appears"};
  return kNames[static_cast<std::size_t>(m)];
}
inline void PrintTo(Moves m, std::ostream* out) { *out << name_of(m); }

/// Where a voxel of the first frame is in another.
inline Voxel moved(const Voxel& v, Moves how, int frame) {
  const double side = 1 << kFrameBits, x = v[0] - side / 2, y = v[1] - side / 2, t = frame;
  std::array<double, 3> p{double(v[0]), double(v[1]), double(v[2])};
  if (how == Moves::kShift) p = {v[0] + 2.0 * t, v[1] - t, v[2] + t};
  if (how == Moves::kTurn)
    p = {side / 2 + std::cos(0.08 * t) * x - std::sin(0.08 * t) * y,
         side / 2 + std::sin(0.08 * t) * x + std::cos(0.08 * t) * y, double(v[2])};
  if (how == Moves::kBend) p = {v[0] + t * std::sin(v[2] / 12.0), double(v[1]), double(v[2])};
  Voxel to;
  for (std::size_t i = 0; i < 3; ++i)
    to[i] = std::clamp(static_cast<std::int32_t>(std::lround(p[i])), 0, (1 << kFrameBits) - 1);
  return to;
}

/// Half of a sphere in the middle, and its colours, at an instant.
inline LightField frame_of(Moves how, int frame, int functions = kFrameFunctions) {
  std::vector<Voxel> first;
  for (const Voxel& v : sphere_cloud(5))
    if (v[2] < 24 && (how != Moves::kAppears || (v[0] + frame) % 4 != 0))
      first.push_back({v[0] + 16, v[1] + 16, v[2] + 16});
  if (how == Moves::kChance)
    first = random_cloud(600, kFrameBits, static_cast<std::uint32_t>(frame) + 9);
  const auto components = smooth_components(first, functions, 1000, 7);
  std::map<std::uint64_t, std::size_t> at;
  for (std::size_t i = 0; i < first.size(); ++i) at[morton(moved(first[i], how, frame))] = i;
  LightField field = make_field({}, kFrameBits, functions);
  const std::size_t planes = 3 * static_cast<std::size_t>(functions);
  for (const auto& [code, i] : at) {
    field.positions.push_back(from_morton(code));
    const auto row = components.begin() + static_cast<std::ptrdiff_t>(i * planes);
    field.components.insert(field.components.end(), row, row + static_cast<std::ptrdiff_t>(planes));
  }
  return field;
}

inline LightField with_normals(LightField field) {
  field.normals.bits = 5;
  for (std::size_t p = 0; p < field.num_points(); ++p)
    field.normals.octahedral.push_back(
        {static_cast<std::uint16_t>(p % 32), static_cast<std::uint16_t>(p / 7 % 32)});
  return field;
}

/// Three groups of functions, units of several levels.
inline CodingParameters frame_parameters(std::uint32_t step, int functions = kFrameFunctions) {
  CodingParameters p;
  p.step.assign(static_cast<std::size_t>(functions), {step, step, step});
  for (int k = 0; k < functions; ++k) p.group.push_back(k == 0 ? 0 : k < 3 ? 1 : 2);
  p.geometry_level_ends = {3, 5, 6};
  p.coefficient_level_ends = {2, 5, 6};
  p.threads = 1;
  return p;
}

/// The bytes of every frame.
inline std::vector<Bytes> coded_frames(const std::vector<LightField>& fields,
                                       const CodingParameters& parameters, int group = 16) {
  FrameEncoder encoder(parameters, group);
  std::vector<Bytes> frames;
  for (std::size_t t = 0; t < fields.size(); ++t) {
    auto bytes = encoder.add(fields[t], 0.5 + static_cast<double>(t) / 30);
    EXPECT_TRUE(bytes) << (bytes ? "" : bytes.error().message);
    frames.push_back(bytes ? *bytes : Bytes{});
  }
  return frames;
}

inline Bytes joined(const std::vector<Bytes>& frames) {
  Bytes all;
  for (const Bytes& frame : frames) all.insert(all.end(), frame.begin(), frame.end());
  return all;
}

inline std::vector<LightField> fields_of(Moves how, int frames, int functions = kFrameFunctions) {
  std::vector<LightField> fields;
  for (int t = 0; t < frames; ++t) fields.push_back(frame_of(how, t, functions));
  return fields;
}

/// The same with harmonics of degree 0: they can be drawn.
inline std::vector<LightField> drawn_fields_of(Moves how, int frames) {
  std::vector<LightField> fields = fields_of(how, frames, 1);
  for (LightField& field : fields) {
    field.header.has_basis = true;
    field.header.basis.id = BasisId::kHarmonics;
    field.header.basis.degree = 0;
  }
  return fields;
}

inline FrameDecoder opened(const Bytes& stream, const DecodeOptions& options = {}) {
  auto decoder = FrameDecoder::open(stream, options);
  EXPECT_TRUE(decoder) << (decoder ? "" : to_string(decoder.error()));
  return *std::move(decoder);
}

inline LightField decoded_frame(FrameDecoder& decoder, std::size_t frame) {
  auto field = decoder.decode(frame);
  EXPECT_TRUE(field) << frame << (field ? "" : to_string(field.error()));
  return field ? *field : LightField{};
}

inline void expect_same(const LightField& a, const LightField& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.components, b.components);
  EXPECT_EQ(a.normals.octahedral, b.normals.octahedral);
  EXPECT_EQ(a.partial, b.partial);
}

}  // namespace slf::test
