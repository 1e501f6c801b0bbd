// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit_setting_rows.h"

#include "encoder/fit/environment.h"
#include "encoder/setting_row_kinds.h"

namespace slf {

const SettingScope kPaperFit = {
    "--fit paper", [](const EncoderSettings& s) { return s.fit.method == FitMethod::kPaper; }};
const SettingScope kHierarchicalFit = {"--fit hierarchical", [](const EncoderSettings& s) {
                                         return s.fit.method == FitMethod::kHierarchical;
                                       }};
const SettingScope kSplines = {"--basis bspline", [](const EncoderSettings& s) {
                                 return s.fit.basis.id == BasisId::kBspline;
                               }};

namespace {

using namespace row_kinds;

const SettingScope kHarmonics = {"--basis harmonics", [](const EncoderSettings& s) {
                                   return s.fit.basis.id == BasisId::kHarmonics;
                                 }};
const SettingScope kSplinesPerhaps = {
    "--basis bspline",
    [](const EncoderSettings& s) { return s.fit.basis.id == BasisId::kBspline || s.search.basis; }};
const SettingScope kPictures = {"--fit-to pictures",
                                [](const EncoderSettings& s) { return s.fit.pictures.rounds > 0; }};

void add_observation(SettingTable& rows) {
  add(rows, SettingPart::kObservation, "Observation (paper III-A)", nullptr,
      {recorded(number("delta", SLF_AT(observe.delta_degrees), 0, 90,
                       "A view is valid up to 90 - delta degrees from the normal; degrees")),
       recorded(number("occlusion-resolution", SLF_AT(observe.occlusion_resolution), 0.05, 8,
                       "Depth buffer pixels per image pixel")),
       recorded(number(
           "depth-tolerance", SLF_AT(observe.depth_tolerance), 0, 1000,
           "Hidden if deeper than the depth buffer by more, in point spacings; 0: strict"))});
  add(rows, SettingPart::kStart, "Observation (paper III-A)", nullptr,
      {choice("match-exposure", SLF_AT(match_exposure),
              Words<MatchExposure>{{"on", MatchExposure::kOn},
                                   {"off", MatchExposure::kOff},
                                   {"auto", MatchExposure::kAuto}},
              "Multiply R, G, B of each photograph so that all see the same points alike; auto: "
              "where most of them differ; off in preset paper"),
       choice(
           "refine-cameras", SLF_AT(refine_cameras),
           Words<RefineCameras>{{"on", RefineCameras::kOn}, {"off", RefineCameras::kOff}},
           "Train the poses of input photographs first, by splats that are given up again: where "
           "calibration is wrong by parts of a pixel; takes as long as half a training of splats"),
       on_or_off("check-cameras", SLF_AT(check_cameras),
                 "Leave out input images that the others contradict (another object, a wrong "
                 "pose), and correct those of another exposure; off in preset paper")});
}

void add_splines(SettingTable& rows) {
  const Basis basis;
  const auto whole = SettingInfo::kWhole;
  const std::string functions = std::to_string(basis.num_functions());
  add(rows, SettingPart::kFit, "View maps (paper II)", &kSplines,
      {in(kSplinesPerhaps, recorded(number("order", SLF_AT(fit.basis.order), 1, 4,
                                           "Order of the B-spline wavelets"))),
       other({"functions",
              whole,
              1,
              4096,
              {},
              functions,
              "N, functions per view map: a power of two; s0 = s1 or s1 + 1",
              "",
              {}}),
       other({"scales",
              SettingInfo::kPair,
              0,
              6,
              {},
              "",
              "s0,s1 apart: 2^s0 functions of azimuth times 2^s1 of elevation",
              "",
              {}}),
       inner(number("scales-theta", SLF_AT(fit.basis.scales_theta), 0, 6, "s0")),
       inner(number("scales-gamma", SLF_AT(fit.basis.scales_gamma), 0, 6, "s1"))});
}

void add_paper(SettingTable& rows) {
  const char* group = "View maps (paper II)";
  SettingRow to =
      words_of_fit("fit-to", {"points", "pictures"}, "pictures",
                   "What the cameras saw of each point (paper), or how the pictures look that are "
                   "drawn from them");
  to.value = [](const EncoderSettings& s) {
    return s.fit.pictures.rounds > 0 ? "pictures" : "points";
  };
  add(rows, SettingPart::kFit, group, nullptr,
      {recorded(
           choice("fit", SLF_AT(fit.method),
                  Words<FitMethod>{{"paper", FitMethod::kPaper},
                                   {"hierarchical", FitMethod::kHierarchical}},
                  "Every point by itself and smoothed (paper), or with a prior from octree blocks"),
           "paper"),
       recorded(std::move(to))});
  add_splines(rows);
  add(rows, SettingPart::kFit, group, &kPaperFit,
      {recorded(number("lambda", SLF_AT(fit.lambda), 0, 1e9, "Ridge weight")),
       recorded(number("beta", SLF_AT(fit.beta), 0, 1e9, "Smoothness weight")),
       recorded(number("iterations", SLF_AT(fit.iterations), 0, 100, "T, sweeps of smoothing")),
       recorded(flag("penalise-dc", SLF_AT(fit.penalise_dc), true,
                     "lambda and beta hold for the mean too (paper)")),
       flag("free-dc", SLF_AT(fit.penalise_dc), false, "They leave out the mean (default)")});
  add(rows, SettingPart::kFit, group, nullptr,
      {recorded(
          number("neighbours", SLF_AT(fit.neighbours), 1, 64, "Nearest points to smooth over"),
          "8")});
}

void add_hierarchy(SettingTable& rows) {
  const char* group = "Hierarchical fit (--fit hierarchical)";
  add(rows, SettingPart::kFit, group, nullptr,
      {choice_or_auto(
           "basis", SLF_AT(fit.basis.id),
           Words<BasisId>{{"bspline", BasisId::kBspline}, {"harmonics", BasisId::kHarmonics}},
           "harmonics",
           "B-spline wavelets (paper), or spherical harmonics, for the hierarchical fit; "
           "auto: by cross-validation"),
       searched(
           &FitSearch::directions,
           recorded(choice_or_auto(
                        "directions", SLF_AT(fit.directions),
                        Words<Directions>{{"world", Directions::kWorld},
                                          {"reflected", Directions::kReflected}},
                        "auto",
                        "Directions of the world (paper), or mirrored at the surface; auto: by "
                        "cross-validation"),
                    "world")),
       inner(number("normal-cell-log2", SLF_AT(fit.normal_cell_log2), 0, 20,
                    "Cells that normals of mirrored directions are averaged in"))});
  add(rows, SettingPart::kFit, group, &kHierarchicalFit,
      {words_of_fit(
           "cross-validate", {"on", "off"}, "on",
           "Choose what no option gives of --directions, --block-strength, --block-growth, "
           "--point-penalty by predicting held-out input images"),
       in(kHarmonics, number("degree", SLF_AT(fit.basis.degree), 0, 10, "Degree of the harmonics")),
       recorded(number("block-log2", SLF_AT(fit.hierarchy.block_log2), 0, 21,
                       "Side of the finest blocks, 2^n spacings of points")),
       searched(&FitSearch::strength,
                recorded(number("block-strength", SLF_AT(fit.hierarchy.strength), 1e-6, 1e6,
                                "Pull of a block towards the one above, per observation"))),
       searched(&FitSearch::growth,
                recorded(number("block-growth", SLF_AT(fit.hierarchy.growth), 1, 10,
                                "Growth of its penalties with a function's fineness"))),
       searched(&FitSearch::point_penalty,
                recorded(number("point-penalty", SLF_AT(fit.hierarchy.point_penalty), 1e-6, 1e9,
                                "Pull of a point towards the blocks around it"))),
       recorded(number("point-growth", SLF_AT(fit.hierarchy.point_growth), 1, 10,
                       "Growth of its penalties")),
       recorded(number("environment-degree", SLF_AT(fit.environment.degree), 0,
                       kMaxEnvironmentDegree,
                       "Degree of the light about the object that its surface reflects; 0: none")),
       recorded(number_or("0", 0.0, "environment-radius", SLF_AT(fit.environment.radius),
                          kLeastEnvironmentRadius, 1e6,
                          "Where that light is, in halves of the object's longest side; 0: by "
                          "cross-validation")),
       inner(number("environment-strength", SLF_AT(fit.environment.strength), 1e-9, 1e9,
                    "Pull of it towards none, per observation"))});
}

/// What --fit-to and --effort choose.
void add_pictures(SettingTable& rows) {
  add(rows, SettingPart::kFit, "Fit to pictures", &kPictures,
      {inner(recorded(number("picture-rounds", SLF_AT(fit.pictures.rounds), 0, 20, "Rounds"))),
       inner(recorded(
           number("picture-steps", SLF_AT(fit.pictures.steps), 1, 100, "Steps of a round"))),
       inner(recorded(number("picture-mean-penalty", SLF_AT(fit.pictures.mean_penalty), 1e-6, 1e9,
                             "Pull of a point's mean to where it started"))),
       inner(recorded(number("picture-penalty", SLF_AT(fit.pictures.penalty), 1e-6, 1e9,
                             "Pull of its other functions"))),
       inner(recorded(
           number("picture-growth", SLF_AT(fit.pictures.growth), 1, 10, "Growth of that"))),
       inner(recorded(number("picture-outlier", SLF_AT(fit.pictures.outlier), 1e-3, 1e9,
                             "Grey levels at which a pixel counts a quarter")))});
}

/// What --cross-validate, and what is given, leave to be searched.
void add_search(SettingTable& rows) {
  const char* help = "By cross-validation";
  add(rows, SettingPart::kSearch, "Cross-validation", nullptr,
      {inner(on_or_off("search-directions", SLF_AT(search.directions), help)),
       inner(on_or_off("search-basis", SLF_AT(search.basis), help)),
       inner(on_or_off("search-block-strength", SLF_AT(search.strength), help)),
       inner(on_or_off("search-block-growth", SLF_AT(search.growth), help)),
       inner(on_or_off("search-point-penalty", SLF_AT(search.point_penalty), help)),
       inner(on_or_off("search-pictures", SLF_AT(search.pictures), help))});
}

}  // namespace

void add_fit_rows(SettingTable& rows) {
  add_observation(rows);
  add_paper(rows);
  add_hierarchy(rows);
  add_pictures(rows);
  add_search(rows);
}

}  // namespace slf
