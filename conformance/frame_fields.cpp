// SPDX-License-Identifier: Apache-2.0
#include "conformance/frame_fields.h"

#include <algorithm>
#include <utility>

#include "conformance/fields.h"

namespace slf::conformance {
namespace {

constexpr int kBits = kFrameBits;
constexpr std::int32_t kOne = 1 << Motion::kMatrixBits;

/// Smooth, with some noise: levels predict levels, and frames frames.
std::vector<std::int32_t> smooth(const std::vector<Voxel>& voxels, int functions) {
  Random random(5);
  std::vector<std::int32_t> components;
  for (const Voxel& v : voxels)
    for (int k = 0; k < functions; ++k)
      for (int c = 0; c < 3; ++c) {
        const std::int32_t x = v[0] - 16, y = v[1] - 16, z = v[2] - 16;
        const auto noise = static_cast<std::int32_t>(random.below(33)) - 16;
        const std::int32_t wave = x * y * (7 + k) + 40 * (z + c) * (z - k) + 200 * x - 90 * c * y;
        components.push_back(wave / (1 + 2 * k) + noise);
      }
  return components;
}

}  // namespace

LightField frame_field(const std::function<Voxel(const Voxel&)>& to, int functions) {
  LightField all = field(sphere(kBits, 0, 6), kBits, functions);
  all.components = smooth(all.positions, functions);
  for (Voxel& v : all.positions) {
    v = to(v);
    for (auto& c : v) c = std::clamp(c, 0, (1 << kBits) - 1);
  }
  LightField made = all;
  made.positions = sorted(all.positions);
  made.components.clear();
  const std::size_t planes = 3 * static_cast<std::size_t>(functions);
  for (const Voxel& v : made.positions) {
    const auto i = std::find(all.positions.begin(), all.positions.end(), v) - all.positions.begin();
    const auto row = all.components.begin() + i * static_cast<std::ptrdiff_t>(planes);
    made.components.insert(made.components.end(), row, row + static_cast<std::ptrdiff_t>(planes));
  }
  return made;
}

LightField still(int functions) {
  return frame_field([](const Voxel& v) { return v; }, functions);
}

Voxel turned(const Voxel& v) { return {v[0] - (v[1] - 16) / 4, v[1] + (v[0] - 16) / 4 + 1, v[2]}; }

Motion turn() {
  Motion motion;
  motion.matrix[0][1] = kOne / 4;
  motion.matrix[1][0] = -kOne / 4;
  motion.shift = {1, -15, 2};
  return motion;
}

Voxel bent(const Voxel& v) { return {v[0] + (v[2] - 16) * (v[2] - 16) / 16, v[1], v[2]}; }

Motion lattice_motion(int log2, const std::array<std::int32_t, 3>& first,
                      const std::array<std::int32_t, 3>& size) {
  Motion motion;
  motion.lattice_log2 = log2;
  motion.lattice_first = first;
  motion.lattice_size = size;
  for (std::int32_t z = 0; z < size[2]; ++z)
    for (std::int32_t y = 0; y < size[1]; ++y)
      for (std::int32_t x = 0; x < size[0]; ++x) {
        const std::int32_t d = ((first[2] + z) << log2) - 16;
        motion.lattice.push_back({-(d * d / 4) * 4, 4 * (x % 3), -8 * (y % 2)});
      }
  return motion;
}

CodingParameters frame_parameters(int functions) {
  CodingParameters p = with_steps(functions, 30);
  for (int k = 0; k < functions; ++k) p.group.push_back(k == 0 ? 0 : 1);
  return p;
}

Case frame_case(const char* id, const char* purpose, const FrameWriter& writer,
                std::vector<std::string> clauses) {
  Case c = case_of_stream(id, purpose, std::move(clauses), writer.stream());
  c.frames = writer.frames().size();
  return c;
}

}  // namespace slf::conformance
