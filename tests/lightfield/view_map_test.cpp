// SPDX-License-Identifier: Apache-2.0
// Node form against the plain sum over the basis functions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "lightfield/nodes.h"
#include "slf/decoder.h"
#include "slf/encoder.h"
#include "slf/given_planes.h"
#include "slf/view_map.h"

namespace slf::view_map_test {
namespace {

/// Components such as an encoder makes: large DC, the rest within +- 60 grey levels, many zero.
LightField random_field(const Basis& basis, ColourTransform colour, std::size_t points) {
  std::mt19937 random(3);
  LightField field;
  field.header.basis = basis;
  field.header.colour = colour;
  field.header.num_functions = basis.num_functions();
  for (int k = 0; k < basis.num_functions(); ++k) field.header.shift.push_back(k % 3 + 4);
  for (std::size_t p = 0; p < points; ++p) {
    field.positions.push_back({static_cast<std::int32_t>(p), 0, 0});
    for (int i = 0; i < 3 * basis.num_functions(); ++i) {
      const auto value = static_cast<std::int32_t>(random() % 2000) - 1000;
      const bool zero = i >= 3 && random() % 4 == 0;
      field.components.push_back(i < 3 ? 128 * 16 + value : zero ? 0 : value);
    }
  }
  return field;
}

std::array<double, 3> plain_sum(const LightField& field, std::size_t p, double theta,
                                double gamma) {
  const auto matrix = colour_matrix(field.header.colour);
  const auto functions = static_cast<std::size_t>(field.header.num_functions);
  std::array<double, 3> rgb{0, 0, 0};
  for (std::size_t k = 0; k < functions; ++k)
    for (std::size_t to = 0; to < 3; ++to)
      for (std::size_t from = 0; from < 3; ++from)
        rgb[to] +=
            matrix[to][from] *
            std::ldexp(field.components[(p * functions + k) * 3 + from], -field.header.shift[k]) *
            basis_value(field.header.basis, static_cast<int>(k), theta, gamma);
  return rgb;
}

struct Shape {
  int order, scales_theta, scales_gamma;
};

std::string name_of(const Shape& shape) {
  std::string name("o");  // + on a literal trips gcc 12's -Wrestrict
  name += std::to_string(shape.order) + "_" + std::to_string(shape.scales_theta);
  return name + "_" + std::to_string(shape.scales_gamma);
}
void PrintTo(const Shape& shape, std::ostream* out) { *out << name_of(shape); }

class ViewMapsTest : public testing::TestWithParam<Shape> {
 protected:
  Basis basis() const {
    return {BasisId::kBspline, GetParam().order, GetParam().scales_theta, GetParam().scales_gamma};
  }
};

TEST_P(ViewMapsTest, NodesGiveTheSumOverTheFunctions) {
  for (const auto colour : {ColourTransform::kNone, ColourTransform::kOpponent}) {
    const LightField field = random_field(basis(), colour, 3);
    const ViewMaps maps(field, 2);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> theta(-3.1415926f, 3.1415926f), gamma(-1, 1);
    for (int n = 0; n < 60; ++n) {
      const float t = n == 0 ? std::numbers::pi_v<float> : n == 1 ? 0 : theta(random);
      const float g = n == 0 ? 1.0f : n == 1 ? -1.0f : gamma(random);
      const std::size_t p = static_cast<std::size_t>(n) % 3;
      const auto nodes = maps.radiance_unclamped(p, t, g);
      const auto sum = plain_sum(field, p, static_cast<double>(t), static_cast<double>(g));
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_NEAR(static_cast<double>(nodes[c]), sum[c], 1.0 / 256)
            << "theta " << t << ", gamma " << g;
    }
  }
}

TEST_P(ViewMapsTest, TheFunctionsSpanEverySplineOnTheGrid) {
  // The map between coefficients and nodes is square; it is onto when no pivot of it vanishes.
  for (const int scales : {GetParam().scales_theta, GetParam().scales_gamma}) {
    const AxisTable table(GetParam().order, scales);
    const auto n = static_cast<std::size_t>(table.size());
    std::vector<std::vector<double>> rows(n, std::vector<double>(n));
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        rows[i][j] = table.coefficient(static_cast<int>(i), static_cast<int>(j));
    for (std::size_t i = 0; i < n; ++i) {
      const auto pivot = std::max_element(
          rows.begin() + static_cast<std::ptrdiff_t>(i), rows.end(),
          [i](const auto& a, const auto& b) { return std::abs(a[i]) < std::abs(b[i]); });
      ASSERT_GT(std::abs((*pivot)[i]), 1e-3) << "scales " << scales << ", column " << i;
      std::swap(rows[i], *pivot);
      for (std::size_t r = i + 1; r < n; ++r) {
        const double factor = rows[r][i] / rows[i][i];
        for (std::size_t j = i; j < n; ++j) rows[r][j] -= factor * rows[i][j];
      }
    }
  }
}

TEST_P(ViewMapsTest, TheTransposedMapIsTheTranspose) {
  const NodeMap<double> map(basis());
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> x(map.size()), y(map.size()), cx(map.size()), cty(map.size()),
      scratch(map.size());
  for (double& v : x) v = uniform(random);
  for (double& v : y) v = uniform(random);
  map.to_nodes(x.data(), cx.data(), scratch.data());
  map.transposed(y.data(), cty.data(), scratch.data());
  double forward = 0, backward = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    forward += cx[i] * y[i];
    backward += x[i] * cty[i];
  }
  EXPECT_NEAR(forward, backward, 1e-10 * (1 + std::abs(forward)));
}

TEST(ViewMapsOfHarmonics, GiveTheSumOverTheFunctions) {
  const LightField field =
      random_field({BasisId::kHarmonics, 2, 0, 0, 6}, ColourTransform::kOpponent, 5);
  const ViewMaps maps(field);
  for (std::size_t p = 0; p < 5; ++p)
    for (const auto& [theta, gamma] : {std::pair{0.3f, -0.2f}, {-3.0f, 0.99f}, {1.7f, -1.0f}}) {
      const auto expected =
          plain_sum(field, p, static_cast<double>(theta), static_cast<double>(gamma));
      const auto rgb = maps.radiance_unclamped(p, theta, gamma);
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(static_cast<double>(rgb[c]), expected[c], 1.0 / 16);
    }
}

TEST(Spec_6_4_Frame, ReflectedIsTheGlobalOneAtTheMirroredDirection) {
  // A plane: the normal is z, so a mirrored direction has its azimuth turned by half a circle.
  LightField field = random_field({BasisId::kHarmonics, 2, 0, 0, 4}, ColourTransform::kNone, 0);
  std::vector<Voxel> plane;
  for (std::int32_t i = 0; i < 64; ++i)
    plane.push_back(
        {(i & 1) | (i >> 1 & 2) | (i >> 2 & 4), (i >> 1 & 1) | (i >> 2 & 2) | (i >> 3 & 4), 3});
  const LightField values = random_field(field.header.basis, ColourTransform::kNone, 64);
  field = values;
  field.header.grid.bits = 3;
  field.positions = plane;
  const ViewMaps global(field);
  field.header.directions = Directions::kReflected;
  const ViewMaps reflected(field);
  for (std::size_t p = 0; p < 64; p += 7)
    for (const auto& [theta, gamma] : {std::pair{0.3f, 0.2f}, {-2.0f, 0.9f}}) {
      const float turned =
          theta > 0 ? theta - std::numbers::pi_v<float> : theta + std::numbers::pi_v<float>;
      const auto a = reflected.radiance_unclamped(p, theta, gamma);
      const auto b = global.radiance_unclamped(p, turned, gamma);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 0.02);
    }
}

