// SPDX-License-Identifier: Apache-2.0
// Plenoptic clouds: what is read of a PLY, and what comes back of a file.
#include <gmock/gmock.h>

#include "encoder/plenoptic/corrections.h"
#include "plenoptic_support.h"
#include "slf/decoder.h"

namespace slf::plenoptic_test {
namespace {

using test::sphere_of_views;
using test::TemporaryDirectory;
using testing::HasSubstr;

struct Read {
  PlenopticCloud cloud;
  std::string error;
  std::vector<std::string> warnings;
  std::size_t views = 0;  ///< as counted
};

std::string properties_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += "property uchar " + name + "\n";
  return text;
}

Read read(const std::string& properties, const std::string& rows, const std::string& views = "",
          const std::string& comments = "") {
  const TemporaryDirectory directory;
  const auto lines = std::count(rows.begin(), rows.end(), '\n');
  test::write_text(directory / "a.ply", "ply\nformat ascii 1.0\n" + comments + "element vertex " +
                                            std::to_string(lines) +
                                            "\nproperty int x\nproperty int y\nproperty int z\n" +
                                            properties + "end_header\n" + rows);
  PlenopticOptions options;
  if (!views.empty()) {
    test::write_text(directory / "views.json", views);
    options.views = directory / "views.json";
  }
  Read result;
  result.views = count_plenoptic_views(directory / "a.ply");
  auto cloud = read_plenoptic(directory / "a.ply", options, &result.warnings);
  if (cloud)
    result.cloud = *std::move(cloud);
  else
    result.error = cloud.error().message;
  return result;
}

TEST(PlenopticReader, TakesEveryFurtherTripleInFileOrderWhateverItsName) {
  const Read got =
      read(properties_of({"zeta", "alpha_of_it", "m", "red", "green", "blue", "q", "p", "o"}),
           "4 0 0 1 2 3 40 50 60 7 8 9\n0 0 0 10 20 30 4 5 6 70 80 90\n");
  EXPECT_EQ(got.error, "");
  EXPECT_EQ(got.views, 2u);
  EXPECT_EQ(got.cloud.views, 2u);
  EXPECT_TRUE(got.cloud.own_colour);
  EXPECT_EQ(got.cloud.colours, (std::vector<std::uint8_t>{4, 5, 6, 10, 20, 30, 70, 80, 90,  //
                                                          40, 50, 60, 1, 2, 3, 7, 8, 9}))
      << "own colour, then views; points in Morton order";
  EXPECT_THAT(got.cloud.taken, HasSubstr("2 views: zeta alpha_of_it m ... o"));
  EXPECT_EQ(got.cloud.grid.step, 1);
  EXPECT_EQ(got.cloud.grid.bits, 3);
}

TEST(PlenopticReader, TakesPositionsOfViewsFromCommentsOrFromJson) {
  const std::string names = properties_of({"a", "b", "c", "d", "e", "f"});
  const std::string row = "0 0 0 1 2 3 4 5 6\n1 0 0 1 2 3 4 5 6\n";
  const Read said = read(names, row, "",
                         "comment made by hand\ncomment View 0 left 1.5 -2 3e1\n"
                         "comment camera: 4 5 6\n");
  EXPECT_EQ(said.cloud.view_positions, (std::vector<Vec3>{{1.5, -2, 30}, {4, 5, 6}}));
  const Read json = read(names, row, R"({"views": [{"position": [1, 2, 3]}, [4, 5, 6]]})");
  EXPECT_EQ(json.cloud.view_positions, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}})) << json.error;
}

