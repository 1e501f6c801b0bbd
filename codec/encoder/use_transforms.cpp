// SPDX-License-Identifier: Apache-2.0
#include "codec/encoder/use_transforms.h"

#include <algorithm>
#include <cmath>

#include "codec/encoder/pack_parameters.h"
#include "codec/sequence.h"
#include "codec/transform_units.h"
#include "slf/parallel.h"
#include "slf/view_map.h"

namespace slf {

std::vector<double> error_weights(const LightFieldHeader& header) {
  std::vector<double> weights(static_cast<std::size_t>(header.num_functions), 1);
  if (header.has_basis) {
    const std::vector<double> norms = basis_norms(header.basis);
    std::copy(norms.begin(), norms.end(), weights.begin());
  }
  for (std::size_t k = 0; k < weights.size(); ++k)
    weights[k] = std::pow(std::ldexp(weights[k], header.shift.empty() ? 0 : -header.shift[k]), 2);
  return weights;
}

Result<std::vector<std::uint16_t>, InputError> use_transforms(
    const LightField& field, const SceneLayout& layout, CodingParameters parameters,
    std::vector<ForwardTransform>& transforms, SequenceParameterSet& set, SliceCoding& coding,
    std::vector<CodedUnit>& units) {
  parameters.step = function_steps(set);
  std::vector<PlaneTransform> inverse;
  for (const ForwardTransform& transform : transforms) {
    inverse.push_back(transform.inverse);
    for (const std::uint16_t k : transform.inverse.functions)
      parameters.step[k] = parameters.step[transform.inverse.functions[0]];
  }
  const std::uint32_t level = set.sps_level, features = set.features;  // a group of frames has them
  SLF_TRY(set, sequence_of_checked(field, parameters));
  set.sps_level = level;
  set.features = features;
  set_base(layout, set);
  set.sps_transform_flag = 1;
  set.sps_num_transforms_minus1 = static_cast<std::uint32_t>(transforms.size() - 1);
  for (const ForwardTransform& transform : transforms) {
    SLF_TRY(auto payload, write_transform(transform, set.num_groups()));
    units.push_back({UnitType::kTransform, std::move(payload), {}});
  }
  coding.matrices.resize(coding.groups.size());
  for (const ForwardTransform& transform : transforms)
    for (std::size_t g = 0; g < coding.groups.size(); ++g)
      if (const auto columns = columns_of_group(transform.inverse, coding.groups, g);
          !columns.empty())
        coding.matrices[g] = write_columns(transform, columns);
  CodedFunctions coded = code_functions(std::move(coding.groups), inverse);
  for (std::size_t i = 0; i < transforms.size(); ++i)
    transforms[i].inverse.components = inverse[i].components;
  coding.groups = std::move(coded.groups);
  const std::vector<std::uint32_t> steps = plane_steps(set);
  coding.steps.clear();
  for (const std::size_t j : planes_of(coded.functions)) coding.steps.push_back(steps[j]);
  return std::move(coded.functions);
}

std::vector<std::int32_t> find_components(const std::vector<ForwardTransform>& transforms,
                                          const std::vector<std::uint16_t>& coded, std::size_t row,
                                          std::vector<std::int32_t> planes, int threads) {
  constexpr std::size_t kPointGrain = 256;
  // A transform has no more components than functions: width <= row.
  const std::size_t points = planes.size() / row, width = 3 * coded.size();
  parallel_ranges(points, kPointGrain, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<ComponentFinder> finders(transforms.begin(), transforms.end());
    std::vector<std::int32_t> found(width);
    for (std::size_t p = begin; p < end; ++p) {
      std::int32_t* given = &planes[p * row];
      for (std::size_t r = 0; r < coded.size(); ++r)  // those of no transform stay
        std::copy_n(given + std::size_t{3} * coded[r], 3, &found[3 * r]);
      for (ComponentFinder& finder : finders) finder.find(given, found.data());
      std::copy(found.begin(), found.end(), given);
    }
  });
  for (std::size_t p = 1; p < points && width < row; ++p)
    std::copy_n(&planes[p * row], width, &planes[p * width]);
  planes.resize(points * width);
  return planes;
}

namespace {

/// The first group with a function of direction: attributes are before it, and have no transform.
std::size_t first_of_views(const LightFieldHeader& header, const PlaneGroups& groups) {
  std::size_t first = 0;
  while (!header.attributes.empty() && first < groups.size() &&
         groups[first].front() >= header.num_view_functions())
    ++first;
  return first;
}

}  // namespace

Result<ChosenTransforms, InputError> choose_transforms(
    const LightField& given, const TransformInput& input, const SceneLayout& layout,
    const CodingParameters& parameters, SequenceParameterSet& set, SliceCoding& coding,
    std::vector<CodedUnit>& units) {
  ChosenTransforms chosen;
  if (parameters.transform == TransformMode::kNone || coding.groups.empty()) return chosen;
  const std::vector<double> weights = error_weights(given.header);
  chosen.transforms =
      derive_transforms(input, coding.groups, first_of_views(given.header, coding.groups), weights,
                        coding.steps, parameters.transform, parameters.threads);
  if (chosen.transforms.empty()) return chosen;
  SLF_TRY(chosen.coded,
          use_transforms(given, layout, parameters, chosen.transforms, set, coding, units));
  return chosen;
}

}  // namespace slf
