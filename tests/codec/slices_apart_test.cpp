// SPDX-License-Identifier: Apache-2.0
// Slices that are coded knowing their own points alone, and added to the base.
// Spec 7.3, 8.1, 8.8.3.
#include "bitstream/index.h"
#include "codec/encoder/pack_parameters.h"
#include "codec/encoder/slice_encoder.h"
#include "codec/scene_units.h"
#include "codec/sequence.h"
#include "geometry/morton.h"
#include "scene_support.h"

namespace slf::slices_apart_test {
namespace {

using namespace test;

constexpr int kBaseLevels = 3;

CodingParameters apart() {
  CodingParameters p = parameters_of({kBaseLevels, 1500, SliceStart::kApart}, kFunctions, 12);
  p.geometry_level_ends = {2, 5, 6};
  p.coefficient_level_ends = {2, 5, 6};
  p.quality_layers = 2;
  p.rdo = 0.4;
  return p;
}

/// Payloads of the units of a slice; of the base for SliceUnitHeader::kBase.
std::vector<std::vector<std::uint8_t>> units_of(std::span<const std::uint8_t> stream,
                                                std::uint32_t slice) {
  const Units units = *split_units(stream);
  const SequenceParameterSet set = *find_sequence(units);
  std::vector<std::vector<std::uint8_t>> out;
  for (const Unit& unit : units.units)
    if (has_ids(unit.type) && read_ids(unit, set)->slice_id == slice)
      out.emplace_back(unit.payload.begin(), unit.payload.end());
  return out;
}

SliceTable table_of(std::span<const std::uint8_t> stream) {
  const Units units = *split_units(stream);
  return collect_units(units, *find_sequence(units))->stream.table;
}

/// In Morton order, as slices hold them.
std::vector<std::uint64_t> codes_of(const LightField& field) {
  std::vector<std::uint64_t> codes;
  for (const Voxel& v : field.positions) codes.push_back(morton(v));
  return codes;
}

TEST(Spec_7_3_SlicesApart, HaveUnitsThatNoOtherSliceChanges) {
  LightField field = decoded(packed(sphere(), apart()));  // in Morton order
  const auto before = packed(field, apart());
  const SliceTable table = table_of(before);
  ASSERT_GE(table.slices.size(), 3u);
  ASSERT_TRUE(table.apart());
  const std::size_t planes = static_cast<std::size_t>(field.num_planes()),
                    first = table.slices[0].points(), end = first + table.slices[1].points();
  for (std::size_t i = first * planes; i < end * planes; ++i)
    field.components[i] = 3 * field.components[i] + static_cast<int>(i % 41);
  for (std::size_t p = first; p < end; ++p) field.normals.octahedral[p] = {1, 2};
  const auto after = packed(field, apart());
  for (std::uint32_t s = 0; s < table.slices.size(); ++s)
    EXPECT_EQ(units_of(before, s) == units_of(after, s), s != 1) << s;
  EXPECT_NE(units_of(before, SliceUnitHeader::kBase), units_of(after, SliceUnitHeader::kBase));
}

/// The layout of a scene of one slice: its cells, and no word of others.
SceneLayout layout_of_slice(std::span<const std::uint64_t> codes, std::size_t slice) {
  SceneLayout layout;
  layout.base_levels = kBaseLevels;
  layout.weight_before = {0};
  for (const std::uint64_t code : codes) {
    const std::uint64_t cell = code >> 3 * (kBits - kBaseLevels);
    if (!layout.cells.empty() && layout.cells.back() == cell) continue;
    layout.cells.push_back(cell);
    layout.classes.push_back(4);
    layout.weight_before.push_back(layout.weight_before.back() + 16);
  }
  layout.cuts = {{0, 0, codes.size()}};
  layout.first_slice = slice;
  layout.table.slices_start = static_cast<std::uint32_t>(SliceStart::kApart);
  layout.table.slices = {{static_cast<std::uint32_t>(layout.cells.size() - 1),
                          static_cast<std::uint32_t>(codes.size() - 1)}};
  return layout;
}

TEST(Spec_7_3_SlicesApart, AreCodedByThemselvesToTheSameBytes) {
  LightField field = decoded(packed(sphere(), apart()));
  const auto stream = packed(field, apart());
  const SequenceParameterSet set = *find_sequence(*split_units(stream));
  const SliceCoding coding{set, plane_groups(set), plane_steps(set), true, {}, apart().rdo};
  const UnitLayout slots = layout_of(set);
  const std::vector<std::uint64_t> codes = codes_of(field);
  const std::size_t planes = static_cast<std::size_t>(field.num_planes());
  std::size_t begin = 0;
  const SliceTable table = table_of(stream);
  for (std::size_t s = 0; s < table.slices.size(); ++s) {
    const std::size_t points = table.slices[s].points();
    const auto own = std::span(codes).subspan(begin, points);
    const SceneLayout layout = layout_of_slice(own, s);
    const SliceToEncode slice{coding,
                              layout,
                              slots_of(slots, Owner::kSlice),
                              s,
                              {own, std::span(field.positions).subspan(begin, points),
                               std::span(field.components).subspan(begin * planes, points * planes),
                               std::span(field.normals.octahedral).subspan(begin, points)},
                              nullptr};
    std::vector<std::int32_t> base_input(layout.cells.size() * planes);
    std::vector<std::vector<std::uint8_t>> units;
    const CodedUnits geometry = *encode_slice_geometry(slice, nullptr);
    SliceTree tree = *transform_slice(slice, base_input, 1);
    const CodedUnits values = *encode_slice_values(slice, std::move(tree), nullptr, 1);
    for (const CodedUnits& coded : {geometry, values})
      for (const CodedUnit& unit : coded) units.push_back(unit.payload);
    EXPECT_EQ(units, units_of(stream, static_cast<std::uint32_t>(s))) << s;
    begin += points;
  }
}

/// Where a slice's coefficients are not there yet, and those of the base are.
TEST(Spec_8_8_3_SlicesApart, WithoutCoefficientsHaveTheMeansOfTheirCells) {
  const auto stream = packed(sphere(), apart());
  DecodeOptions of_base, beginning;
  of_base.levels = kBaseLevels;
  const LightField means = decoded(stream, of_base);
  const StreamInfo info = *read_info(stream);
  for (const UnitInfo& unit : info.units)
    if (beginning.max_bytes == 0 && unit.slice == 0 && unit.type == "coefficients")
      beginning.max_bytes = unit.offset;
  for (int levels = kBaseLevels + 1; levels <= kBits; ++levels) {
    beginning.levels = levels;
    const LightField field = decoded(stream, beginning);
    const std::size_t planes = static_cast<std::size_t>(field.num_planes());
    std::size_t cell = 0;
    for (std::size_t p = 0; p < field.num_points(); ++p) {
      Voxel at = field.positions[p];
      for (auto& c : at) c >>= levels - kBaseLevels;
      if (at != means.positions[cell]) ++cell;
      ASSERT_EQ(at, means.positions[cell]);
      ASSERT_TRUE(std::equal(&field.components[p * planes], &field.components[p * planes] + planes,
                             &means.components[cell * planes]));
    }
    EXPECT_EQ(cell + 1, means.num_points());
  }
}

}  // namespace
}  // namespace slf::slices_apart_test
