// SPDX-License-Identifier: Apache-2.0
// From names and values to the encoder's settings.
#include "slf/settings.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include "base/input_error.h"
#include "base/shortest.h"
#include "encoder/fit_setting_rows.h"
#include "encoder/setting_row_kinds.h"
#include "encoder/setting_rows.h"

namespace slf {
namespace {

using Outcome = Result<Done, InputError>;

/// All of the text as one number.
template <class T>
std::errc read(std::string_view text, T& value) {
  const auto [stopped, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && stopped != text.data() + text.size() ? std::errc::invalid_argument
                                                                      : error;
}

std::string wrong_whole(std::string_view text, double low, double high) {
  std::int64_t value = 0;
  const std::errc error = read(text, value);
  const std::string given(text);
  if (error == std::errc::invalid_argument) return given + " is not a whole number";
  const auto least = static_cast<std::int64_t>(low), most = static_cast<std::int64_t>(high);
  if (error != std::errc() || value < least || value > most)
    return given + " is not in the range " + std::to_string(least) + " to " + std::to_string(most);
  return "";
}

std::string wrong_number(std::string_view text, double low, double high) {
  double value = 0;
  const std::errc error = read(text, value);
  const std::string given(text);
  if (error == std::errc::invalid_argument) return given + " is not a number";
  if (error != std::errc() || !(value >= low && value <= high))
    return given + " is not in the range " + shortest(low) + " to " + shortest(high);
  return "";
}

std::string wrong_pair(std::string_view text, double low, double high) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return std::string(text) + " is not two numbers, N,N";
  const std::string first = wrong_whole(text.substr(0, comma), low, high);
  return first.empty() ? wrong_whole(text.substr(comma + 1), low, high) : first;
}

std::string list_of(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : "|") + word;
  return list;
}

/// What was given, by name.
class Given {
 public:
  explicit Given(const GivenSettings& given) : given_(given) {}

  const std::string* find(std::string_view name) const {
    for (const auto& [key, value] : given_)
      if (key == name) return &value;
    return nullptr;
  }
  bool has(std::string_view name) const { return find(name) != nullptr; }
  bool is(std::string_view name, std::string_view value) const {
    const std::string* there = find(name);
    return there != nullptr && *there == value;
  }
  int whole(std::string_view name, int otherwise) const {
    const std::string* there = find(name);
    if (there != nullptr) read(*there, otherwise);
    return otherwise;
  }

