// Mirrors codec/pack.cpp as far as the quantiser.
#include "codec/quantise_field.h"

#include <utility>

#include "attributes/coefficient_quantiser.h"
#include "attributes/raht_forward.h"
#include "codec/derive_transforms.h"
#include "codec/pack_parameters.h"
#include "codec/sequence.h"
#include "codec/use_transforms.h"
#include "geometry/morton.h"

namespace slf {
namespace {

/// Transforms across planes where they pay: into the header, and the components that they code.
Result<Done, InputError> transform_planes(const LightField& given, const SceneLayout& layout,
                                          const CodingParameters& parameters,
                                          const TransformInput& input, SequenceParameterSet& set,
                                          SliceCoding& coding, LightField& field) {
  const std::vector<double> weights = error_weights(given.header);
  auto transforms = derive_transforms(input, coding.groups, weights, coding.steps,
                                      parameters.transform, parameters.threads);
  if (transforms.empty()) return Done{};
  std::vector<CodedUnit> units;
  SLF_TRY(field.header.coded,
          use_transforms(given, layout, parameters, transforms, set, coding, units));
  field.components = find_components(transforms, field.header.coded, 3 * weights.size(),
                                     given.components, parameters.threads);
  for (ForwardTransform& t : transforms) field.header.transforms.push_back(std::move(t.inverse));
  return Done{};
}

}  // namespace

Result<LightField, InputError> quantise_field(const LightField& given, CodingParameters parameters,
                                              double scale) {
  parameters.base_levels = 0;
  std::vector<std::uint64_t> codes;
  for (const Voxel& v : given.positions) codes.push_back(morton(v));
  SLF_TRY(SequenceParameterSet set, sequence_of(given, parameters));  // 7.2
  SLF_TRY(const SceneLayout layout, lay_out(codes, given.header.grid.bits, parameters));
  set_base(layout, set);
  SliceCoding coding{set,   plane_groups(set),  plane_steps(set),
                     false, parameters.texture, parameters.rdo};
  LightField field = given;
  if (parameters.transform != TransformMode::kNone)  // 8.7.5
    SLF_CHECK(transform_planes(given, layout, parameters,
                               {codes, given.components, layout.cuts, scale}, set, coding, field));
  const RahtTree tree = build_raht_tree(codes);
  raht_forward(tree, static_cast<int>(coding.planes()), field.components, parameters.threads);
  Quantised quantised = quantise_coefficients(coding.quantiser_input(tree, codes), field.components,
                                              parameters.threads);
  field.components = std::move(quantised.values);
  return field;
}

}  // namespace slf
