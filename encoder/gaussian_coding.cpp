// SPDX-License-Identifier: Apache-2.0
#include "encoder/gaussian_coding.h"

#include <algorithm>
#include <cmath>

#include "encoder/component_planes.h"

namespace slf {

CodingParameters gaussian_parameters(const LightField& field, const GaussianSteps& steps,
                                     const EncoderSettings& settings) {
  const LightFieldHeader& header = field.header;
  CodingParameters parameters = coding_parameters(settings);
  for (const int group : scale_groups(header.basis)) parameters.group.push_back(group + 1);
  std::vector<double> step(parameters.group.size(), steps.colour);
  for (const Attribute& attribute : header.attributes)
    for (int i = 0; i < attribute.num_functions; ++i) {
      parameters.group.push_back(0);
      step.push_back(attribute.id == AttributeId::kOpacity ? steps.opacity : steps.shape);
    }
  for (std::size_t k = 0; k < step.size(); ++k) {
    const double units = std::ldexp(step[k], header.shift[k]);
    const auto rounded = static_cast<std::uint32_t>(std::lround(std::clamp(units, 1.0, kMostStep)));
    parameters.step.push_back({rounded, rounded, rounded});
  }
  parameters.coefficient_level_ends = parameters.geometry_level_ends = level_ends(header.grid.bits);
  return parameters;
}

}  // namespace slf
