// SPDX-License-Identifier: Apache-2.0
// Values of every kind: few and many, large and zero, in groups, predicted, transformed.
#include <algorithm>

#include "conformance/cases.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

/// The mean, a few functions, the rest.
void add_groups(CodingParameters& parameters) {
  for (int k = 0; k < 24; ++k) parameters.group.push_back(k == 0 ? 0 : k < 5 ? 1 : 2);
  parameters.coefficient_level_ends = {3, 4, 5};
}

Case two_points() {
  Case c = case_of("two-points", "annex B: one merge", {"8.6", "8.7.2", "8.8"},
                   field({{0, 0, 0}, {1, 1, 1}}, 1, 1), with_steps(1, 4));
  c.field.components = {100, -200, 300, 400, 500, -600};
  return c;
}

Case of_coder(bool vector) {
  Case c = case_of(vector ? "vector" : "independent", "three groups, three level ranges",
                   {"7.6", vector ? "8.7.2" : "8.7.3", "8.8", "8.9"}, field(small_sphere(), 5, 24),
                   with_steps(24, 250));
  c.levels = {1, 3, 4};
  c.groups = {1, 2};
  c.parameters.coefficients = vector ? CoefficientCoder::kVector : CoefficientCoder::kIndependent;
  add_groups(c.parameters);
  c.parameters.geometry_level_ends = {3, 5};
  return c;
}

Case predicted(bool surface) {
  Case c = case_of(surface ? "prediction" : "prediction-full-cube",
                   "levels predicted from coarser ones, three groups, several slices",
                   {"7.6", "8.7.6", "8.8", "8.9"},
                   field(surface ? small_sphere() : lattice(8, 8, 8), surface ? 5 : 3, 12),
                   with_steps(12, 40));
  c.levels = surface ? std::vector<int>{1, 3, 4} : std::vector<int>{1, 2};
  c.groups = {1, 2};
  c.parameters.rdo = surface ? 0.3 : 0;
  for (int k = 0; k < 12; ++k) c.parameters.group.push_back(k == 0 ? 0 : k % 2 + 1);
  c.parameters.coefficient_level_ends =
      surface ? std::vector<int>{3, 4, 5} : std::vector<int>{2, 3};
  c.parameters.max_slice_points = surface ? 330 : 1u << 20;
  return c;
}

Case unequal_steps() {
  Case c = case_of("unequal-steps", "steps and shifts per function and channel", {"7.2", "8.7.4"},
                   field(small_sphere(), 5, 4));
  c.parameters.step = {{8, 16, 17}, {9, 9, 9}, {9, 9, 9}, {100, 50, 1}};
  c.field.header.shift = {6, 6, 5, 0};
  return c;
}

Case all_zero() {
  Case c = case_of("all-zero", "components that are all zero", {"8.7.2"}, field(sphere(5), 5, 16),
                   with_steps(16, 1));
  std::fill(c.field.components.begin(), c.field.components.end(), 0);
  return c;
}

Case transformed(bool joint) {
  Case c = case_of(joint ? "transform-joint" : "transform-functions",
                   "transforms across planes, of lower rank, over three groups",
                   {"7.11", "8.7.5", "8.9"}, field(small_sphere(), 5, 24), with_steps(24, 250));
  c.levels = {3, 4};
  c.groups = {1, 2};
  c.parameters.transform = joint ? TransformMode::kJoint : TransformMode::kFunctions;
  add_groups(c.parameters);
  c.parameters.max_slice_points = 600;
  return c;
}

/// Colours of 40 to 220 or so.
Case transformed_harmonics() {
  Case c = case_of("transform-harmonics", "radiance of functions that a transform makes",
                   {"6.7", "7.11"}, field(sphere(4), 4, 9, 60 << 6), with_steps(9, 20));
  c.field.header.has_basis = true;
  c.field.header.basis = {BasisId::kHarmonics, 2, 0, 0, 2};
  c.field.header.shift.assign(9, 6);
  for (std::size_t i = 0; i < c.field.components.size(); i += 27)
    for (std::size_t channel = 0; channel < 3; ++channel)
      c.field.components[i + channel] += 128 << 6;
  c.parameters.group = {0, 1, 1, 1, 2, 2, 2, 2, 2};
  c.parameters.transform = TransformMode::kFunctions;
  return c;
}

}  // namespace

std::vector<Case> component_cases() {
  return {two_points(),
          of_coder(true),
          of_coder(false),
          predicted(true),
          predicted(false),
          unequal_steps(),
          case_of("large-magnitudes", "escapes of the magnitude code, step 1", {"8.3.4", "8.6.2"},
                  field(sphere(4), 4, 2, 2000000), with_steps(2, 1)),
          all_zero(),
          transformed(false),
          transformed(true),
          transformed_harmonics()};
}

}  // namespace slf::conformance
