#include "codec/slice_encoder.h"

#include <algorithm>
#include <new>
#include <numeric>

#include "attributes/normal_model.h"
#include "attributes/quantiser.h"
#include "attributes/raht_forward.h"
#include "base/release.h"
#include "codec/component_encoder.h"
#include "codec/slice_digest.h"
#include "codec/slice_texture_encoder.h"
#include "entropy/range_encoder.h"
#include "geometry/draco_encoder.h"
#include "geometry/octree_encoder.h"

namespace slf {
namespace {

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

}  // namespace

SliceEncoder::SliceEncoder(const SliceCoding& coding, const SceneLayout& layout, std::size_t slice,
                           const SliceInput& input, SliceLead* lead)
    : coding_(&coding), layout_(&layout), slice_(slice), input_(input), lead_(lead) {}

void SliceEncoder::add(UnitType type, std::uint32_t range, std::uint32_t group,
                       std::span<const std::uint8_t> body) {
  SliceUnitHeader header{slice_id(), range, group, 0, {}};
  units_.push_back(type == UnitType::kCoefficients
                       ? coefficient_unit(std::move(header), {body.begin(), body.end()}, *coding_)
                       : part_unit(type, std::move(header), body, coding_->set));
}

void SliceEncoder::encode_octree(OccupancyStates states) {
  const SequenceParameterSet& set = coding_->set;
  OctreeEncoder octree(input_.morton, coding_->grid_bits(), std::move(states),
                       layout_->base_levels);
  for (std::uint32_t r = set.base_geometry_ranges(); r < set.geometry_ranges(); ++r) {
    const std::size_t place = units_.size();
    if (follows()) octree.start_from(known(lead_->geometry.wait(place)));
    add(UnitType::kGeometry, r, 0, octree.encode(static_cast<int>(set.geometry_end(r))));
    if (leads()) lead_->geometry.publish(place, octree.states());
  }
}

Result<Done, InputError> SliceEncoder::encode_geometry(const EncodedBase* base) {
  if (!coding_->set.has_draco()) {
    encode_octree(base != nullptr ? base->geometry : OccupancyStates(input_.morton.size()));
    return Done{};
  }
  auto draco = encode_draco({input_.positions.begin(), input_.positions.end()});
  if (!draco)
    return InputError{Errc::kUnsupported,
                      "geometry coder draco: Draco failed, or is not part of this build"};
  add(UnitType::kGeometry, 0, 0, *draco);
  return Done{};
}

void SliceEncoder::encode_normals() {
  if (coding_->set.sps_normal_bits == 0) return;
  RangeEncoder encoder;
  NormalModel model(static_cast<int>(coding_->set.sps_normal_bits));
  for (auto normal : input_.normals) model.code(encoder, normal);
  add(UnitType::kNormals, 0, 0, encoder.finish());
}

Result<Done, InputError> SliceEncoder::transform(std::span<std::int32_t> base_input, int threads) {
  const std::size_t planes = coding_->planes();
  if (planes == 0 || coding_->set.has_texture()) return Done{};
  if (!fits_transform(input_, *layout_))
    return InputError{
        Errc::kInvalidArgument,
        "components: the largest, times the root of the number of points, reaches 2^27"};
  tree_ = build_raht_tree(input_.morton);
  first_.resize(tree_.size() + 1);
  std::iota(first_.begin(), first_.end(), 0u);
  if (layout_->base_levels > 0)
    cells_ = find_cells(tree_, first_, 3 * (coding_->grid_bits() - layout_->base_levels),
                        layout_->cuts[slice_ - layout_->first_slice].first_cell);
  raht_forward(tree_, static_cast<int>(planes), input_.components, threads, cells_.size());
  if (layout_->base_levels > 0)
    put_into_base(cells_, input_.components, layout_->weights(), planes, base_input);
  return Done{};
}

Result<Done, InputError> SliceEncoder::encode_texture(int threads) {
  SLF_TRY(const auto payloads, encode_slice_texture(input_, *coding_, threads));
  for (std::uint32_t g = 0; g < payloads.size(); ++g)
    add(UnitType::kCoefficients, 0, g, payloads[g]);
  return Done{};
}

void SliceEncoder::encode_coefficients(const EncodedBase* base, const Quantised& quantised) {
  const SequenceParameterSet& set = coding_->set;
  CoefficientModels models(coding_->groups, tree_, input_.morton, first_, set.has_vectors(), {},
                           set.num_layers());
  if (base != nullptr) {
    if (!base->models.empty()) models.adopt(base->models.front(), cells_);
    models.start_from_all(base->states);
  }
  ComponentEncoder encoder(*coding_, tree_, layout_->base_levels, quantised, input_.components,
                           models);
  for (const SliceUnitHeader& ids : component_units(*coding_, slice_id())) {
    const std::size_t place = units_.size();
    if (follows()) models.start_from(ids.group, known(lead_->coefficients.wait(place)), ids.layer);
    units_.push_back(encoder.encode(ids));
    if (leads()) lead_->coefficients.publish(place, models.states(ids.group, ids.layer));
  }
}

Quantised SliceEncoder::quantise(const EncodedBase* base, int threads) {
  QuantisedBase cells{cells_, layout_->base_levels, layout_->weights(), {}, nullptr};
  if (base != nullptr) {
    cells.coefficients = base->coefficients;
    cells.quantised = &base->quantised;
  }
  return quantise_coefficients({tree_,
                                input_.morton,
                                coding_->grid_bits(),
                                coding_->groups,
                                coding_->steps,
                                coding_->set.sps_prediction_flag != 0,
                                coding_->rdo,
                                0,
                                {},
                                layout_->base_levels > 0 ? &cells : nullptr},
                               input_.components, threads);
}

Result<Done, InputError> SliceEncoder::encode_components(const EncodedBase* base, int threads) {
  if (coding_->planes() == 0) return Done{};
  if (coding_->set.has_texture()) return encode_texture(threads);
  Quantised quantised = quantise(base, threads);
  encode_coefficients(base, quantised);
  decoded_ = std::move(quantised.values);
  tree_ = {};
  return Done{};
}

void SliceEncoder::encode_digest() {
  if (!coding_->digest) return;
  const auto digest =
      slice_digest(input_.positions,
                   decoded_.empty() ? std::span<const std::int32_t>(input_.components) : decoded_,
                   input_.normals);
  add(UnitType::kDigest, 0, 0, digest);
  release(decoded_);
}

}  // namespace slf
