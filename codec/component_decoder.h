// Coefficient units of the base or of a slice to components. Spec 8.6 - 8.9.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "attributes/coefficient_decoder.h"
#include "attributes/raht_tree.h"
#include "attributes/slice_cells.h"
#include "codec/scene_units.h"
#include "codec/sequence_plan.h"

namespace slf {

/// What slices start from when the base is decoded.
struct BaseComponents {
  std::vector<CoefficientModels> models;  ///< one, or none: no unit was decoded
  std::vector<CoefficientStates> states;  ///< [layers][groups]
  std::vector<std::int32_t> values;       ///< [cells][planes] mean * sqrt(its weight); the mean
                                          ///< where slices are apart
  std::vector<std::uint8_t> any;          ///< [groups] not all of its values are zero
  const PartUnit* last = nullptr;         ///< unit that was decoded last
};

/// The rows whose components are decoded: nodes of the kept levels.
struct ComponentRows {
  std::span<const std::uint64_t> codes;  ///< of all points (base: cells), in the grid's frame
  const RahtTree& tree;
  std::span<const std::uint32_t> first;  ///< [rows + 1] first code of each
  int start = 0;                         ///< level where coding starts: 0, or that of the cells
  int levels = 0;                        ///< of the rows
  CodeWeights weights{};                 ///< of the codes
};

class ComponentDecoder {
 public:
  ComponentDecoder(const SequencePlan& plan, const ComponentRows& rows);

  /// A slice, after the base. first_cell: the slice's among those of the scene, which weigh
  /// `weights`.
  void start_from_base(const BaseComponents& base, const CodeWeights& weights,
                       std::size_t first_cell, std::span<std::int32_t> components);
  /// A slice apart, of which the base tells the cells alone.
  void start_apart();
  /// Entropy decoding of a unit. components: [rows][planes], coefficients after.
  Result<Done> decode(const PartUnit& unit, std::span<std::int32_t> components);
  /// All units are decoded, and nothing else is going to start from them: leaves memory to what
  /// follows.
  void drop_models() { models_.drop(); }
  /// Dequantisation and inverse transform, when all units are decoded. An error is of the last.
  Result<Done> reconstruct(std::span<std::int32_t> components, int threads);
  /// The mean of each node, of what reconstruct() left.
  void to_means(std::span<std::int32_t> components) const;
  /// What the rows of `finer`, which has these and more, have in common with these.
  void take_rows(const ComponentDecoder& finer, std::span<const std::int32_t> from,
                 std::span<std::int32_t> to);

  /// Of the layer of a group that a unit is of.
  CoefficientStates states(const SliceUnitHeader& unit) {
    return models_.states(unit.group, unit.layer);
  }
  void start_from(const SliceUnitHeader& unit, const CoefficientStates& states) {
    models_.start_from(unit.group, states, unit.layer);
  }
  /// Leaves nothing here.
  BaseComponents take_base(std::vector<std::int32_t> values);

 private:
  std::size_t order_at(std::uint32_t level) const {
    return slf::order_at(rows_.tree, plan_.grid_bits(), level);
  }
  void set_modes(const PartUnit& unit);
  bool misses_layers() const;
  Result<Done> dequantise(std::span<std::int32_t> components) const;
  Result<Done> transform_back(std::span<std::int32_t> components, int threads);
  Result<Done> undo(std::span<const std::uint32_t> steps, std::span<std::int32_t> components,
                    std::size_t used, int threads);
  std::size_t used_planes();

  const SequencePlan& plan_;
  ComponentRows rows_;
  CoefficientModels models_;
  SliceCells cells_;                                // of a slice with a base; else empty
  std::vector<std::uint8_t> nonzero_, of_unit_;     // [rows]
  std::vector<std::uint8_t> any_;                   // [groups] a value or coefficient is not zero
  std::vector<std::vector<std::uint8_t>> modes_;    // [groups][levels from start] cu_prediction
  std::vector<std::vector<std::uint32_t>> layers_;  // [groups][coefficient ranges] decoded so far
  const PartUnit* last_ = nullptr;                  // decoded, here or in the base
};

}  // namespace slf