TEST(PlenopticReader, WhatScansMeasureIsNoColourOfAView) {
  const std::string row = "0 0 0 10 20 30 1 2 3\n";
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{"classification", "ring", "flag"},
        {"Intensity", "scalar_Label", "return_number"},
        {"scan_angle", "user_data", "point_source_id"}}) {
    std::vector<std::string> all{"red", "green", "blue"};
    all.insert(all.end(), names.begin(), names.end());
    EXPECT_EQ(read(properties_of(all), row).views, 0u) << names[0];
  }
  const Read mixed = read(properties_of({"red", "green", "blue", "ring", "a", "b", "c"}),
                          "0 0 0 10 20 30 9 1 2 3\n");
  EXPECT_EQ(mixed.views, 1u) << mixed.error;
  EXPECT_THAT(mixed.cloud.colours, testing::ElementsAre(10, 20, 30, 1, 2, 3));
}

TEST(PlenopticReader, SaysWhatItTookForViewsWhereCoordinatesHaveNoGrid) {
  const std::string row = "0.5 0 0 10 20 30 1 2 3\n1 0 0 10 20 30 1 2 3\n";
  const std::string error = read(properties_of({"red", "green", "blue", "a", "b", "c"}), row).error;
  EXPECT_THAT(error, HasSubstr("1 view: a b c"));
  EXPECT_THAT(error, HasSubstr("--as colour"));
  EXPECT_THAT(error, HasSubstr("--grid-bits"));
}

TEST(PlenopticReader, RefusesAViewWithoutAColour) {
  EXPECT_THAT(
      read(properties_of({"p", "q", "r_", "s", "t", "u", "v"}), "0 0 0 1 2 3 4 5 6 7\n").error,
      HasSubstr("7 further properties of 8 bits (p ... v) are no whole triples"));
  EXPECT_THAT(read(properties_of({"red_0", "green_0", "red_1", "green_1", "blue_1", "blue_0"}),
                   "0 0 0 1 2 3 4 5 6\n")
                  .error,
              HasSubstr("red_0, green_0, red_1: a colour is missing"));
}

TEST(PlenopticReader, RefusesAsManyViewsAsNobodyHas) {
  std::vector<std::string> names;
  for (int i = 0; i < 3 * 255; ++i) names.push_back("c" + std::to_string(i));
  EXPECT_THAT(read(properties_of(names), "").error, HasSubstr("255 views, of which 254 are"));
}

TEST(PlenopticReader, RefusesNamesTwiceAndPositionsOfOtherViews) {
  EXPECT_THAT(read(properties_of({"a", "b", "c", "a", "b", "c"}), "0 0 0 1 2 3 4 5 6\n").error,
              HasSubstr("'a' twice"));
  EXPECT_THAT(
      read(properties_of({"a", "b", "c", "d", "e", "f"}), "0 0 0 1 2 3 4 5 6\n", "[[1,2,3]]").error,
      HasSubstr("1 positions of views; "));
  const Read comments = read(properties_of({"a", "b", "c", "d", "e", "f"}), "0 0 0 1 2 3 4 5 6\n",
                             "", "comment view 0 1 2 3\n");
  EXPECT_TRUE(comments.cloud.view_positions.empty());
  EXPECT_THAT(comments.warnings, testing::Contains(HasSubstr("1 positions of views")));
}

TEST(PlenopticReader, RefusesNamesBeyondAscii) {
  EXPECT_THAT(
      read(properties_of({"\xff\xfe", "b", "c", "d", "e", "f"}), "0 0 0 1 2 3 4 5 6\n").error,
      HasSubstr("beyond ASCII"));
}

TEST(PlenopticReader, LeavesCloudsOfOneColourAndSplatsAlone) {
  EXPECT_EQ(read(properties_of({"red", "green", "blue"}), "0 0 0 1 2 3\n").views, 0u);
  EXPECT_EQ(read(properties_of({"red", "green", "blue", "alpha"}), "0 0 0 1 2 3 4\n").views, 0u);
}

PlenopticCloud round_trip(const PlenopticCloud& cloud, const PlenopticSettings& settings,
                          PlenopticEncoded* out = nullptr) {
  const auto encoded = encode_plenoptic(cloud, settings);
  EXPECT_TRUE(encoded) << encoded.error().message;
  const auto field = decode(encoded->stream);
  EXPECT_TRUE(field);
  const auto back = decode_plenoptic(encoded->stream, *field, read_info(encoded->stream)->metadata);
  EXPECT_TRUE(back) << back.error().message;
  if (out != nullptr) *out = *encoded;
  return *back;
}

