// SPDX-License-Identifier: Apache-2.0
// Limits that no ordinary motion, mean or atlas comes to: both sides of each are reached.
#include "bitstream/parameter_sets.h"
#include "conformance/cases.h"
#include "conformance/edit_frames.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

Case two_frames(const char* id, const char* purpose, std::vector<std::string> clauses,
                const FrameWriter& writer) {
  Case c = case_of_stream(id, purpose, std::move(clauses), writer.stream());
  c.frames = writer.frames().size();
  return c;
}

/// Displacements of more than 2^20 voxels to either side.
void add_far(std::vector<Case>& cases) {
  FrameWriter writer(with_steps(1, 40));
  const LightField far = field(scattered(24, 21, 43), 21, 1);
  writer.add(far);
  Motion motion;
  motion.matrix[0] = {Motion::kMostEntry, 0, 0};
  motion.matrix[1] = {0, -Motion::kMostEntry, 3};
  motion.matrix[2] = {7, 0, Motion::kMostEntry};
  motion.shift = {Motion::kMostShift, -Motion::kMostShift, 5};
  writer.add(far, motion);
  cases.push_back(two_frames("frames-far", "displacements beyond 2^20 voxels", {"8.12.1"}, writer));
}

/// Means of nodes beyond 2^17 in the reference.
void add_large(std::vector<Case>& cases) {
  FrameWriter writer(with_steps(1, 4000));
  const LightField large = field(sphere(4, 0, 5), 4, 1, 4000000);
  writer.add(large);
  writer.add(large, {});
  cases.push_back(two_frames("frames-of-large-means", "means beyond 2^17 in the frame before",
                             {"8.12.4"}, writer));
}

/// A lattice that begins among the points and ends among them.
void add_inner_lattice(std::vector<Case>& cases) {
  FrameWriter writer(with_steps(1, 40));
  const LightField ball = field(sphere(5, 0, 9), 5, 1);
  writer.add(ball);
  Motion motion;
  motion.lattice_log2 = 3;
  motion.lattice_first = {2, 2, 1};
  motion.lattice_size = {1, 2, 2};
  motion.lattice = {{4, -4, 0}, {-8, 0, 4}, {0, 8, -4}, {4, 4, 4}};
  writer.add(ball, motion);
  cases.push_back(two_frames("frames-lattice-within", "points on all sides of a lattice",
                             {"7.13", "8.12.1"}, writer));
}

/// A cell that is larger than the grid.
void add_atlas(std::vector<Case>& cases) {
  CodingParameters p = with_steps(1, 8);
  p.coefficients = CoefficientCoder::kTexture;
  p.texture.bits = 8;
  p.texture.qp = 38;
  p.index = p.digest = false;
  Case c = case_of("texture-one-cell", "a cell of the atlas that is larger than the grid",
                   {"8.11.1", "8.11.3"}, field(sphere(4, 2), 4, 1, 600), p);
  if (const auto stream = pack(c.field, p))
    c.stream = edited(*stream, [](auto& units) {
      edit_sequence(units, [](SequenceParameterSet& set) { set.sps_texture_cell_log2 = 7; });
    });
  cases.push_back(c);
}

}  // namespace

std::vector<Case> limit_cases() {
  std::vector<Case> cases;
  add_far(cases);
  add_large(cases);
  add_inner_lattice(cases);
  add_atlas(cases);
  return cases;
}

}  // namespace slf::conformance
