// SPDX-License-Identifier: Apache-2.0
// Encoding: a capture, or given integers, to bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "slf/camera_poses.h"
#include "slf/camera_trust.h"
#include "slf/capture.h"
#include "slf/error.h"
#include "slf/exposure.h"
#include "slf/fit.h"
#include "slf/surface.h"
#include "slf/types.h"

namespace slf {

enum class GeometryCoder : std::uint8_t { kOctree = 0, kDraco = 1 };

/// How planes are entropy coded. Spec 7.6.
enum class CoefficientCoder : std::uint8_t {
  kVector = 0,       ///< per node over the planes of a group, with shared significance
  kIndependent = 1,  ///< each plane alone, one context set per plane: the paper's way
  kTexture = 2,      ///< each plane a picture, coded by HEVC: the paper's second way. Spec 8.11
};

/// Transforms across planes, derived from the components (Karhunen-Loeve) and coded. Spec 8.7.5.
enum class TransformMode : std::uint8_t {
  kNone,
  kFunctions,  ///< one matrix over functions for all channels, and one over channels
  kJoint,      ///< one matrix over all planes: for many planes, whose matrix is a small share
};

/// How planes become pictures. Needs x265 (SLF_X265), and libde265 for digests.
struct TextureSettings {
  enum Mode : std::uint8_t {
    kIntra,     ///< every plane by itself
    kLowDelay,  ///< predicted from the planes before it in its group
  };
  int bits = 10;  ///< of a sample: 8, 10 or 12
  int qp = 22;    ///< of HEVC, 0 .. 51
  Mode mode = kLowDelay;
  std::string preset = "superfast";  ///< of x265. Slower ones do not always give the same bytes
  bool lossless = false;             ///< the pictures, not the rounding to samples; qp is not used
};

/// CodingParameters::base_levels: 24 points or more in a cell, no base for a few points.
inline constexpr int kAutomaticBase = -1;
inline constexpr std::uint32_t kDefaultSlicePoints = 1u << 17;
inline constexpr std::uint32_t kMostSlicePoints = 1u << 22;

/// How given integers become bytes. Same integers and parameters give the same bytes everywhere;
/// with a transform, which is found in floating point, from one binary.
struct CodingParameters {
  static constexpr std::int32_t kMostStep = (1 << 27) - 1;  ///< range of sps_plane_step

