// SPDX-License-Identifier: Apache-2.0
// Which settings frames in time have, and what to say of the others.
#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "base/input_error.h"
#include "encoder/setting_rows.h"
#include "slf/frame_inputs.h"

namespace slf {
namespace {

constexpr const char* kPointsAsGiven =
    "points of frames are coded as they are given, or --surface splats has photographs train them: "
    "mend or densify each frame first, by slf encode of it alone and slf decode";
constexpr const char* kNoTarget = "--target-bitrate, or -q, is for a sequence";
constexpr const char* kOneSlice =
    "a frame is one slice: --group and --part divide a sequence, slf truncate --frames cuts it";
constexpr const char* kTheirCoders = "frames have the octree and the vector coder alone";
constexpr const char* kAsTaken =
    "photographs and poses of frames are taken as they are: correct them before";

/// A setting of which frames have some values or none.
struct PartlyOfFrames {
  std::string_view name;
  SettingInfo::Frames frames;
  std::vector<std::string> values;
  const char* instead;
};

const std::vector<PartlyOfFrames>& partly() {
  using Info = SettingInfo;
  static const std::vector<PartlyOfFrames> all = {
      {"preset", Info::kAnyFrames, {"default"}, "--fit paper fits view maps as the paper does"},
      {"densify", Info::kAnyFrames, {"off", "auto"}, kPointsAsGiven},
      {"surface", Info::kAnyFrames, {"given", "auto", "splats"}, kPointsAsGiven},
      {"surface-seconds", Info::kNotFrames, {}, kPointsAsGiven},
      {"surface-memory", Info::kNotFrames, {}, kPointsAsGiven},
      {"geometry", Info::kAnyFrames, {"octree"}, kTheirCoders},
      {"coefficients", Info::kAnyFrames, {"vector"}, kTheirCoders},
      {"target-bytes", Info::kNotFrames, {}, kNoTarget},
      {"target-psnr", Info::kNotFrames, {}, kNoTarget},
      {"quality-layers", Info::kAnyFrames, {"1"}, "frames have one quality layer: -q chooses it"},
      {"base-levels", Info::kAnyFrames, {"0", "auto"}, kOneSlice},
      {"slice-points", Info::kNotFrames, {}, kOneSlice},
      {"slice-start", Info::kNotFrames, {}, kOneSlice},
      {"match-exposure", Info::kFramesOfPhotographs, {"off", "auto"}, kAsTaken},
      {"refine-cameras", Info::kFramesOfPhotographs, {"off"}, kAsTaken},
  };
  return all;
}

constexpr std::string_view kAny[] = {
    "linear", "grid-bits",  "voxel-size", "metres-per-unit", "quality", "target-bitrate",
    "steps",  "colour",     "klt",        "chroma-step",     "predict", "reference-contexts",
    "rdo",    "normal-bits"};

/// What splats alone do not have, and frames of them do.
constexpr std::string_view kOfSplatsInTime[] = {"target-bitrate", "reference-contexts"};

constexpr std::string_view kOfPhotographs[] = {"effort",
                                               "splats",
                                               "photograph-pixels",
                                               "quality-loss",
                                               "delta",
                                               "occlusion-resolution",
                                               "depth-tolerance",
                                               "check-cameras",
                                               "fit",
                                               "fit-to",
                                               "order",
                                               "functions",
                                               "scales",
                                               "lambda",
                                               "beta",
                                               "iterations",
                                               "penalise-dc",
                                               "free-dc",
                                               "neighbours",
                                               "basis",
                                               "directions",
                                               "cross-validate",
                                               "degree",
                                               "block-log2",
                                               "block-strength",
                                               "block-growth",
                                               "point-penalty",
                                               "point-growth",
                                               "environment-degree",
                                               "environment-radius"};

/// What clouds of views have, however they are coded.
constexpr std::string_view kOfViews[] = {
    "metres-per-unit", "quality", "target-bitrate", "klt", "reference-contexts", "predict", "rdo"};

/// What their view maps have beyond that.
constexpr std::string_view kOfViewMaps[] = {
    "steps",         "colour",       "chroma-step",        "effort",
    "fit",           "order",        "functions",          "scales",
    "lambda",        "beta",         "iterations",         "penalise-dc",
    "free-dc",       "basis",        "directions",         "cross-validate",
    "degree",        "block-log2",   "block-strength",     "block-growth",
    "point-penalty", "point-growth", "environment-degree", "environment-radius"};

template <class Names>
bool is_among(const Names& names, std::string_view name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

const PartlyOfFrames* find_partly(std::string_view name) {
  for (const PartlyOfFrames& row : partly())
    if (row.name == name) return &row;
  return nullptr;
}

bool are_views(FrameKind kind) {
  return kind == FrameKind::kPlanes || kind == FrameKind::kViewMaps;
}

/// A setting that some frames have.
Result<Done, InputError> check_of_views(const SettingInfo& info, const std::string& value,
                                        FrameKind kind) {
  const std::string option = "--" + info.name;
  const bool as_it_is = !info.frame_values.empty() && info.frames == SettingInfo::kAnyFrames &&
                        value != "splats";  // points are taken as given, by the coders of frames
  if (as_it_is || is_among(kOfViews, info.name)) return Done{};
  if (is_among(kOfViewMaps, info.name)) {
    if (kind == FrameKind::kViewMaps) return Done{};
    return invalid_argument(option +
                            " is for view maps (--as viewmaps), and these frames are planes");
  }
  if (info.frames == SettingInfo::kFramesOfPhotographs || value == "splats")
    return invalid_argument(option +
                            " is for photographs, and frames that are clouds of views have none");
  if (info.name == "grid-bits" || info.name == "voxel-size")
    return invalid_argument(option +
                            " is not for clouds of views: whole coordinates are the grid of all");
  return invalid_argument(option +
                          " is not for clouds of views: --as colour takes red, green, blue alone, "
                          "and has it");
}

Result<Done, InputError> check_one(const SettingInfo& info, const std::string& value,
                                   FrameKind kind) {
  const auto& values = info.frame_values;
  const bool has_value = values.empty() || is_among(values, value);
  if (info.frames == SettingInfo::kNotFrames || !has_value) {
    const PartlyOfFrames* row = find_partly(info.name);
    const std::string given = "--" + info.name + (values.empty() ? "" : " " + value);
    return invalid_argument(
        given + " is not for frames: " + (row != nullptr ? row->instead : kTheirCoders));
  }
  if (are_views(kind)) return check_of_views(info, value, kind);
  const bool trains = info.name == "surface" && value == "splats";
  if ((info.frames == SettingInfo::kFramesOfPhotographs || trains) && kind != FrameKind::kCaptures)
    return invalid_argument("--" + info.name + " is for photographs, and frames that are " +
                            (kind == FrameKind::kSplats ? "splats" : "clouds") + " have none");
  if (kind == FrameKind::kSplats && info.splats != SettingInfo::kAnySplats &&
      !is_among(kOfSplatsInTime, info.name))
    return invalid_argument("--" + info.name +
                            " is for photographs and clouds, and these frames are splats");
  return Done{};
}

}  // namespace

void mark_for_frames(SettingTable& rows) {
  for (SettingRow& row : rows) {
    SettingInfo& info = row.info;
    if (is_among(kAny, info.name)) info.frames = SettingInfo::kAnyFrames;
    if (is_among(kOfPhotographs, info.name)) info.frames = SettingInfo::kFramesOfPhotographs;
    if (const PartlyOfFrames* known = find_partly(info.name)) {
      info.frames = known->frames;
      info.frame_values = known->values;
    }
  }
}

Result<Done, InputError> check_frame_settings(const GivenSettings& given, FrameKind kind) {
  for (const auto& [name, value] : given)
    for (const SettingInfo& info : encoder_settings())
      if (info.name == name) SLF_CHECK(check_one(info, value, kind));
  return Done{};
}

}  // namespace slf
