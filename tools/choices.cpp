// SPDX-License-Identifier: Apache-2.0
#include "tools/choices.h"

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tools/options.h"

namespace slf::tools {
namespace {

template <class T>
using Words = std::vector<std::pair<std::string, T>>;

/// The option takes one of the words; any other is refused with the list of them.
template <class T>
CLI::Option* add_choice(CLI::App& verb, const char* name, T& choice, const Words<T>& words,
                        const std::string& description) {
  std::string list;
  for (const auto& [word, value] : words) list += (list.empty() ? "" : "|") + word;
  const auto set = [&choice, words](const std::string& given) {
    for (const auto& [word, value] : words)
      if (word == given) choice = value;
  };
  std::string initial;
  for (const auto& [word, value] : words)
    if (value == choice) initial = word;
  const auto known = [words, list](std::string& given) {
    for (const auto& [word, value] : words)
      if (word == given) return std::string();
    return given + " is none of " + list;
  };
  return verb.add_option_function<std::string>(name, set, description)
      ->type_name(list)
      ->default_str(initial)
      ->check(CLI::Validator(known, ""));
}

}  // namespace

CLI::Option* add_up_choice(CLI::App& verb, UpAxis& choice) {
  return add_choice<UpAxis>(verb, "--up", choice,
                            {{"+x", UpAxis::kPlusX},
                             {"-x", UpAxis::kMinusX},
                             {"+y", UpAxis::kPlusY},
                             {"-y", UpAxis::kMinusY},
                             {"+z", UpAxis::kPlusZ},
                             {"-z", UpAxis::kMinusZ}},
                            "World axis that points up, instead of the capture's");
}

const char* igc_codec_name(IgcCodec codec) {
  switch (codec) {
    case IgcCodec::kHevcLowDelay:
      return "hevc";
    case IgcCodec::kHevcIntra:
      return "hevc-intra";
    case IgcCodec::kAv1:
      return "av1";
  }
  return "";
}

CLI::Option* add_igc_codec_choice(CLI::App& verb, IgcCodec& choice) {
  Words<IgcCodec> words;
  for (const IgcCodec codec : {IgcCodec::kHevcLowDelay, IgcCodec::kHevcIntra, IgcCodec::kAv1})
    words.emplace_back(igc_codec_name(codec), codec);
  return add_choice<IgcCodec>(verb, "--codec", choice, words,
                              "Coder of the images; hevc: low delay (paper)");
}

CLI::Option* add_igc_chroma_choice(CLI::App& verb, IgcChroma& choice) {
  return add_choice<IgcChroma>(verb, "--chroma", choice,
                               {{"420", IgcChroma::k420}, {"444", IgcChroma::k444}},
                               "Chroma at half the resolution, or at the full one");
}

std::string igc_setting_in_words(const std::string& key, const std::string& value) {
  static const std::map<std::string, std::vector<const char*>> kWords{
      {"codec",
       {igc_codec_name(IgcCodec::kHevcLowDelay), igc_codec_name(IgcCodec::kHevcIntra),
        igc_codec_name(IgcCodec::kAv1)}},
      {"chroma", {"420", "444"}},
      {"transfer", {"display", "linear"}},
      {"fit", {"paper", "hierarchical"}},
      {"basis", {"bspline", "harmonics"}},
      {"frame", {"global", "reflected"}},
      {"colour", {"none", "opponent"}}};
  const auto words = kWords.find(key);
  if (words == kWords.end() || value.size() != 1) return value;
  const auto at = static_cast<std::size_t>(value[0] - '0');
  return at < words->second.size() ? words->second[at] : value;
}

}  // namespace slf::tools