TEST(PlenopticPlanes, GiveBackEveryByteAndEveryProperty) {
  for (const bool mean : {true, false}) {
    const PlenopticCloud cloud = sphere_of_views(5, 3, mean);
    PlenopticEncoded encoded;
    const PlenopticCloud back = round_trip(cloud, {}, &encoded);
    EXPECT_TRUE(encoded.exact);
    EXPECT_EQ(back.positions, cloud.positions);
    EXPECT_EQ(back.colours, cloud.colours);
    EXPECT_EQ(back.properties, cloud.properties);
    EXPECT_EQ(back.view_positions, cloud.view_positions);
    EXPECT_LT(encoded.stream.size(), cloud.colours.size() * 2 / 3);
  }
}

TEST(PlenopticPlanes, AreExactOfOneViewAndOfNoise) {
  PlenopticCloud cloud = sphere_of_views(1, 120);
  EXPECT_EQ(round_trip(cloud, {}).colours, cloud.colours);
  cloud = sphere_of_views(2, 0);
  std::mt19937 random(1);
  for (auto& byte : cloud.colours) byte = random() % 2 == 0 ? 0 : 255;
  EXPECT_EQ(round_trip(cloud, {}).colours, cloud.colours);
}

TEST(PlenopticPlanes, AreTheSameForAnyThreadCount) {
  const PlenopticCloud cloud = sphere_of_views(3);
  PlenopticSettings settings;
  settings.encoder.threads = 1;
  const auto one = encode_plenoptic(cloud, settings);
  settings.encoder.threads = 3;
  EXPECT_EQ(encode_plenoptic(cloud, settings)->stream, one->stream);
}

TEST(PlenopticPlanes, LoseMoreWithALargerStep) {
  const PlenopticCloud cloud = sphere_of_views(5);
  double before = 1000;
  std::size_t bytes = std::size_t{1} << 40;
  for (const double q : {2.0, 8.0, 32.0}) {
    PlenopticSettings settings;
    settings.encoder.q = q;
    PlenopticEncoded encoded;
    const auto quality = measure_plenoptic(round_trip(cloud, settings, &encoded), cloud);
    ASSERT_TRUE(quality);
    EXPECT_LT(quality->views[0].yuv[0], before);
    EXPECT_LT(encoded.stream.size(), bytes);
    EXPECT_GT(quality->views[0].yuv[0], 30);
    before = quality->views[0].yuv[0];
    bytes = encoded.stream.size();
  }
}

TEST(PlenopticPlanes, AreNearTheExactOnesWhereTheFileIsCut) {
  const PlenopticCloud cloud = sphere_of_views(4);
  const auto encoded = encode_plenoptic(cloud, {});
  const StreamInfo info = *read_info(encoded->stream);
  const auto corrections = std::find_if(info.units.begin(), info.units.end(),
                                        [](const auto& unit) { return unit.type == "type 192"; });
  ASSERT_NE(corrections, info.units.end());
  const std::vector<std::uint8_t> cut(
      encoded->stream.begin(), encoded->stream.begin() + std::ptrdiff_t(corrections->offset));
  const auto field = decode(cut);
  std::vector<std::string> warnings;
  const auto back = decode_plenoptic(cut, *field, read_info(cut)->metadata, &warnings);
  ASSERT_TRUE(back);
  EXPECT_THAT(warnings, testing::ElementsAre(HasSubstr("not whole")));
  EXPECT_GT(measure_plenoptic(*back, cloud)->views[0].yuv[0], 38);
}

