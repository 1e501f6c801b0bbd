// SPDX-License-Identifier: Apache-2.0
// Mean colours of a decode of no more than they need.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "slf/decoder.h"
#include "slf/view_map.h"

namespace slf::means_only_test {
namespace {

/// Among the streams are transforms over several groups, which all are needed where function 0 is
/// one of theirs.
TEST(Spec_8_9_MeansOnly, MeansOfEveryStreamAreThoseOfAllOfIt) {
  int compared = 0, fewer = 0;
  const auto streams = std::filesystem::path(SLF_CONFORMANCE) / "streams";
  for (const auto& folder : std::filesystem::directory_iterator(streams)) {
    std::ifstream in(folder.path() / "stream.slf", std::ios::binary);
    const std::vector<std::uint8_t> stream{std::istreambuf_iterator<char>(in), {}};
    DecodeOptions options;
    const auto whole = decode(stream, options);
    if (!whole || whole->header.num_components() == 0) continue;
    options.means_only = true;
    const auto part = decode(stream, options);
    ASSERT_TRUE(part) << folder;
    EXPECT_EQ(mean_colours(*part), mean_colours(*whole)) << folder;
    ++compared;
    fewer += part->header.num_components() < whole->header.num_components();
  }
  EXPECT_GT(compared, 100);
  EXPECT_GT(fewer, 10);
}

}  // namespace
}  // namespace slf::means_only_test
