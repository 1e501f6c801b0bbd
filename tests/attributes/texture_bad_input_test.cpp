// SPDX-License-Identifier: Apache-2.0
// Units of pictures that are damaged, cut off or out of range. Spec 7.6.
#include <functional>

#include "bitstream/bit_writer.h"
#include "bitstream/units.h"
#include "texture_support.h"

namespace slf::texture_bad_input_test {
namespace {

using namespace test;

/// The first coefficient unit's payload behind level_range, slice_id and plane_group replaced.
std::vector<std::uint8_t> with_texture_unit(
    const std::vector<std::uint8_t>& stream,
    const std::function<std::vector<std::uint8_t>(std::vector<std::uint8_t>)>& edit) {
  std::vector<std::uint8_t> out(kSignature.begin(), kSignature.end());
  bool done = false;
  const Units units = *split_units(stream);
  for (const Unit& unit : units.units) {
    std::vector<std::uint8_t> payload(unit.payload.begin(), unit.payload.end());
    if (unit.type == UnitType::kCoefficients && !std::exchange(done, true)) payload = edit(payload);
    append_unit(out, unit.type, payload);
  }
  return out;
}

void expect_refused(const std::vector<std::uint8_t>& stream, const char* element) {
  const auto decoded = decode(stream);
  ASSERT_FALSE(decoded) << element;
  EXPECT_STREQ(decoded.error().element, element);
}

/// A unit of one group of three planes: their flags and offsets, then `pictures`.
std::vector<std::uint8_t> texture_unit(std::uint64_t level_range,
                                       const std::vector<std::pair<int, std::int64_t>>& planes,
                                       std::span<const std::uint8_t> pictures = {}) {
  BitWriter out;
  out.ue(level_range);
  out.ue(0);
  out.ue(0);
  out.align();
  for (const auto& [flag, offset] : planes) {
    out.u(1, static_cast<std::uint64_t>(flag));
    out.se(offset);
  }
  out.append(pictures);
  return out.take();
}

TEST(Spec_7_6_Hazards, UnitsOutOfRangeAreRefusedByName) {
  LightField field = test::make_field(test::sphere_cloud(4), 4, 1);
  std::fill(field.components.begin(), field.components.end(), 5);
  CodingParameters parameters = texture_coding(1, 1 << 20, 12, false);
  parameters.index = parameters.digest = false;
  const auto stream = packed(field, parameters);
  const auto edited = [&](const std::vector<std::uint8_t>& unit) {
    return with_texture_unit(stream, [&](const auto&) { return unit; });
  };
  const std::vector<std::uint8_t> byte = {0};
  ASSERT_TRUE(decode(edited(texture_unit(0, {{0, 1}, {0, -2}, {0, (1 << 30) - 1}}))));
  expect_refused(edited(texture_unit(1, {{0, 1}, {0, 1}, {0, 1}})), "level_range");
  expect_refused(edited(texture_unit(0, {{0, 1}, {0, 1}, {0, 1 << 30}})), "tx_offset");
  expect_refused(edited(texture_unit(0, {{0, 1}, {1, -(1 << 20)}, {0, 1}})), "tx_offset");
  expect_refused(edited(texture_unit(0, {{0, 1}, {0, 1}, {0, 1}}, byte)), "tx_pictures");
  expect_refused(edited(texture_unit(0, {{0, 1}})), "tx_offset");
}

TEST(Spec_7_6_Hazards, EveryTruncationAndFlippedByteGivesAValueOrAnError) {
  SKIP_WITHOUT_HEVC();
  CodingParameters parameters = texture_coding(1, 16, 8, false);
  parameters.index = parameters.digest = false;
  const auto stream = packed(test::make_field(test::sphere_cloud(4), 4, 1), parameters);
  std::size_t size = 0;
  with_texture_unit(stream, [&](auto payload) { return size = payload.size(), payload; });
  for (std::size_t at = 0; at < size; ++at) {
    (void)decode(
        with_texture_unit(stream, [&](auto payload) { return payload.resize(at), payload; }));
    const auto damaged = with_texture_unit(stream, [&](auto payload) {
      payload[at] = static_cast<std::uint8_t>(payload[at] ^ 0x5A);
      return payload;
    });
    const auto decoded = decode(damaged);
    if (!decoded) {
      EXPECT_STRNE(decoded.error().element, "");
    }
  }
  const auto without_pictures =
      with_texture_unit(stream, [](auto payload) { return payload.resize(8), payload; });
  EXPECT_FALSE(decode(without_pictures));
}

}  // namespace
}  // namespace slf::texture_bad_input_test
