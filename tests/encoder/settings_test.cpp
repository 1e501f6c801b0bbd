// SPDX-License-Identifier: Apache-2.0
#include "slf/settings.h"
#include "slf/frame_inputs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "encoder/setting_row_kinds.h"

namespace slf::settings_test {
namespace {

const SettingInfo& setting(const std::string& name) {
  for (const SettingInfo& info : encoder_settings())
    if (info.name == name) return info;
  ADD_FAILURE() << name;
  return encoder_settings().front();
}

std::string error_of(const GivenSettings& given) {
  const auto settings = settings_from(given);
  return settings ? "accepted" : settings.error().message;
}

TEST(Settings, WhatIsShownAsInitialMayBeGiven) {
  for (const SettingInfo& info : encoder_settings()) {
    if (info.initial.empty()) continue;
    EXPECT_EQ(wrong_value(info, info.initial), "") << info.name;
    EXPECT_FALSE(info.help.empty() || info.help.back() == '.') << info.name;
  }
}

TEST(Settings, RangesIncludeTheirEndsAndNoMore) {
  for (const SettingInfo& info : encoder_settings()) {
    if (info.kind != SettingInfo::kWhole) continue;
    const auto low = static_cast<std::int64_t>(info.low),
               high = static_cast<std::int64_t>(info.high);
    EXPECT_EQ(wrong_value(info, std::to_string(low)), "") << info.name;
    EXPECT_EQ(wrong_value(info, std::to_string(high)), "") << info.name;
    EXPECT_NE(wrong_value(info, std::to_string(low - 1)), "") << info.name;
    EXPECT_NE(wrong_value(info, std::to_string(high + 1)), "") << info.name;
    EXPECT_NE(wrong_value(info, "1.5"), "") << info.name;
    EXPECT_NE(wrong_value(info, ""), "") << info.name;
  }
}

TEST(Settings, NumbersAreFiniteAndInRange) {
  const SettingInfo& delta = setting("delta");
  EXPECT_EQ(wrong_value(delta, "0.5"), "");
  for (const char* text : {"nan", "inf", "-1", "90.001", "1e400", "10 ", "ten", ""})
    EXPECT_NE(wrong_value(delta, text), "") << text;
  EXPECT_EQ(wrong_value(setting("environment-radius"), "0"), "");
  EXPECT_NE(wrong_value(setting("environment-radius"), "1"), "");
  EXPECT_EQ(wrong_value(setting("grid-bits"), "auto"), "");
}

TEST(Settings, WhatIsNotGivenIsThePresets) {
  const auto settings = settings_from({});
  ASSERT_TRUE(settings);
  EXPECT_EQ(settings->q, settings_of(Preset::kDefault).q);
  const auto paper = settings_from({{"preset", "paper"}});
  ASSERT_TRUE(paper);
  EXPECT_EQ(paper->coefficients, CoefficientCoder::kIndependent);
  EXPECT_EQ(paper->grid_bits, 9);
  const auto quick = settings_from({{"effort", "1"}});
  ASSERT_TRUE(quick);
  EXPECT_EQ(quick->fit.basis.degree, settings_of(Preset::kDefault, 1).fit.basis.degree);
}

TEST(Settings, WhatIsGivenTakesItsPlaceInAnyOrder) {
  const auto settings = settings_from({{"lambda", "0.25"},
                                       {"preset", "paper"},
                                       {"scales", "5,2"},
                                       {"grid-bits", "auto"},
                                       {"penalise-dc", "off"}});
  ASSERT_TRUE(settings);
  EXPECT_EQ(settings->fit.lambda, 0.25);
  EXPECT_EQ(settings->fit.basis.scales_theta, 5);
  EXPECT_EQ(settings->fit.basis.scales_gamma, 2);
  EXPECT_EQ(settings->grid_bits, 0);
  EXPECT_TRUE(settings->fit.penalise_dc) << "off leaves the preset's";
}

TEST(Settings, WhatIsGivenIsNotSearched) {
  const auto settings = settings_from({{"block-strength", "0.5"}, {"directions", "world"}});
  ASSERT_TRUE(settings);
  EXPECT_FALSE(settings->search.strength || settings->search.directions);
  EXPECT_TRUE(settings->search.growth);
  EXPECT_EQ(settings->fit.directions, Directions::kWorld);
}

TEST(Settings, MistakesNameTheSetting) {
  EXPECT_EQ(error_of({{"detla", "3"}}), "--detla is not a setting of the encoder");
  EXPECT_EQ(error_of({{"delta", "3"}, {"delta", "3"}}), "--delta is given twice");
  EXPECT_EQ(error_of({{"delta", "91"}}), "--delta 91 is not in the range 0 to 90");
  EXPECT_EQ(error_of({{"quality", "8"}, {"target-bytes", "9"}}),
            "--quality excludes --target-bytes");
  EXPECT_EQ(error_of({{"quality", "8"}, {"quality-loss", "1"}}),
            "--quality-loss is for --quality auto");
  EXPECT_EQ(error_of({{"quality-loss", "0"}}), "--quality-loss 0 is not in the range 0.001 to 10");
  EXPECT_EQ(error_of({{"preset", "paper"}, {"quality", "auto"}, {"quality-loss", "1"}}),
            "accepted");
  EXPECT_EQ(error_of({{"preset", "best"}}), "--preset best is none of default|paper");
  EXPECT_EQ(error_of({{"functions", "100"}}), "--functions 100 is not a power of two");
  EXPECT_EQ(error_of({{"fit", "hierarchical"}, {"beta", "1"}}), "--beta is for --fit paper");
}

TEST(Settings, WhatSplatsDoNotHaveIsRefusedWithThem) {
  int refused = 0;
  for (const SettingInfo& info : encoder_settings()) {
    if (info.splats != SettingInfo::kNotSplats || info.kind == SettingInfo::kText) continue;
    std::string value = info.words.empty() ? "" : info.words.back();
    if (value.empty())
      value = info.kind == SettingInfo::kFlag ? "on"
              : info.kind == SettingInfo::kPair
                  ? "3,3"
                  : std::to_string(static_cast<int>(std::ceil(info.low)));
    EXPECT_EQ(error_of({{"surface", "splats"}, {info.name, value}}),
              "--" + info.name + " is for a surface, not --surface splats");
    ++refused;
  }
  EXPECT_GE(refused, 39);
  EXPECT_EQ(error_of({{"surface", "splats"}, {"effort", "3"}, {"klt", "joint"}, {"quality", "9"}}),
            "accepted");
}

/// A value that a setting may have; of words the last.
std::string some_value(const SettingInfo& info) {
  if (!info.words.empty()) return info.words.back();
  if (info.kind == SettingInfo::kFlag) return "on";
  if (info.kind == SettingInfo::kPair) return "3,3";
  return info.kind == SettingInfo::kText ? "x" : std::to_string(static_cast<int>(info.high));
}

TEST(Settings, WhatFramesDoNotHaveIsRefusedWithThemAndWhatWouldDoIsNamed) {
  int refused = 0, of_photographs = 0, of_any = 0;
  for (const SettingInfo& info : encoder_settings()) {
    const bool limited = !info.frame_values.empty();
    for (const std::string& value : info.frame_values)
      EXPECT_EQ(wrong_value(info, value), "") << info.name;
    std::string value = some_value(info);
    for (const std::string& word : info.words)
      if (limited && std::count(info.frame_values.begin(), info.frame_values.end(), word) == 0)
        value = word;
    if (limited && std::count(info.frame_values.begin(), info.frame_values.end(), value) > 0)
      value = std::to_string(static_cast<int>(info.high));
    const auto of_captures = check_frame_settings({{info.name, value}}, FrameKind::kCaptures),
               of_clouds = check_frame_settings({{info.name, value}}, FrameKind::kClouds);
    if (info.frames == SettingInfo::kNotFrames || limited) {
      ASSERT_FALSE(of_captures || of_clouds) << info.name;
      EXPECT_NE(of_captures.error().message.find("--" + info.name), std::string::npos);
      EXPECT_NE(of_captures.error().message.find(" is not for frames: "), std::string::npos);
      ++refused;
    } else {
      EXPECT_TRUE(of_captures) << info.name;
      EXPECT_EQ(bool(of_clouds), info.frames == SettingInfo::kAnyFrames) << info.name;
      ++(info.frames == SettingInfo::kAnyFrames ? of_any : of_photographs);
    }
  }
  EXPECT_GE(refused, 18);
  EXPECT_GE(of_photographs, 25);
  EXPECT_GE(of_any, 12);
  EXPECT_TRUE(
      check_frame_settings({{"surface", "given"}, {"base-levels", "auto"}}, FrameKind::kClouds));
}

const SettingScope kOnOctrees = {"--geometry octree", [](const EncoderSettings& s) {
                                   return s.geometry == GeometryCoder::kOctree;
                                 }};

/// The table and one row more, of a member that has none.
SettingTable with_one_more() {
  SettingTable table = setting_rows();
  row_kinds::add(table, SettingPart::kGeometry, "Geometry", &kOnOctrees,
                 {row_kinds::recorded(row_kinds::number("densify-from", SLF_AT(densify.from), 1, 4,
                                                        "Pixels between points"),
                                      "2")});
  return table;
}

TEST(SettingTable, OneRowMoreIsReadCheckedRecordedAndKept) {
  const SettingTable table = with_one_more();
  const auto settings = settings_from({{"densify-from", "3.5"}}, table);
  ASSERT_TRUE(settings);
  EXPECT_EQ(settings->densify.from, 3.5);
  EXPECT_EQ(settings_from({{"densify-from", "5"}}, table).error().message,
            "--densify-from 5 is not in the range 1 to 4");
  EXPECT_EQ(settings_from({{"geometry", "draco"}, {"densify-from", "3"}}, table).error().message,
            "--densify-from is for --geometry octree");
  EXPECT_EQ(recorded_settings(*settings, {SettingPart::kGeometry}, table),
            (Metadata{{"densify_from", "3.5"}}));
  EXPECT_TRUE(recorded_settings(EncoderSettings{}, {SettingPart::kGeometry}, table).empty());

  EncoderSettings back;
  const GivenSettings kept = kept_settings(*settings, {SettingPart::kGeometry}, table);
  ASSERT_TRUE(put_settings(kept, {SettingPart::kGeometry}, back, table));
  EXPECT_EQ(back.densify.from, 3.5);
  EXPECT_FALSE(put_settings(kept, {SettingPart::kGeometry}, back)) << "another table's";
}

TEST(SettingTable, PlacesAreCheckedByTheirRanges) {
  EXPECT_TRUE(check_ranges({}));
  EXPECT_TRUE(check_ranges(settings_of(Preset::kPaper)));
  const SettingTable table = with_one_more();
  for (const double wrong : {0.5, 4.5, std::nan("")}) {
    EncoderSettings settings;
    settings.densify.from = wrong;
    const auto checked = check_ranges(settings, table);
    ASSERT_FALSE(checked) << wrong;
    EXPECT_EQ(checked.error().code, Errc::kInvalidArgument);
    EXPECT_EQ(checked.error().message.rfind("densify-from: ", 0), 0u) << checked.error().message;
  }
}

TEST(SettingTable, EveryPlaceKeepsWhatItsRowReads) {
  const auto all = {SettingPart::kStart,       SettingPart::kGeometry, SettingPart::kCoding,
                    SettingPart::kObservation, SettingPart::kFit,      SettingPart::kTexture};
  for (const SettingRow& row : setting_rows()) {
    if (!row.apply || !row.value || row.info.kind == SettingInfo::kFlag) continue;
    std::vector<std::string> values = row.info.words;
    const auto written = [&](double number) {  // a whole one has no exponent: 100000
      return row.info.kind == SettingInfo::kNumber ? shortest(number)
                                                   : std::to_string(std::int64_t(number));
    };
    if (row.info.low < row.info.high)
      values.insert(values.end(), {written(row.info.low), written(row.info.high)});
    if (row.info.low < 1e5 && 1e5 < row.info.high) values.push_back(written(1e5));
    for (const std::string& value : values) {
      if (value == "auto" && row.info.kind == SettingInfo::kWord) continue;
      EncoderSettings settings;
      row.apply(settings, value);
      EXPECT_EQ(row.value(settings), value) << row.info.name;
    }
  }
  for (const Preset preset : {Preset::kDefault, Preset::kPaper}) {
    EncoderSettings back;
    GivenSettings kept = kept_settings(settings_of(preset), all);
    // What is nothing unless it is given cannot be put back.
    for (const auto& [name, value] : kept)
      if (!value.empty())
        for (const SettingRow& row : setting_rows())
          if (row.info.name == name) row.apply(back, value);
    EXPECT_EQ(kept_settings(back, all), kept);
  }
}

}  // namespace
}  // namespace slf::settings_test
