// SPDX-License-Identifier: Apache-2.0
// Kinds of rows of the settings' table: a number, a number or a word, one of some words, a flag.
#pragma once

#include <charconv>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "encoder/setting_rows.h"

namespace slf::row_kinds {

inline std::string shown(double number) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, number).ptr};
}

/// A number that was checked: of any other text the result is 0.
template <class T>
T number_of(const std::string& text) {
  T value{};
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

inline const EncoderSettings& initial_settings() {
  static const EncoderSettings settings = settings_of(Preset::kDefault);
  return settings;
}

/// @param member  from settings to the number's place in them
template <class Member>
SettingRow number(const char* name, Member member, double low, double high, const char* help) {
  EncoderSettings settings = initial_settings();
  using T = std::remove_reference_t<decltype(member(settings))>;
  constexpr auto kind = std::is_floating_point_v<T> ? SettingInfo::kNumber : SettingInfo::kWhole;
  return {
      {name, kind, low, high, {}, shown(static_cast<double>(member(settings))), help, "", {}},
      [member](EncoderSettings& s, const std::string& text) { member(s) = number_of<T>(text); }};
}

/// A number, or a word that stands for one.
template <class Member, class T>
SettingRow number_or(const char* word, T stands_for, const char* name, Member member, double low,
                     double high, const char* help) {
  SettingRow row = number(name, member, low, high, help);
  row.info.words = {word};
  if (row.info.initial == shown(static_cast<double>(stands_for))) row.info.initial = word;
  row.apply = [=, set = row.apply](EncoderSettings& s, const std::string& text) {
    if (text == word)
      member(s) = stands_for;
    else
      set(s, text);
  };
  return row;
}

template <class T>
using Words = std::vector<std::pair<const char*, T>>;

template <class Member, class T>
SettingRow choice(const char* name, Member member, Words<T> words, const char* help) {
  EncoderSettings settings = initial_settings();
  SettingRow row{{name, SettingInfo::kWord, 0, 0, {}, "", help, "", {}}, {}};
  for (const auto& [word, value] : words) {
    row.info.words.emplace_back(word);
    if (member(settings) == value) row.info.initial = word;
  }
  row.apply = [=](EncoderSettings& s, const std::string& text) {
    for (const auto& [word, value] : words)
      if (text == word) member(s) = value;
  };
  return row;
}

template <class Member>
SettingRow on_or_off(const char* name, Member member, const char* help) {
  return choice(name, member, Words<bool>{{"on", true}, {"off", false}}, help);
}

/// A flag of the command line. What it sets, given.
template <class Member>
SettingRow flag(const char* name, Member member, const char* help) {
  return {{name, SettingInfo::kFlag, 0, 0, {}, "", help, "", {}},
          [=](EncoderSettings& s, const std::string& text) {
            if (text == "on") member(s);
          }};
}

/// A setting that takes more than its place: settings_from() knows it.
inline SettingRow other(SettingInfo info) { return {std::move(info), {}}; }

inline SettingRow words_of_fit(const char* name, std::vector<std::string> words,
                               const char* initial, const char* help) {
  return other({name, SettingInfo::kWord, 0, 0, std::move(words), initial, help, "", {}});
}

}  // namespace slf::row_kinds
