// SPDX-License-Identifier: Apache-2.0
// Scenes of a base and several slices: spec 7.3, 7.7, 8.2.
#include <algorithm>
#include <cstdlib>

#include "scene_support.h"

namespace slf::scene_test {
namespace {

using namespace test;
using enum SliceStart;

class SceneRoundTrip : public testing::TestWithParam<Shape> {};

TEST_P(SceneRoundTrip, StepOfOneIsLosslessUpToRounding) {
  const LightField field = sphere();
  for (const auto coder : {CoefficientCoder::kVector, CoefficientCoder::kIndependent})
    for (const bool predict : {false, true}) {
      CodingParameters p = parameters_of(GetParam(), kFunctions, 1);
      p.coefficients = coder;
      p.predict = predict;
      const LightField out = decoded(packed(field, p));
      ASSERT_EQ(out.positions, field.positions);
      EXPECT_EQ(out.normals.octahedral, field.normals.octahedral);
      EXPECT_FALSE(out.partial);
      int largest = 0;
      for (std::size_t i = 0; i < field.components.size(); ++i)
        largest = std::max(largest, std::abs(out.components[i] - field.components[i]));
      EXPECT_LE(largest, 4);
    }
}

TEST_P(SceneRoundTrip, NeitherBytesNorIntegersDependOnThreads) {
  const LightField field = sphere();
  CodingParameters p = parameters_of(GetParam(), kFunctions, 12);
  p.rdo = 0.3;
  p.threads = 1;
  const auto one = packed(field, p);
  const LightField alone = decoded(one);
  for (const int threads : {2, 3}) {
    p.threads = threads;
    EXPECT_EQ(packed(field, p), one);
    DecodeOptions options;
    options.threads = threads;
    const LightField other = decoded(one, options);
    EXPECT_EQ(other.positions, alone.positions);
    EXPECT_EQ(other.components, alone.components);
  }
}

INSTANTIATE_TEST_SUITE_P(Spec_8_2, SceneRoundTrip,
                         testing::Values(Shape{0, 1u << 16, kShared}, Shape{1, 1u << 16, kShared},
                                         Shape{3, 1u << 16, kShared}, Shape{5, 1u << 16, kShared},
                                         Shape{2, 2500, kShared}, Shape{2, 2500, kBase},
                                         Shape{4, 700, kShared}, Shape{4, 700, kBase},
                                         Shape{2, 2500, kApart}, Shape{4, 700, kApart},
                                         Shape{5, 100, kApart}, Shape{5, 100, kShared},
                                         Shape{-1, 1u << 16, kShared}, Shape{-1, 3000, kShared}),
                         [](const auto& shape) { return name_of(shape.param); });

TEST(Spec_7_7_Index, BoxesAreThoseOfTheCells) {
  const StreamInfo info = *read_info(scene(kShared));
  const LightField field = sphere();
  std::size_t first = 0;
  for (const SliceInfo& slice : info.slices) {
    ASSERT_TRUE(slice.box);
    for (std::size_t i = first; i < first + slice.points; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_GE(field.positions[i][axis], slice.box->low[axis]);
        EXPECT_LE(field.positions[i][axis], slice.box->high[axis]);
      }
    first += slice.points;
  }
  EXPECT_EQ(first, field.num_points());
}

}  // namespace
}  // namespace slf::scene_test
