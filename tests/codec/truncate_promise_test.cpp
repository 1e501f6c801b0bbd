// SPDX-License-Identifier: Apache-2.0
// The promise of truncate(), over the whole suite: decode() of what it makes, with the same
// options, is decode() of the stream with them. Of whole, cut and damaged streams.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "bitstream/units.h"
#include "slf/decoder.h"
#include "slf/frames.h"
#include "slf/join_frames.h"
#include "slf/truncate.h"
#include "tests/fuzz/fuzz.h"

namespace slf::truncate_promise_test {
namespace {

using Stream = std::vector<std::uint8_t>;

std::vector<std::filesystem::path> suite() {
  std::vector<std::filesystem::path> folders;
  for (const auto& folder :
       std::filesystem::directory_iterator(std::filesystem::path(SLF_CONFORMANCE) / "streams"))
    folders.push_back(folder.path());
  std::sort(folders.begin(), folders.end());
  return folders;
}

Stream read(const std::filesystem::path& folder) {
  std::ifstream file(folder / "stream.slf", std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
  return {bytes.begin(), bytes.end()};
}

/// The whole, one end, a plate and a voxel of the middle, and nothing, of a grid of so many bits.
std::vector<std::optional<VoxelBox>> regions_of(int bits) {
  const std::int32_t side = 1 << bits, half = side / 2;
  return {VoxelBox{{0, 0, 0}, {side - 1, side - 1, side - 1}},
          VoxelBox{{half, 0, 0}, {side - 1, half, side - 1}},
          VoxelBox{{0, 0, side / 3}, {side - 1, side - 1, side / 3}},
          VoxelBox{{half, half, half}, {half, half, half}},
          VoxelBox{{2 * side, 0, 0}, {2 * side, 1, 1}}};
}

/// Each option by itself, then levels and layers of regions.
std::vector<DecodeOptions> options_of(const StreamInfo& info) {
  std::vector<DecodeOptions> all(1);
  const auto add = [&](int levels, int groups, int layers, std::optional<VoxelBox> region) {
    DecodeOptions options;
    options.levels = levels;
    options.groups = groups;
    options.layers = layers;
    options.region = region;
    all.push_back(options);
  };
  const int bits = info.header.grid.bits;
  int layers = 0;
  for (const int of_group : info.layers) layers = std::max(layers, of_group);
  for (int levels = 1; levels <= bits; ++levels) add(levels, 0, 0, {});
  for (int groups = 1; groups <= info.num_groups; ++groups) add(0, groups, 0, {});
  for (int layer = 1; layer <= layers; ++layer) add(0, 0, layer, {});
  for (const auto& region : regions_of(bits)) {
    add(0, 0, 0, region);
    add(std::max(bits - 1, 1), 1, 1, region);
    add(std::max(info.base_levels, 1), 0, 0, region);
  }
  all.emplace_back().means_only = true;
  return all;
}

void expect_equal(const LightField& cut, const LightField& whole) {
  EXPECT_EQ(cut.positions, whole.positions);
  EXPECT_EQ(cut.components, whole.components);
  EXPECT_EQ(cut.normals.bits, whole.normals.bits);
  EXPECT_EQ(cut.normals.octahedral, whole.normals.octahedral);
  EXPECT_EQ(cut.header.coded, whole.header.coded);
  EXPECT_EQ(cut.header.transforms.size(), whole.header.transforms.size());
  EXPECT_EQ(cut.header.grid.step, whole.header.grid.step);
  EXPECT_EQ(cut.header.grid.origin, whole.header.grid.origin);
  EXPECT_TRUE(cut.partial || !whole.partial);
}

/// 1 where the promise was to be kept, and was looked at.
int check_promise(const Stream& stream, DecodeOptions options) {
  options.limits = fuzz::small_limits();
  options.limits.max_points = 1 << 18;
  options.limits.max_memory = 1 << 28;
  options.limits.max_work = 1 << 28;
  const auto whole = decode(stream, options);
  if (!whole) return 0;
  SCOPED_TRACE("levels " + std::to_string(options.levels) + " groups " +
               std::to_string(options.groups) + " layers " + std::to_string(options.layers) +
               (options.region ? " region from " + std::to_string(options.region->low[0]) + " " +
                                     std::to_string(options.region->low[1]) + " " +
                                     std::to_string(options.region->low[2])
                               : ""));
  const auto cut = truncate(stream, options);
  EXPECT_TRUE(cut) << to_string(cut.error());
  if (!cut) return 0;
  EXPECT_LE(cut->size(), stream.size());
  const auto again = decode(*cut, options);
  EXPECT_TRUE(again) << to_string(again.error());
  if (again) expect_equal(*again, *whole);
  return 1;
}

/// A stream of one light field that this build decodes. No region is cut out of frames.
bool has_one_light_field(const Stream& stream) {
  const auto frames = list_frames(stream);
  return frames && !is_of_frames(stream) && decode(stream);
}

TEST(Spec_8_9_TruncatePromise, HoldsForEveryOptionOfEveryStream) {
  int checked = 0, streams = 0;
  for (const auto& folder : suite()) {
    SCOPED_TRACE(folder.filename().string());
    const Stream stream = read(folder);
    if (!has_one_light_field(stream)) continue;
    ++streams;
    const auto info = read_info(stream);
    ASSERT_TRUE(info);
    for (const DecodeOptions& options : options_of(*info))
      checked += check_promise(stream, options);
  }
  EXPECT_GT(streams, 120);
  EXPECT_GT(checked, 3000);
}

TEST(Spec_8_9_TruncatePromise, HoldsForStreamsThatWereCut) {
  int checked = 0;
  for (const auto& folder : suite()) {
    SCOPED_TRACE(folder.filename().string());
    const Stream stream = read(folder);
    if (!has_one_light_field(stream)) continue;
    const auto info = read_info(stream);
    ASSERT_TRUE(info);
    const std::size_t units = info->units.size();
    for (const std::size_t kept : {units / 4, units / 2, 3 * units / 4, units - 1}) {
      const auto& last = info->units[std::max<std::size_t>(kept, 1) - 1];
      const auto end = stream.begin() + static_cast<std::ptrdiff_t>(last.offset + last.bytes);
      for (const auto& region : regions_of(info->header.grid.bits)) {
        DecodeOptions options;
        options.region = region;
        checked += check_promise({stream.begin(), end}, options);
        options.levels = std::max(info->header.grid.bits - 1, 1);
        checked += check_promise({stream.begin(), end}, options);
      }
    }
  }
  EXPECT_GT(checked, 2000);
}

TEST(Spec_8_9_TruncatePromise, ACutIsNeverLongerThanTheStreamOrThanWasAskedFor) {
  int checked = 0, within = 0;
  for (const auto& folder : suite()) {
    SCOPED_TRACE(folder.filename().string());
    const Stream stream = read(folder);
    if (!has_one_light_field(stream)) continue;
    const auto info = read_info(stream);
    ASSERT_TRUE(info);
    const UnitInfo& last = info->units[info->units.size() * 2 / 3];
    const auto end = stream.begin() + static_cast<std::ptrdiff_t>(last.offset + last.bytes);
    for (DecodeOptions options : options_of(*info)) {
      if (!options.region) checked += check_promise({stream.begin(), end}, options);
      options.max_bytes = stream.size() - stream.size() / 5;
      const auto cut = truncate(stream, options);
      if (!cut) continue;
      EXPECT_LE(cut->size(), options.max_bytes);
      ++within;
    }
  }
  EXPECT_GT(checked, 500);
  EXPECT_GT(within, 2000);
}

/// A sequence unit of a later version becomes one of this: 7.1.2.
Stream behind_sequence(const Stream& stream) {
  const Unit sequence = *read_unit(stream, kSignature.size());
  return {stream.begin() + static_cast<std::ptrdiff_t>(sequence.offset + sequence.bytes),
          stream.end()};
}

TEST(Spec_8_9_TruncatePromise, WhereNothingIsLeftOutTheStreamIsAsItWas) {
  int streams = 0, same = 0;
  for (const auto& folder : suite()) {
    SCOPED_TRACE(folder.filename().string());
    const Stream stream = read(folder);
    const auto info = read_info(stream);
    if (!info || !has_one_light_field(stream)) continue;
    for (std::size_t u = 0; u < info->units.size(); u += 3) {
      const UnitInfo& last = info->units[info->units.size() - 1 - u];
      const Stream begin(stream.begin(),
                         stream.begin() + static_cast<std::ptrdiff_t>(last.offset + last.bytes));
      const auto copy = truncate(begin, {});
      EXPECT_EQ(static_cast<bool>(copy), static_cast<bool>(decode(begin))) << last.type;
      if (copy) {
        EXPECT_EQ(behind_sequence(*copy), behind_sequence(begin));
        EXPECT_LE(copy->size(), begin.size());
        same += *copy == begin;
      }
      ++streams;
    }
  }
  EXPECT_GT(streams, 1000);
  EXPECT_GT(same, 1000);
}

TEST(Spec_8_9_TruncatePromise, HoldsForDamagedStreamsAsFarAsTheyDecode) {
  std::mt19937 random(42);
  int checked = 0;
  for (const auto& folder : suite()) {
    SCOPED_TRACE(folder.filename().string());
    const Stream stream = read(folder);
    if (!has_one_light_field(stream)) continue;
    for (int damage = 0; damage < 8; ++damage) {
      Stream damaged = stream;
      damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
      damaged = fuzz::with_sound_crcs(damaged);
      DecodeOptions options;
      options.levels = damage % 4;
      options.groups = damage / 4;
      checked += check_promise(damaged, options);
      options.region = VoxelBox{{0, 0, 0}, {1 << (2 * damage), 1 << damage, 1 << damage}};
      checked += check_promise(damaged, options);
    }
  }
  EXPECT_GT(checked, 300);
}

TEST(Spec_8_9_TruncatePromise, HoldsForEveryFrame) {
  int checked = 0;
  for (const auto& folder : suite()) {
    SCOPED_TRACE(folder.filename().string());
    const Stream stream = read(folder);
    const auto frames = list_frames(stream);
    if (!frames || frames->size() < 2) continue;
    for (const int levels : {0, 1, 3})
      for (const int groups : {0, 1}) {
        DecodeOptions options;
        options.levels = levels;
        options.groups = groups;
        const auto cut = truncate(stream, options);
        auto whole = FrameDecoder::open(stream, options);
        if (!cut || !whole) continue;
        EXPECT_LE(cut->size(), stream.size());
        auto left = FrameDecoder::open(*cut, options);
        ASSERT_TRUE(left) << to_string(left.error());
        ASSERT_EQ(left->frames().size(), frames->size());
        for (std::size_t frame = 0; frame < frames->size(); ++frame) {
          const auto asked = whole->decode(frame);
          if (!asked) continue;
          const auto same = left->decode(frame);
          ASSERT_TRUE(same) << frame << ": " << to_string(same.error());
          expect_equal(*same, *asked);
          ++checked;
        }
      }
  }
  EXPECT_GT(checked, 50);
}

}  // namespace
}  // namespace slf::truncate_promise_test
