// SPDX-License-Identifier: Apache-2.0
#include "encoder/setting_rows.h"

#include <algorithm>

#include "encoder/setting_row_kinds.h"

namespace slf {
namespace {

using namespace row_kinds;

void add(std::vector<SettingRow>& rows, const char* group, std::vector<SettingRow> more) {
  for (SettingRow& row : more) {
    row.info.group = group;
    rows.push_back(std::move(row));
  }
}

void exclude(std::vector<SettingRow>& rows, const std::vector<std::string>& names) {
  for (SettingRow& row : rows)
    for (const std::string& name : names)
      if (std::find(names.begin(), names.end(), row.info.name) != names.end() &&
          row.info.name != name)
        row.info.excludes.push_back(name);
}

// NOLINTNEXTLINE: a place in the settings, for reading and writing.
#define SLF_AT(member) \
  [](auto& s) -> auto& { return s.member; }

void add_start(std::vector<SettingRow>& rows) {
  add(rows, "",
      {flag(
           "linear", [](EncoderSettings& s) { s.observe.transfer = Transfer::kLinear; },
           "Fit in linear light (sRGB decoded); default: display values"),
       words_of_fit("preset", {"default", "paper"}, "default",
                    "Where all other settings start from; paper: the paper as written"),
       other({"effort",
              SettingInfo::kWhole,
              1,
              kMostEffort,
              {},
              std::to_string(kDefaultEffort),
              "Time for bytes: 1 is quickest, 8 looks furthest (docs/cli.md)",
              "",
              {}})});
}

void add_geometry(std::vector<SettingRow>& rows) {
  add(rows, "Geometry",
      {number_or("auto", 0, "grid-bits", SLF_AT(grid_bits), 1, 21,
                 "Voxel grid, bits per axis; auto: a voxel is what the sharpest photographs "
                 "resolve, or the cloud's own spacing"),
       number("voxel-size", SLF_AT(voxel_size), 1e-12, 1e12,
              "Voxel edge in world units, in place of --grid-bits"),
       choice(
           "densify", SLF_AT(densify.mode),
           Words<Densify>{{"on", Densify::kOn}, {"off", Densify::kOff}, {"auto", Densify::kAuto}},
           "Make up points between those of a cloud that is coarser than the grid; auto: on "
           "automatic grids, where an even surface has two pixels or more between points "
           "(effort 8: 1.25)"),
       choice("surface", SLF_AT(surface),
              Words<Surface>{{"given", Surface::kGiven},
                             {"mended", Surface::kMended},
                             {"trained", Surface::kTrained},
                             {"auto", Surface::kAuto},
                             {"splats", Surface::kSplats}},
              "Points as given (scans, exact models), moved to where photographs agree, trained by "
              "photographs, or what predicts held-out input photographs best; splats: no surface "
              "but translucent points of any size, for outlines and rough geometry"),
       number(
           "surface-seconds", SLF_AT(surface_seconds), 0, 1e6,
           "Train a surface for about so long, seconds; 0: as long as it pays. Files then differ "
           "from run to run"),
       number("surface-memory", SLF_AT(surface_memory), 16, 1 << 20,
              "MiB that photographs of a training take at most: they are halved to fit"),
       choice("geometry", SLF_AT(geometry),
              Words<GeometryCoder>{{"octree", GeometryCoder::kOctree},
                                   {"draco", GeometryCoder::kDraco}},
              "Coder of the positions")});
}

void add_coding(std::vector<SettingRow>& rows) {
  add(rows, "Coding",
      {number_or(
           "auto", kAutomaticQ, "quality", SLF_AT(q), 0.05, 4096,
           "Quantiser step Q in grey levels: smaller is better and larger; auto: the largest "
           "that costs held-out input images --quality-loss at most, 16 where that is smaller, "
           "there are none, nothing is fitted to pictures, or preset paper is given"),
       number("quality-loss", SLF_AT(quality_loss), 0.001, 10,
              "What a Q that is chosen may cost, dB of the PSNR of held-out input images"),
       number("target-bytes", SLF_AT(target_bytes), 1, 1099511627776,
              "Find the Q that gives a file of 99 to 100 % of so many bytes"),
       number("target-psnr", SLF_AT(target_psnr), 1, 100,
              "Find the Q that gives the input images' PSNR, up to 0.05 dB more: of pictures, or "
              "of points with --fit-to points"),
       choice("steps", SLF_AT(steps_by_norm), Words<bool>{{"by-norm", true}, {"uniform", false}},
              "Quantiser steps: Q / (2 norm of the function), or Q for all; paper: uniform"),
       choice("coefficients", SLF_AT(coefficients),
              Words<CoefficientCoder>{{"vector", CoefficientCoder::kVector},
                                      {"independent", CoefficientCoder::kIndependent},
                                      {"texture", CoefficientCoder::kTexture}},
              "Coder of the components: planes of a group together, or each alone (paper), or as "
              "pictures by HEVC (paper's TMC)"),
       choice("colour", SLF_AT(colour),
              Words<ColourTransform>{{"opponent", ColourTransform::kOpponent},
                                     {"none", ColourTransform::kNone}},
              "Colour transform; paper: none"),
       choice("klt", SLF_AT(transform),
              Words<TransformMode>{{"off", TransformMode::kNone},
                                   {"functions", TransformMode::kFunctions},
                                   {"joint", TransformMode::kJoint}},
              "Code what is not correlated: over functions, and channels; or over all planes "
              "jointly"),
       number("chroma-step", SLF_AT(chroma_step), 0.1, 10,
              "Steps of the second and third channel, over those of the first"),
       on_or_off("predict", SLF_AT(predict),
                 "Predict finer levels from coarser ones where that pays; paper: off"),
       number("rdo", SLF_AT(rdo), 0, 1,
              "Quantise by distortion and rate, 0 to 1; 0: to the nearest (paper)"),
       number("quality-layers", SLF_AT(quality_layers), 1, 4,
              "Layers in which coefficients are coded, each at half of the step of the one before: "
              "quality is a cut of the file (--layers), for some 1 % more bytes"),
       number_or("0", 0, "normal-bits", SLF_AT(normal_bits), 4, 12,
                 "Code normals with so many bits per coordinate; 0: not"),
       number_or("auto", kAutomaticBase, "base-levels", SLF_AT(base_levels), 0, 20,
                 "Octree levels coded once for all slices; 0: none, and one slice; auto: 24 "
                 "points or more in a cell of the base"),
       number("slice-points", SLF_AT(max_slice_points), 1, kMostSlicePoints,
              "Points of a slice, about: slices are decoded side by side, or some of them alone"),
       choice("slice-start", SLF_AT(slice_start),
              Words<SliceStart>{{"shared", SliceStart::kShared},
                                {"base", SliceStart::kBase},
                                {"apart", SliceStart::kApart}},
              "Slices start from what the first has learnt (smallest), from the base, or from "
              "nothing: apart, each coded by itself")});
}

void add_observation(std::vector<SettingRow>& rows) {
  add(rows, "Observation (paper III-A)",
      {number("delta", SLF_AT(observe.delta_degrees), 0, 90,
              "A view is valid up to 90 - delta degrees from the normal; degrees"),
       number("occlusion-resolution", SLF_AT(observe.occlusion_resolution), 0.05, 8,
              "Depth buffer pixels per image pixel"),
       number("depth-tolerance", SLF_AT(observe.depth_tolerance), 0, 1000,
              "Hidden if deeper than the depth buffer by more, in point spacings; 0: strict"),
       on_or_off("check-cameras", SLF_AT(check_cameras),
                 "Leave out input images that the others contradict (another object, a wrong "
                 "pose), and correct those of another exposure; off in preset paper")});
}

void add_fit(std::vector<SettingRow>& rows) {
  const Basis basis;
  add(rows, "View maps (paper II)",
      {words_of_fit("fit", {"paper", "hierarchical"}, "hierarchical",
                    "Every point by itself and smoothed (paper), or with a prior from octree "
                    "blocks"),
       words_of_fit("fit-to", {"points", "pictures"}, "pictures",
                    "What the cameras saw of each point (paper), or how the pictures look that are "
                    "drawn from them"),
       number("order", SLF_AT(fit.basis.order), 1, 4, "Order of the B-spline wavelets"),
       other({"functions",
              SettingInfo::kWhole,
              1,
              4096,
              {},
              std::to_string(basis.num_functions()),
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
       number("lambda", SLF_AT(fit.lambda), 0, 1e9, "Ridge weight"),
       number("beta", SLF_AT(fit.beta), 0, 1e9, "Smoothness weight"),
       number("iterations", SLF_AT(fit.iterations), 0, 100, "T, sweeps of smoothing"),
       number("neighbours", SLF_AT(fit.neighbours), 1, 64, "Nearest points to smooth over"),
       flag(
           "penalise-dc", [](EncoderSettings& s) { s.fit.penalise_dc = true; },
           "lambda and beta hold for the mean too (paper)"),
       flag(
           "free-dc", [](EncoderSettings& s) { s.fit.penalise_dc = false; },
           "They leave out the mean (default)")});
}

void add_hierarchy(std::vector<SettingRow>& rows) {
  add(rows, "Hierarchical fit (--fit hierarchical)",
      {words_of_fit("basis", {"bspline", "harmonics", "auto"}, "harmonics",
                    "B-spline wavelets (paper), or spherical harmonics, for the hierarchical fit; "
                    "auto: by cross-validation"),
       words_of_fit("frame", {"global", "reflected", "auto"}, "auto",
                    "Directions in world axes (paper), or mirrored at the surface; auto: by "
                    "cross-validation"),
       words_of_fit("cross-validate", {"on", "off"}, "on",
                    "Choose what no option gives of --frame, --block-strength, --block-growth, "
                    "--point-penalty by predicting held-out input images"),
       number("degree", SLF_AT(fit.basis.degree), 0, 10, "Degree of the harmonics"),
       number("block-log2", SLF_AT(fit.hierarchy.block_log2), 0, 21,
              "Side of the finest blocks, 2^n spacings of points"),
       number("block-strength", SLF_AT(fit.hierarchy.strength), 1e-6, 1e6,
              "Pull of a block towards the one above, per observation"),
       number("block-growth", SLF_AT(fit.hierarchy.growth), 1, 10,
              "Growth of its penalties with a function's fineness"),
       number("point-penalty", SLF_AT(fit.hierarchy.point_penalty), 1e-6, 1e9,
              "Pull of a point towards the blocks around it"),
       number("point-growth", SLF_AT(fit.hierarchy.point_growth), 1, 10, "Growth of its penalties"),
       number("environment-degree", SLF_AT(fit.environment.degree), 0, 16,
              "Degree of the light about the object that its surface reflects; 0: none"),
       number_or("0", 0.0, "environment-radius", SLF_AT(fit.environment.radius), 2, 1e6,
                 "Where that light is, in halves of the object's longest side; 0: by "
                 "cross-validation")});
}

void add_texture(std::vector<SettingRow>& rows) {
  add(rows, "Texture (--coefficients texture)",
      {choice("texture-bits", SLF_AT(texture.bits), Words<int>{{"8", 8}, {"10", 10}, {"12", 12}},
              "Bits of a sample"),
       number("texture-qp", SLF_AT(texture.qp), 0, 51, "QP of HEVC; takes the place of -q"),
       choice("texture-mode", SLF_AT(texture.mode),
              Words<TextureSettings::Mode>{{"intra", TextureSettings::kIntra},
                                           {"low-delay", TextureSettings::kLowDelay}},
              "Every plane by itself, or predicted from those before it"),
       {{"texture-preset",
         SettingInfo::kText,
         0,
         0,
         {},
         initial_settings().texture.preset,
         "x265's, ultrafast to veryslow; beyond superfast bytes may differ from run to run",
         "",
         {}},
        [](EncoderSettings& s, const std::string& text) { s.texture.preset = text; }},
       flag(
           "texture-lossless", [](EncoderSettings& s) { s.texture.lossless = true; },
           "Pictures without loss: what is lost is the rounding to samples")});
}

#undef SLF_AT

std::vector<SettingRow> all_rows() {
  std::vector<SettingRow> rows;
  add_start(rows);
  add_geometry(rows);
  add_coding(rows);
  add_observation(rows);
  add_fit(rows);
  add_hierarchy(rows);
  add_texture(rows);
  exclude(rows, {"grid-bits", "voxel-size"});
  exclude(rows, {"quality", "target-bytes", "target-psnr"});
  exclude(rows, {"quality-loss", "target-bytes"});
  exclude(rows, {"quality-loss", "target-psnr"});
  exclude(rows, {"functions", "scales"});
  exclude(rows, {"penalise-dc", "free-dc"});
  for (SettingRow& row : rows)  // nothing, unless it is given
    for (const char* name : {"voxel-size", "target-bytes", "target-psnr"})
      if (row.info.name == name) row.info.initial.clear();
  return rows;
}

}  // namespace

const std::vector<SettingRow>& setting_rows() {
  static const std::vector<SettingRow> rows = all_rows();
  return rows;
}

}  // namespace slf
