// SPDX-License-Identifier: Apache-2.0
// Streams that say something else of themselves. Over the whole suite; of whole, cut and damaged
// ones. Spec 7.2, 7.8.
#include "slf/annotate.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>

#include "frames_support.h"

namespace slf::annotate_test {
namespace {

using namespace test;

Bytes read(const std::filesystem::path& folder) {
  std::ifstream file(folder / "stream.slf", std::ios::binary);
  const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
  return {bytes.begin(), bytes.end()};
}

Annotations notes(std::optional<std::string> value) {
  return {{{"notes", std::move(value)}}, std::nullopt};
}

/// Types and payloads of all units but those that say something of the stream.
std::vector<Bytes> coded_units(const Bytes& stream) {
  std::vector<Bytes> all;
  for (std::size_t at = 0; at < stream.size();) {
    const auto rest = std::span(stream).subspan(at);
    if (std::equal(kSignature.begin(), kSignature.end(), rest.begin(),
                   rest.begin() + std::ptrdiff_t(std::min(rest.size(), kSignature.size()))))
      at += kSignature.size();
    const auto unit = read_unit(stream, at);
    if (!unit) break;
    const bool says = unit->type == UnitType::kSequence || unit->type == UnitType::kIndex ||
                      unit->type == UnitType::kFrame || unit->type == UnitType::kMetadata ||
                      unit->type == UnitType::kFiller || unit->type == UnitType::kEnd;
    if (!says)
      all.emplace_back(stream.begin() + std::ptrdiff_t(at),
                       stream.begin() + std::ptrdiff_t(at + std::size_t(unit->bytes)));
    at += static_cast<std::size_t>(unit->bytes);
  }
  return all;
}

void expect_same_fields(const Bytes& a, const Bytes& b) {
  auto one = FrameDecoder::open(a), other = FrameDecoder::open(b);
  ASSERT_EQ(bool(one), bool(other));
  if (!one) return;
  ASSERT_EQ(one->frames().size(), other->frames().size());
  for (std::size_t t = 0; t < one->frames().size(); ++t) {
    const auto before = one->decode(t), after = other->decode(t);
    ASSERT_EQ(bool(before), bool(after)) << t;
    if (!before) continue;
    EXPECT_EQ(before->positions, after->positions);
    EXPECT_EQ(before->components, after->components);
    EXPECT_EQ(before->normals.octahedral, after->normals.octahedral);
  }
}

std::string notes_of(const Bytes& stream) {
  const auto info = read_info(stream);
  EXPECT_TRUE(info);
  for (const auto& [key, value] : info->metadata)
    if (key == "notes") return value;
  return "none";
}

TEST(Spec_7_8_Annotate, UnitsOfPointsAndValuesStayByteForByteInEveryStream) {
  std::size_t tried = 0;
  for (const auto& folder :
       std::filesystem::directory_iterator(std::filesystem::path(SLF_CONFORMANCE) / "streams")) {
    const Bytes stream = read(folder.path());
    SCOPED_TRACE(folder.path().filename().string());
    if (!read_info(stream)) continue;
    const auto noted = annotate(stream, notes("{}"));
    ASSERT_TRUE(noted) << to_string(noted.error());
    EXPECT_EQ(coded_units(*noted), coded_units(stream));
    EXPECT_EQ(notes_of(*noted), "{}");
    EXPECT_EQ(*annotate(*noted, notes("{}")), *noted) << "twice is once";
    if (stream.size() < 20000) expect_same_fields(stream, *noted);
    const auto bare = annotate(*noted, notes(std::nullopt));
    EXPECT_EQ(notes_of(*bare), "none");
    ++tried;
  }
  EXPECT_GT(tried, 50u);
}

TEST(Spec_7_8_Annotate, NotesThatGoAgainLeaveTheStreamThatWas) {
  for (const bool index : {false, true}) {
    auto parameters = frame_parameters(12);
    parameters.index = index;
    parameters.metadata = {{"title", "A"}};
    const Bytes stream = *pack(frame_of(Moves::kNothing, 0), parameters);
    const Bytes noted = *annotate(stream, notes("a\nb"));
    EXPECT_NE(noted, stream);
    EXPECT_EQ(*annotate(noted, notes(std::nullopt)), stream) << index;
  }
}

TEST(Spec_7_8_Annotate, EveryGroupOfFramesWithMetadataSaysIt) {
  auto parameters = frame_parameters(12);
  parameters.metadata = {{"title", "A"}};
  const Bytes stream = joined(coded_frames(fields_of(Moves::kShift, 6), parameters, 3));
  const Bytes noted = *annotate(stream, {{{"notes", "{}"}}, 0.25});
  expect_same_fields(stream, noted);
  std::size_t groups = 0;
  const auto frames = split_frames(noted);
  ASSERT_TRUE(frames);
  for (const FrameUnits& frame : *frames) {
    if (frame.header.predicted()) continue;
    const Bytes own(noted.begin() + std::ptrdiff_t(frame.offset),
                    noted.begin() + std::ptrdiff_t(frame.offset + frame.bytes));
    EXPECT_EQ(notes_of(own), "{}");
    EXPECT_EQ(read_info(own)->header.metres_per_unit, 0.25);
    ++groups;
  }
  EXPECT_EQ(groups, 2u);
  const Bytes bare = *annotate(noted, {{{"notes", std::nullopt}}, 0.0});
  EXPECT_EQ(bare, stream);
}

TEST(Spec_7_8_Annotate, WhatNoReaderTakesIsRefused) {
  const Bytes stream = *pack(frame_of(Moves::kNothing, 0), frame_parameters(12));
  for (const std::string& text :
       {std::string("\xFF"), std::string(1, '\0'), std::string(2u << 20, 'a')})
    EXPECT_EQ(annotate(stream, notes(text)).error().code, Errc::kInvalidArgument);
  EXPECT_FALSE(annotate(stream, {{{"", "a"}}, std::nullopt}));
  for (const double metres : {-1.0, std::nan(""), HUGE_VAL})
    EXPECT_EQ(std::string(annotate(stream, {{}, metres}).error().element), "metres_per_unit");
}

TEST(AnnotateTest, WhatStaysOfAFilmIsNotCopied) {
  const auto fields = fields_of(Moves::kShift, 6);
  const Bytes film = joined(coded_frames(fields, frame_parameters(8), 3));
  const auto is_of_film = [&](const std::span<const std::uint8_t>& piece) {
    return piece.data() >= film.data() && piece.data() < film.data() + film.size();
  };
  for (const std::optional<double> metres : {std::optional<double>(), std::optional(2.0)}) {
    Annotations said = notes("[]");
    said.metres_per_unit = metres;
    const auto pieces = annotate_in_pieces(film, said);
    const auto whole = annotate(film, said);
    ASSERT_TRUE(pieces && whole);
    Bytes all;
    std::size_t copied = 0;
    for (const auto& piece : pieces->pieces) {
      all.insert(all.end(), piece.begin(), piece.end());
      copied += is_of_film(piece) ? 0 : piece.size();
    }
    EXPECT_EQ(all, *whole);
    EXPECT_EQ(pieces->bytes(), whole->size());
    EXPECT_EQ(pieces->written.size(), metres ? 2u : 1u);
    EXPECT_LT(copied, film.size());
    EXPECT_NE(copied, 0u);
  }
}

TEST(Spec_7_8_Annotate, EveryCutAndEveryChangedByteIsAnErrorOrAStreamThatDecodesAlike) {
  const Bytes still = *pack(frame_of(Moves::kNothing, 0), frame_parameters(12));
  const Bytes moving = joined(coded_frames(fields_of(Moves::kShift, 2), frame_parameters(12), 2));
  for (const Bytes& stream : {still, moving})
    for (std::size_t i = 0; i < stream.size(); i += 1 + stream.size() / 400) {
      const Bytes cut(stream.begin(), stream.begin() + std::ptrdiff_t(i));
      if (const auto noted = annotate(cut, notes("{}"))) expect_same_fields(cut, *noted);
      Bytes changed = stream;
      changed[i] ^= 0x15;
      changed = fuzz::with_sound_crcs(changed);
      const auto noted = annotate(changed, notes("{}"), fuzz::small_limits());
      if (noted && decode(changed, {})) {
        EXPECT_TRUE(decode(*noted, {}));
      }
    }
}

}  // namespace
}  // namespace slf::annotate_test
