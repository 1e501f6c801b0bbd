#include "tools/choices.h"

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

CLI::Option* add_densify_choice(CLI::App& verb, Densify& choice) {
  return add_choice<Densify>(
      verb, "--densify", choice,
      {{"on", Densify::kOn}, {"off", Densify::kOff}, {"auto", Densify::kAuto}},
      "Make up points between those of a cloud that is coarser than the grid; auto: on automatic "
      "grids, where an even surface has two pixels or more between points (effort 8 and 9: 1.25)");
}

CLI::Option* add_refine_choice(CLI::App& verb, RefineGeometry& choice) {
  return add_choice<RefineGeometry>(
      verb, "--refine-geometry", choice,
      {{"on", RefineGeometry::kOn}, {"off", RefineGeometry::kOff}, {"auto", RefineGeometry::kAuto}},
      "Move points to where the photographs agree: where held-out input photographs gain at all, "
      "never (scans, exact models), or where they gain 5 %");
}

CLI::Option* add_geometry_choice(CLI::App& verb, GeometryCoder& choice) {
  return add_choice<GeometryCoder>(
      verb, "--geometry", choice,
      {{"octree", GeometryCoder::kOctree}, {"draco", GeometryCoder::kDraco}},
      "Coder of the positions");
}

CLI::Option* add_coefficients_choice(CLI::App& verb, CoefficientCoder& choice) {
  return add_choice<CoefficientCoder>(
      verb, "--coefficients", choice,
      {{"vector", CoefficientCoder::kVector},
       {"independent", CoefficientCoder::kIndependent},
       {"texture", CoefficientCoder::kTexture}},
      "Coder of the components: planes of a group together, or each alone (paper), or as pictures "
      "by HEVC (paper's TMC)");
}

void add_texture_options(CLI::App& verb, TextureSettings& settings) {
  const auto texture = [](CLI::Option* option) {
    option->group("Texture (--coefficients texture)");
  };
  texture(verb.add_option("--texture-bits", settings.bits, "Bits of a sample: 8, 10 or 12")
              ->capture_default_str()
              ->check(CLI::IsMember({8, 10, 12})));
  texture(verb.add_option("--texture-qp", settings.qp, "QP of HEVC; takes the place of -q")
              ->capture_default_str()
              ->check(whole_range(0, 51)));
  texture(add_choice<TextureSettings::Mode>(
      verb, "--texture-mode", settings.mode,
      {{"intra", TextureSettings::kIntra}, {"low-delay", TextureSettings::kLowDelay}},
      "Every plane by itself, or predicted from those before it"));
  texture(verb.add_option("--texture-preset", settings.preset,
                          "x265's, ultrafast to veryslow; beyond superfast bytes may differ from "
                          "run to run")
              ->type_name("NAME")
              ->capture_default_str());
  texture(verb.add_flag("--texture-lossless", settings.lossless,
                        "Pictures without loss: what is lost is the rounding to samples"));
}

CLI::Option* add_predict_choice(CLI::App& verb, bool& choice) {
  return add_choice<bool>(verb, "--predict", choice, {{"on", true}, {"off", false}},
                          "Predict finer levels from coarser ones where that pays; paper: off");
}

CLI::Option* add_base_levels(CLI::App& verb, int& levels) {
  const CLI::Validator levels_or_auto(
      [](std::string& given) {
        if (given != "auto") return whole_range(0, 20)(given);
        given = std::to_string(kAutomaticBase);
        return std::string();
      },
      "0 to 20 or auto");
  return verb
      .add_option("--base-levels", levels,
                  "Octree levels coded once for all slices; 0: none, and one slice; auto: about 24 "
                  "points in a cell of the base")
      ->default_str("auto")
      ->transform(levels_or_auto);
}

CLI::Option* add_slice_points(CLI::App& verb, std::uint32_t& points) {
  return verb
      .add_option(
          "--slice-points", points,
          "Points of a slice, about: slices are decoded side by side, or some of them alone")
      ->capture_default_str()
      ->check(whole_range(1, kMostSlicePoints));
}

CLI::Option* add_rdo(CLI::App& verb, double& strength) {
  return verb
      .add_option("--rdo", strength,
                  "Quantise by distortion and rate, 0 to 1; 0: to the nearest (paper)")
      ->capture_default_str()
      ->check(range(0, 1));
}

CLI::Option* add_colour_choice(CLI::App& verb, ColourTransform& choice) {
  return add_choice<ColourTransform>(
      verb, "--colour", choice,
      {{"opponent", ColourTransform::kOpponent}, {"none", ColourTransform::kNone}},
      "Colour transform; paper: none");
}

CLI::Option* add_klt_choice(CLI::App& verb, TransformMode& choice) {
  return add_choice<TransformMode>(
      verb, "--klt", choice,
      {{"off", TransformMode::kNone},
       {"functions", TransformMode::kFunctions},
       {"joint", TransformMode::kJoint}},
      "Code what is not correlated: over functions, and channels; or over all planes jointly");
}

CLI::Option* add_fit_choice(CLI::App& verb, FitMethod& choice) {
  return add_choice<FitMethod>(
      verb, "--fit", choice,
      {{"paper", FitMethod::kPaper}, {"hierarchical", FitMethod::kHierarchical}},
      "Every point by itself and smoothed (paper), or with a prior from octree blocks");
}

CLI::Option* add_fit_to_choice(CLI::App& verb, bool& pictures) {
  return add_choice<bool>(verb, "--fit-to", pictures, {{"points", false}, {"pictures", true}},
                          "What the cameras saw of each point (paper), or how the pictures look "
                          "that are drawn from them");
}

CLI::Option* add_basis_choice(CLI::App& verb, std::optional<BasisId>& choice) {
  return add_choice<std::optional<BasisId>>(
      verb, "--basis", choice,
      {{"bspline", BasisId::kBspline}, {"harmonics", BasisId::kHarmonics}, {"auto", std::nullopt}},
      "B-spline wavelets (paper), or spherical harmonics, for the hierarchical fit; auto: by "
      "cross-validation");
}

CLI::Option* add_frame_choice(CLI::App& verb, std::optional<FrameId>& choice) {
  return add_choice<std::optional<FrameId>>(
      verb, "--frame", choice,
      {{"global", FrameId::kGlobal}, {"reflected", FrameId::kReflected}, {"auto", std::nullopt}},
      "Directions in world axes (paper), or mirrored at the surface; auto: by cross-validation");
}

CLI::Option* add_cross_validate_choice(CLI::App& verb, bool& choice) {
  return add_choice<bool>(verb, "--cross-validate", choice, {{"on", true}, {"off", false}},
                          "Choose what no option gives of --frame, --block-strength, "
                          "--block-growth, --point-penalty by predicting held-out input images");
}

CLI::Option* add_check_cameras_choice(CLI::App& verb, bool& choice) {
  return add_choice<bool>(
      verb, "--check-cameras", choice, {{"on", true}, {"off", false}},
      "Leave out input images that the others contradict (another object, a "
      "wrong pose), and correct those of another exposure; off in preset paper");
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

CLI::Option* add_steps_choice(CLI::App& verb, bool& by_norm) {
  return add_choice<bool>(
      verb, "--steps", by_norm, {{"by-norm", true}, {"uniform", false}},
      "Quantiser steps: Q / (2 norm of the function), or Q for all; paper: uniform");
}

}  // namespace slf::tools
