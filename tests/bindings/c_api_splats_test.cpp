// SPDX-License-Identifier: Apache-2.0
// Gaussian splats by the C interface: shapes and opacities are those of the library.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/quaternion.h"
#include "c_api_objects.h"
#include "slf/decoder.h"
#include "slf/gaussians.h"
#include "slf/slf.h"

namespace slf::c_api_splats_test {
namespace {

using test::Field;
using test::Stream;
using test::stream_of;

/// xx, xy, xz, yy, yz, zz of R S S R^T; of what a float does not hold infinite or no number.
std::array<double, 6> covariance_of(const Gaussians& splats, std::size_t p) {
  const Matrix3x3 axes = rotation_of(splats.rotations[p]);
  std::array<double, 6> out{};
  std::size_t e = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = i; j < 3; ++j, ++e)
      for (std::size_t k = 0; k < 3; ++k)
        out[e] += axes[i][k] * axes[j][k] * std::exp(2.0 * double{splats.log_deviations[p][k]});
  return out;
}

TEST(CApiSplats, ShapesAndOpacitiesAreThoseOfGaussians) {
  const auto bytes = stream_of("attributes");
  const auto decoded = decode(bytes);
  ASSERT_TRUE(decoded);
  const auto splats = gaussians_of(*decoded);
  ASSERT_TRUE(splats);
  const Stream stream(bytes);
  const Field field(stream.handle, nullptr);
  ASSERT_EQ(field.shape.has_splats, 1u);
  const std::size_t points = splats->size();
  std::vector<float> covariances(6 * points), opacities(points);
  ASSERT_EQ(slf_read_splat_covariances(field.handle, 0, points, covariances.data(), 0, nullptr),
            SLF_OK);
  ASSERT_EQ(slf_read_splat_opacities(field.handle, 0, points, opacities.data(), 0, nullptr),
            SLF_OK);
  for (std::size_t p = 0; p < points; ++p) {
    EXPECT_NEAR(opacities[p], 1 / (1 + std::exp(-double{splats->logits[p]})), 1e-6);
    const auto expected = covariance_of(*splats, p);
    // Turns and logarithms are floats there: logarithms of up to 100 to 1e-5.
    const double most = *std::ranges::max_element(expected);
    if (!(most < 1e38)) continue;
    for (std::size_t e = 0; e < 6; ++e)
      EXPECT_NEAR(covariances[6 * p + e], expected[e], 3e-5 * most) << "point " << p << ", " << e;
  }
}

TEST(CApiSplats, InfoSaysSoAndPartsOfTheArraysGoWhereTheStrideSays) {
  const Stream stream(stream_of("attributes"));
  slf_info info{};
  info.size = sizeof info;
  ASSERT_EQ(slf_get_info(stream.handle, &info, nullptr), SLF_OK);
  EXPECT_EQ(info.has_splats, 1u);
  const Field field(stream.handle, nullptr);
  std::vector<float> packed(18), apart(21, -7);
  ASSERT_EQ(slf_read_splat_covariances(field.handle, 4, 3, packed.data(), 0, nullptr), SLF_OK);
  ASSERT_EQ(slf_read_splat_covariances(field.handle, 4, 3, apart.data(), 28, nullptr), SLF_OK);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t e = 0; e < 7; ++e) EXPECT_EQ(apart[7 * i + e], e < 6 ? packed[6 * i + e] : -7);
  slf_error error = SLF_ERROR_INIT;
  EXPECT_EQ(slf_read_splat_opacities(field.handle, field.shape.points, 1, apart.data(), 0, &error),
            SLF_INVALID_ARGUMENT);
  EXPECT_STREQ(error.element, "first");
}

TEST(CApiSplats, SurfacesHaveNone) {
  const Stream stream(stream_of("harmonics"));
  const Field field(stream.handle, nullptr);
  EXPECT_EQ(field.shape.has_splats, 0u);
  float value = -7;
  slf_error error = SLF_ERROR_INIT;
  EXPECT_EQ(slf_read_splat_covariances(field.handle, 0, 0, &value, 0, &error),
            SLF_INVALID_ARGUMENT);
  EXPECT_STREQ(error.element, "splat_covariances");
  EXPECT_EQ(slf_read_splat_opacities(field.handle, 0, 1, &value, 0, &error), SLF_INVALID_ARGUMENT);
  EXPECT_STREQ(error.element, "splat_opacities");
  EXPECT_EQ(value, -7);
}

}  // namespace
}  // namespace slf::c_api_splats_test