/// Components of function 0, mixed in their channels, and of `rank` sums of all others; of the
/// first planes as given_planes makes them, finely enough for their rounding not to matter.
struct SummedField {
  LightField field, planes;
};
SummedField summed_field(const Basis& basis, std::size_t rank, bool joint, std::size_t points) {
  constexpr int kShift = 12;
  std::mt19937 random(7);
  const auto symmetric = [&](std::int32_t most) {
    return static_cast<std::int32_t>(random() % (2u * static_cast<std::uint32_t>(most) + 1)) - most;
  };
  SummedField made;
  LightFieldHeader& header = made.field.header;
  header.basis = basis;
  header.colour = ColourTransform::kOpponent;
  header.num_functions = basis.num_functions();
  header.shift.assign(static_cast<std::size_t>(header.num_functions), kShift);
  PlaneTransform mean, others;
  mean.functions = {0};
  mean.rank = 1;
  mean.colour = {{{400, 300, -20}, {-300, 390, 100}, {50, -80, 500}}};
  mean.matrix = {17000};
  mean.components = {0};
  header.coded = {0};
  for (int k = 1; k < header.num_functions; ++k)
    others.functions.push_back(static_cast<std::uint16_t>(k));
  others.rank = rank;
  others.lanes = joint ? 1 : 3;
  for (std::size_t r = 1; r <= rank; ++r) {
    others.components.push_back(static_cast<std::uint16_t>(r));
    header.coded.push_back(static_cast<std::uint16_t>(r));
  }
  for (std::size_t i = 0; i < others.rows() * others.columns(); ++i)
    others.matrix.push_back(symmetric(6000 / static_cast<std::int32_t>(std::sqrt(others.rows()))));
  header.transforms = {mean, others};
  for (std::size_t p = 0; p < points; ++p) {
    made.field.positions.push_back({static_cast<std::int32_t>(p), 0, 0});
    for (std::size_t i = 0; i < 3 * (rank + 1); ++i)
      made.field.components.push_back((i < 3 ? 100 << kShift : 0) + symmetric(40 << kShift));
  }
  made.planes = made.field;
  made.planes.components = given_planes(made.field);
  made.planes.header.coded.clear();
  made.planes.header.transforms.clear();
  return made;
}

