#include "codec/slice_decoder.h"

#include <algorithm>

#include "attributes/normal_model.h"
#include "attributes/raht_inverse.h"
#include "base/release.h"
#include "codec/node_voxels.h"
#include "codec/slice_digest.h"
#include "entropy/range_decoder.h"
#include "geometry/draco_decoder.h"
#include "geometry/octree_decoder.h"

namespace slf {
namespace {

Voxel cell_at(const Voxel& voxel, int below) {
  return {voxel[0] >> below, voxel[1] >> below, voxel[2] >> below};
}

/// Slice 0 failed where this one would have gone on from it: its error is the one to report.
Error abandoned() { return {Errc::kTruncated, "slice_id"}; }

}  // namespace

SliceDecoder::SliceDecoder(const SequencePlan& plan, const Base& base, const PartUnits& units,
                           std::size_t slice, SliceLead* lead)
    : plan_(&plan), base_(&base), units_(&units), slice_(slice), lead_(lead) {}

std::span<const std::uint64_t> SliceDecoder::cells() const {
  return base_->cells_of(plan_->table, slice_);
}

Result<Done> SliceDecoder::decode_octree(OccupancyStates first_states) {
  const SequenceParameterSet& set = plan_->set;
  OctreeDecoder octree(plan_->grid_bits(), points(), std::move(first_states), plan_->base_levels(),
                       cells());
  for (std::size_t place = 0; place < units_->size(); ++place) {
    const PartUnit& unit = (*units_)[place];
    if (unit.type != UnitType::kGeometry) break;
    if (!plan_->needs_points() && octree.level() >= plan_->levels) break;
    offset = unit.offset;
    if (follows()) {
      const OccupancyStates* states = lead_->geometry.wait(place);
      if (states == nullptr) return abandoned();
      octree.start_from(*states);
    }
    SLF_CHECK(plan_->begin_unit(unit.payload.size()));
    const int end = static_cast<int>(set.geometry_end(unit.header.range));
    SLF_CHECK(in_unit(unit, octree.decode(unit.payload, end)));
    if (!leads()) continue;
    lead_->geometry.publish(place,
                            end < plan_->grid_bits() ? octree.states() : octree.take_states());
  }
  level_ = octree.level();
  partial = level_ < plan_->grid_bits() && (plan_->needs_points() || level_ < plan_->levels);
  codes_ = octree.take_morton();
  return Done{};
}

Result<Done> SliceDecoder::decode_draco_unit() {
  const PartUnit& unit = units_->front();
  offset = unit.offset;
  SLF_CHECK(plan_->begin_unit(unit.payload.size()));
  level_ = plan_->grid_bits();
  SLF_TRY(codes_, in_unit(unit, decode_draco(unit.payload, level_, points())));
  return Done{};
}

Result<Done> SliceDecoder::check_count() const {
  if (level_ == plan_->grid_bits() && codes_.size() != points())
    return of_unit(UnitType::kSlices, plan_->table.offset, Errc::kOutOfRange,
                   "slice_num_points_minus1");
  return Done{};
}

Result<Done> SliceDecoder::decode_geometry(OccupancyStates states) {
  partial = units_->empty();
  if (!partial && plan_->set.has_draco()) {
    SLF_CHECK(decode_draco_unit());
    SLF_CHECK(check_count());
  } else if (!partial) {
    SLF_CHECK(decode_octree(std::move(states)));
    SLF_CHECK(check_count());
  } else if (plan_->has_base() && plan_->set.sps_cut_slices_flag == 0) {
    level_ = plan_->base_levels();  // its cells stand for it
    codes_.assign(cells().begin(), cells().end());
  }
  if (!codes_.empty()) keep();
  return Done{};
}

/// Cuts the points to plan.levels and puts them on that grid. Where the geometry is incomplete,
/// nodes of the deepest level known stand for their points, which are in the middle of them.
void SliceDecoder::keep() {
  positions = node_voxels(codes_, level_, *plan_);
  const bool values = plan_->planes() > 0 || plan_->set.sps_normal_bits > 0;
  if (!partial && values) top_ = build_raht_top(codes_, plan_->lowest_split(plan_->levels));
  if (!values) release(codes_);
}

/// Of a slice whose geometry is incomplete: the nodes known stand for its points, without
/// coefficients. Between zeros there is nothing to interpolate. Spec 8.9.2.
Result<Done> SliceDecoder::interpolate_nodes(std::span<std::int32_t> components, int threads) {
  if (base_->components.values.empty() || apart()) return Done{};
  for (std::uint64_t& code : codes_) code <<= plan_->lowest_split(level_);
  const int levels = std::min(level_, plan_->levels);
  const RahtTop top = build_raht_top(codes_, plan_->lowest_split(levels));
  ComponentDecoder decoder(*plan_, {codes_, top.tree, top.first, plan_->base_levels(), levels});
  start(decoder, components);
  SLF_CHECK(decoder.reconstruct(components, threads));
  decoder.to_means(components);
  return Done{};
}

void SliceDecoder::start(ComponentDecoder& decoder, std::span<std::int32_t> components) const {
  if (!plan_->has_base()) return;
  if (apart()) return decoder.start_apart();
  decoder.start_from_base(base_->components, base_->weights(), base_->first[slice_], components);
}

/// The level of whose rows the units of slice 0 are decoded: others start from the states after a
/// whole unit, also where fewer levels are kept.
int SliceDecoder::levels_ahead() const {
  if (!leads()) return plan_->levels;
  std::uint32_t range = 0;
  while (static_cast<int>(plan_->set.coefficient_end(range)) < plan_->levels) ++range;
  return static_cast<int>(plan_->set.coefficient_end(range));
}

Result<Done> SliceDecoder::decode_units(ComponentDecoder& decoder,
                                        std::span<std::int32_t> components) {
  start(decoder, components);
  for (std::size_t place = 0; place < units_->size(); ++place) {
    const PartUnit& unit = (*units_)[place];
    if (!plan_->wants_values(unit.type, unit.header)) continue;
    offset = unit.offset;
    if (follows()) {
      const CoefficientStates* states = lead_->coefficients.wait(place);
      if (states == nullptr) return abandoned();
      decoder.start_from(unit.header, *states);
    }
    SLF_CHECK(plan_->begin_unit(unit.payload.size()));
    SLF_CHECK(decoder.decode(unit, components));
    if (leads()) lead_->coefficients.publish(place, decoder.states(unit.header));
  }
  return Done{};
}

/// Units whole, on rows of more levels than are kept; then those of the rows that are kept.
Result<Done> SliceDecoder::decode_ahead(ComponentDecoder& decoder,
                                        std::span<std::int32_t> components, int levels) {
  const RahtTop top = build_raht_top(codes_, plan_->lowest_split(levels));
  ComponentDecoder finer(*plan_, {codes_, top.tree, top.first, plan_->base_levels(), levels});
  std::vector<std::int32_t> all(top.tree.size() * plan_->planes());
  SLF_CHECK(decode_units(finer, all));
  decoder.take_rows(finer, all, components);
  return Done{};
}

Result<Done> SliceDecoder::decode_part(std::span<std::int32_t> components, int threads) {
  ComponentDecoder decoder(*plan_,
                           {codes_, top_.tree, top_.first, plan_->base_levels(), plan_->levels});
  const int levels = levels_ahead();
  SLF_CHECK(levels > plan_->levels ? decode_ahead(decoder, components, levels)
                                   : decode_units(decoder, components));
  decoder.drop_models();
  SLF_CHECK(decoder.reconstruct(components, threads));
  if (plan_->kept_levels_only()) decoder.to_means(components);
  return Done{};
}

Result<Done> SliceDecoder::decode_components(std::span<std::int32_t> components, int threads) {
  if (plan_->planes() == 0 || codes_.empty()) return Done{};
  if (!is_whole(slots_of(layout_of(plan_->set), Owner::kSlice), units_->size())) partial = true;
  if (top_.tree.size() == 0) return interpolate_nodes(components, threads);
  return plan_->set.has_texture() ? decode_texture_units(components, threads)
                                  : decode_part(components, threads);
}

Result<Done> SliceDecoder::decode_normals(std::span<std::array<std::uint16_t, 2>> normals) {
  const auto unit = std::find_if(units_->begin(), units_->end(),
                                 [](const PartUnit& u) { return u.type == UnitType::kNormals; });
  if (unit == units_->end() || top_.tree.size() == 0) {
    partial = true;
    return Done{};
  }
  offset = unit->offset;
  return in_unit(*unit, read_normals(unit->payload, normals));
}

Result<Done> SliceDecoder::read_normals(std::span<const std::uint8_t> payload,
                                        std::span<std::array<std::uint16_t, 2>> normals) const {
  RangeDecoder decoder(payload);
  NormalModel model(static_cast<int>(plan_->set.sps_normal_bits));
  for (std::size_t i = 0, kept = 0; i < top_.first.back(); ++i) {
    std::array<std::uint16_t, 2> normal{};
    if (decoder.exhausted()) break;
    if (!model.code(decoder, normal)) return decoder.here(Errc::kOutOfRange, "nu_magnitude");
    if (i == top_.first[kept])
      normals[kept++] = normal;  // a coarser node has the normal of its first point
  }
  return decoder.finish("nu_normals");
}

Result<Done> SliceDecoder::check_digest(std::span<const std::int32_t> components,
                                        std::span<const std::array<std::uint16_t, 2>> normals) {
  for (const PartUnit& unit : *units_) {
    if (unit.type != UnitType::kDigest || partial || !plan_->whole) continue;
    offset = unit.offset;
    const auto digest = slice_digest(positions, components, normals);
    if (unit.payload.size() != digest.size())
      return in_unit(unit, Error{Errc::kOutOfRange, "digest_sha256"});
    if (!std::equal(digest.begin(), digest.end(), unit.payload.begin()))
      return in_unit(unit, Error{Errc::kChecksum, "digest_sha256"});
  }
  return Done{};
}

void SliceDecoder::add_means(std::span<std::int32_t> components) const {
  if (!apart() || components.empty()) return;
  const std::size_t planes = plan_->planes();
  const int below = plan_->levels - plan_->base_levels();
  const std::int32_t* mean = base_->components.values.data() + base_->first[slice_] * planes;
  for (std::size_t row = 0; row < positions.size(); ++row) {
    if (row > 0 && cell_at(positions[row], below) != cell_at(positions[row - 1], below))
      mean += planes;
    for (std::size_t j = 0; j < planes; ++j) components[row * planes + j] += mean[j];  // 8.8.2
  }
}

void SliceDecoder::drop() {
  release(positions);
  release(codes_);
  top_ = {};
}

}  // namespace slf
