// SPDX-License-Identifier: Apache-2.0
#include "encoder/coding_parameters.h"

#include <algorithm>
#include <cmath>

#include "codec/encoder/texture_parameters.h"
#include "encoder/component_planes.h"

namespace slf {

std::vector<int> level_ends(int bits) {
  if (bits < 4) return {bits};
  return {bits - 2, bits - 1, bits};
}

CodingParameters coding_parameters(const EncoderSettings& settings) {
  CodingParameters parameters;
  parameters.geometry = settings.geometry;
  parameters.coefficients = settings.coefficients;
  parameters.texture = settings.texture;
  if (settings.coefficients != CoefficientCoder::kTexture)
    parameters.transform = settings.transform;
  parameters.predict = settings.predict;
  parameters.reference_contexts = settings.reference_contexts;
  parameters.rdo = std::max(settings.rdo, 0.0);
  parameters.quality_layers = settings.quality_layers;
  parameters.base_levels = settings.base_levels;
  parameters.max_slice_points = settings.max_slice_points;
  parameters.slice_start = settings.slice_start;
  parameters.threads = settings.threads;
  return parameters;
}

CodingParameters coding_parameters(const LightField& field, const EncoderSettings& settings) {
  const LightFieldHeader& header = field.header;
  const bool texture = settings.coefficients == CoefficientCoder::kTexture;
  CodingParameters parameters = coding_parameters(settings);
  parameters.step =
      texture ? texture_steps(header.basis, header.shift,
                              least_texture_steps(field.components, std::size_t(field.num_planes()),
                                                  settings.texture.bits),
                              settings.steps_by_norm)
              : quantiser_steps(header.basis, header.shift, settings.q, settings.steps_by_norm);
  for (auto& step : parameters.step)
    for (std::size_t c = texture ? 3 : 1; c < 3; ++c)
      step[c] = static_cast<std::uint32_t>(
          std::lround(std::clamp(step[c] * settings.chroma_step, 1.0, kMostStep)));
  if (settings.preset != Preset::kPaper) {  // the paper codes all in one unit
    parameters.group = scale_groups(header.basis);
    if (!texture) parameters.coefficient_level_ends = level_ends(header.grid.bits);
    if (settings.geometry == GeometryCoder::kOctree)
      parameters.geometry_level_ends = level_ends(header.grid.bits);
  }
  return parameters;
}

}  // namespace slf
