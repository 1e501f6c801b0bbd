// SPDX-License-Identifier: Apache-2.0
// The table of the encoder's settings: one row names, describes, reads and writes one of them.
// Whatever has settings walks it: options, the check of the interface, metadata, plans, .igc,
// Python, the laboratory.
#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "slf/settings.h"

namespace slf {

/// Where a setting counts. Elsewhere it is idle, and refused where it is given.
struct SettingScope {
  const char* name;  ///< "--fit paper", as a person would give it
  bool (*holds)(const EncoderSettings&);
};

/// What a row is about.
enum class SettingPart : std::uint8_t {
  kStart,
  kGeometry,
  kCoding,
  kObservation,
  kFit,
  kSearch,
  kTexture
};

struct SettingRow {
  SettingInfo info;
  /// Puts a value that wrong_value() accepts into its place. Empty: it
  /// has no place, settings_from() looks at it by name.
  std::function<void(EncoderSettings&, const std::string&)> apply;
  /// What is in its place, as text that apply reads back; empty text: nothing was set. Empty: it
  /// has no place of its own.
  std::function<std::string(const EncoderSettings&)> value = {};
  SettingPart part = SettingPart::kStart;
  const SettingScope* scope = nullptr;  ///< null: everywhere
  bool option = true;       ///< false: no option, but follows from others; plans keep it
  bool recorded = false;    ///< in the metadata of a file, as name_with_underscores
  std::string unless = {};  ///< but not where it has this value
  bool FitSearch::*searched = nullptr;  ///< what looks for it where it is not given
};

using SettingTable = std::vector<SettingRow>;

const SettingTable& setting_rows();

/// Says in each row what frames in time have of it. A row that it does not know is refused of them.
void mark_for_frames(SettingTable& rows);

/// As settings_from(given), of any table.
Result<EncoderSettings, InputError> settings_from(const GivenSettings& given,
                                                  const SettingTable& table);

/// Whatever has a place has a value of its range.
/// @errors kInvalidArgument with the setting's name
Result<Done, InputError> check_ranges(const EncoderSettings& settings,
                                      const SettingTable& table = setting_rows());

/// What the metadata of a file says of its settings, of some parts.
Metadata recorded_settings(const EncoderSettings& settings,
                           std::initializer_list<SettingPart> parts,
                           const SettingTable& table = setting_rows());

/// Names and values of all rows of some parts that have a place, in their order.
GivenSettings kept_settings(const EncoderSettings& settings,
                            std::initializer_list<SettingPart> parts,
                            const SettingTable& table = setting_rows());

/// Reads them back, from a file.
/// @errors kInvalidInput: others than these, another order, a value outside of its range
Result<Done, InputError> put_settings(const GivenSettings& kept,
                                      std::initializer_list<SettingPart> parts,
                                      EncoderSettings& settings,
                                      const SettingTable& table = setting_rows());

}  // namespace slf
