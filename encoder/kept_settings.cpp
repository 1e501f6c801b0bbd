// SPDX-License-Identifier: Apache-2.0
// Walks over the table of settings: what is checked, recorded, kept and read back.
#include <algorithm>

#include "encoder/setting_rows.h"

namespace slf {
namespace {

bool is_of(const SettingRow& row, std::initializer_list<SettingPart> parts) {
  return std::find(parts.begin(), parts.end(), row.part) != parts.end();
}

bool is_kept(const SettingRow& row, std::initializer_list<SettingPart> parts) {
  return row.apply && row.value && is_of(row, parts);
}

}  // namespace

Result<Done, InputError> check_ranges(const EncoderSettings& settings, const SettingTable& table) {
  for (const SettingRow& row : table) {
    if (!row.value) continue;
    const std::string value = row.value(settings);
    if (value.empty()) continue;
    if (const std::string what = wrong_value(row.info, value); !what.empty())
      return InputError{Errc::kInvalidArgument, row.info.name + ": " + what};
  }
  return Done{};
}

Metadata recorded_settings(const EncoderSettings& settings,
                           std::initializer_list<SettingPart> parts, const SettingTable& table) {
  Metadata metadata;
  for (const SettingRow& row : table) {
    if (!row.recorded || !is_of(row, parts)) continue;
    if (row.scope != nullptr && !row.scope->holds(settings)) continue;
    std::string key = row.info.name, value = row.value(settings);
    if (value == row.unless) continue;
    std::replace(key.begin(), key.end(), '-', '_');
    metadata.emplace_back(std::move(key), std::move(value));
  }
  return metadata;
}

GivenSettings kept_settings(const EncoderSettings& settings,
                            std::initializer_list<SettingPart> parts, const SettingTable& table) {
  GivenSettings kept;
  for (const SettingRow& row : table)
    if (is_kept(row, parts)) kept.emplace_back(row.info.name, row.value(settings));
  return kept;
}

Result<Done, InputError> put_settings(const GivenSettings& kept,
                                      std::initializer_list<SettingPart> parts,
                                      EncoderSettings& settings, const SettingTable& table) {
  auto next = kept.begin();
  for (const SettingRow& row : table) {
    if (!is_kept(row, parts)) continue;
    if (next == kept.end() || next->first != row.info.name)
      return InputError{Errc::kInvalidInput, row.info.name + " is expected"};
    if (next->second.empty() && row.value(EncoderSettings{}).empty()) {
      ++next;  // nothing, as it is without it
      continue;
    }
    if (const std::string what = wrong_value(row.info, next->second); !what.empty())
      return InputError{Errc::kInvalidInput, row.info.name + ": " + what};
    row.apply(settings, (next++)->second);
  }
  if (next != kept.end()) return InputError{Errc::kInvalidInput, next->first + " is not expected"};
  return Done{};
}

}  // namespace slf
