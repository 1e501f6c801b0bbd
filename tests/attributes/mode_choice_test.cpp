// SPDX-License-Identifier: Apache-2.0
// How a level is predicted is the encoder's choice, made on a part of a large level's nodes. Spec
// 8.7.6.
#include <gtest/gtest.h>

#include <utility>

#include "attributes/encoder/coefficient_quantiser.h"
#include "attributes/encoder/raht_forward.h"
#include "attributes/raht_inverse.h"
#include "level_prediction_support.h"

namespace slf::mode_choice_test {
namespace {

using test::Values;

constexpr int kBits = 9;

/// So many points that modes of the last level are tried on a fourth of its nodes.
std::vector<Voxel> sheet() {
  std::vector<Voxel> voxels;
  for (int x = 0; x < 400; ++x)
    for (int y = 0; y < 400; ++y)
      voxels.push_back({x, y, 200 + static_cast<int>(50 * std::sin(0.02 * x))});
  return test::sorted_distinct(std::move(voxels));
}

/// Group 0 is smooth; group 1 noise, of which no neighbour tells anything.
class ModeChoice : public testing::Test {
 protected:
  ModeChoice() : field_(test::smooth_field(sheet(), kBits, 2)) {
    std::mt19937 random(7);
    for (std::size_t i = 0; i < field_.components.size(); ++i)
      if (i % 6 >= 3) field_.components[i] = static_cast<std::int32_t>(random() % 401) - 200;
    codes_ = test::codes(field_.positions);
    tree_ = build_raht_tree(codes_);
    coefficients_ = field_.components;
    raht_forward(tree_, 6, coefficients_, 1);
  }

  Quantised quantise(int threads, Values& coefficients) const {
    return quantise_coefficients({tree_, codes_, kBits, groups_, steps_, true, 0, 0, {}, nullptr},
                                 coefficients, threads);
  }

  LightField field_;
  PlaneGroups groups_ = {{0}, {1}};
  std::vector<std::uint32_t> steps_ = std::vector<std::uint32_t>(6, 12);
  std::vector<std::uint64_t> codes_;
  RahtTree tree_;
  Values coefficients_;
};

TEST_F(ModeChoice, PredictsWhatIsSmoothAndNoNoise) {
  Values coefficients = coefficients_;
  const Quantised quantised = quantise(1, coefficients);
  EXPECT_NE(quantised.modes[0].back(), kUnpredicted);
  EXPECT_EQ(quantised.modes[1].back(), kUnpredicted);
}

TEST_F(ModeChoice, LeavesWhatADecoderGetsForAnyThreads) {
  Values coefficients = coefficients_, again = coefficients_;
  const Quantised quantised = quantise(1, coefficients);
  const Quantised on_two = quantise(2, again);
  EXPECT_EQ(coefficients, again);
  EXPECT_EQ(quantised.modes, on_two.modes);
  const std::vector<PredictedPlanes> planes = {{0, 3, quantised.modes[0]},
                                               {3, 6, quantised.modes[1]}};
  TransformLevels levels(codes_, kBits, 0, 0, {});
  ASSERT_TRUE(raht_inverse_predicted(tree_, levels, planes, steps_, coefficients, 1));
  EXPECT_EQ(coefficients, quantised.values);
}

}  // namespace
}  // namespace slf::mode_choice_test
