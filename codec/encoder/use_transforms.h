// SPDX-License-Identifier: Apache-2.0
// A sequence, its slices and their values with transforms across planes. Spec 7.11, 8.7.5.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "attributes/encoder/forward_transform.h"
#include "codec/encoder/coded_unit.h"
#include "codec/encoder/derive_transforms.h"
#include "codec/encoder/scene_layout.h"

namespace slf {

/// [K] of the squared errors of a component: (norm of the function / 2^shift)^2.
std::vector<double> error_weights(const LightFieldHeader& header);

/// Makes set and coding those of a field that is coded with these transforms, and adds their units.
/// What a transform codes has the steps of its first function, in whose units it is.
/// @param transforms  told where their components stand
/// @return [R] the functions that components stand in
/// @errors kInvalidArgument: of the parameters
Result<std::vector<std::uint16_t>, InputError> use_transforms(
    const LightField& field, const SceneLayout& layout, CodingParameters parameters,
    std::vector<ForwardTransform>& transforms, SequenceParameterSet& set, SliceCoding& coding,
    std::vector<CodedUnit>& units);

/// The given planes [P][row] to components [P][3 R], in their place. row: 3 K
std::vector<std::int32_t> find_components(const std::vector<ForwardTransform>& transforms,
                                          const std::vector<std::uint16_t>& coded, std::size_t row,
                                          std::vector<std::int32_t> planes, int threads);

/// Transforms that pay, and the functions that their components stand in.
struct ChosenTransforms {
  std::vector<ForwardTransform> transforms;  ///< none where none pays
  std::vector<std::uint16_t> coded;          ///< [R]
};

/// Derives transforms of the given field and uses them.
Result<ChosenTransforms, InputError> choose_transforms(
    const LightField& given, const TransformInput& input, const SceneLayout& layout,
    const CodingParameters& parameters, SequenceParameterSet& set, SliceCoding& coding,
    std::vector<CodedUnit>& units);

}  // namespace slf
