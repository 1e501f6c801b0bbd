// SPDX-License-Identifier: Apache-2.0
// Scenes larger than one machine: a plan that all parts share, parts that are coded apart, and the
// file that they make together. The same file however the work was divided.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "slf/camera_trust.h"
#include "slf/capture.h"
#include "slf/encoder.h"
#include "slf/error.h"
#include "slf/fit.h"
#include "slf/limits.h"
#include "slf/settings.h"
#include "slf/types.h"

namespace slf {

inline constexpr std::uint64_t kDefaultSceneMemory = std::uint64_t{2} << 30;
inline constexpr int kMostParts = 4096;

/// A coded transform across planes. Spec 7.11.
struct PlannedTransform {
  PlaneTransform coded;                 ///< `components` are not used
  std::vector<std::uint8_t> precision;  ///< [columns]
};

/// A run of cells of the base, with its points.
struct PlannedSlice {
  std::uint32_t cells = 0, points = 0;
};

/// What all parts share. Small, and the same for the same capture, settings and binary.
struct ScenePlan {
  GivenSettings settings;      ///< of the encoder, as they were given, with a step for all slices
  Metadata metadata;           ///< of the file: what the encoder records, then what the caller gave
  std::vector<int> cameras;    ///< ascending: those that no check left out; empty: a coloured cloud
  std::vector<int> reduction;  ///< [capture_cameras] log2: photographs are read so much smaller,
                               ///< where points need no more of them
  std::size_t capture_cameras = 0;  ///< how many the capture has
  Vec3 origin{};                    ///< Capture::origin
  UpAxis up = UpAxis::kPlusZ;
  Grid grid;                         ///< from the origin
  double spacing = 0;                ///< between points, world units
  std::string points_digest;         ///< SHA-256, hexadecimal, of all points on the grid
  std::string photographs_digest;    ///< of calibrations, and of sizes of the photographs' files
  std::uint64_t planning_bytes = 0;  ///< what putting them there takes
  int base_levels = 0;
  std::vector<PlannedSlice> slices;
  FitSettings fit;                 ///< nothing is left to choose in it
  std::vector<CameraTrust> trust;  ///< of the cameras that see the sample, ascending
  int gamma_min_q7 = -127, gamma_max_q7 = 127;
  std::vector<int> shift;  ///< [K]
  std::vector<PlannedTransform> transforms;

  /// Seconds of coding all slices in one process, about, as the sample took here; 0: not measured.
  /// Not written.
  double seconds = 0;
  ChosenStep step;  ///< where the step came from. Not written

  std::uint64_t points() const;
};

/// Where the work is done, and with what.
struct SceneWork {
  /// For points, depth maps and slices that are done; made where it is missing. Processes may share
  /// it. What is in it can be made again from the capture.
  std::filesystem::path directory;
  std::uint64_t memory = kDefaultSceneMemory;  ///< bytes
  bool resume = false;                         ///< slices that are done there are not coded again
  int threads = 0;
  std::function<void(const std::string&)> log = {};  ///< a line about what was done; may be empty
};

/// Part `index` of `count`, from 0: slices of about as many points.
struct ScenePart {
  int index = 0, count = 1;
};

/// What the work takes, before it is done.
struct SceneCost {
  std::uint64_t points = 0;
  std::size_t slices = 0, cameras = 0;
  std::uint64_t memory = 0;    ///< bytes that a slice takes at the most
  std::uint64_t planning = 0;  ///< bytes while points are put on the grid: by plan_scene, and by
                               ///< encode_part where has_points is false
  std::uint64_t disk = 0;      ///< bytes of the work directory
  double seconds = 0;          ///< ScenePlan::seconds
};

/// Chooses everything that slices must agree on: the grid, the slices, and from a sample of the
/// scene whose size does not grow with it, cameras, settings of the fit, light, transforms.
/// Writes the points into the work directory.
/// @param cameras  the input cameras; empty only where the capture has none
/// @errors those of voxelise, observe, choose_fit. kInvalidArgument: settings that need the whole
///         scene at once: targets, textures, Draco, mended geometry, a paper preset.
///         kLimitExceeded: a slice or the points do not fit into the memory; says what would do.
///         kUnreadable, kUnwritable.
Result<ScenePlan, InputError> plan_scene(const Capture& capture, std::span<const int> cameras,
                                         const GivenSettings& settings, const Metadata& metadata,
                                         const SceneWork& work, const Progress& progress = {});

/// As JSON. The same bytes for the same plan.
std::string write_plan(const ScenePlan& plan);
/// @errors kUnreadable; kInvalidInput: names the element
Result<ScenePlan, InputError> read_plan(const std::filesystem::path& file);

SceneCost cost_of(const ScenePlan& plan);

/// Are the points of the plan in the work directory? Else encode_part needs the capture's cloud.
bool has_points(const ScenePlan& plan, const SceneWork& work);

/// Codes the slices of a part: a partial stream of its own, which merge_parts joins.
/// @param capture  its cameras; its cloud only where has_points is false
/// @errors those of plan_scene; kInvalidInput: the capture is not the plan's
Result<std::vector<std::uint8_t>, InputError> encode_part(const Capture& capture,
                                                          const ScenePlan& plan,
                                                          const ScenePart& part,
                                                          const SceneWork& work,
                                                          const Progress& progress = {});

/// A part in memory, with the name that messages call it by.
struct PartStream {
  std::string name;
  std::vector<std::uint8_t> bytes;
};

struct MergedScene {
  std::vector<std::uint8_t> stream;
  std::vector<std::size_t> missing;  ///< slices
};

/// Joins parts without coding slices again.
/// @param allow_missing  else missing slices are an error; with it the stream is partial
/// @errors kInvalidInput: names the parts that are of different plans or have a slice in common,
///         and the slices that are missing; the part that is damaged. kLimitExceeded: max_memory
/// @param limits  max_memory: of the units of all parts together, 512 bytes each and their payloads
Result<MergedScene, InputError> merge_parts(std::span<const PartStream> parts, bool allow_missing,
                                            int threads = 0,
                                            const DecodeLimits& limits = DecodeLimits::none());

}  // namespace slf