TEST(ViewMapsOfCodedFunctions, GiveTheSumOverTheGivenPlanes) {
  for (const Basis& basis :
       {Basis{BasisId::kHarmonics, 2, 0, 0, 10}, Basis{BasisId::kHarmonics, 2, 0, 0, 3},
        Basis{BasisId::kBspline, 3, 3, 2}})
    for (const bool joint : {false, true}) {
      const SummedField made = summed_field(basis, 7, joint, 16);
      const ViewMaps maps(made.field), plain(made.planes);
      for (std::size_t p = 0; p < 16; ++p)
        for (const auto& [theta, gamma] : {std::pair{0.3f, -0.2f}, {-3.0f, 0.99f}, {1.7f, -1.0f}}) {
          const auto expected =
              plain_sum(made.planes, p, static_cast<double>(theta), static_cast<double>(gamma));
          const auto rgb = maps.radiance_unclamped(p, theta, gamma);
          for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(static_cast<double>(rgb[c]), expected[c], 1.0 / 16);
        }
      for (std::size_t p = 0; p < 16; ++p)
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(maps.mean(p)[c], plain.mean(p)[c], 0.02);
    }
}

TEST(ViewMapsOfCodedFunctions, ManyAtOnceAreWithinAFiftiethOfOneByOne) {
  const SummedField made = summed_field({BasisId::kHarmonics, 2, 0, 0, 10}, 30, false, 64);
  const ViewMaps maps(made.field);
  std::vector<std::uint32_t> points(64);
  for (std::uint32_t p = 0; p < points.size(); ++p) points[p] = p;
  std::vector<std::array<float, 3>> colours(64);
  std::mt19937 random(1);
  for (int view = 0; view < 50; ++view) {
    Vec3 eye;
    for (double& x : eye) x = static_cast<double>(random() % 2001) / 10 - 100;
    maps.radiances(eye, points, colours);
    for (const std::uint32_t p : points) {
      const auto [theta, gamma] =
          direction_of({eye[0] - made.field.positions[p][0], eye[1], eye[2]});
      const auto expected = maps.radiance(p, theta, gamma);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(colours[p][c], expected[c], 0.02);
    }
  }
}

/// Spec 8.9: the groups of a file that function 0 has a part in, and no more.
TEST(MeanColours, NeedNoGroupThatFunction0HasNoPartIn) {
  LightField field =
      random_field({BasisId::kHarmonics, 2, 0, 0, 3}, ColourTransform::kOpponent, 90);
  field.header.grid = {{0, 0, 0}, 1, 7};
  CodingParameters parameters;
  parameters.step.assign(16, {9, 9, 9});
  parameters.group = {0, 0, 0, 0, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2};
  for (const auto mode : {TransformMode::kNone, TransformMode::kFunctions, TransformMode::kJoint}) {
    parameters.transform = mode;
    const auto stream = pack(field, parameters);
    ASSERT_TRUE(stream) << stream.error().message;
    DecodeOptions options;
    options.means_only = true;
    const auto whole = decode(*stream), part = decode(*stream, options);
    ASSERT_TRUE(whole && part);
    EXPECT_EQ(mean_colours(*part), mean_colours(*whole));
    EXPECT_FALSE(part->partial);
    EXPECT_LE(part->header.num_components(), 4);
    options.groups = 1;  // asked for: others are missed
    const auto less = decode(*stream, options);
    ASSERT_TRUE(less);
    EXPECT_TRUE(less->partial);
  }
}

INSTANTIATE_TEST_SUITE_P(OrdersAndScales, ViewMapsTest,
                         testing::Values(Shape{1, 0, 0}, Shape{2, 0, 0}, Shape{3, 0, 0},
                                         Shape{4, 0, 0}, Shape{1, 4, 3}, Shape{2, 4, 3},
                                         Shape{3, 4, 3}, Shape{4, 4, 3}, Shape{1, 0, 3},
                                         Shape{2, 0, 3}, Shape{3, 0, 3}, Shape{4, 0, 3},
                                         Shape{2, 1, 1}, Shape{4, 1, 2}, Shape{2, 6, 2},
                                         Shape{3, 2, 5}),
                         [](const auto& shape) { return name_of(shape.param); });

TEST(ViewMaps, DoNotDependOnTheNumberOfThreads) {
  const LightField field = random_field(Basis{}, ColourTransform::kOpponent, 1500);
  const ViewMaps one(field, 1), seven(field, 7);
  for (std::size_t p = 0; p < field.num_points(); ++p)
    ASSERT_EQ(one.radiance_unclamped(p, 1.1f, 0.3f), seven.radiance_unclamped(p, 1.1f, 0.3f));
}

}  // namespace
}  // namespace slf::view_map_test
