// SPDX-License-Identifier: Apache-2.0
#include "encoder/setting_rows.h"

#include <algorithm>

#include "encoder/fit_setting_rows.h"
#include "encoder/rate_control.h"
#include "encoder/setting_row_kinds.h"

namespace slf {
namespace {

using namespace row_kinds;

void exclude(SettingTable& rows, const std::vector<std::string>& names) {
  for (SettingRow& row : rows)
    for (const std::string& name : names)
      if (std::find(names.begin(), names.end(), row.info.name) != names.end() &&
          row.info.name != name)
        row.info.excludes.push_back(name);
}

void count_for_splats(SettingTable& rows, SettingInfo::Splats splats,
                      std::initializer_list<std::string_view> names) {
  for (SettingRow& row : rows)
    if (std::find(names.begin(), names.end(), row.info.name) != names.end())
      row.info.splats = splats;
}

const SettingScope kTextures = {"--coefficients texture", [](const EncoderSettings& s) {
                                  return s.coefficients == CoefficientCoder::kTexture;
                                }};
const SettingScope kPlanes = {
    "--coefficients vector and independent",
    [](const EncoderSettings& s) { return s.coefficients != CoefficientCoder::kTexture; }};
const SettingScope kChosenStep = {"--quality auto",
                                  [](const EncoderSettings& s) { return s.q == kAutomaticQ; }};
const SettingScope kTrainedSurface = {
    "--surface auto, trained and splats", [](const EncoderSettings& s) {
      return s.surface != Surface::kGiven && s.surface != Surface::kMended;
    }};

const SettingScope kTrainedSplats = {"--surface auto and splats", [](const EncoderSettings& s) {
                                       return s.surface == Surface::kAuto ||
                                              s.surface == Surface::kSplats;
                                     }};

void add_start(SettingTable& rows) {
  add(rows, SettingPart::kStart, "", nullptr,
      {flag("linear", SLF_AT(observe.transfer), Transfer::kLinear,
            "Fit in linear light (sRGB decoded); default: display values"),
       words_of_fit("preset", {"default", "paper"}, "default",
                    "Where all other settings start from; paper: the paper as written"),
       in(kHierarchicalFit, other({"effort",
                                   SettingInfo::kWhole,
                                   1,
                                   kMostEffort,
                                   {},
                                   std::to_string(kDefaultEffort),
                                   "Time for bytes: 1 is quickest, 8 looks furthest (docs/cli.md)",
                                   "",
                                   {}}))});
}

void add_geometry(SettingTable& rows) {
  add(rows, SettingPart::kGeometry, "Geometry", nullptr,
      {number_or("auto", 0, "grid-bits", SLF_AT(grid_bits), 1, 21,
                 "Voxel grid, bits per axis; auto: a voxel is what the sharpest photographs "
                 "resolve, or the cloud's own spacing"),
       number_or_nothing("voxel-size", SLF_AT(voxel_size), 1e-12, 1e12,
                         "Voxel edge in world units, in place of --grid-bits"),
       number_or_nothing("metres-per-unit", SLF_AT(metres_per_unit), 1e-12, 1e12,
                         "Metres in a unit of the world, kept in the file: viewers measure by it"),
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
              "given: points as they are (scans, exact models); mended: moved to where photographs "
              "agree; trained: by photographs; splats: no surface but translucent points of any "
              "size, for outlines and rough geometry; auto: tries these, and keeps what shows "
              "input photographs best that it has not seen"),
       in(kTrainedSplats,
          number_or_nothing("splats", SLF_AT(splats), 1, 1e7,
                            "Splats at most, where photographs train these. None: as many as "
                            "are worth their bytes to photographs that trials have not seen")),
       in(kTrainedSurface, number("surface-seconds", SLF_AT(surface_seconds), 0, 1e6,
                                  "Train a surface for about so long, seconds; 0: as long as it "
                                  "pays. Files then differ "
                                  "from run to run")),
       in(kTrainedSurface,
          number("surface-memory", SLF_AT(surface_memory), 16, 1 << 20,
                 "MiB that photographs of a training take at most: they are halved to fit")),
       number("photograph-pixels", SLF_AT(photograph_pixels), 0, 1e6,
              "Most pixels of a photograph, millions: a larger one is halved as it is read; 0: as "
              "they are"),
       choice("geometry", SLF_AT(geometry),
              Words<GeometryCoder>{{"octree", GeometryCoder::kOctree},
                                   {"draco", GeometryCoder::kDraco}},
              "Coder of the positions")});
}

void add_coding(SettingTable& rows) {
  add(rows, SettingPart::kCoding, "Coding", nullptr,
      {number_or(
           "auto", kAutomaticQ, "quality", SLF_AT(q), kLeastQ, kMostQ,
           "Quantiser step Q in grey levels: smaller is better and larger; auto: the largest "
           "that costs held-out input images --quality-loss at most, 16 where that is smaller, "
           "there are none, nothing is fitted to pictures, or preset paper is given"),
       in(kChosenStep,
          number("quality-loss", SLF_AT(quality_loss), 0.001, 10,
                 "What a Q that is chosen may cost, dB of the PSNR of held-out input images")),
       number_or_nothing("target-bytes", SLF_AT(target_bytes), 1, 1099511627776,
                         "Find the Q that gives a file of 99 to 100 % of so many bytes"),
       number_or_nothing(
           "target-bitrate", SLF_AT(target_bitrate), 1, 1e12,
           "Find the Q for which all frames together have 97 to 100 % of so many bits a second at "
           "--rate; they are coded some five times"),
       number_or_nothing(
           "target-psnr", SLF_AT(target_psnr), 1, 100,
           "Find the Q that gives the input images' PSNR, up to 0.05 dB more: of pictures, or "
           "of points with --fit-to points; of a file of splats: pictures from around it against "
           "those of the splats as they are given"),
       recorded(choice(
           "steps", SLF_AT(steps_by_norm), Words<bool>{{"by-norm", true}, {"uniform", false}},
           "Quantiser steps: Q / (2 norm of the function), or Q for all; paper: uniform")),
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
       in(kPlanes,
          recorded(
              choice(
                  "klt", SLF_AT(transform),
                  Words<TransformMode>{{"off", TransformMode::kNone},
                                       {"functions", TransformMode::kFunctions},
                                       {"joint", TransformMode::kJoint}},
                  "Code what is not correlated: over functions, and channels; or over all planes "
                  "jointly"),
              "off")),
       recorded(number("chroma-step", SLF_AT(chroma_step), 0.1, 10,
                       "Steps of the second and third channel, over those of the first"),
                "1"),
       on_or_off("predict", SLF_AT(predict),
                 "Predict finer levels from coarser ones where that pays; paper: off"),
       on_or_off("reference-contexts", SLF_AT(reference_contexts),
                 "Contexts of a frame by the frame before; off: readers of format 1.0 read them")});
}

void add_layers_and_slices(SettingTable& rows) {
  add(rows, SettingPart::kCoding, "Coding", nullptr,
      {number_or("auto", kAutomaticRdo, "rdo", SLF_AT(rdo), 0, 1,
                 "Quantise by distortion and rate, 0 to 1; 0: to the nearest (paper); auto: 1 of "
                 "splats that photographs train, else 0"),
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

void add_texture(SettingTable& rows) {
  add(rows, SettingPart::kTexture, "Texture (--coefficients texture)", &kTextures,
      {recorded(choice("texture-bits", SLF_AT(texture.bits),
                       Words<int>{{"8", 8}, {"10", 10}, {"12", 12}}, "Bits of a sample")),
       recorded(
           number("texture-qp", SLF_AT(texture.qp), 0, 51, "QP of HEVC; takes the place of -q")),
       recorded(choice("texture-mode", SLF_AT(texture.mode),
                       Words<TextureSettings::Mode>{{"intra", TextureSettings::kIntra},
                                                    {"low-delay", TextureSettings::kLowDelay}},
                       "Every plane by itself, or predicted from those before it")),
       recorded(
           {{"texture-preset",
             SettingInfo::kText,
             0,
             0,
             {},
             initial_settings().texture.preset,
             "x265's, ultrafast to veryslow; beyond superfast bytes may differ from run to run",
             "",
             {}},
            [](EncoderSettings& s, const std::string& text) { s.texture.preset = text; },
            [](const EncoderSettings& s) { return s.texture.preset; }}),
       recorded(flag("texture-lossless", SLF_AT(texture.lossless), true,
                     "Pictures without loss: what is lost is the rounding to samples"),
                "off")});
}

SettingTable all_rows() {
  SettingTable rows;
  add_start(rows);
  add_geometry(rows);
  add_coding(rows);
  add_layers_and_slices(rows);
  add_fit_rows(rows);
  add_texture(rows);
  exclude(rows, {"grid-bits", "voxel-size"});
  exclude(rows, {"quality", "target-bytes", "target-psnr"});
  for (const char* other : {"quality", "quality-loss", "target-bytes", "target-psnr"})
    exclude(rows, {other, "target-bitrate"});
  exclude(rows, {"quality-loss", "target-bytes"});
  exclude(rows, {"quality-loss", "target-psnr"});
  exclude(rows, {"functions", "scales"});
  exclude(rows, {"penalise-dc", "free-dc"});
  count_for_splats(
      rows, SettingInfo::kTrainedSplats,
      {"preset", "surface", "splats", "surface-seconds", "surface-memory", "photograph-pixels",
       "match-exposure", "refine-cameras", "check-cameras", "target-bitrate"});
  count_for_splats(rows, SettingInfo::kAnySplats,
                   {"effort", "grid-bits", "voxel-size", "metres-per-unit", "quality",
                    "target-bytes", "target-psnr", "klt", "predict", "rdo", "quality-layers",
                    "base-levels", "slice-points", "slice-start"});
  mark_for_frames(rows);
  return rows;
}

}  // namespace

const SettingTable& setting_rows() {
  static const SettingTable rows = all_rows();
  return rows;
}

}  // namespace slf
