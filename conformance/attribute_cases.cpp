// SPDX-License-Identifier: Apache-2.0
// Values of points that are no view map. Spec 6.8.
#include "conformance/cases.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

/// Harmonics of a degree with functions of attributes behind them.
LightField with_attributes(int degree, std::vector<Attribute> attributes) {
  LightFieldHeader header;
  header.basis = {BasisId::kHarmonics, 2, 0, 0, degree};
  header.attributes = std::move(attributes);
  header.num_functions = header.basis.num_functions();
  for (const Attribute& attribute : header.attributes)
    header.num_functions += attribute.num_functions;
  header.colour = ColourTransform::kOpponent;
  header.shift.assign(static_cast<std::size_t>(header.num_functions), 2);
  header.grid = {{-1, 0.5, 2}, 0.25, 5};
  LightField filled = field(small_sphere(), 5, header.num_functions);
  filled.header = std::move(header);
  return filled;
}

Case splats() {
  const LightField filled =
      with_attributes(1, {{AttributeId::kOpacity, 1}, {AttributeId::kShape, 2}});
  Case c = case_of("attributes", "opacity and shape, in a group before those of colour",
                   {"6.8", "7.2", "8.9"}, filled, with_steps(7, 12));
  c.parameters.group = {1, 2, 2, 2, 0, 0, 0};
  c.parameters.step[4] = {1, 1, 1};
  c.parameters.coefficient_level_ends = c.parameters.geometry_level_ends = {3, 4, 5};
  c.levels = {3};
  c.groups = {1, 2};
  return c;
}

Case mixed() {
  const LightField filled = with_attributes(
      0, {{AttributeId::kNone, 3}, {AttributeId::kShape, 2}, {AttributeId::kNone, 1}});
  Case c = case_of("attributes-in-a-transform", "values without a meaning; a transform over all",
                   {"6.7", "6.8", "7.11", "8.7.5"}, filled, with_steps(7, 12));
  c.parameters.group = {0, 1, 1, 1, 1, 1, 1};
  c.parameters.transform = TransformMode::kFunctions;
  return c;
}

}  // namespace

std::vector<Case> attribute_cases() { return {splats(), mixed()}; }

}  // namespace slf::conformance
