// SPDX-License-Identifier: Apache-2.0
#include "tools/frame_choices.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace slf::tools {
namespace {

/// What frames have of an option that is no setting of the encoder.
struct FrameChoice {
  enum Of : std::uint8_t { kAll, kPhotographs, kClouds, kViews, kNotViews, kNone };
  std::string_view option;
  Of of = kAll;
  std::string_view instead = {};  ///< of kNone: what would do
};

constexpr std::string_view kOneSlice =
    "--group and --part divide a sequence, and no more than a frame is held";

constexpr std::array kChoices = {
    FrameChoice{"output"},
    FrameChoice{"points", FrameChoice::kPhotographs},
    FrameChoice{"points-world", FrameChoice::kPhotographs},
    FrameChoice{"images", FrameChoice::kPhotographs},
    FrameChoice{"split", FrameChoice::kPhotographs},
    FrameChoice{"refit-still", FrameChoice::kPhotographs},
    FrameChoice{"crop", FrameChoice::kNotViews},
    FrameChoice{"crs", FrameChoice::kNotViews},
    FrameChoice{"up", FrameChoice::kNotViews},
    FrameChoice{"metadata"},
    FrameChoice{"notes"},
    FrameChoice{"threads"},
    FrameChoice{"quiet"},
    FrameChoice{"json"},
    FrameChoice{"part"},
    FrameChoice{"dry-run"},
    FrameChoice{"frames"},
    FrameChoice{"group"},
    FrameChoice{"rate"},
    FrameChoice{"as", FrameChoice::kClouds},
    FrameChoice{"memory", FrameChoice::kNone, kOneSlice},
    FrameChoice{"plan", FrameChoice::kNone, "--part needs no plan of frames"},
    FrameChoice{"work", FrameChoice::kNone,
                "nothing is kept between runs: --part codes groups that are done once"},
    FrameChoice{"resume", FrameChoice::kNone,
                "nothing is kept between runs: --part codes groups that are done once"},
    FrameChoice{"log", FrameChoice::kNone, "--json tells of every frame"},
    FrameChoice{"views", FrameChoice::kViews},
    FrameChoice{"hold-out", FrameChoice::kViews},
};

bool is_setting(const std::string& name) {
  const auto& settings = encoder_settings();
  return std::any_of(settings.begin(), settings.end(),
                     [&](const SettingInfo& setting) { return setting.name == name; });
}

bool are_views(FrameKind kind) {
  return kind == FrameKind::kPlanes || kind == FrameKind::kViewMaps;
}

Outcome check_choice(const std::string& name, FrameKind kind) {
  const auto found = std::find_if(kChoices.begin(), kChoices.end(),
                                  [&](const FrameChoice& c) { return c.option == name; });
  const std::string option = "encode: --" + name;
  if (found == kChoices.end() || found->of == FrameChoice::kNone)
    return Failure{kUsage, option + " is not for frames" +
                               (found == kChoices.end() ? "" : ": " + std::string(found->instead))};
  if (found->of == FrameChoice::kPhotographs && kind != FrameKind::kCaptures)
    return Failure{kUsage, option + " is for photographs, and frames that are " + words_of(kind) +
                               " have none"};
  const std::string these = ", and these frames are " + words_of(kind);
  if (found->of == FrameChoice::kClouds && kind != FrameKind::kClouds && !are_views(kind))
    return Failure{kUsage, option + " is for clouds" + these};
  if (found->of == FrameChoice::kViews && !are_views(kind))
    return Failure{kUsage, option + " is for clouds of views" + these};
  if (found->of == FrameChoice::kNotViews && are_views(kind))
    return Failure{kUsage, option + " is for photographs and clouds of one colour" + these +
                               " (--as colour takes red, green, blue alone)"};
  return Done{};
}

}  // namespace

std::string words_of(FrameKind kind) {
  if (kind == FrameKind::kSplats) return "splats";
  if (kind == FrameKind::kPlanes || kind == FrameKind::kViewMaps) return "clouds of views";
  return kind == FrameKind::kClouds ? "clouds" : "captures";
}

std::vector<GivenOption> given_options(const CLI::App& verb) {
  std::vector<GivenOption> given;
  for (const CLI::Option* option : verb.get_options())
    if (option->count() > 0 && !option->get_lnames().empty())
      given.push_back({option->get_lnames().front(),
                       option->results().empty() ? "" : option->results().front()});
  return given;
}

Outcome check_frame_options(const std::vector<GivenOption>& given, const EncodeOptions& encode,
                            FrameKind kind) {
  for (const GivenOption& option : given) {
    if (!is_setting(option.name)) SLF_CHECK(check_choice(option.name, kind));
    if (option.name == "as" && kind == FrameKind::kClouds && option.value != "auto" &&
        option.value != "colour")
      return Failure{kUsage, "encode: --as " + option.value +
                                 " is for clouds of views, and these frames have one colour"};
  }
  auto checked = check_frame_settings(encode.given, kind);
  if (!checked) return Failure{kUsage, "encode: " + checked.error().message};
  return Done{};
}

}  // namespace slf::tools
