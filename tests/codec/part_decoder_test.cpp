// SPDX-License-Identifier: Apache-2.0
// Parts of a stream that are decoded without reading the rest.
#include "slf/part_decoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "bitstream/units.h"

namespace slf::part_decoder_test {
namespace {

/// A stream in memory that counts what is read of it.
struct Counted {
  std::vector<std::uint8_t> stream;
  std::uint64_t read = 0;

  explicit Counted(const std::filesystem::path& folder) {
    std::ifstream in(folder / "stream.slf", std::ios::binary);
    stream.assign(std::istreambuf_iterator<char>(in), {});
  }
  StreamSource source() {
    return {stream.size(), [this](std::uint64_t offset, std::span<std::uint8_t> to) {
              if (offset > stream.size() || to.size() > stream.size() - offset) return false;
              std::copy_n(stream.begin() + static_cast<std::ptrdiff_t>(offset), to.size(),
                          to.begin());
              read += to.size();
              return true;
            }};
  }
};

std::filesystem::path streams() { return std::filesystem::path(SLF_CONFORMANCE) / "streams"; }

/// Parts of every kind, alone and together.
std::vector<DecodeOptions> parts_of(const StreamBeginning& beginning, std::uint64_t stream_bytes) {
  const StreamInfo& info = beginning.info;
  const int bits = info.header.grid.bits, half = 1 << (bits - 1);
  std::vector<DecodeOptions> all;
  for (const int levels : {0, 1, bits - 1})
    for (const int groups : {0, std::min(1, info.num_groups)})
      for (const bool region : {false, true})
        for (const bool means_only : {false, true}) {
          DecodeOptions options;
          options.levels = levels;
          options.groups = groups;
          options.means_only = means_only;
          if (region) options.region = VoxelBox{{0, 0, 0}, {half, half, half / 2}};
          all.push_back(options);
        }
  DecodeOptions one_layer;
  one_layer.layers = 1;
  all.push_back(one_layer);
  for (std::uint64_t eighth = 1; eighth <= 9; ++eighth) {
    DecodeOptions options;
    options.max_bytes = stream_bytes * eighth / 8;
    all.push_back(options);
  }
  return all;
}

void expect_equal(const LightField& part, const LightField& whole) {
  EXPECT_EQ(part.positions, whole.positions);
  EXPECT_EQ(part.components, whole.components);
  EXPECT_EQ(part.normals.bits, whole.normals.bits);
  EXPECT_EQ(part.normals.octahedral, whole.normals.octahedral);
  EXPECT_EQ(part.partial, whole.partial);
  EXPECT_EQ(part.header.coded, whole.header.coded);
  EXPECT_EQ(part.header.shift, whole.header.shift);
  EXPECT_EQ(part.header.num_functions, whole.header.num_functions);
  EXPECT_EQ(part.header.transforms.size(), whole.header.transforms.size());
  EXPECT_EQ(part.header.grid.bits, whole.header.grid.bits);
  EXPECT_EQ(part.header.grid.step, whole.header.grid.step);
  EXPECT_EQ(part.header.grid.origin, whole.header.grid.origin);
}

TEST(Spec_8_9_PartDecoder, GivesWhatADecodeOfTheWholeGivesInEveryStream) {
  int compared = 0, less = 0;
  for (const auto& folder : std::filesystem::directory_iterator(streams())) {
    SCOPED_TRACE(folder.path().filename().string());
    Counted counted(folder.path());
    const StreamSource source = counted.source();
    const auto beginning = read_beginning(source);
    ASSERT_TRUE(beginning) << to_string(beginning.error());
    if (!*beginning) continue;
    for (const DecodeOptions& options : parts_of(**beginning, source.bytes)) {
      counted.read = 0;
      const auto part = decode_part(source, **beginning, options);
      const auto whole = decode(counted.stream, options);
      if (!whole) {  // what this build has not, or no room for headers: never more than decode()
        EXPECT_TRUE(!part || !*part) << to_string(whole.error());
        continue;
      }
      ASSERT_TRUE(part) << to_string(part.error());
      if (!*part) continue;
      expect_equal(**part, *whole);
      ++compared;
      less += (*beginning)->bytes.size() + counted.read < source.bytes;
    }
  }
  EXPECT_GT(compared, 1000);
  EXPECT_GT(less, 1000);
}

TEST(Spec_8_9_PartDecoder, TheMetadataOfTheStreamsEndAreRead) {
  int behind = 0;
  for (const auto& folder : std::filesystem::directory_iterator(streams())) {
    SCOPED_TRACE(folder.path().filename().string());
    Counted counted(folder.path());
    const auto whole = read_info(counted.stream);
    if (!whole) continue;
    const auto beginning = read_beginning(counted.source());
    ASSERT_TRUE(beginning) << to_string(beginning.error());
    if (!*beginning) continue;
    const auto metadata = read_metadata(counted.source(), **beginning);
    ASSERT_TRUE(metadata) << to_string(metadata.error());
    EXPECT_EQ(*metadata, whole->metadata);
    const auto unit = std::find_if(whole->units.begin(), whole->units.end(),
                                   [](const UnitInfo& u) { return u.type == "metadata"; });
    if (unit == whole->units.end() || unit->offset < (*beginning)->bytes.size()) continue;
    ++behind;
    counted.stream[unit->offset + unit->bytes - 1] ^= 1;  // its checksum
    EXPECT_FALSE(read_metadata(counted.source(), **beginning));
  }
  EXPECT_GT(behind, 0);
}

TEST(Spec_8_9_PartDecoder, LeavesToDecodeWhatIsNoPart) {
  Counted counted(streams() / "scene-shared");
  const StreamSource source = counted.source();
  const auto beginning = read_beginning(source);
  ASSERT_TRUE(beginning && *beginning);
  counted.read = 0;
  DecodeOptions all, levels, means, bytes, headers;
  levels.levels = (*beginning)->info.header.grid.bits;
  means.means_only = true;
  bytes.max_bytes = source.bytes;
  headers.max_bytes = (*beginning)->bytes.size() - 1;
  for (const DecodeOptions& options : {all, levels, means, bytes, headers}) {
    const auto part = decode_part(source, **beginning, options);
    ASSERT_TRUE(part);
    EXPECT_FALSE(part->has_value());
  }
  EXPECT_EQ(counted.read, 0u);
}

TEST(Spec_8_9_PartDecoder, ABeginningIsOfAStreamThatIsWhole) {
  for (const char* name : {"no-index-no-digest", "scene-prefix-14"}) {
    Counted counted(streams() / name);
    const auto beginning = read_beginning(counted.source());
    ASSERT_TRUE(beginning) << name;
    EXPECT_FALSE(beginning->has_value()) << name;
  }
  Counted counted(streams() / "scene-shared");
  for (const int change : {-1, 1}) {
    Counted other = counted;
    other.stream.resize(other.stream.size() + static_cast<std::size_t>(change));
    const auto beginning = read_beginning(other.source());
    EXPECT_TRUE(!beginning || !*beginning) << change;
  }
}

TEST(Spec_8_9_PartDecoder, ASourceThatFailsIsUnreadable) {
  Counted counted(streams() / "scene-shared");
  StreamSource source = counted.source();
  const auto beginning = read_beginning(source);
  ASSERT_TRUE(beginning && *beginning);
  source.read = [](std::uint64_t, std::span<std::uint8_t>) { return false; };
  DecodeOptions options;
  options.levels = 1;
  const auto part = decode_part(source, **beginning, options);
  ASSERT_FALSE(part);
  EXPECT_EQ(part.error().code, Errc::kUnreadable);
  const auto none = read_beginning(source);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::kUnreadable);
}

TEST(Spec_8_9_PartDecoder, LimitsHoldForWhatIsRead) {
  Counted counted(streams() / "scene-shared");
  const StreamSource source = counted.source();
  DecodeLimits limits;
  limits.max_stream_bytes = source.bytes - 1;
  const auto long_one = read_beginning(source, limits);
  ASSERT_FALSE(long_one);
  EXPECT_EQ(long_one.error().code, Errc::kLimitExceeded);
  EXPECT_EQ(counted.read, 0u);
  limits = {};
  limits.max_memory = 100;
  const auto large = read_beginning(source, limits);
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, Errc::kLimitExceeded);
  EXPECT_EQ(counted.read, 0u);
}

/// It would be held beside what is decoded.
TEST(Spec_8_9_PartDecoder, ALongFillerBeforeTheIndexIsNotReadForAPart) {
  Counted counted(streams() / "slices");
  const Units units = *split_units(counted.stream);
  std::vector<std::uint8_t> filler;
  append_unit(filler, UnitType::kFiller, std::vector<std::uint8_t>(1 << 20));
  const Unit* index = units.first(UnitType::kIndex);
  ASSERT_NE(index, nullptr);
  counted.stream.insert(counted.stream.begin() + static_cast<std::ptrdiff_t>(index->offset),
                        filler.begin(), filler.end());
  DecodeLimits limits;
  limits.max_memory = counted.stream.size();
  const auto beginning = read_beginning(counted.source(), limits);
  ASSERT_TRUE(beginning);
  EXPECT_FALSE(beginning->has_value());
  EXPECT_LE(counted.read, limits.max_memory / 4);
  limits.max_memory *= 8;
  const auto affordable = read_beginning(counted.source(), limits);
  EXPECT_TRUE(affordable && *affordable);
}

}  // namespace
}  // namespace slf::part_decoder_test
