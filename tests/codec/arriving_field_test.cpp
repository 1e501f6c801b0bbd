// SPDX-License-Identifier: Apache-2.0
// A light field that does not move, decoded while it arrives: what decode() makes of the same
// units. Spec 7.1, 8.9.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "frames_support.h"
#include "slf/frame_reader.h"

namespace slf::arriving_field_test {
namespace {

using namespace test;

std::filesystem::path suite() { return std::filesystem::path(SLF_CONFORMANCE) / "streams"; }

Bytes golden(const std::string& name) {
  std::ifstream file(suite() / name / "stream.slf", std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
  return {bytes.begin(), bytes.end()};
}

std::vector<std::string> goldens() {
  std::vector<std::string> names;
  for (const auto& folder : std::filesystem::directory_iterator(suite()))
    if (!moves(golden(folder.path().filename()))) names.push_back(folder.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

/// [units + 1] where the units of a stream begin and end, and which is that of slices: its place,
/// or that of the last.
struct Boundaries {
  std::vector<std::size_t> at;
  std::size_t headers = 0;
};

Boundaries boundaries_of(const Bytes& stream) {
  Boundaries found{{kSignature.size()}, 0};
  const Units units = *split_units(stream);
  for (const Unit& unit : units.units) {
    found.at.push_back(static_cast<std::size_t>(unit.offset + unit.bytes));
    if (unit.type == UnitType::kSlices) found.headers = found.at.back();
  }
  if (found.headers == 0) found.headers = stream.size() + 1;  // it has none
  return found;
}

FrameReader reader(const DecodeOptions& options = {}) { return *FrameReader::open(options); }

std::span<const std::uint8_t> piece(const Bytes& stream, std::size_t begin, std::size_t end) {
  return std::span(stream).subspan(begin, end - begin);
}

/// The same light field, or the same error.
void expect_like(const Result<LightField>& is, const Result<LightField>& should) {
  ASSERT_EQ(static_cast<bool>(is), static_cast<bool>(should))
      << (is ? to_string(should.error()) : to_string(is.error()));
  if (is) {
    EXPECT_EQ(is->header.grid.bits, should->header.grid.bits);
    EXPECT_EQ(is->header.coded, should->header.coded);
    expect_same(*is, *should);
  } else {
    EXPECT_EQ(to_string(is.error()), to_string(should.error()));
  }
}

TEST(Spec_8_9_Arrival, EveryPrefixOfUnitsDecodesAsDecodeDoes) {
  for (const std::string& name : goldens()) {
    SCOPED_TRACE(name);
    const Bytes stream = golden(name);
    const Boundaries units = boundaries_of(stream);
    const std::size_t step = stream.size() * units.at.size() > 100000 ? 7 : 1;  // a second of each
    FrameReader read = reader();
    std::size_t before = 0;
    for (std::size_t unit = 0; unit < units.at.size(); ++unit) {
      const std::size_t at = units.at[unit];
      ASSERT_TRUE(read.push(piece(stream, before, at)));
      before = at;
      ASSERT_EQ(read.frames().size(), at >= units.headers ? 1u : 0u) << at;
      if (read.frames().empty()) continue;
      EXPECT_EQ(read.frames()[0].bytes, at);
      EXPECT_EQ(read.frames()[0].arriving, !read_info(piece(stream, 0, at))->complete);
      if (unit % step == 0) expect_like(read.decode(0), decode(piece(stream, 0, at)));
    }
    ASSERT_TRUE(read.finish());
    EXPECT_FALSE(read.frames().at(0).arriving);
    expect_like(read.decode(0), decode(stream));
  }
}

TEST(Spec_8_9_Arrival, PrefixesOfPartsAreThoseOfMaxBytes) {
  DecodeOptions part;
  part.levels = 3;
  part.groups = 1;
  for (const std::string name : {"layers-four", "scene-shared", "harmonics"}) {
    SCOPED_TRACE(name);
    const Bytes stream = golden(name);
    FrameReader read = reader();
    std::size_t before = 0;
    for (const std::size_t at : boundaries_of(stream).at) {
      ASSERT_TRUE(read.push(piece(stream, before, at)));
      before = at;
      if (read.frames().empty()) continue;
      for (DecodeOptions options : {DecodeOptions{}, part}) {
        ASSERT_TRUE(read.set_options(options));
        const auto is = read.decode(0);
        options.max_bytes = at;
        expect_like(is, decode(stream, options));
      }
    }
  }
}

TEST(Spec_8_9_Arrival, ByteByByteAUnitCountsWithItsLast) {
  for (const std::string name : {"two-points", "scene-shared", "harmonics", "layers-four"}) {
    SCOPED_TRACE(name);
    const Bytes stream = golden(name);
    const Boundaries units = boundaries_of(stream);
    FrameReader read = reader();
    std::size_t unit = 0;  // that ended last
    for (std::size_t size = 1; size <= stream.size(); ++size) {
      ASSERT_TRUE(read.push(piece(stream, size - 1, size)));
      const bool ends = unit + 1 < units.at.size() && units.at[unit + 1] == size;
      if (ends) ++unit;
      ASSERT_EQ(read.frames().size(), size >= units.headers ? 1u : 0u);
      ASSERT_EQ(read.held_bytes(), size);
      if (read.frames().empty()) continue;
      ASSERT_EQ(read.frames()[0].bytes, units.at[unit]);
      ASSERT_EQ(read.bytes_of(0).size(), units.at[unit]);
      if (ends) expect_like(read.decode(0), decode(piece(stream, 0, size)));
    }
  }
}

TEST(Spec_7_1_Arrival, EveryTruncationEndsAsDecodeDoes) {
  for (const std::string name : {"two-points", "scene-shared", "feature-empty-prefix"}) {
    SCOPED_TRACE(name);
    const Bytes stream = golden(name);
    for (std::size_t size = 0; size <= stream.size(); ++size) {
      const auto cut = piece(stream, 0, size);
      const auto should = decode(cut);
      FrameReader read = reader();
      ASSERT_TRUE(read.push(cut));
      const auto ended = read.finish();
      if (ended) {
        expect_like(read.decode(0), should);
        continue;
      }
      ASSERT_FALSE(should) << size;
      if (size == 0) continue;  // no stream, or none yet
      EXPECT_EQ(to_string(ended.error()), to_string(should.error())) << size;
    }
  }
}

TEST(Spec_7_1_Arrival, EveryChangedByteIsTheErrorOfDecodeWhenItsUnitHasCome) {
  for (const std::string name : {"two-points", "scene-shared"}) {
    const Bytes sound = golden(name);
    for (std::size_t at = kSignature.size(); at < sound.size(); ++at) {
      Bytes stream = sound;
      stream[at] ^= 0x10;
      const auto should = decode(stream);
      ASSERT_FALSE(should);
      FrameReader read = reader();
      Result<Done> taken = Done{};
      std::size_t size = 0;
      while (taken && size < stream.size()) {
        taken = read.push(piece(stream, size, size + 1));
        ++size;
      }
      if (taken) taken = read.finish();
      ASSERT_FALSE(taken) << name << at;
      EXPECT_EQ(to_string(taken.error()), to_string(should.error())) << name << at;
      EXPECT_FALSE(read.push({}));
      FrameReader at_once = reader();
      EXPECT_FALSE(at_once.push(stream) && at_once.finish());
      ASSERT_EQ(at_once.frames().size(), read.frames().size());
      if (read.frames().empty()) continue;  // headers
      EXPECT_EQ(at_once.frames()[0].bytes, read.frames()[0].bytes);
      EXPECT_TRUE(read.frames()[0].lost);
      EXPECT_FALSE(read.frames()[0].arriving);
      EXPECT_EQ(to_string(read.decode(0).error()), to_string(should.error()));
    }
  }
}

TEST(Spec_7_1_Arrival, BytesBehindTheEndUnitAreRefused) {
  const Bytes stream = golden("two-points");
  FrameReader read = reader();
  ASSERT_TRUE(read.push(stream));
  EXPECT_FALSE(read.frames().at(0).arriving);
  expect_like(read.decode(0), decode(stream));
  const auto pushed = read.push(piece(stream, 0, 1));
  ASSERT_FALSE(pushed);
  EXPECT_STREQ(pushed.error().element, "end_of_stream");
  EXPECT_FALSE(read.decode(0));
}

TEST(FrameReader, AFieldThatDoesNotMoveIsReadAgainFromItsBeginning) {
  const Bytes stream = golden("scene-shared");
  FrameReader read = reader();
  ASSERT_TRUE(read.push(piece(stream, 0, stream.size() / 2)));
  ASSERT_TRUE(read.frames().at(0).arriving);
  read.drop_before(0);
  EXPECT_EQ(read.held_bytes(), stream.size() / 2);
  ASSERT_TRUE(read.seek(0));
  EXPECT_EQ(read.held_bytes(), 0u);
  EXPECT_EQ(read.decode(0).error().code, Errc::kUnreadable);
  ASSERT_TRUE(read.push(stream));
  ASSERT_TRUE(read.finish());
  EXPECT_EQ(read.frames().size(), 1u);
  expect_like(read.decode(0), decode(stream));
}

TEST(FrameReader, NoUnitIsLookedAtAgainBeforeItIsWhole) {
  constexpr std::size_t kBytes = std::size_t{1} << 20;  // an hour, if it were with every byte
  for (const UnitType type : {UnitType::kSequence, UnitType::kFiller, UnitType::kFrame}) {
    Bytes stream(kSignature.begin(), kSignature.end());
    if (type != UnitType::kSequence) append_unit(stream, UnitType::kSequence, Bytes(kBytes, 0));
    append_unit(stream, type, Bytes(kBytes, 0));
    stream.pop_back();
    FrameReader read = reader();
    for (std::size_t at = 0; at < stream.size(); ++at)
      ASSERT_TRUE(read.push(piece(stream, at, at + 1)));
    EXPECT_TRUE(read.frames().empty());
    EXPECT_EQ(read.held_bytes(), stream.size());
  }
}

TEST(FrameReader, ManySmallUnitsThatComeByBytesAreReadOnce) {
  const Bytes sound = golden("two-points");
  const Boundaries units = boundaries_of(sound);
  Bytes stream(sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(units.headers));
  while (stream.size() < std::size_t{1} << 21) append_unit(stream, UnitType::kFiller, {});
  FrameReader read = reader();
  for (std::size_t at = 0; at < stream.size(); ++at)
    ASSERT_TRUE(read.push(piece(stream, at, at + 1)));
  EXPECT_EQ(read.frames().size(), 1u);
  EXPECT_EQ(read.frames()[0].bytes, stream.size());
}

}  // namespace
}  // namespace slf::arriving_field_test
