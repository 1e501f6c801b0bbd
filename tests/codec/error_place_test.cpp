// SPDX-License-Identifier: Apache-2.0
// What an error of a stream says of its place, on the streams that have to be refused. Spec annex
// F.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "bitstream/units.h"
#include "codec/stream/stream_pieces.h"
#include "slf/syntax_listing.h"

namespace slf::error_place_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

const std::filesystem::path kRefused = std::filesystem::path(SLF_CONFORMANCE) / "refused";

Bytes refused(const std::string& id) {
  std::ifstream in(kRefused / id / "stream.slf", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> all_refused() {
  std::vector<std::string> ids;
  for (const auto& folder : std::filesystem::directory_iterator(kRefused))
    ids.push_back(folder.path().filename().string());
  return ids;
}

/// Bits are counted by hand: 8 bytes of signature, units of 1 byte of type and 1 or 2 of length.
struct Place {
  const char* id;
  Errc code;
  const char* element;
  const char* unit;
  std::uint64_t bit;
};

constexpr Place kPlaces[] = {
    {"signature", Errc::kNotSlf, "signature", "", 0},
    {"bytes-after-end", Errc::kOutOfRange, "end_of_stream", "", 46144},
    {"length-of-seven-bytes", Errc::kOutOfRange, "unit_length", "sequence", 72},
    {"crc", Errc::kChecksum, "unit_crc", "coefficients", 29920},
    {"version-major", Errc::kUnsupported, "sps_version_major", "sequence", 72},
    {"profile", Errc::kUnsupported, "sps_profile", "sequence", 96},
    {"normal-bits", Errc::kUnsupported, "sps_normal_bits", "sequence", 117},
    {"feature-last", Errc::kUnsupported, "sps_feature[31]", "sequence", 271},
    {"frames-empty-slices", Errc::kOutOfRange, "unit_type", "slices", 368},
    {"feature-empty-without-frame", Errc::kOutOfRange, "unit_type", "end", 240},
    {"unit-to-be-understood-29", Errc::kUnsupported, "unit_type", "type 29", 44920},
    {"step-zero", Errc::kOutOfRange, "sps_step", "sequence", 302},
    {"slices-longer", Errc::kOutOfRange, "slices_trailing_bits", "slices", 204},
    {"points-one-more", Errc::kOutOfRange, "slice_num_points_minus1", "slices", 272},
    {"geometry-shorter", Errc::kTruncated, "gu_occupancy", "geometry", 6160},
    {"slices-late", Errc::kOutOfRange, "unit_type", "geometry", 272},
    {"normals-escape", Errc::kOutOfRange, "nu_magnitude", "normals", 440},
    {"coefficients-alignment", Errc::kReserved, "alignment_zero_bits", "coefficients", 427},
    {"coefficient-limit", Errc::kOutOfRange, "cu_magnitude", "coefficients", 640},
    {"layers-shorter", Errc::kTruncated, "cu_coefficients", "refinement", 29392},
    {"index-box-range", Errc::kOutOfRange, "index_box", "index", 793},
    {"index-ids", Errc::kOutOfRange, "index_unit_ids", "index", 288},
    {"metadata-not-utf8", Errc::kOutOfRange, "metadata_text", "metadata", 45256},
    {"digest", Errc::kChecksum, "digest_sha256", "digest", 44320},
    {"matrix-shorter", Errc::kTruncated, "cu_matrix", "coefficients", 1304},
    {"transform-rank", Errc::kOutOfRange, "tr_rank_minus1", "transform", 251},
    {"units-lost", Errc::kOutOfRange, "end_num_units", "end", 45248},
};

TEST(Spec_F_Places, AreThatOfTheElementInTheStream) {
  for (const Place& place : kPlaces) {
    const auto decoded = decode(refused(place.id));
    ASSERT_FALSE(decoded) << place.id;
    const Error& error = decoded.error();
    EXPECT_EQ(error.code, place.code) << place.id;
    EXPECT_STREQ(error.element, place.element) << place.id;
    EXPECT_STREQ(error.unit, place.unit) << place.id;
    EXPECT_EQ(error.bit_offset, place.bit) << place.id;
  }
}

TEST(Spec_F_Places, LieInAUnitOfTheTypeThatIsNamed) {
  std::set<std::string> named;
  for (const std::string& id : all_refused()) {
    const Bytes stream = refused(id);
    const auto units = split_units(stream);
    const auto decoded = decode(stream);
    if (!units || decoded || decoded.error().code == Errc::kUnsupported) continue;
    const Error& error = decoded.error();
    const auto holds = [&](const Unit& unit) {
      return error.bit_offset >= 8 * unit.offset &&
             error.bit_offset < 8 * (unit.offset + unit.bytes);
    };
    const auto unit = std::find_if(units->units.begin(), units->units.end(), holds);
    ASSERT_NE(unit, units->units.end()) << id << " " << to_string(error);
    EXPECT_STREQ(error.unit, unit_name(unit->type)) << id << " " << to_string(error);
    named.insert(error.unit);
  }
  EXPECT_EQ(named, (std::set<std::string>{"sequence", "slices", "geometry", "normals",
                                          "coefficients", "refinement", "index", "metadata",
                                          "digest", "transform", "frame", "end"}));
}

/// The same error for who reads headers alone, where these show it.
TEST(Spec_F_Places, AreTheSameForEveryReader) {
  int compared = 0;
  for (const std::string& id : all_refused()) {
    const Bytes stream = refused(id);
    const auto decoded = decode(stream);
    ASSERT_FALSE(decoded) << id;
    const auto same = [&](const auto& result) {
      if (result || std::string(result.error().element) != decoded.error().element) return;
      EXPECT_EQ(to_string(result.error()), to_string(decoded.error())) << id;
      ++compared;
    };
    same(read_info(stream));
    same(list_syntax(stream));
  }
  EXPECT_GT(compared, 100);
}

/// Decodes from the head of a stream and the pieces that are asked for.
Result<LightField> decode_from_pieces(const Bytes& stream, const DecodeOptions& options) {
  SLF_TRY(const auto head, find_head(stream, stream.size(), DecodeLimits{}.max_memory));
  const auto begin = std::span(stream).first(static_cast<std::size_t>(head->bytes));
  SLF_TRY(const ReadPlan plan, plan_read(begin, stream.size(), options));
  if (plan.whole) return decode(stream, options);
  std::vector<StreamPiece> pieces;
  for (const ByteRange& range : plan.ranges)
    pieces.push_back(
        {range.offset, std::span(stream).subspan(static_cast<std::size_t>(range.offset),
                                                 static_cast<std::size_t>(range.bytes))});
  return decode_pieces(begin, plan, pieces, options);
}

TEST(Spec_F_Places, AreTheSameWhereAPartIsRead) {
  std::size_t compared = 0;
  for (const std::string& id : all_refused()) {
    const Bytes stream = refused(id);
    if (!split_units(stream) || !read_info(stream)) continue;
    DecodeOptions options;
    options.groups = 1;
    const auto whole = decode(stream, options), part = decode_from_pieces(stream, options);
    if (whole || part) continue;
    EXPECT_EQ(to_string(part.error()), to_string(whole.error())) << id;
    ++compared;
  }
  EXPECT_GT(compared, 3u);
}

TEST(Spec_F_Places, AreNotSaidOfArgumentsAndLimits) {
  EXPECT_EQ(to_string(Error{Errc::kLimitExceeded, "max_points"}), "kLimitExceeded: max_points");
  EXPECT_EQ(to_string(Error{Errc::kOutOfRange, "sps_step", 302, "sequence"}),
            "kOutOfRange: sps_step in the sequence unit, bit 302");
  EXPECT_EQ(to_string(Error{Errc::kNotSlf, "signature"}), "kNotSlf: signature, bit 0");
}

}  // namespace
}  // namespace slf::error_place_test
