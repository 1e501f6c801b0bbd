// SPDX-License-Identifier: Apache-2.0
// The encoder's settings by name: what command lines, bindings and tables are made from.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "slf/encoder.h"
#include "slf/error.h"

namespace slf {

enum class FrameKind : std::uint8_t;  // slf/frame_inputs.h

/// What a setting is called, what it may be, and what it is for.
struct SettingInfo {
  enum Kind : std::uint8_t {
    kNumber,  ///< low .. high, or one of the words
    kWhole,   ///< a whole number of low .. high, or one of the words
    kPair,    ///< two of those with a comma between them
    kWord,    ///< one of the words
    kFlag,    ///< "on" or "off"
    kText,    ///< anything
  };
  /// What splats have of it. Elsewhere it is refused.
  enum Splats : std::uint8_t {
    kNotSplats,
    kTrainedSplats,  ///< those that photographs train
    kAnySplats,      ///< those that are given, too
  };
  /// What frames in time have of it. Elsewhere it is refused.
  enum Frames : std::uint8_t {
    kNotFrames,
    kFramesOfPhotographs,  ///< those that photographs belong to
    kAnyFrames,            ///< coloured clouds, too
  };
  std::string name;  ///< "delta", the program's --delta
  Kind kind = kText;
  double low = 0, high = 0;
  std::vector<std::string> words;
  std::string initial;  ///< of the default preset at its default effort; empty: nothing
  std::string help;     ///< a sentence without a full stop, with the unit
  std::string group;    ///< what it belongs to
  std::vector<std::string> excludes;  ///< names of settings that may not be given beside it
  Splats splats = kNotSplats;
  Frames frames = kNotFrames;
  std::vector<std::string> frame_values = {};  ///< the values that frames have; empty: all
};

/// All of them, in the order in which a person reads them. "preset" and "effort" come first: what
/// is not given is theirs.
const std::vector<SettingInfo>& encoder_settings();

/// What is wrong with a value of a setting, e.g. "22 is not in the range 1 to 21"; empty: nothing.
std::string wrong_value(const SettingInfo& setting, std::string_view value);

/// Names and values, each name once.
using GivenSettings = std::vector<std::pair<std::string, std::string>>;

/// The preset's settings with everything that is given in its place. What only one fit or basis has
/// chooses it, where neither is given.
/// @errors kInvalidArgument, with "--name" in the message: no such setting, given twice, a value
///         outside its range, one that excludes another, one that the fit or basis, or splats, do
///         not have.
/// Thread-safe.
Result<EncoderSettings, InputError> settings_from(const GivenSettings& given);

/// Refuses what frames in time do not have, so that nothing is given without effect.
/// @errors kInvalidArgument, with "--name" in the message and what would do in its place
Result<Done, InputError> check_frame_settings(const GivenSettings& given, FrameKind kind);

}  // namespace slf
