// SPDX-License-Identifier: Apache-2.0
// Prediction in a base and the slices below it: a decoder reconstructs what the encoder did.
// Spec 8.7.6.
#include <gtest/gtest.h>

#include "attributes/encoder/coefficient_quantiser.h"
#include "attributes/encoder/raht_forward.h"
#include "attributes/raht_inverse.h"
#include "level_prediction_support.h"

namespace slf::scene_prediction_test {
namespace {

using test::Values;

class ScenePrediction : public testing::TestWithParam<test::NamedCloud> {};

/// What an encoder makes of a part of a scene, and what a decoder makes of that.
struct CodedPart {
  RahtTree tree;
  Values coefficients;
  Quantised quantised;
};

Values decoded_part(const CodedPart& part, TransformLevels levels, const PlaneGroups& groups,
                    const std::vector<std::uint32_t>& steps, Values values, std::size_t cells) {
  std::vector<PredictedPlanes> planes;
  for (std::size_t g = 0; g < groups.size(); ++g)
    planes.push_back({3 * g, 3 * g + 3, part.quantised.modes[g]});
  EXPECT_TRUE(
      raht_inverse_predicted(part.tree, levels, planes, steps, values, 1, {}, kAllPlanes, cells));
  return values;
}

TEST_P(ScenePrediction, BaseAndSlicesReconstructWhatTheEncoderDid) {
  const int bits = GetParam().bits, level = (bits + 1) / 2;
  if (bits < 2) GTEST_SKIP() << "one level";
  const auto codes = test::codes(GetParam().voxels);
  const PlaneGroups groups = {{0}, {1}};
  const std::vector<std::uint32_t> steps(6, 12);
  auto base_codes = test::cells_of(codes, bits - level);
  for (auto& code : base_codes) code <<= 3 * (bits - level);
  const auto before = test::weights_by_chance(base_codes.size(), 5);
  const CodeWeights weights(before);
  const Values components = test::smooth_field(GetParam().voxels, bits, 2).components;
  for (const double rdo : {0.0, 1.0}) {
    CodedPart base{build_raht_tree(base_codes, weights), Values(base_codes.size() * 6), {}};
    std::vector<CodedPart> parts;
    std::vector<SliceCells> cells;
    const auto slices = test::slices_of(codes, bits - level, 2);
    std::size_t begin = 0;
    for (const auto& slice : slices) {
      const std::size_t end = begin + slice.points.size() * 6;
      parts.push_back({build_raht_tree(slice.points),
                       Values(components.begin() + static_cast<std::ptrdiff_t>(begin),
                              components.begin() + static_cast<std::ptrdiff_t>(end)),
                       {}});
      begin = end;
      const auto first = test::one_row_a_point(slice.points.size());
      cells.push_back(find_cells(parts.back().tree, first, 3 * (bits - level), slice.first_cell));
      raht_forward(parts.back().tree, 6, parts.back().coefficients, 1, cells.back().size());
      put_into_base(cells.back(), parts.back().coefficients, weights, 6, base.coefficients);
    }
    raht_forward(base.tree, 6, base.coefficients, 1);
    base.quantised = quantise_coefficients(
        {base.tree, base_codes, bits, groups, steps, true, rdo, bits - level, weights, nullptr},
        base.coefficients, 1);
    const Values base_values =
        decoded_part(base, TransformLevels(base_codes, bits, bits - level, 0, weights), groups,
                     steps, base.coefficients, 0);
    EXPECT_EQ(base_values, base.quantised.values);
    for (std::size_t s = 0; s < slices.size(); ++s) {
      const QuantisedBase start{cells[s], level, weights, base.coefficients, &base.quantised};
      parts[s].quantised = quantise_coefficients(
          {parts[s].tree, slices[s].points, bits, groups, steps, true, rdo, 0, {}, &start},
          parts[s].coefficients, 2);
      Values values = parts[s].coefficients;
      start_from_base(cells[s], base_values, weights, 6, values);
      EXPECT_EQ(decoded_part(parts[s], TransformLevels(slices[s].points, bits, 0, level), groups,
                             steps, values, cells[s].size()),
                parts[s].quantised.values);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Spec_8_7_6, ScenePrediction,
                         testing::ValuesIn(test::clouds_of_every_shape()),
                         [](const auto& cloud) { return cloud.param.name; });

}  // namespace
}  // namespace slf::scene_prediction_test
