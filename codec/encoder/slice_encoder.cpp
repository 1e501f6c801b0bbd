// SPDX-License-Identifier: Apache-2.0
#include "codec/encoder/slice_encoder.h"

#include <algorithm>
#include <new>
#include <numeric>
#include <optional>

#include "attributes/encoder/raht_forward.h"
#include "attributes/normal_model.h"
#include "attributes/quantiser.h"
#include "codec/encoder/component_encoder.h"
#include "codec/slice_digest.h"
#include "codec/unit_reference.h"
#include "entropy/range_encoder.h"
#include "geometry/encoder/draco_encoder.h"
#include "geometry/encoder/octree_encoder.h"

namespace slf {
namespace {

using Body = std::vector<std::uint8_t>;

/// Slice 0 is without its states only where memory ran out.
template <class States>
const States& known(const States* states) {
  if (states == nullptr) throw std::bad_alloc();
  return *states;
}

/// sqrt of the weight of all times the largest component is what the mean of all could reach. Spec
/// 8.8.2.
bool fits_transform(const SliceInput& input, const SceneLayout& layout) {
  std::int64_t largest = 0;
  for (const std::int32_t value : input.components)
    largest = std::max(largest, std::abs(std::int64_t{value}));
  std::uint64_t weight = input.morton.size();
  if (layout.base_levels > 0)
    weight = std::max<std::uint64_t>(weight, layout.weights().of(0, layout.cells.size()));
  const auto root = static_cast<std::int64_t>(isqrt(weight)) + 1;
  return largest < kCoefficientLimit && largest * root < kCoefficientLimit;
}

Body encode_octree_unit(const SliceToEncode& slice, std::size_t place, OctreeEncoder& octree) {
  if (slice.follows()) octree.start_from(known(slice.lead->geometry.wait(place)));
  if (const FrameReference* reference = slice.coding.reference)
    octree.start_from(*reference->state.octree[place]);
  Body body =
      octree.encode(static_cast<int>(slice.coding.set.geometry_end(slice.slots[place].range)));
  if (slice.leads()) slice.lead->geometry.publish(place, octree.states());
  return body;
}

Result<Body, InputError> encode_draco_unit(const SliceInput& input) {
  auto body = encode_draco({input.positions.begin(), input.positions.end()});
  if (body) return *std::move(body);
  return InputError{Errc::kUnsupported,
                    "geometry coder draco: Draco failed, or is not part of this build"};
}

Body encode_normals(const SliceToEncode& slice) {
  RangeEncoder encoder;
  NormalModel model(static_cast<int>(slice.coding.set.sps_normal_bits));
  for (auto normal : slice.input.normals) model.code(encoder, normal);
  return encoder.finish();
}

Quantised quantise(const SliceToEncode& slice, const SliceTree& tree, const EncodedBase* base,
                   int threads) {
  const SceneLayout& layout = slice.layout;
  QuantisedBase cells{tree.cells, layout.base_levels, layout.weights(), {}, nullptr};
  if (base != nullptr) {
    cells.coefficients = base->coefficients;
    cells.quantised = &base->quantised;
  }
  QuantiserInput rows = slice.coding.quantiser_input(tree.tree, slice.input.morton);
  std::optional<ReferenceMeans> means;
  if (const FrameReference* reference = slice.coding.reference) {
    means.emplace(reference->means());
    rows.reference = &*means;
  }
  if (layout.base_levels > 0) rows.base = &cells;
  return quantise_coefficients(rows, slice.input.components, threads);
}

Result<CodedUnits, InputError> encode_coefficients(const SliceToEncode& slice,
                                                   const SliceTree& tree, const EncodedBase* base,
                                                   const Quantised& quantised) {
  const SequenceParameterSet& set = slice.coding.set;
  CoefficientModels models(slice.coding.groups, tree.tree, slice.input.morton, tree.first,
                           set.has_vectors(), {}, set.num_layers());
  if (base != nullptr) {
    if (!base->models.empty()) models.adopt(base->models.front(), tree.cells);
    models.start_from_all(base->states);
  }
  ComponentEncoder encoder(slice.coding, tree.tree, slice.layout.base_levels, quantised,
                           slice.input.components, models);
  const UnitReference there(slice.coding.reference, set,
                            {tree.tree, slice.input.morton, tree.first, slice.coding.grid_bits()},
                            slice.coding.steps);
  CodedUnits units;
  for (std::size_t place = 0; place < slice.slots.size(); ++place) {
    const UnitSlot& slot = slice.slots[place];
    if (!has_values(slot.type)) continue;
    SliceUnitHeader ids = ids_of(slot, slice.slice_id());
    ids.cu_prediction = encoder.modes_of(ids);
    there.before_unit(ids, models);
    if (slice.follows())
      models.start_from(slot.group, known(slice.lead->coefficients.wait(place)), slot.layer);
    if (const FrameReference* reference = slice.coding.reference)
      models.start_from(slot.group, *reference->state.coefficients[place], slot.layer);
    SLF_TRY(CodedUnit unit, encoder.encode(ids_of(slot, slice.slice_id())));
    units.push_back(std::move(unit));
    if (slice.leads())
      slice.lead->coefficients.publish(place, models.states(slot.group, slot.layer));
  }
  return units;
}

/// @param components  as a decoder gets them
Result<Done, InputError> add_digest(const SliceToEncode& slice,
                                    std::span<const std::int32_t> components, CodedUnits& units) {
  if (!slice.coding.digest) return Done{};
  const auto digest = slice_digest(slice.input.positions, components, slice.input.normals);
  SLF_TRY(CodedUnit unit, part_unit(UnitType::kDigest, ids_of(slice.slots.back(), slice.slice_id()),
                                    digest, slice.coding.set));
  units.push_back(std::move(unit));
  return Done{};
}

}  // namespace

Result<CodedUnits, InputError> encode_slice_geometry(const SliceToEncode& slice,
                                                     const EncodedBase* base) {
  const SequenceParameterSet& set = slice.coding.set;
  OctreeEncoder octree(
      slice.input.morton, slice.coding.grid_bits(),
      base != nullptr ? base->geometry : OccupancyStates(slice.input.morton.size()),
      slice.layout.base_levels);
  if (slice.coding.reference != nullptr) octree.predict_from(slice.coding.reference->moved);
  CodedUnits units;
  for (std::size_t place = 0; place < slice.slots.size(); ++place) {
    const UnitSlot& slot = slice.slots[place];
    Body body;
    if (slot.type == UnitType::kNormals) {
      body = encode_normals(slice);
    } else if (slot.type != UnitType::kGeometry) {
      break;
    } else if (set.has_draco()) {
      SLF_TRY(body, encode_draco_unit(slice.input));
    } else {
      body = encode_octree_unit(slice, place, octree);
    }
    SLF_TRY(CodedUnit unit, part_unit(slot.type, ids_of(slot, slice.slice_id()), body, set));
    units.push_back(std::move(unit));
  }
  return units;
}

Result<SliceTree, InputError> transform_slice(const SliceToEncode& slice,
                                              std::span<std::int32_t> base_input, int threads) {
  const std::size_t planes = slice.coding.planes();
  const SceneLayout& layout = slice.layout;
  SliceTree transform;
  if (planes == 0 || slice.coding.set.has_texture()) return transform;
  if (!fits_transform(slice.input, layout))
    return InputError{
        Errc::kInvalidArgument,
        "components: the largest, times the root of the number of points, reaches 2^27"};
  transform.tree = build_raht_tree(slice.input.morton);
  transform.first.resize(transform.tree.size() + 1);
  std::iota(transform.first.begin(), transform.first.end(), 0u);
  if (layout.base_levels > 0)
    transform.cells = find_cells(transform.tree, transform.first,
                                 3 * (slice.coding.grid_bits() - layout.base_levels),
                                 layout.cuts[slice.slice - layout.first_slice].first_cell);
  raht_forward(transform.tree, static_cast<int>(planes), slice.input.components, threads,
               transform.cells.size());
  if (layout.base_levels > 0)
    put_into_base(transform.cells, slice.input.components, layout.weights(), planes, base_input);
  return transform;
}

Result<CodedUnits, InputError> encode_slice_values(const SliceToEncode& slice, SliceTree tree,
                                                   const EncodedBase* base, int threads) {
  CodedUnits units;
  if (slice.coding.set.has_texture()) {
    SLF_TRY(units, encode_slice_texture(slice, threads));
  }
  if (slice.coding.planes() == 0 || slice.coding.set.has_texture()) {
    SLF_CHECK(add_digest(slice, slice.input.components, units));
    return units;
  }
  const Quantised quantised = quantise(slice, tree, base, threads);
  SLF_TRY(units, encode_coefficients(slice, tree, base, quantised));
  SLF_CHECK(add_digest(slice, quantised.values, units));
  return units;
}

}  // namespace slf
