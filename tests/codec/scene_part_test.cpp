// SPDX-License-Identifier: Apache-2.0
// Parts of a scene: fewer levels, groups, a region, beginnings of streams. Spec 8.9.
#include <array>
#include <cmath>

#include "bitstream/units.h"
#include "geometry/weight_classes.h"
#include "scene_support.h"
#include "slf/truncate.h"

namespace slf::scene_part_test {
namespace {

using namespace test;

void expect_same(const LightField& a, const LightField& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.components, b.components);
  EXPECT_EQ(a.normals.octahedral, b.normals.octahedral);
  EXPECT_EQ(a.header.grid.bits, b.header.grid.bits);
  EXPECT_EQ(a.header.coded, b.header.coded);
  EXPECT_EQ(a.partial, b.partial);
}

DecodeOptions part(int levels, int groups, std::optional<VoxelBox> region = {}) {
  DecodeOptions options;
  options.levels = levels;
  options.groups = groups;
  options.region = region;
  return options;
}

const VoxelBox kCorner{{0, 0, 0}, {22, 40, 63}};

class ScenePart : public testing::TestWithParam<SliceStart> {};

TEST_P(ScenePart, FewerLevelsHaveTheMeansOfNodes) {
  CodingParameters p = parameters_of({3, 1500, GetParam()}, 1, 1);
  const LightField field = test::make_field(test::sphere_cloud(kBits), kBits, 1);
  const auto stream = packed(field, p);
  for (int levels = 1; levels <= kBits; ++levels) {
    const LightField coarse = decoded(stream, part(levels, 0));
    std::vector<Voxel> nodes;
    std::vector<double> sum, weight;
    const int own = levels <= 3 ? 3 : kBits;  // cells of the base count as their classes
    for (std::size_t i = 0; i < field.num_points();) {
      Voxel cell = field.positions[i];
      for (auto& c : cell) c >>= kBits - own;
      double value = 0, points = 0;
      for (; i < field.num_points(); ++i, ++points) {
        Voxel other = field.positions[i];
        for (auto& c : other) c >>= kBits - own;
        if (other != cell) break;
        value += field.components[3 * i];
      }
      for (auto& c : cell) c >>= own - levels;
      if (nodes.empty() || nodes.back() != cell) {
        nodes.push_back(cell);
        sum.push_back(0);
        weight.push_back(0);
      }
      const double own_weight = 1u << weight_class(static_cast<std::uint64_t>(points));
      sum.back() += value / points * own_weight;
      weight.back() += own_weight;
    }
    ASSERT_EQ(coarse.positions, nodes) << levels;
    for (std::size_t n = 0; n < nodes.size(); ++n)
      ASSERT_NEAR(coarse.components[3 * n], sum[n] / weight[n], 3) << levels << " levels, " << n;
  }
}

TEST_P(ScenePart, TruncatedStreamsDecodeToThatPart) {
  const auto stream = scene(GetParam());
  for (int levels = 0; levels <= kBits; ++levels)
    for (int groups = 0; groups <= 3; ++groups)
      for (const bool region : {false, true}) {
        const DecodeOptions options =
            part(levels, groups, region ? std::optional(kCorner) : std::nullopt);
        const auto cut = truncate(stream, options);
        ASSERT_TRUE(cut) << to_string(cut.error());
        const LightField expected = decoded(stream, options);
        LightField again = decoded(*cut, options);
        again.partial =
            expected.partial;  // what is cut is partial, also where nothing was left out
        expect_same(again, expected);
        if (!region && (levels > 0 || groups > 0)) {
          LightField alone = decoded(*cut);
          alone.partial = expected.partial;
          expect_same(alone, expected);
        }
        if (levels > 0 && levels < 5) {
          EXPECT_LT(cut->size(), stream.size());
        }
        const auto twice = truncate(*cut, options);
        ASSERT_TRUE(twice) << to_string(twice.error());
        EXPECT_EQ(*twice, *cut);
      }
}

TEST_P(ScenePart, TruncatedToBytesIsNoLargerAndDecodes) {
  const auto stream = scene(GetParam());
  for (std::size_t bytes = 500; bytes < stream.size(); bytes += 777) {
    DecodeOptions options;
    options.max_bytes = bytes;
    const auto cut = truncate(stream, options);
    if (!cut) {
      EXPECT_EQ(cut.error().code, Errc::kInvalidArgument);
      continue;
    }
    EXPECT_LE(cut->size(), bytes);
    EXPECT_TRUE(decoded(*cut).partial);
    EXPECT_TRUE(read_info(*cut)->cut.has_value());
  }
}

TEST_P(ScenePart, ARegionIsTheWholeFiltered) {
  const auto stream = scene(GetParam());
  for (const int levels : {1, 3, 4, 6}) {
    const LightField whole = decoded(stream, part(levels, 0)),
                     some = decoded(stream, part(levels, 0, kCorner));
    const std::size_t planes = static_cast<std::size_t>(whole.num_planes());
    std::size_t at = 0;
    for (std::size_t i = 0; i < whole.num_points(); ++i) {
      bool inside = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int low = whole.positions[i][axis] << (kBits - levels);
        inside = inside && low <= kCorner.high[axis] &&
                 low + (1 << (kBits - levels)) > kCorner.low[axis];
      }
      if (!inside) continue;
      ASSERT_LT(at, some.num_points());
      EXPECT_EQ(some.positions[at], whole.positions[i]);
      EXPECT_EQ(some.normals.octahedral[at], whole.normals.octahedral[i]);
      for (std::size_t j = 0; j < planes; ++j)
        EXPECT_EQ(some.components[at * planes + j], whole.components[i * planes + j]);
      ++at;
    }
    EXPECT_EQ(at, some.num_points());
  }
}

