// SPDX-License-Identifier: Apache-2.0
// Slices, normals, and what headers say of a light field.
#include "conformance/cases.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

Case slices() {
  Case c = case_of("slices", "several slices", {"7.3", "8.2"}, field(sphere(5), 5, 3),
                   with_steps(3, 32));
  c.parameters.max_slice_points = 400;
  return c;
}

Case slices_of_one_cell() {
  std::vector<Voxel> uneven = sphere(5);
  for (const Voxel& stray :
       {Voxel{100, 3, 90}, Voxel{127, 127, 127}, Voxel{64, 64, 64}, Voxel{65, 64, 64}})
    uneven.push_back(stray);
  Case c = case_of("slices-of-one-cell", "every cell is a slice, those of lone points among them",
                   {"7.3", "8.9"}, field(sorted(uneven), 7, 3), with_steps(3, 32));
  c.levels = {1, 3, 6};
  c.parameters.base_levels = 3;
  c.parameters.max_slice_points = 1;
  c.field.normals.bits = 4;
  for (std::size_t p = 0; p < c.field.num_points(); ++p)
    c.field.normals.octahedral.push_back(
        {static_cast<std::uint16_t>(p % 16), static_cast<std::uint16_t>(p / 7 % 16)});
  return c;
}

Case normals() {
  Case c = case_of("normals", "coded normals, whole and of coarser nodes", {"7.5", "8.9", "8.10"},
                   field(sphere(5), 5, 1), with_steps(1, 16));
  c.levels = {3};
  c.field.normals.bits = 7;
  Random random(9);
  std::uint32_t a = 0, b = 0;
  for (std::size_t p = 0; p < c.field.num_points(); ++p) {
    a = (a + random.below(5)) % 128;
    b = (b + 127 + random.below(3)) % 128;
    c.field.normals.octahedral.push_back(
        {static_cast<std::uint16_t>(a), static_cast<std::uint16_t>(b)});
  }
  return c;
}

Case basis() {
  Case c = case_of("basis", "a B-spline light field with every header element in use",
                   {"6.3", "7.2"}, field(small_sphere(), 5, 8), with_steps(8, 16));
  LightFieldHeader& header = c.field.header;
  header.has_basis = true;
  header.basis = {BasisId::kBspline, 3, 2, 1};
  header.colour = ColourTransform::kOpponent;
  header.transfer = Transfer::kLinear;
  header.grid = {{-1.5, 2.25, 1e5}, 0.03125, 5};
  header.up = UpAxis::kMinusY;
  header.right_handed = false;
  header.metres_per_unit = 0.01;
  header.gamma_min_q7 = -100;
  header.gamma_max_q7 = 90;
  c.parameters.metadata = {{"source", "generated"}, {"note", "größer"}};
  return c;
}

Case harmonics() {
  Case c = case_of("harmonics", "spherical harmonics of reflected directions, a group per degree",
                   {"6.3", "6.4", "7.2"}, field(small_sphere(), 5, 9), with_steps(9, 16));
  c.field.header.has_basis = true;
  c.field.header.basis = {BasisId::kHarmonics, 2, 0, 0, 2};
  c.field.header.directions = Directions::kReflected;
  c.field.header.normal_cell_log2 = 1;
  c.field.header.colour = ColourTransform::kOpponent;
  c.parameters.group = {0, 1, 1, 1, 2, 2, 2, 2, 2};
  return c;
}

Case bare() {
  Case c = case_of("no-index-no-digest", "only what must be there", {"7.1"}, field(sphere(4), 4, 1),
                   with_steps(1, 8));
  c.parameters.index = c.parameters.digest = false;
  return c;
}

Case unknown_unit() {
  Case c = bare();
  c.id = "unknown-unit";
  c.purpose = "a unit of a type to come is skipped";
  c.unknown_unit = true;
  return c;
}

Case draco() {
  Case c = case_of("draco", "profile 1", {"8.5"}, field(sphere(6), 6, 1), with_steps(1, 16));
  c.parameters.geometry = GeometryCoder::kDraco;
  return c;
}

}  // namespace

std::vector<Case> header_cases() {
  return {slices(), slices_of_one_cell(), normals(), basis(), harmonics(),
          bare(),   unknown_unit(),       draco()};
}

}  // namespace slf::conformance
