// SPDX-License-Identifier: Apache-2.0
#include "tools/setting_options.h"

#include <map>

#include "tools/text.h"

namespace slf::tools {
namespace {

std::string shown(const SettingInfo& setting, double number) {
  if (setting.kind != SettingInfo::kNumber)
    return std::to_string(static_cast<std::int64_t>(number));
  return shortest(number);
}

}  // namespace

std::string type_of(const SettingInfo& setting) {
  std::string words;
  for (const std::string& word : setting.words) words += (words.empty() ? "" : "|") + word;
  const std::string between = shown(setting, setting.low) + " to " + shown(setting, setting.high);
  const std::string also = words.empty() ? "" : " or " + words;
  switch (setting.kind) {
    case SettingInfo::kNumber:
      return "FLOAT:" + between + also;
    case SettingInfo::kWhole:
      return "INT:" + between + also;
    case SettingInfo::kPair:
      return "INT,INT:" + between;
    case SettingInfo::kWord:
      return words;
    case SettingInfo::kFlag:
      return "flag";
    case SettingInfo::kText:
      break;
  }
  return "NAME";
}

namespace {

const char* kind_name(SettingInfo::Kind kind) {
  switch (kind) {
    case SettingInfo::kNumber:
      return "number";
    case SettingInfo::kWhole:
      return "whole";
    case SettingInfo::kPair:
      return "pair";
    case SettingInfo::kWord:
      return "word";
    case SettingInfo::kFlag:
      return "flag";
    case SettingInfo::kText:
      break;
  }
  return "text";
}

CLI::Option* add_setting(CLI::App& verb, GivenSettings& given, const SettingInfo& setting) {
  const std::string name = (setting.name == "quality" ? "-q,--" : "--") + setting.name;
  if (setting.kind == SettingInfo::kFlag)
    return verb.add_flag_function(
        name, [&given, &setting](std::int64_t) { given.emplace_back(setting.name, "on"); },
        setting.help);
  const auto check = [&setting](std::string& value) { return wrong_value(setting, value); };
  return verb
      .add_option_function<std::string>(
          name,
          [&given, &setting](const std::string& value) { given.emplace_back(setting.name, value); },
          setting.help)
      ->type_name(type_of(setting))
      ->default_str(setting.initial)
      ->check(CLI::Validator(check, ""));
}

}  // namespace

void add_settings(CLI::App& verb, GivenSettings& given,
                  const std::function<bool(const SettingInfo&)>& wanted) {
  std::map<std::string, CLI::Option*> options;
  for (const SettingInfo& setting : encoder_settings()) {
    if (!wanted(setting)) continue;
    CLI::Option* option = options[setting.name] = add_setting(verb, given, setting);
    if (!setting.group.empty()) option->group(setting.group);
    for (const std::string& name : setting.excludes)
      if (const auto other = options.find(name); other != options.end())
        option->excludes(other->second);
  }
}

nlohmann::ordered_json settings_table_json() {
  auto list = nlohmann::ordered_json::array();
  for (const SettingInfo& s : encoder_settings()) {
    nlohmann::ordered_json row = {{"name", s.name}, {"kind", kind_name(s.kind)}};
    if (s.kind == SettingInfo::kNumber || s.kind == SettingInfo::kWhole ||
        s.kind == SettingInfo::kPair) {
      row["low"] = s.low;
      row["high"] = s.high;
    }
    if (!s.words.empty()) row["words"] = s.words;
    row["initial"] = s.initial;
    row["group"] = s.group;
    row["help"] = s.help;
    if (!s.excludes.empty()) row["excludes"] = s.excludes;
    list.push_back(std::move(row));
  }
  return list;
}

}  // namespace slf::tools