  GeometryCoder geometry = GeometryCoder::kOctree;
  CoefficientCoder coefficients = CoefficientCoder::kVector;
  /// [K] 0 .. 15, group 0 holds function 0, or attributes, which have no transform if they are in
  /// groups before those of functions; empty: all 0
  std::vector<int> group;
  std::vector<std::array<std::uint32_t, 3>> step;  ///< [K][3] 1 .. kMostStep, component units;
                                                   ///< empty: all 1. With kTexture that of a sample
  /// Not with kTexture. What a transform codes has the steps of its first function: function 0, or
  /// the first outside group 0
  TransformMode transform = TransformMode::kNone;
  std::vector<int>
      coefficient_level_ends;  ///< ascending octree levels at which coefficient units end;
                               ///< the last is the grid's bits. Empty: one unit per group
  std::vector<int> geometry_level_ends;  ///< the same for geometry units
  bool predict = true;  ///< coarser levels predict finer ones where that pays. Spec 8.7.6
  /// Frames have contexts by the frame before. Spec 8.12.6: such a stream is of version 1.1
  bool reference_contexts = true;
  double rdo = 0;  ///< 0 .. 1: quantise by distortion and rate; 0: to the nearest
  /// 1 .. 4, of the vector coder alone where above 1: values come bit by bit, each layer at half of
  /// the step of the one before, the last at `step`. So quality is a cut of the file, too
  int quality_layers = 1;
  std::vector<int> group_layers;  ///< [groups] in place of quality_layers; empty: all alike
  TextureSettings texture;        ///< where coefficients is kTexture
  /// Octree levels that are coded once for all slices; 0: none, and one slice. They end a unit of
  /// either kind, whatever the level ends above
  int base_levels = kAutomaticBase;
  std::uint32_t base_weight = 0;  ///< points that each cell of the base counts as, to a power of
                                  ///< two; 0: those that it has
  /// There are as many slices as give this many points each, about. One with Draco or a texture
  std::uint32_t max_slice_points = kDefaultSlicePoints;
  SliceStart slice_start = SliceStart::kShared;
  bool digest = true;  ///< a checksum of what each slice decodes to. Spec 7.9
  bool index = true;   ///< where every unit is, so that a part can be read alone. Spec 7.7
  Metadata metadata;
  int threads = 0;  ///< 0: all cores
};

struct EncoderSettings;

/// Those that the settings of an encoder have, too; steps, groups and level ends follow from the
/// light field.
CodingParameters coding_parameters(const EncoderSettings& settings);

/// Level ends of a grid of so many bits that serve most: all but the two finest levels, then one
/// each, so that a scene of several slices begins with all of it, coarsely.
std::vector<int> level_ends(int bits);

/// Codes an integer light field (`slf pack`, and the last step of encode).
/// Positions may come in any order; they are sorted, components and normals with them.
/// @errors kInvalidArgument: duplicate or out-of-grid positions, sizes that do not fit together, a
///         component too large for its slice (|c| * sqrt(points) must stay below 2^27), a parameter
///         out of range. kUnsupported: Draco, or x265 for textures, was left out of this build.
/// Thread-safe. O(points (levels + planes)).
Result<std::vector<std::uint8_t>, InputError> pack(const LightField& light_field,
                                                   const CodingParameters& parameters = {});

enum class Preset { kDefault, kPaper };

/// EncoderSettings::q: chosen from held-out input pictures, kPlainQ at the least.
inline constexpr double kAutomaticQ = 0;
inline constexpr double kAutomaticRdo = -1;
/// The step of preset paper, and where none can be chosen.
inline constexpr double kPlainQ = 16;

struct EncoderSettings {
  Preset preset = Preset::kDefault;
  int grid_bits = 0;           ///< 1 .. 21; 0: the density that the photographs resolve
  double voxel_size = 0;       ///< > 0: instead of grid_bits
  double metres_per_unit = 0;  ///< > 0: of the capture's world, for the header; 0: not known
  DensifySettings densify{Densify::kAuto};  ///< not of meshes, nor of geometry that was mended
  Surface surface = Surface::kAuto;         ///< kGiven without cameras
  std::size_t splats = 0;  ///< most of them that photographs train; 0: as many as pay
  /// > 0: training ends after about so long, with steps as small as at its end; files then differ
  /// from run to run
  double surface_seconds = 0;
  /// Directory where trainings leave what they would need to go on, now and then; empty: nowhere.
  /// Not with surface_seconds.
  std::filesystem::path work;
  bool resume = false;        ///< trainings go on from what is in `work`; else it is made anew
  int surface_memory = 1024;  ///< 16 or more, MiB: photographs of a training are halved to fit
  /// Photographs of more millions of pixels are halved as they are read, as often as it takes; 0:
  /// none is.
  double photograph_pixels = 2.5;
  ObserveSettings observe;
  /// Photographs are given one exposure and white balance before anything else; not without
  /// points, nor in parts or frames.
  MatchExposure match_exposure = MatchExposure::kAuto;
  /// Poses are trained before anything else; not without photographs, nor in parts or frames.
  RefineCameras refine_cameras = RefineCameras::kOff;
  bool check_cameras = true;  ///< leaves out, or corrects, cameras that the others contradict
  FitSettings fit = FitSettings::hierarchical();
  FitSearch search;  ///< changes fit; not without cameras
  /// Quantiser step Q, grey levels, 0.05 .. 4096, or kAutomaticQ: the largest that costs no more
  /// than quality_loss, or kPlainQ where that is larger
  double q = kAutomaticQ;
  double quality_loss =
      0.1;  ///< 0.001 .. 10 dB of held-out input pictures, of a step that is chosen
  std::uint64_t target_bytes = 0;  ///< > 0: of the file, in place of q, which is the first guess
  /// > 0: bits a second of all frames of a sequence together, in place of q; encode_frames() alone
  double target_bitrate = 0;
  /// > 0: PSNR of the input images, dB, in place of q: of pictures with a picture fit, else of
  /// points
  double target_psnr = 0;
  bool steps_by_norm = true;  ///< step_k = Q / (2 ||b_k||); false: Q for every plane
  ColourTransform colour = ColourTransform::kOpponent;
  TransformMode transform = TransformMode::kFunctions;  ///< none where coefficients is kTexture
  double chroma_step = 1;  ///< 0.1 .. 10: channels 1 and 2 have steps this much larger
  GeometryCoder geometry = GeometryCoder::kOctree;
  CoefficientCoder coefficients = CoefficientCoder::kVector;
  TextureSettings texture;         ///< where coefficients is kTexture: its qp takes the place of q
  bool predict = true;             ///< CodingParameters
  bool reference_contexts = true;  ///< the same
  double rdo = kAutomaticRdo;  ///< CodingParameters; or 1 of splats that photographs train, else 0
  int quality_layers = 1;      ///< CodingParameters
  int normal_bits = 0;         ///< 0: normals are not coded; 4 .. 12
  int base_levels = kAutomaticBase;                      ///< CodingParameters
  std::uint32_t max_slice_points = kDefaultSlicePoints;  ///< CodingParameters
  SliceStart slice_start = SliceStart::kShared;          ///< CodingParameters
  Metadata metadata;  ///< added to what the encoder itself records
  int threads = 0;
};

inline constexpr int kDefaultEffort = 7, kMostEffort = 8;

/// The settings of a preset. kPaper is the configuration of the paper as written (spec annex C).
/// @param effort  1 .. kMostEffort, of kDefault alone: time of the encoder for bytes at equal
///                quality. 7 is what the members above start with. Measured: docs/decisions/013
EncoderSettings settings_of(Preset preset, int effort = kDefaultEffort);

/// Where a quantiser step came from, and what it is expected to cost.
struct ChosenStep {
  enum Origin : std::uint8_t {
    kGiven,          ///< by the settings, or by a target
    kChosen,         ///< by held-out input pictures
    kNoCameras,      ///< kPlainQ, as in all that follow: a coloured cloud
    kTexture,        ///< whose quality is its QP
    kNoPictures,     ///< nothing is fitted to pictures
    kTooFewCameras,  ///< to hold some out
    kTooFewPixels,   ///< that held-out cameras see whole of the sample
    kSplats,         ///< splats have a step of their own
  };
  Origin origin = kGiven;
  double loss = 0;                      ///< kChosen: dB of the held-out pictures that q costs
  double held_out = 0;                  ///< kChosen: their PSNR before quantisation, dB
  std::size_t cameras = 0, points = 0;  ///< kChosen: that were held out; of the sample
  double seconds = 0;
};

/// For a person: "chosen: costs 0.09 dB ..." or "not chosen: there are no ...".
std::string reason_of(const ChosenStep& step);

struct Encoded {
  std::vector<std::uint8_t> stream;
  double q = 0;     ///< the step it was coded with
  ChosenStep step;  ///< where q came from
  Grid grid;        ///< with the bits and the step that were given or chosen
  Density density;  ///< what the photographs resolve; all of it where grid_bits was 0
  std::size_t points = 0, merged = 0, observations = 0, unobserved_points = 0;
  ExposureReport exposure;           ///< what became of the photographs
  PoseReport poses;                  ///< what became of the cameras
  SurfaceReport surface;             ///< what became of the capture's points before anything else
  ChosenFit fit;                     ///< of a capture with cameras
  PictureFit pictures;               ///< where fit.settings.pictures has rounds
  std::vector<CameraTrust> cameras;  ///< of settings.check_cameras, ascending; else empty
  double seconds_voxelise = 0, seconds_observe = 0, seconds_choose = 0, seconds_fit = 0,
         seconds_pictures = 0, seconds_code = 0;
  std::vector<std::string> warnings;
};

/// From a capture to an .slf stream. With no cameras (a coloured cloud) the colours are coded as a
/// light field of one component.
/// @param cameras  the input cameras (split_cameras); empty only where the capture has none.
/// @errors those of check_capture(). kInvalidArgument: no cameras of a capture that has some, or a
/// surface that only photographs make; those of the steps: voxelise, observe, check_cameras,
/// fit_view_maps, pack. Deterministic for any thread count of one binary.
Result<Encoded, InputError> encode(const Capture& capture, std::span<const int> cameras,
                                   const EncoderSettings& settings, const Progress& progress = {});

}  // namespace slf