TEST_P(ScenePart, ARegionIsHeldToTheLimitsByTheSlicesItMeets) {
  const auto stream = scene(GetParam());
  DecodeOptions whole = part(0, 0), some = part(0, 0, kCorner);
  whole.threads = some.threads = 1;
  some.limits.max_points = whole.limits.max_points = read_info(stream)->num_points - 1;
  const auto refused = decode(stream, whole);
  ASSERT_FALSE(refused);
  EXPECT_STREQ(refused.error().element, "max_points");
  expect_same(decoded(stream, some), decoded(stream, part(0, 0, kCorner)));
  some.limits.max_points = 10;
  EXPECT_FALSE(decode(stream, some));
  some.limits = {};
  some.limits.max_memory = 1;
  EXPECT_FALSE(decode(stream, some));
}

TEST_P(ScenePart, EveryBeginningOfUnitsIsThePartialScene) {
  const auto stream = scene(GetParam());
  const StreamInfo info = *read_info(stream);
  std::size_t with_base_colours = 0;
  for (const UnitInfo& unit : info.units) {
    if (unit.offset == 8) continue;  // no unit at all
    DecodeOptions options;
    options.max_bytes = unit.offset;
    const LightField field = decoded(stream, options);
    EXPECT_TRUE(field.partial);
    if (with_base_colours == 0 && !unit.base && unit.slice >= 0)
      with_base_colours = field.num_points();
  }
  EXPECT_EQ(with_base_colours, decoded(stream, part(3, 0)).num_points());
}

TEST_P(ScenePart, LevelsOfTheBaseOpenNoUnitOfASlice) {
  const auto stream = scene(GetParam());
  const Units units = *split_units(stream);
  const StreamInfo info = *read_info(stream);
  std::vector<std::uint8_t> wrong(kSignature.begin(), kSignature.end());
  for (std::size_t i = 0; i < units.units.size(); ++i) {
    std::vector<std::uint8_t> payload(units.units[i].payload.begin(), units.units[i].payload.end());
    if (info.units[i].slice >= 0)
      for (std::size_t at = std::min<std::size_t>(4, payload.size()); at < payload.size(); ++at)
        payload[at] ^= 0xA5;
    append_unit(wrong, units.units[i].type, payload);
  }
  EXPECT_FALSE(decode(wrong));
  for (int levels = 1; levels <= 3; ++levels)
    expect_same(decoded(wrong, part(levels, 0)), decoded(stream, part(levels, 0)));
}

