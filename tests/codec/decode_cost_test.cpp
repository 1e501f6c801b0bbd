// SPDX-License-Identifier: Apache-2.0
// What a decode is said to take is what it is refused for.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "slf/decoder.h"

namespace slf::decode_cost_test {
namespace {

std::vector<std::uint8_t> bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Spec_9_DecodeCost, IsTheLimitThatLetsWholeCutAndPartialStreamsPass) {
  int compared = 0;
  const auto streams = std::filesystem::path(SLF_CONFORMANCE) / "streams";
  for (const auto& folder : std::filesystem::directory_iterator(streams)) {
    const auto stream = bytes_of(folder.path() / "stream.slf");
    for (const int part : {0, 1}) {
      DecodeOptions options;
      options.levels = options.groups = part;
      if (!decode(stream, options)) continue;  // Draco, textures: left out of some builds
      const auto cost = decode_cost(stream, options);
      ASSERT_TRUE(cost) << folder;
      options.limits.max_memory = cost->memory_most;
      options.limits.max_work = cost->work;
      EXPECT_TRUE(decode(stream, options)) << folder;
      if (cost->work == 0) continue;  // a scene without points
      --options.limits.max_work;
      EXPECT_FALSE(decode(stream, options)) << folder;
      options.limits.max_work = cost->work;
      --options.limits.max_memory;
      EXPECT_FALSE(decode(stream, options)) << folder;
      ++compared;
    }
  }
  EXPECT_GT(compared, 200);
}

/// Two threads have two slices in flight; where there is no room for that, one decodes them.
TEST(Spec_9_DecodeCost, ThreadsAreAsManyAsTheMemoryHasRoomFor) {
  const auto stream =
      bytes_of(std::filesystem::path(SLF_CONFORMANCE) / "streams" / "scene-alone" / "stream.slf");
  DecodeOptions options;
  const auto one = decode_cost(stream, options);
  ASSERT_TRUE(one);
  options.threads = 2;
  const auto two = decode_cost(stream, options);
  ASSERT_TRUE(two);
  ASSERT_GT(two->memory_most, one->memory_most);
  options.limits.max_memory = one->memory_most;
  EXPECT_EQ(decode_cost(stream, options)->memory_most, one->memory_most);
  EXPECT_TRUE(decode(stream, options));
}

}  // namespace
}  // namespace slf::decode_cost_test
