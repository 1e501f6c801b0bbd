// SPDX-License-Identifier: Apache-2.0
// What was asked of a stream, as far as it has it. Spec 8.9.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "attributes/coefficient_models.h"
#include "attributes/plane_transform.h"
#include "bitstream/index.h"
#include "codec/decoder/decode_progress.h"
#include "codec/frame_state.h"
#include "codec/scene_units.h"
#include "slf/decoder.h"
#include "slf/types.h"

namespace slf {

/// What all frames of a group have in common.
struct GroupRequest {
  PlaneGroups groups = {};                ///< those to decode: places of their components
  std::vector<std::uint16_t> coded = {};  ///< [R] functions that components stand in
  std::vector<PlaneTransform> transforms = {};
  std::vector<std::uint32_t> steps = {};  ///< [3 R]
  bool groups_missing = false;            ///< some are that were asked for
  bool all_groups = true;                 ///< none is left out because means do not need it
};

struct Request : GroupRequest {
  explicit Request(const StreamHeader& of) : stream(of) {}

  const StreamHeader& stream;
  int levels = 0;                                 ///< octree levels to keep, 1 .. grid_bits
  int layers = 1;                                 ///< of coefficients to decode, at most
  std::uint64_t most_values = ~std::uint64_t{0};  ///< of components that are given out
  bool whole = true;     ///< no levels, groups or layers are left out: digests are checked
  bool missing = false;  ///< some are that would be part of what was asked for
  std::optional<VoxelBox> region = {};        ///< of the whole grid
  const FrameReference* reference = nullptr;  ///< of a frame that is predicted
  FrameState* kept = nullptr;                 ///< receives what the next may be predicted from
  std::shared_ptr<DecodeProgress> watch = nullptr;  ///< where the caller wants to know

  /// What was asked for is in the base alone: no unit of a slice is opened.
  bool base_alone() const { return levels <= stream.base_levels(); }
  bool kept_levels_only() const { return levels < stream.grid_bits(); }
  int dropped_levels() const { return stream.grid_bits() - levels; }
  std::size_t planes() const { return 3 * coded.size(); }
  /// Weights, normals and frames predicted from this one need all points, whatever levels are kept.
  bool needs_points() const {
    return !kept_levels_only() || kept != nullptr || planes() > 0 ||
           (stream.set.sps_normal_bits > 0 && !base_alone());
  }
  /// Does the next frame need all levels of this one? Spec 8.12.7.
  bool keeps_all_levels() const { return kept != nullptr && stream.set.has_moved_points(); }
  /// Are means kept of all levels of units that are decoded? Spec 8.12.6.
  bool keeps_whole_units() const {
    return keeps_all_levels() || (kept != nullptr && stream.set.has_reference_contexts());
  }
  /// Is the unit needed? Never a digest, which is of the whole.
  bool wants(const UnitSlot& slot) const;
  /// Does a box of nodes at `level`, ends included, meet the region?
  bool meets_region(const Voxel& low, const Voxel& high, int level) const;
  /// Does a voxel of the kept levels stand for one in the region?
  bool in_region(const Voxel& voxel) const { return meets_region(voxel, voxel, levels); }
  /// A unit of so many bytes is about to be decoded.
  /// @errors kCancelled
  Result<Done> begin_unit(std::uint64_t bytes) const {
    return watch ? watch->begin_unit(bytes) : Result<Done>(Done{});
  }
};

/// Components that a stream of so many bytes may give; kNone: any number.
std::uint64_t most_values(const DecodeLimits& limits, std::uint64_t bytes);

/// @param scene  kept by reference: what it is asked of
/// @errors kInvalidArgument: levels or groups beyond what the stream has; those of the transforms.
/// @param group  of a predicted frame, which has no transforms of its own
Result<Request> request_of(const Units& units, const SceneUnits& scene,
                           const DecodeOptions& options, const GroupRequest* group = nullptr);

/// The loop over the layout: step(unit, place) for the units of an owner that are there, wanted and
/// of these types, in the order of their slots.
/// @errors kCancelled; those of step
template <class Step>
Result<Done> for_each_wanted(const PartUnits& units, Owner owner, const Request& request,
                             bool (*of_type)(UnitType), const Step& step) {
  const auto slots = request.stream.slots(owner);
  for (std::size_t place = 0; place < units.size(); ++place)
    if (of_type(slots[place].type) && request.wants(slots[place])) {
      SLF_CHECK(request.begin_unit(units[place].payload.size()));
      SLF_CHECK(step(units[place], place));
    }
  return Done{};
}
constexpr bool has_occupancy(UnitType type) { return type == UnitType::kGeometry; }
constexpr bool has_normals(UnitType type) { return type == UnitType::kNormals; }

/// Payload bytes of the units that are wanted; values: of coefficients and refinements alone.
std::uint64_t bytes_wanted(const SceneUnits& scene, const Request& request, bool values);

/// [slices] Is it opened? Those that meet the region are, and the one they start from; all where
/// another frame is predicted from this.
/// @param meets  of a slice
template <class Meets>
std::vector<std::uint8_t> choose_slices(const Request& request, const Meets& meets) {
  const SliceTable& table = request.stream.table;
  std::vector<std::uint8_t> chosen(table.slices.size(), true);
  if (request.kept != nullptr) return chosen;
  for (std::size_t s = 0; request.region && s < chosen.size(); ++s)
    chosen[s] = (s == 0 && table.shared()) || meets(s);
  return chosen;
}

/// By their boxes in an index, which may keep more than their cells do. boxes: [slices], or none
std::vector<std::uint8_t> choose_slices_by_box(const Request& request,
                                               const std::vector<CellBox>& boxes);

/// Is a unit wanted, and its slice opened?
bool wants_unit(const Request& request, const std::vector<std::uint8_t>& chosen, UnitType type,
                const SliceUnitHeader& ids);

/// What the sequence says of a stream with what was asked for in it.
/// @param chosen   [slices]
/// @param present  [slices] Has it a geometry unit? Where a chosen one has none, its cells stand
///                 for it (8.9.2), which sps_cut_slices_flag would forbid: all cells do then.
SequenceParameterSet cut_sequence(const Request& request, const std::vector<std::uint8_t>& chosen,
                                  const std::vector<std::uint8_t>& present);

/// The header of what comes out, without points.
LightField empty_field(const Request& request);

}  // namespace slf
