// One slice, from its units to integers. Spec 8.2.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "attributes/raht_tree.h"
#include "codec/base_decoder.h"
#include "codec/scene_units.h"
#include "codec/sequence_plan.h"
#include "codec/slice_lead.h"
#include "slf/types.h"

namespace slf {

/// A slice on its way. Steps are called in the order of the members below; normals may come before
/// components.
class SliceDecoder {
 public:
  /// @param lead  of slices that share states, else nullptr
  SliceDecoder(const SequencePlan& plan, const Base& base, const PartUnits& units,
               std::size_t slice, SliceLead* lead);

  /// Occupancy to `positions` (on the grid of plan.levels bits) and the transform tree.
  /// states: what the first unit starts from, unless slice 0 has left some for it.
  Result<Done> decode_geometry(OccupancyStates states);
  /// Coefficients to components [positions][3 R]; the span is zero on entry.
  Result<Done> decode_components(std::span<std::int32_t> components, int threads);
  Result<Done> decode_normals(std::span<std::array<std::uint16_t, 2>> normals);
  Result<Done> check_digest(std::span<const std::int32_t> components,
                            std::span<const std::array<std::uint16_t, 2>> normals);
  /// Of slices apart: what the base has of every cell to what stands in it. Spec 8.8.3.
  void add_means(std::span<std::int32_t> components) const;

  /// Leaves nothing of the slice's points.
  void drop();

  std::size_t points() const { return plan_->table.slices[slice_].points(); }

  std::vector<Voxel> positions;
  bool partial = false;                      ///< units were missing
  std::uint64_t offset = ~std::uint64_t{0};  ///< of the unit that was begun last, in the stream

 private:
  bool leads() const { return lead_ != nullptr && slice_ == 0; }
  bool follows() const { return lead_ != nullptr && slice_ != 0; }
  bool apart() const { return plan_->has_base() && plan_->table.apart(); }
  std::span<const std::uint64_t> cells() const;
  Result<Done> decode_octree(OccupancyStates states);
  Result<Done> decode_draco_unit();
  Result<Done> check_count() const;
  void keep();
  void start(ComponentDecoder& decoder, std::span<std::int32_t> components) const;
  Result<Done> decode_units(ComponentDecoder& decoder, std::span<std::int32_t> components);
  Result<Done> decode_ahead(ComponentDecoder& decoder, std::span<std::int32_t> components,
                            int levels);
  int levels_ahead() const;
  Result<Done> read_normals(std::span<const std::uint8_t> payload,
                            std::span<std::array<std::uint16_t, 2>> normals) const;
  Result<Done> decode_part(std::span<std::int32_t> components, int threads);
  Result<Done> interpolate_nodes(std::span<std::int32_t> components, int threads);
  /// Spec 8.11. In slice_texture_decoder.cpp.
  Result<Done> decode_texture_units(std::span<std::int32_t> components, int threads);

  const SequencePlan* plan_;
  const Base* base_;
  const PartUnits* units_;
  std::size_t slice_;
  SliceLead* lead_;
  int level_ = 0;                     // that is known
  std::vector<std::uint64_t> codes_;  // of the nodes at that level
  RahtTop top_;                       // of the kept rows; empty where the geometry is incomplete
};

}  // namespace slf
