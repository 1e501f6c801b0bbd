// SPDX-License-Identifier: Apache-2.0
// A plan with all that follows from it: what every step of a part works on.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "attributes/encoder/forward_transform.h"
#include "codec/encoder/coded_unit.h"
#include "encoder/parts/region.h"
#include "slf/scene.h"

namespace slf {

struct PlannedScene {
  explicit PlannedScene(const ScenePlan& of) : plan(of) {}

  const ScenePlan& plan;
  EncoderSettings settings;
  std::filesystem::path directory;  ///< of depth maps and slices: a plan has its own
  SceneCells cells;
  SequenceParameterSet set;
  std::vector<ForwardTransform> transforms;
  std::vector<std::uint16_t> coded;  ///< [R] functions that components stand in
  std::vector<CodedUnit> head;       ///< transforms and slices, as a stream begins with them
  std::unique_ptr<SliceCoding> coding;

  /// [cells of slice] of the scene.
  std::vector<std::size_t> cells_of(std::size_t slice) const;
};

/// Version of the JSON.
inline constexpr int kPlanVersion = 4;

/// Points of the sample that a plan is made on, about, with what is around them.
inline constexpr std::size_t kPlanSample = 24000;

/// Points of a slice where the settings do not say: what a default encode fits into 2 GiB with.
inline constexpr std::uint32_t kScenePoints = 1u << 16;

/// Points of other cells that a fit sees beside those of its own, in spacings.
inline constexpr double kAround = 8;

/// Points that a slice sees, of its own; about.
inline constexpr double kWithAround = 1.4;

/// The settings of a plan, and whether a scene can be coded in parts with them.
/// @errors kInvalidArgument
Result<EncoderSettings, InputError> scene_settings(const GivenSettings& given, bool cameras,
                                                   int threads);

/// Cells and slices, with a base whose cells are not smaller than what slices see around them.
/// @param codes  of all points
/// @errors those of lay_out; kInvalidInput: too few points
Result<Done, InputError> lay_out_scene(std::span<const std::uint64_t> codes, double spacing,
                                       const EncoderSettings& settings, SceneCells& cells);

/// Voxels of kAround, at most the side of a cell.
int voxels_around(const SceneCells& scene, double spacing);

/// A field of one point of nothing, with the header of the scene's.
LightField scene_header(const ScenePlan& plan, const EncoderSettings& settings);

/// SHA-256 of the plan as JSON.
std::array<std::uint8_t, 32> digest_of(const ScenePlan& plan);

/// Whether there is memory for a slice, or for all points on their way to the grid.
/// @errors kLimitExceeded: says what would do
Result<Done, InputError> check_memory(const ScenePlan& plan, const SceneWork& work);
Result<Done, InputError> check_planning(const ScenePlan& plan, const SceneWork& work);

/// @errors kUnreadable: the points are not in the directory; kInvalidInput: others are, or the
///         plan's numbers do not go together; kUnwritable
Result<std::unique_ptr<PlannedScene>, InputError> open_scene(const ScenePlan& plan,
                                                             const SceneWork& work);

}  // namespace slf