TEST(PlenopticCorrections, DamageEndsInAValueOrAnError) {
  std::vector<std::uint8_t> exact(600), near(600);
  std::mt19937 random(3);
  for (std::size_t i = 0; i < exact.size(); ++i) {
    near[i] = static_cast<std::uint8_t>(random() & 255);
    exact[i] =
        static_cast<std::uint8_t>(std::clamp(int(near[i]) + int(random() % 61) - 30, 0, 255));
  }
  const auto payload = write_corrections({exact, 6}, {near, 6}, 1);
  std::vector<std::uint8_t> bytes = near;
  ASSERT_TRUE(apply_corrections(payload, 6, bytes, 1));
  EXPECT_EQ(bytes, exact);
  for (std::size_t size = 0; size < payload.size(); ++size) {
    bytes = near;
    EXPECT_FALSE(apply_corrections(
        std::vector(payload.begin(), payload.begin() + std::ptrdiff_t(size)), 6, bytes, 1))
        << size;
  }
  for (std::size_t i = 0; i < payload.size(); ++i) {
    auto changed = payload;
    changed[i] ^= 0x55;
    bytes = near;
    static_cast<void>(apply_corrections(changed, 6, bytes, 1));
  }
}

TEST(PlenopticViewMaps, PredictTheViewsThatAreHeldOut) {
  const PlenopticCloud cloud = sphere_of_views(12);
  PlenopticSettings settings;
  settings.hold_out = {3, 7};
  settings.encoder.q = 4;
  settings.encoder.fit.basis.degree = 3;
  PlenopticEncoded encoded;
  const PlenopticCloud back = round_trip(cloud, settings, &encoded);
  EXPECT_EQ(encoded.as, PlenopticCoding::kViewMaps) << "auto";
  EXPECT_EQ(held_out_views(read_info(encoded.stream)->metadata), (std::vector<int>{3, 7}));
  const auto quality = measure_plenoptic(back, cloud);
  EXPECT_GT(quality->views[0].yuv[0], 38);
  EXPECT_GT(quality->views[3].yuv[0], 30);
  EXPECT_EQ(back.properties, cloud.properties);
}

TEST(PlenopticViewMaps, HaveTheDegreeThatMemoryHasRoomFor) {
  const PlenopticCloud cloud = sphere_of_views(12);
  PlenopticSettings settings;
  settings.as = PlenopticCoding::kViewMaps;
  settings.encoder.fit.basis.degree = 3;
  const auto functions = [&] {
    const auto encoded = encode_plenoptic(cloud, settings);
    return encoded ? decode(encoded->stream)->header.num_functions : 0;
  };
  EXPECT_EQ(functions(), 16);
  settings.memory = 12 * 9 * cloud.num_points();
  EXPECT_EQ(functions(), 9);
  settings.most_memory = (3 * cloud.num_colours() + 150 + 2 * 18 * 4) * cloud.num_points();
  EXPECT_EQ(functions(), 4);
  settings.most_memory = 150 * cloud.num_points();
  EXPECT_EQ(encode_plenoptic(cloud, settings).error().code, Errc::kLimitExceeded);
}

TEST(PlenopticViewMaps, AreRefusedWithoutDirections) {
  PlenopticSettings settings;
  settings.as = PlenopticCoding::kViewMaps;
  PlenopticCloud cloud = sphere_of_views(4);
  cloud.view_positions.assign(4, Vec3{1, 2, 3});
  EXPECT_THAT(encode_plenoptic(cloud, settings).error().message, HasSubstr("two places or more"));
  cloud.view_positions.clear();
  EXPECT_THAT(encode_plenoptic(cloud, settings).error().message, HasSubstr("need positions"));
  settings.as = PlenopticCoding::kPlanes;
  EXPECT_TRUE(encode_plenoptic(cloud, settings));
  settings.hold_out = {1};
  EXPECT_THAT(encode_plenoptic(cloud, settings).error().message, HasSubstr("planes predict no"));
  settings.as = PlenopticCoding::kAuto;
  settings.hold_out = {4};
  EXPECT_THAT(encode_plenoptic(cloud, settings).error().message, HasSubstr("views are 0 to 3"));
}

}  // namespace
}  // namespace slf::plenoptic_test
