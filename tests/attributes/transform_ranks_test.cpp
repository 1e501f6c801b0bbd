// SPDX-License-Identifier: Apache-2.0
// Transforms across planes of any rank: planes that are zero, constant or independent, and few
// points. Spec 8.7.5, encoder.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "slf/decoder.h"
#include "slf/encoder.h"
#include "slf/given_planes.h"
#include "tests/codec/field_support.h"

namespace slf::transform_ranks_test {
namespace {

enum class Plane : std::uint8_t { kNoise, kZero, kConstant };

/// Planes that have nothing in common.
LightField field_of(const std::vector<Voxel>& voxels, const std::vector<Plane>& planes) {
  LightField field = test::make_field(voxels, 6, static_cast<int>(planes.size() / 3), 1);
  std::mt19937 random(11);
  for (std::size_t i = 0; i < field.components.size(); ++i) {
    const auto noise = static_cast<std::int32_t>(random() % 4001) - 2000;
    const Plane plane = planes[i % planes.size()];
    field.components[i] = plane == Plane::kZero ? 0 : plane == Plane::kConstant ? 700 : noise;
  }
  return field;
}

/// Root of the mean squared error of all planes, in steps of 1.
double error_of(const LightField& field, TransformMode mode) {
  CodingParameters parameters;
  parameters.transform = mode;
  parameters.step.assign(static_cast<std::size_t>(field.header.num_functions), {1, 1, 1});
  const auto stream = pack(field, parameters);
  EXPECT_TRUE(stream);
  if (!stream) return 1e9;
  const auto decoded = decode(*stream);
  EXPECT_TRUE(decoded) << to_string(decoded.error());
  if (!decoded) return 1e9;
  const auto planes = given_planes(*decoded);
  double sum = 0;
  for (std::size_t i = 0; i < planes.size(); ++i)
    sum += std::pow(planes[i] - field.components[i], 2.0);
  return std::sqrt(sum / static_cast<double>(planes.size()));
}

/// By whether channels are mixed too.
class TransformRanks : public testing::TestWithParam<bool> {
 protected:
  static TransformMode mode() {
    return GetParam() ? TransformMode::kJoint : TransformMode::kFunctions;
  }
};

TEST_P(TransformRanks, LoseNoPlaneWhateverTheOthersAre) {
  for (const std::size_t points :
       {std::size_t{1}, std::size_t{2}, std::size_t{20}, std::size_t{900}}) {
    const auto voxels = test::sorted_distinct(test::random_cloud(points, 6, 4));
    for (const std::size_t functions : {1u, 2u, 3u, 5u})
      for (std::size_t noise = 0; noise <= 3 * functions; ++noise)
        for (const Plane other : {Plane::kZero, Plane::kConstant}) {
          std::vector<Plane> planes(3 * functions, other);
          std::fill_n(planes.begin(), noise, Plane::kNoise);
          EXPECT_LT(error_of(field_of(voxels, planes), mode()), 4)
              << points << " points, " << noise << " of " << 3 * functions << " planes, others "
              << (other == Plane::kZero ? "zero" : "constant");
        }
  }
}

TEST_P(TransformRanks, LoseNoPlaneAmongZeros) {
  const auto voxels = test::sorted_distinct(test::random_cloud(500, 6, 9));
  std::mt19937 random(2);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<Plane> planes(12);
    for (Plane& plane : planes) plane = random() % 2 == 0 ? Plane::kZero : Plane::kNoise;
    EXPECT_LT(error_of(field_of(voxels, planes), mode()), 4) << trial;
  }
}

INSTANTIATE_TEST_SUITE_P(Spec_8_7_5, TransformRanks, testing::Bool(),
                         [](const auto& joint) { return joint.param ? "joint" : "functions"; });

}  // namespace
}  // namespace slf::transform_ranks_test