 private:
  const GivenSettings& given_;
};

InputError wrong_setting(const std::string& name, const std::string& what) {
  return invalid_argument(std::string("--").append(name).append(" ").append(what));
}

Outcome check_given(const GivenSettings& all, const SettingTable& table) {
  const Given given(all);
  for (const auto& pair : all) {
    const std::string &name = pair.first, &value = pair.second;
    const auto row = std::find_if(table.begin(), table.end(), [&](const SettingRow& r) {
      return r.option && r.info.name == name;
    });
    if (row == table.end()) return wrong_setting(name, "is not a setting of the encoder");
    if (given.find(name) != &value) return wrong_setting(name, "is given twice");
    if (const std::string what = wrong_value(row->info, value); !what.empty())
      return wrong_setting(name, what);
    for (const std::string& excluded : row->info.excludes)
      if (given.has(excluded)) return wrong_setting(name, "excludes --" + excluded);
  }
  return Done{};
}

/// A value that only another fit or search has.
Outcome refuse(const Given& given, const char* name, const char* value, const char* of) {
  if (given.is(name, value))
    return invalid_argument(std::string("--") + name + " " + value + " is for " + of);
  return Done{};
}

/// By the effort alone: nobody said --surface.
bool takes_points_as_given(const Given& given, const EncoderSettings& settings) {
  return given.has("effort") && !given.has("surface") && settings.surface == Surface::kGiven;
}

/// What was given for another fit, basis or coder than the one in force.
Outcome refuse_idle(const Given& given, const EncoderSettings& settings,
                    const SettingTable& table) {
  if (settings.fit.method == FitMethod::kPaper) {
    const char* of = "--fit hierarchical";
    SLF_CHECK(refuse(given, "basis", "harmonics", of));
    SLF_CHECK(refuse(given, "basis", "auto", of));
    SLF_CHECK(refuse(given, "directions", "auto", of));
  }
  if (given.is("cross-validate", "off")) {
    SLF_CHECK(refuse(given, "basis", "auto", "--cross-validate on"));
    SLF_CHECK(refuse(given, "directions", "auto", "--cross-validate on"));
  }
  for (const SettingRow& row : table)
    if (row.scope != nullptr && given.has(row.info.name) && !row.scope->holds(settings))
      return invalid_argument("--" + row.info.name + " is for " + row.scope->name +
                              (takes_points_as_given(given, settings)
                                   ? ", and --effort 1 to 3 takes points as they are given"
                                   : ""));
  return Done{};
}

Outcome refuse_what_splats_lack(const Given& given, const EncoderSettings& settings,
                                const SettingTable& table) {
  if (settings.surface != Surface::kSplats) return Done{};
  SLF_CHECK(refuse(given, "preset", "paper", "a surface, not --surface splats"));
  for (const SettingRow& row : table)
    if (given.has(row.info.name) && row.info.splats == SettingInfo::kNotSplats)
      return invalid_argument("--" + row.info.name + " is for a surface, not --surface splats");
  return Done{};
}

bool is_of_paper(const SettingRow& row) {
  const SettingScope* scope = row.scope;
  return scope == &kPaperFit || scope == &kSplines || row.info.name == "order";
}

/// Each fit has a basis and directions of its own. Settings that only the paper's has choose it.
void choose_fit(const Given& given, EncoderSettings& settings, const SettingTable& table) {
  FitSettings& fit = settings.fit;
  const bool of_paper =
      !given.has("basis") && std::any_of(table.begin(), table.end(), [&](const SettingRow& row) {
        return given.has(row.info.name) && is_of_paper(row);
      });
  const bool hierarchical = given.has("fit") ? given.is("fit", "hierarchical")
                                             : !of_paper && fit.method == FitMethod::kHierarchical;
  const FitSettings start = hierarchical ? FitSettings::hierarchical() : FitSettings{};
  if (start.method != fit.method) {
    fit.method = start.method;
    fit.basis = start.basis;
    fit.directions = start.directions;
    fit.pictures = start.pictures;
    settings.search = FitSearch{};
  }
  if (given.is("basis", "bspline") && fit.basis.id != BasisId::kBspline) fit.basis = Basis{};
  if (given.is("basis", "harmonics") && fit.basis.id != BasisId::kHarmonics)
    fit.basis = FitSettings::hierarchical().basis;
  if (given.is("basis", "auto")) fit.basis.id = BasisId::kHarmonics;
}

void choose_pictures(const Given& given, PictureFitSettings& pictures) {
  if (given.is("fit-to", "points")) pictures.rounds = 0;
  if (given.is("fit-to", "pictures") && pictures.rounds == 0)
    pictures = FitSettings::hierarchical().pictures;
}

/// What is left to cross-validation where the preset has `of_preset`: nothing that was given, and
/// all else where it is asked for.
FitSearch search_of(const Given& given, FitMethod method, FitSearch of_preset,
                    const SettingTable& table) {
  const bool asked = given.has("cross-validate")
                         ? given.is("cross-validate", "on")
                         : given.is("basis", "auto") || given.is("directions", "auto");
  const bool on = asked || (!given.has("cross-validate") && of_preset.any());
  if (method != FitMethod::kHierarchical || !on) return FitSearch::none();
  FitSearch search = of_preset;
  if (asked) search.points = std::max(search.points, FitSearch{}.points);
  for (const SettingRow& row : table) {
    if (row.searched == nullptr) continue;
    const std::string& name = row.info.name;
    search.*row.searched =
        (asked || of_preset.*row.searched) && (!given.has(name) || given.is(name, "auto"));
  }
  search.basis =
      given.has("basis") ? given.is("basis", "auto") : of_preset.basis && !given.has("degree");
  return search;
}

Outcome choose_scales(const Given& given, Basis& basis) {
  if (given.has("functions")) {
    const auto n = static_cast<unsigned>(given.whole("functions", 1));
    if (!std::has_single_bit(n))
      return invalid_argument("--functions " + std::to_string(n) + " is not a power of two");
    const int scales = std::countr_zero(n);
    basis.scales_gamma = scales / 2;
    basis.scales_theta = scales - basis.scales_gamma;
  }
  if (const std::string* scales = given.find("scales")) {
    const std::string_view text(*scales);
    const std::size_t comma = text.find(',');
    read(text.substr(0, comma), basis.scales_theta);
    read(text.substr(comma + 1), basis.scales_gamma);
  }
  return Done{};
}

}  // namespace

const std::vector<SettingInfo>& encoder_settings() {
  static const std::vector<SettingInfo> all = [] {
    std::vector<SettingInfo> infos;
    for (const SettingRow& row : setting_rows())
      if (row.option) infos.push_back(row.info);
    return infos;
  }();
  return all;
}

std::string wrong_value(const SettingInfo& setting, std::string_view value) {
  const auto& words = setting.words;
  if (std::find(words.begin(), words.end(), value) != words.end()) return "";
  switch (setting.kind) {
    case SettingInfo::kNumber:
      return wrong_number(value, setting.low, setting.high);
    case SettingInfo::kWhole:
      return wrong_whole(value, setting.low, setting.high);
    case SettingInfo::kPair:
      return wrong_pair(value, setting.low, setting.high);
    case SettingInfo::kWord:
      return std::string(value) + " is none of " + list_of(words);
    case SettingInfo::kFlag:
      return value == "on" || value == "off" ? "" : std::string(value) + " is none of on|off";
    case SettingInfo::kText:
      break;
  }
  return "";
}

Result<EncoderSettings, InputError> settings_from(const GivenSettings& all) {
  return settings_from(all, setting_rows());
}

Result<EncoderSettings, InputError> settings_from(const GivenSettings& all,
                                                  const SettingTable& table) {
  SLF_CHECK(check_given(all, table));
  const Given given(all);
  const Preset preset = given.is("preset", "paper") ? Preset::kPaper : Preset::kDefault;
  if (given.has("effort") && preset == Preset::kPaper)
    return invalid_argument("--effort is for --preset default");
  EncoderSettings settings = settings_of(preset, given.whole("effort", kDefaultEffort));
  choose_fit(given, settings, table);
  choose_pictures(given, settings.fit.pictures);
  settings.search = search_of(given, settings.fit.method, settings.search, table);
  for (const SettingRow& row : table)
    if (const std::string* value = given.find(row.info.name); value != nullptr && row.apply)
      row.apply(settings, *value);
  SLF_CHECK(choose_scales(given, settings.fit.basis));
  SLF_CHECK(refuse_what_splats_lack(given, settings, table));
  SLF_CHECK(refuse_idle(given, settings, table));
  // More slices than one need a base, whatever the preset has.
  if (given.has("slice-points") && !given.has("base-levels")) settings.base_levels = kAutomaticBase;
  return settings;
}

}  // namespace slf
