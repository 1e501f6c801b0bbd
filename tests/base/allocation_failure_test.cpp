// SPDX-License-Identifier: Apache-2.0
// Every allocation of a decode, and of an encode, fails once: the result is std::bad_alloc or an
// error, and nothing leaks (under AddressSanitizer, .ci/run).
#include <gtest/gtest.h>

#include <new>

#include "conformance/fields.h"
#include "failing_allocations.h"
#include "slf/decoder.h"
#include "slf/encoder.h"
#include "slf/truncate.h"

namespace slf::allocation_failure_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A base, three slices, two groups, normals, metadata.
LightField small_field() {
  LightField field = conformance::field(conformance::sphere(3), 3, 3, 300);
  field.normals.bits = 5;
  field.normals.octahedral.assign(field.num_points(), {3, 30});
  return field;
}

CodingParameters small_parameters() {
  CodingParameters parameters = conformance::with_steps(3, 8);
  parameters.group = {0, 1, 1};
  parameters.base_levels = 1;
  parameters.max_slice_points = 40;
  parameters.metadata = {{"source", "test"}};
  parameters.threads = 1;
  return parameters;
}

/// Lets the n-th allocation fail, and all behind it, for n = 0, 1, .. until there are no more.
/// attempt() returns whether it got what it should.
template <class Attempt>
long fail_each(const Attempt& attempt, long step = 1) {
  for (long n = 0;; n += step) {
    test::allocations_left = n;
    bool good = false, threw = false;
    try {
      good = attempt();
    } catch (const std::bad_alloc&) {
      threw = true;
    }
    const bool enough = test::allocations_left.exchange(-1) > 0;
    if (!enough) continue;
    EXPECT_TRUE(good && !threw) << "with " << n << " allocations";
    return n;
  }
}

void expect_all_failures_survived(const Bytes& stream, int threads, long step = 1) {
  DecodeOptions options;
  options.threads = threads;
  const auto whole = decode(stream, options);
  ASSERT_TRUE(whole) << to_string(whole.error());
  const long allocations = fail_each(
      [&] {
        const auto decoded = decode(stream, options);
        return decoded && decoded->components == whole->components;
      },
      step);
  EXPECT_GT(allocations, 50);
}

TEST(AllocationFailure, InADecodeIsBadAllocOrAnError) {
  expect_all_failures_survived(*pack(small_field(), small_parameters()), 1);
}

TEST(AllocationFailure, InADecodeOfAPartialStream) {
  const Bytes whole = *pack(small_field(), small_parameters());
  const auto info = *read_info(whole);
  const auto& middle = info.units[info.units.size() * 2 / 3];
  expect_all_failures_survived(
      Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(middle.offset)), 1);
}

TEST(AllocationFailure, InADecodeOfACutStream) {
  DecodeOptions options;
  options.levels = 2;
  options.groups = 1;
  expect_all_failures_survived(*truncate(*pack(small_field(), small_parameters()), options), 1);
}

TEST(AllocationFailure, InADecodeWithDraco) {
  LightField field = conformance::field(conformance::sphere(3), 3, 1, 300);
  CodingParameters parameters = conformance::with_steps(1, 8);
  parameters.geometry = GeometryCoder::kDraco;
  parameters.threads = 1;
  const auto stream = pack(field, parameters);
  if (!stream) GTEST_SKIP() << "Draco was left out of this build";
  expect_all_failures_survived(*stream, 1);
}

TEST(AllocationFailure, OnTwoThreadsIsSeenOnTheCallingOne) {
  expect_all_failures_survived(*pack(small_field(), small_parameters()), 2, 7);
}

TEST(AllocationFailure, InAnEncodeIsBadAllocOrAnError) {
  const LightField field = small_field();
  const CodingParameters parameters = small_parameters();
  const Bytes whole = *pack(field, parameters);
  const long allocations = fail_each([&] {
    const auto packed = pack(field, parameters);
    return packed && *packed == whole;
  });
  EXPECT_GT(allocations, 100);
}

TEST(AllocationFailure, InReadingHeadersAndInACut) {
  const Bytes whole = *pack(small_field(), small_parameters());
  DecodeOptions options;
  options.levels = 2;
  EXPECT_GT(fail_each([&] { return static_cast<bool>(read_info(whole)); }), 20);
  EXPECT_GT(fail_each([&] { return static_cast<bool>(truncate(whole, options)); }), 20);
}

/// What a slice needed beside its points is given back before the next but few are begun.
TEST(DecodeMemory, DoesNotGrowFromSliceToSlice) {
  const LightField field = conformance::field(conformance::sphere(6), 6, 1, 300);
  CodingParameters parameters = conformance::with_steps(1, 8);
  parameters.base_levels = 3;
  parameters.max_slice_points = 300;
  parameters.slice_start = SliceStart::kBase;
  const auto stream = pack(field, parameters);
  ASSERT_TRUE(stream);
  const std::size_t slices = read_info(*stream)->slices.size();
  ASSERT_GE(slices, 30u);
  std::vector<long> live;  // as each unit is begun
  DecodeOptions options;
  options.progress = [&](double) {
    live.push_back(test::live_bytes);
    return true;
  };
  ASSERT_TRUE(decode(*stream, options));
  ASSERT_GE(live.size(), 2 * slices);  // a unit of geometry and one of coefficients
  const std::size_t last = live.size() - 1;
  const long growth = live[last] - live[last - 2 * (slices - 3)];
  EXPECT_LT(growth, 2 * static_cast<long>(field.num_points()));
}

/// Bytes that a decode has live at most.
long most_live(const Bytes& stream, const DecodeOptions& options) {
  const long before = test::live_bytes;
  test::most_live_bytes = before;
  EXPECT_TRUE(decode(stream, options));
  return test::most_live_bytes - before;
}

/// The points of a part are not known before its geometry is: they are decoded apart, and moved.
TEST(DecodeMemory, HasTheComponentsOfAPartOfOneSliceOnce) {
  const LightField field = conformance::field(conformance::sphere(5), 5, 60, 300);
  CodingParameters parameters = conformance::with_steps(60, 8);
  parameters.coefficients = CoefficientCoder::kIndependent;  // which needs little beside
  parameters.predict = false;
  const auto stream = pack(field, parameters);
  ASSERT_TRUE(stream);
  DecodeOptions everything_there_is;
  everything_there_is.region = VoxelBox{{0, 0, 0}, {31, 31, 31}};
  const long whole = most_live(*stream, {}), part = most_live(*stream, everything_there_is);
  const auto components = static_cast<long>(4 * field.components.size());
  EXPECT_GT(components, 500000);
  EXPECT_LT(part, whole + components / 4);
}

}  // namespace
}  // namespace slf::allocation_failure_test