TEST_P(ScenePart, TheErrorIsThatOfTheFirstWrongUnitWhateverTheThreads) {
  const auto stream = scene(GetParam());
  const Units units = *split_units(stream);
  const StreamInfo info = *read_info(stream);
  for (std::size_t bad = 0; bad < units.units.size(); ++bad) {
    if (info.units[bad].slice < 0) continue;
    std::vector<std::uint8_t> wrong(kSignature.begin(), kSignature.end());
    for (std::size_t i = 0; i < units.units.size(); ++i) {
      std::vector<std::uint8_t> payload(units.units[i].payload.begin(),
                                        units.units[i].payload.end());
      // Geometry has no codeword of so few bytes; a digest is another.
      if (i == bad) payload.resize(std::min<std::size_t>(payload.size(), 5));
      append_unit(wrong, units.units[i].type, payload);
    }
    DecodeOptions options;
    const auto one = decode(wrong, options);
    options.threads = 3;
    const auto three = decode(wrong, options);
    ASSERT_EQ(bool(one), bool(three));
    if (one) continue;
    EXPECT_EQ(one.error().code, three.error().code);
    EXPECT_STREQ(one.error().element, three.error().element);
  }
}

INSTANTIATE_TEST_SUITE_P(Spec_8_9, ScenePart,
                         testing::Values(SliceStart::kShared, SliceStart::kBase,
                                         SliceStart::kApart),
                         [](const auto& start) { return start_name(start.param); });

/// Root mean square error of a linear field at the nodes of a beginning of its stream.
double error_at_nodes(const LightField& part) {
  double squares = 0;
  for (std::size_t i = 0; i < part.num_points(); ++i) {
    const Voxel& v = part.positions[i];
    squares += std::pow(part.components[3 * i] - 100.0 * (v[0] + 2 * v[1] - v[2]), 2);
  }
  return std::sqrt(squares / static_cast<double>(part.num_points()));
}

TEST(Spec_8_9_2_IncompleteSlices, HaveInterpolatedColoursAtTheNodesKnown) {
  LightField field = test::make_field(test::sphere_cloud(7), 7, 1);
  for (std::size_t i = 0; i < field.num_points(); ++i) {
    const Voxel& v = field.positions[i];
    std::fill_n(&field.components[3 * i], 3, 100 * (v[0] + 2 * v[1] - v[2]));
  }
  CodingParameters p = parameters_of({3, 8000, SliceStart::kShared}, 1, 1);
  p.geometry_level_ends = {3, 6, 7};
  std::array<double, 2> error{};
  for (const bool predict : {false, true}) {
    p.predict = predict;
    const auto stream = packed(field, p);
    const StreamInfo info = *read_info(stream);
    DecodeOptions options;  // up to the last geometry of slice 0
    for (const UnitInfo& unit : info.units)
      if (options.max_bytes == 0 && unit.slice == 0 && unit.level_last == 6)
        options.max_bytes = unit.offset;
    error[predict] = error_at_nodes(decoded(stream, options));
  }
  EXPECT_GT(error[0], 500);  // cells of 16 voxels, one colour each
  EXPECT_LT(error[1], error[0] / 2);
}

TEST(Spec_7_1_Order, ABeginningOfATwentiethHasTheColoursOfTheBase) {
  const LightField field = test::make_field(test::sphere_cloud(7), 7, 16);
  CodingParameters p = parameters_of({-1, 8000, SliceStart::kShared}, 16, 4);
  const auto stream = packed(field, p);
  const StreamInfo info = *read_info(stream);
  DecodeOptions options;
  options.max_bytes = stream.size() / 20;
  const LightField beginning = decoded(stream, options);
  std::vector<Voxel> cells;
  for (Voxel v : beginning.positions) {
    for (auto& c : v) c >>= 7 - info.base_levels;
    if (cells.empty() || cells.back() != v) cells.push_back(v);
  }
  EXPECT_EQ(cells, decoded(stream, part(info.base_levels, 0)).positions);
  EXPECT_TRUE(std::any_of(beginning.components.begin(), beginning.components.end(),
                          [](auto value) { return value != 0; }));
}

}  // namespace
}  // namespace slf::scene_part_test
