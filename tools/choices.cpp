#include "tools/choices.h"

#include <string>
#include <utility>
#include <vector>

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

CLI::Option* add_geometry_choice(CLI::App& verb, GeometryCoder& choice) {
  return add_choice<GeometryCoder>(
      verb, "--geometry", choice,
      {{"octree", GeometryCoder::kOctree}, {"draco", GeometryCoder::kDraco}},
      "Coder of the positions");
}

CLI::Option* add_coefficients_choice(CLI::App& verb, CoefficientCoder& choice) {
  return add_choice<CoefficientCoder>(
      verb, "--coefficients", choice,
      {{"vector", CoefficientCoder::kVector}, {"independent", CoefficientCoder::kIndependent}},
      "Coder of the components: planes of a group together, or each alone (paper)");
}

CLI::Option* add_colour_choice(CLI::App& verb, ColourTransform& choice) {
  return add_choice<ColourTransform>(
      verb, "--colour", choice,
      {{"opponent", ColourTransform::kOpponent}, {"none", ColourTransform::kNone}},
      "Colour transform; paper: none");
}

CLI::Option* add_preset_choice(CLI::App& verb, Preset& choice) {
  return add_choice<Preset>(verb, "--preset", choice,
                            {{"default", Preset::kDefault}, {"paper", Preset::kPaper}},
                            "Where all other settings start from; paper: the paper as written");
}

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

CLI::Option* add_steps_choice(CLI::App& verb, bool& by_norm) {
  return add_choice<bool>(
      verb, "--steps", by_norm, {{"by-norm", true}, {"uniform", false}},
      "Quantiser steps: Q / (2 norm of the function), or Q for all; paper: uniform");
}

}  // namespace slf::tools
