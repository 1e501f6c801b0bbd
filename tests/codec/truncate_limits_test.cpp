// SPDX-License-Identifier: Apache-2.0
// Limits of truncate(): what it makes is decoded within them, or it is not made.
#include <gtest/gtest.h>

#include <vector>

#include "bitstream/units.h"
#include "codec/encoder/assemble.h"
#include "slf/decoder.h"
#include "slf/encoder.h"
#include "slf/truncate.h"

namespace slf::truncate_limits_test {
namespace {

using Stream = std::vector<std::uint8_t>;

/// 4096 points whose values say nothing, and a unit of 3 MB that has no meaning.
Stream padded_field() {
  LightField field;
  field.header.grid = {{0, 0, 0}, 1, 4};
  field.header.has_basis = false;
  field.header.num_functions = 512;
  for (std::int32_t i = 0; i < 4096; ++i) field.positions.push_back({i % 16, i / 16 % 16, i / 256});
  field.components.assign(field.num_points() * 3 * 512, 7);
  CodingParameters parameters;
  parameters.step.assign(512, {1, 1, 1});
  parameters.group.assign(512, 0);
  parameters.group.back() = 1;
  parameters.index = parameters.digest = false;
  const Stream packed = *pack(field, parameters);
  const Units units = *split_units(packed);
  Stream stream(packed.begin(),
                packed.begin() + static_cast<std::ptrdiff_t>(units.units.back().offset));
  append_unit(stream, UnitType::kFiller, Stream(3000000));
  append_unit(stream, UnitType::kEnd, end_payload(units.units.size()));
  return stream;
}

TEST(TruncateLimits, ACutThatTheLimitsOfItsBytesRefuseIsNotMade) {
  const Stream stream = padded_field();
  DecodeOptions options;
  options.groups = 1;
  options.limits.max_values_per_byte = 1;
  const auto whole = decode(stream, options);
  EXPECT_TRUE(whole) << to_string(whole.error());
  const auto cut = truncate(stream, options);
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().code, Errc::kLimitExceeded);
  EXPECT_STREQ(cut.error().element, "max_values_per_byte");
  options.limits.max_values_per_byte = 1 << 14;
  const auto allowed = truncate(stream, options);
  ASSERT_TRUE(allowed) << to_string(allowed.error());
  EXPECT_LT(allowed->size(), 300000u);
  EXPECT_TRUE(decode(*allowed, options));
}

}  // namespace
}  // namespace slf::truncate_limits_test
