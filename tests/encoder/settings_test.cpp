// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "slf/settings.h"

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
  const auto settings = settings_from({{"block-strength", "0.5"}, {"frame", "global"}});
  ASSERT_TRUE(settings);
  EXPECT_FALSE(settings->search.strength || settings->search.frame);
  EXPECT_TRUE(settings->search.growth);
  EXPECT_EQ(settings->fit.frame, FrameId::kGlobal);
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

}  // namespace
}  // namespace slf::settings_test
