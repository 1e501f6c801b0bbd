// SPDX-License-Identifier: Apache-2.0
#include "codec/decoder/slice_decoder.h"

#include <algorithm>

#include "attributes/normal_model.h"
#include "codec/decoder/component_decoder.h"
#include "codec/decoder/node_voxels.h"
#include "codec/slice_digest.h"
#include "codec/unit_reference.h"
#include "entropy/range_decoder.h"
#include "geometry/draco_decoder.h"
#include "geometry/octree_decoder.h"

namespace slf {
namespace {

Voxel cell_at(const Voxel& voxel, int below) {
  return {voxel[0] >> below, voxel[1] >> below, voxel[2] >> below};
}

/// What slice 0 has left after the unit at a place.
/// @errors one that stands behind all others where it failed before: its own is the one to report
template <class States>
Result<const States*> wait_for(SharedStates<States>& shared, std::size_t place) {
  const States* states = shared.wait(place);
  if (states == nullptr) return Error{Errc::kTruncated, "slice_id", ~std::uint64_t{0}};
  return states;
}

Error reference_lacks() { return {Errc::kOutOfRange, "frame_predicted_flag"}; }

/// States after the unit at a place.
template <class States>
void keep(std::vector<std::optional<States>>& kept, std::size_t place, States states) {
  if (kept.size() <= place) kept.resize(place + 1);
  kept[place] = std::move(states);
}

Result<Done> decode_octree_unit(const SliceToDecode& slice, const PartUnit& unit, std::size_t place,
                                OctreeDecoder& octree) {
  auto& shared = slice.scene.lead.geometry;
  if (slice.follows()) {
    SLF_TRY(const OccupancyStates* states, wait_for(shared, place));
    octree.start_from(*states);
  }
  if (const FrameReference* reference = slice.request.reference) {
    const auto& states = reference->state.octree;
    if (place >= states.size() || !states[place]) return in_unit(unit, reference_lacks());
    octree.start_from(*states[place]);
  }
  const int end = static_cast<int>(slice.stream().set.geometry_end(unit.header.range));
  SLF_CHECK(in_unit(unit, octree.decode(unit.payload, end)));
  const bool last = end == slice.stream().grid_bits();
  if (slice.request.kept != nullptr)
    keep(slice.request.kept->octree, place,
         last && !slice.leads() ? octree.take_states() : octree.states());
  if (slice.leads()) shared.publish(place, last ? octree.take_states() : octree.states());
  return Done{};
}

Result<Done> decode_octree(const SliceToDecode& slice, OccupancyStates states,
                           SliceGeometry& geometry) {
  const StreamHeader& stream = slice.stream();
  OctreeDecoder octree(stream.grid_bits(), slice.points(), std::move(states), stream.base_levels(),
                       slice.cells());
  if (slice.request.reference != nullptr) octree.predict_from(slice.request.reference->moved);
  const auto step = [&](const PartUnit& unit, std::size_t place) {
    return decode_octree_unit(slice, unit, place, octree);
  };
  SLF_CHECK(for_each_wanted(slice.units, Owner::kSlice, slice.request, has_occupancy, step));
  geometry.level = octree.level();
  geometry.codes = octree.take_morton();
  if (FrameState* kept = slice.request.kept)
    kept->cells = ReferenceCells(geometry.codes, geometry.level);
  return Done{};
}

Result<Done> decode_draco_unit(const SliceToDecode& slice, SliceGeometry& geometry) {
  geometry.level = slice.stream().grid_bits();
  const auto step = [&](const PartUnit& unit, std::size_t) -> Result<Done> {
    SLF_TRY(geometry.codes,
            in_unit(unit, decode_draco(unit.payload, geometry.level, slice.points())));
    return Done{};
  };
  return for_each_wanted(slice.units, Owner::kSlice, slice.request, has_occupancy, step);
}

/// The deepest nodes that are known.
Result<Done> decode_nodes(const SliceToDecode& slice, OccupancyStates octree,
                          SliceGeometry& geometry) {
  const StreamHeader& stream = slice.stream();
  if (slice.units.empty()) {
    if (!stream.has_base() || stream.set.sps_cut_slices_flag) return Done{};
    geometry.level = stream.base_levels();  // its cells stand for it
    geometry.codes.assign(slice.cells().begin(), slice.cells().end());
    return Done{};
  }
  SLF_CHECK(stream.set.has_draco() ? decode_draco_unit(slice, geometry)
                                   : decode_octree(slice, std::move(octree), geometry));
  if (geometry.level == stream.grid_bits() && geometry.codes.size() != slice.points())
    return of_unit(UnitType::kSlices, stream.table.offset, Errc::kOutOfRange,
                   "slice_num_points_minus1");
  return Done{};
}

/// The level of whose rows the units of slice 0 are decoded: others start from the states after a
/// whole unit, also where fewer levels are kept.
int levels_ahead(const SliceToDecode& slice) {
  if (slice.request.keeps_all_levels()) return slice.stream().grid_bits();
  if (!slice.leads() && slice.request.kept == nullptr) return slice.request.levels;
  const SequenceParameterSet& set = slice.stream().set;
  std::uint32_t range = 0;
  while (static_cast<int>(set.coefficient_end(range)) < slice.request.levels) ++range;
  return static_cast<int>(set.coefficient_end(range));
}

/// Entropy decoding of all units. components: [rows][planes], coefficients after.
Result<CodedCoefficients> decode_coefficient_units(const SliceToDecode& slice,
                                                   const ComponentRows& rows,
                                                   std::span<std::int32_t> components) {
  auto& shared = slice.scene.lead.coefficients;
  ValueState state = start_values(slice, rows, components);
  const UnitReference there(slice.request.reference, slice.stream().set,
                            {rows.tree, rows.codes, rows.first, rows.levels}, slice.request.steps);
  const auto step = [&](const PartUnit& unit, std::size_t place) -> Result<Done> {
    const SliceUnitHeader& ids = unit.header;
    there.before_unit(ids, state.models);
    if (slice.follows()) {
      SLF_TRY(const CoefficientStates* states, wait_for(shared, place));
      state.models.start_from(ids.group, *states, ids.layer);
    }
    if (const FrameReference* reference = slice.request.reference) {
      const auto& states = reference->state.coefficients;
      if (place >= states.size() || !states[place]) return in_unit(unit, reference_lacks());
      state.models.start_from(ids.group, *states[place], ids.layer);
    }
    SLF_CHECK(decode_values_unit(unit, slice.request, rows, state, components));
    if (slice.leads()) shared.publish(place, state.models.states(ids.group, ids.layer));
    if (slice.request.kept != nullptr)
      keep(slice.request.kept->coefficients, place, state.models.states(ids.group, ids.layer));
    return Done{};
  };
  SLF_CHECK(for_each_wanted(slice.units, Owner::kSlice, slice.request, has_values, step));
  return std::move(state.coded);
}

/// The same of units that have more levels than are kept: slice 0 hands on its states after whole
/// units, so these are decoded on rows of all their levels.
Result<CodedCoefficients> decode_ahead(const SliceToDecode& slice, int levels,
                                       const ComponentRows& rows,
                                       std::span<std::int32_t> components, int threads) {
  const RahtTop top = build_raht_top(rows.codes, slice.stream().lowest_split(levels));
  const ComponentRows finer{rows.codes, top.tree, top.first, rows.start, levels};
  std::vector<std::int32_t> all(top.tree.size() * slice.request.planes());
  SLF_TRY(CodedCoefficients coded, decode_coefficient_units(slice, finer, all));
  CodedCoefficients kept = keep_rows(slice.request, finer, coded, all, rows, components);
  if (slice.request.keeps_whole_units())  // their means, for the next frame
    SLF_CHECK(reconstruct(slice.request, finer, std::move(coded), all, threads));
  return kept;
}

Result<Done> decode_vectors(const SliceToDecode& slice, const SliceGeometry& geometry,
                            std::span<std::int32_t> components, int threads) {
  const Request& request = slice.request;
  const ComponentRows rows{geometry.codes, geometry.top.tree, geometry.top.first,
                           request.stream.base_levels(), request.levels};
  const int levels = levels_ahead(slice);
  const bool ahead = levels > request.levels, twice = ahead && request.keeps_whole_units();
  if (request.kept != nullptr)
    request.kept->make_room(twice ? levels : request.levels, request.planes());
  SLF_TRY(CodedCoefficients coded, ahead ? decode_ahead(slice, levels, rows, components, threads)
                                         : decode_coefficient_units(slice, rows, components));
  SLF_CHECK(reconstruct(request, rows, std::move(coded), components, threads, !twice));
  if (request.kept_levels_only()) to_means(rows, request.planes(), components);
  return Done{};
}

/// Where geometry of a slice is missing, the nodes known stand for its points, without
/// coefficients. Between zeros there is nothing to interpolate. Spec 8.9.2.
Result<Done> interpolate_nodes(const SliceToDecode& slice, std::vector<std::uint64_t> codes,
                               int level, std::span<std::int32_t> components, int threads) {
  const Request& request = slice.request;
  const StreamHeader& stream = request.stream;
  if (slice.scene.base.values.values.empty() || stream.apart()) return Done{};
  for (std::uint64_t& code : codes) code <<= stream.lowest_split(level);
  const int levels = std::min(level, request.levels);
  const RahtTop top = build_raht_top(codes, stream.lowest_split(levels));
  const ComponentRows rows{codes, top.tree, top.first, stream.base_levels(), levels};
  ValueState state = start_values(slice, rows, components);
  SLF_CHECK(reconstruct(request, rows, std::move(state.coded), components, threads));
  to_means(rows, request.planes(), components);
  return Done{};
}

Result<Done> decode_slice_components(const SliceToDecode& slice, SliceGeometry geometry,
                                     std::span<std::int32_t> components, int threads) {
  if (slice.request.planes() == 0 || geometry.codes.empty()) return Done{};
  if (geometry.top.tree.size() == 0)
    return interpolate_nodes(slice, std::move(geometry.codes), geometry.level, components, threads);
  return slice.stream().set.has_texture()
             ? decode_slice_texture(slice, geometry, components, threads)
             : decode_vectors(slice, geometry, components, threads);
}

/// A coarser node has the normal of its first point.
/// @param first  [rows + 1] first point of each row
Result<Done> read_normals(std::span<const std::uint8_t> payload, int bits,
                          std::span<const std::uint32_t> first,
                          std::span<std::array<std::uint16_t, 2>> normals) {
  RangeDecoder decoder(payload);
  NormalModel model(bits);
  for (std::size_t i = 0, kept = 0; i < first.back(); ++i) {
    std::array<std::uint16_t, 2> normal{};
    if (decoder.exhausted()) break;
    if (!model.code(decoder, normal)) return decoder.here(Errc::kOutOfRange, "nu_magnitude");
    if (i == first[kept]) normals[kept++] = normal;
  }
  return decoder.finish("nu_normals");
}

Result<Done> decode_normals(const SliceToDecode& slice, const SliceGeometry& geometry,
                            std::span<std::array<std::uint16_t, 2>> normals) {
  if (geometry.top.tree.size() == 0) return Done{};
  const int bits = static_cast<int>(slice.stream().set.sps_normal_bits);
  const auto step = [&](const PartUnit& unit, std::size_t) {
    return in_unit(unit, read_normals(unit.payload, bits, geometry.top.first, normals));
  };
  return for_each_wanted(slice.units, Owner::kSlice, slice.request, has_normals, step);
}

/// It is the last of the slice's units: none is missing.
Result<Done> check_digest(const SliceToDecode& slice, const SliceOutput& output) {
  if (slice.units.empty() || !slice.request.whole) return Done{};
  const PartUnit& unit = slice.units.back();
  if (unit.type != UnitType::kDigest) return Done{};
  const auto digest = slice_digest(output.positions, output.components, output.normals);
  if (unit.payload.size() != digest.size())
    return in_unit(unit, Error{Errc::kOutOfRange, "digest_sha256"});
  if (!std::equal(digest.begin(), digest.end(), unit.payload.begin()))
    return in_unit(unit, Error{Errc::kChecksum, "digest_sha256"});
  return Done{};
}

/// Slices apart: adds what the base has of every cell to what stands in it. Spec 8.8.3.
void add_means(const SliceToDecode& slice, const SliceOutput& output) {
  const BaseState& base = slice.scene.base;
  if (!slice.stream().apart() || output.components.empty()) return;
  const std::size_t planes = slice.request.planes();
  const int below = slice.request.levels - slice.stream().base_levels();
  const std::int32_t* mean = base.values.values.data() + base.first[slice.slice] * planes;
  for (std::size_t row = 0; row < output.positions.size(); ++row) {
    if (row > 0 &&
        cell_at(output.positions[row], below) != cell_at(output.positions[row - 1], below))
      mean += planes;
    for (std::size_t j = 0; j < planes; ++j) output.components[row * planes + j] += mean[j];
  }
}

}  // namespace

Result<SliceGeometry> decode_slice_geometry(const SliceToDecode& slice, OccupancyStates octree) {
  const Request& request = slice.request;
  SliceGeometry geometry;
  SLF_CHECK(decode_nodes(slice, std::move(octree), geometry));
  if (geometry.codes.empty()) return geometry;
  geometry.positions = node_voxels(geometry.codes, geometry.level, request);
  if (request.planes() == 0 && request.stream.set.sps_normal_bits == 0)
    return SliceGeometry{std::move(geometry.positions)};
  if (geometry.level == request.stream.grid_bits())
    geometry.top = build_raht_top(geometry.codes, request.stream.lowest_split(request.levels));
  return geometry;
}

Result<Done> decode_slice_values(const SliceToDecode& slice, SliceGeometry geometry,
                                 const SliceOutput& output, int threads) {
  SLF_CHECK(decode_normals(slice, geometry, output.normals));
  SLF_CHECK(decode_slice_components(slice, std::move(geometry), output.components, threads));
  if (output.positions.empty()) return Done{};
  SLF_CHECK(check_digest(slice, output));
  add_means(slice, output);
  return Done{};
}

}  // namespace slf
