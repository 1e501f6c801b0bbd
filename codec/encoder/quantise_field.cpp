// SPDX-License-Identifier: Apache-2.0
// Mirrors codec/encoder/pack.cpp as far as the quantiser.
#include "codec/encoder/quantise_field.h"

#include <utility>

#include "attributes/encoder/raht_forward.h"
#include "codec/encoder/pack_parameters.h"
#include "codec/encoder/use_transforms.h"
#include "codec/sequence.h"
#include "geometry/morton.h"

namespace slf {

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
  std::vector<CodedUnit> units;
  SLF_TRY(ChosenTransforms chosen,
          choose_transforms(given, {codes, given.components, layout.cuts, scale}, layout,
                            parameters, set, coding, units));  // 8.7.5
  if (!chosen.transforms.empty()) {
    field.components = find_components(chosen.transforms, chosen.coded,
                                       static_cast<std::size_t>(given.num_planes()),
                                       std::move(field.components), parameters.threads);
    field.header.coded = std::move(chosen.coded);
    for (auto& t : chosen.transforms) field.header.transforms.push_back(std::move(t.inverse));
  }
  const RahtTree tree = build_raht_tree(codes);
  raht_forward(tree, static_cast<int>(coding.planes()), field.components, parameters.threads);
  Quantised quantised = quantise_coefficients(coding.quantiser_input(tree, codes), field.components,
                                              parameters.threads);
  field.components = std::move(quantised.values);
  return field;
}

}  // namespace slf
