// SPDX-License-Identifier: Apache-2.0
// Kinds of rows of the settings' table: a number, a number or a word, one of some words, a flag.
#pragma once

#include <charconv>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/shortest.h"
#include "encoder/setting_rows.h"

namespace slf::row_kinds {

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
  const auto value = [member](const EncoderSettings& s) {
    if constexpr (std::is_floating_point_v<T>)
      return shortest(static_cast<double>(member(s)));
    else
      return std::to_string(member(s));  // 100000, not 1e+05
  };
  return {{name, kind, low, high, {}, value(settings), help, "", {}},
          [member](EncoderSettings& s, const std::string& text) { member(s) = number_of<T>(text); },
          value};
}

/// A number, or a word that stands for one.
template <class Member, class T>
SettingRow number_or(const char* word, T stands_for, const char* name, Member member, double low,
                     double high, const char* help) {
  SettingRow row = number(name, member, low, high, help);
  row.info.words = {word};
  row.apply = [=, set = row.apply](EncoderSettings& s, const std::string& text) {
    if (text == word)
      member(s) = stands_for;
    else
      set(s, text);
  };
  row.value = [=, get = row.value](const EncoderSettings& s) {
    return member(s) == stands_for ? word : get(s);
  };
  row.info.initial = row.value(initial_settings());
  return row;
}

/// A number that is 0 unless it is given.
template <class Member>
SettingRow number_or_nothing(const char* name, Member member, double low, double high,
                             const char* help) {
  SettingRow row = number(name, member, low, high, help);
  row.info.initial.clear();
  row.value = [=, get = row.value](const EncoderSettings& s) {
    return member(s) == 0 ? "" : get(s);
  };
  return row;
}

template <class T>
using Words = std::vector<std::pair<const char*, T>>;

template <class Member, class T>
SettingRow choice(const char* name, Member member, Words<T> words, const char* help) {
  SettingRow row{{name, SettingInfo::kWord, 0, 0, {}, "", help, "", {}}, {}};
  for (const auto& [word, value] : words) row.info.words.emplace_back(word);
  row.apply = [=](EncoderSettings& s, const std::string& text) {
    for (const auto& [word, value] : words)
      if (text == word) member(s) = value;
  };
  row.value = [=](const EncoderSettings& s) -> std::string {
    for (const auto& [word, value] : words)
      if (member(s) == value) return word;
    return "none";
  };
  row.info.initial = row.value(initial_settings());
  return row;
}

/// One of some words, or "auto", which encoder/settings.cpp makes one of them.
template <class Member, class T>
SettingRow choice_or_auto(const char* name, Member member, Words<T> words, const char* initial,
                          const char* help) {
  SettingRow row = choice(name, member, std::move(words), help);
  row.info.words.emplace_back("auto");
  row.info.initial = initial;
  return row;
}

template <class Member>
SettingRow on_or_off(const char* name, Member member, const char* help) {
  return choice(name, member, Words<bool>{{"on", true}, {"off", false}}, help);
}

/// A flag of the command line: given, it puts `set` into its place.
template <class Member, class T>
SettingRow flag(const char* name, Member member, T set, const char* help) {
  return {{name, SettingInfo::kFlag, 0, 0, {}, "", help, "", {}},
          [=](EncoderSettings& s, const std::string& text) {
            if (text == "on") member(s) = set;
          },
          [=](const EncoderSettings& s) { return member(s) == set ? "on" : "off"; }};
}

/// A setting that takes more than its place: settings_from() knows it.
inline SettingRow other(SettingInfo info) { return {std::move(info), {}}; }

inline SettingRow words_of_fit(const char* name, std::vector<std::string> words,
                               const char* initial, const char* help) {
  return other({name, SettingInfo::kWord, 0, 0, std::move(words), initial, help, "", {}});
}

/// No option of the program.
inline SettingRow inner(SettingRow row) {
  row.option = false;
  return row;
}

inline SettingRow recorded(SettingRow row, const char* unless = "") {
  row.recorded = true;
  row.unless = unless;
  return row;
}

inline SettingRow searched(bool FitSearch::*by, SettingRow row) {
  row.searched = by;
  return row;
}

inline SettingRow in(const SettingScope& scope, SettingRow row) {
  row.scope = &scope;
  return row;
}

/// Adds rows of one group on a page, one part and, where they have none of
/// their own, one scope.
inline void add(SettingTable& table, SettingPart part, const char* group, const SettingScope* scope,
                std::vector<SettingRow> more) {
  for (SettingRow& row : more) {
    row.info.group = group;
    row.part = part;
    if (row.scope == nullptr) row.scope = scope;
    table.push_back(std::move(row));
  }
}

}  // namespace slf::row_kinds

// NOLINTNEXTLINE: a place in the settings, for reading and writing.
#define SLF_AT(member) \
  [](auto& s) -> auto& { return s.member; }
