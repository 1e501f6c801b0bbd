#include "codec/slice_decoder.h"

#include <algorithm>

#include "attributes/normal_model.h"
#include "attributes/raht_inverse.h"
#include "codec/sequence.h"
#include "codec/slice_digest.h"
#include "entropy/range_decoder.h"
#include "geometry/draco_decoder.h"
#include "geometry/morton.h"
#include "geometry/octree_decoder.h"

namespace slf {

std::uint32_t range_end(const std::vector<std::uint32_t>& coded_ends, std::uint32_t range,
                        std::uint32_t grid_bits) {
  return range < coded_ends.size() ? coded_ends[range] : grid_bits;
}

int slice_level(std::uint32_t end, std::uint32_t grid_bits, std::uint32_t slice_depth) {
  const std::uint32_t above = grid_bits - slice_depth;  // levels above the slice's cube
  return end > above ? static_cast<int>(end - above) : 0;
}

Result<std::vector<std::uint64_t>> SliceDecoder::decode_octree(const SequencePlan& plan,
                                                               int& depth) {
  const auto is_geometry = [](const SliceUnit& u) { return u.type == UnitType::kGeometry; };
  if (std::none_of(units.begin(), units.end(), is_geometry)) {
    partial = true;
    return std::vector<std::uint64_t>{};
  }
  OctreeDecoder octree(static_cast<int>(header.slice_depth),
                       std::uint64_t{header.slice_num_points_minus1} + 1);
  std::uint32_t range = 0;
  for (const SliceUnit& unit : units) {
    if (unit.type != UnitType::kGeometry) continue;
    if (unit.header.range != range || range > plan.set.sps_num_geometry_ranges_minus1)
      return Error{Errc::kOutOfRange, "level_range", unit.offset * 8};
    const int known = static_cast<int>(plan.set.grid_bits() - header.slice_depth) + octree.level();
    if (!plan.needs_points() && known >= plan.levels) break;
    const std::uint32_t end =
        range_end(plan.set.sps_geometry_range_end, range, plan.set.grid_bits());
    SLF_CHECK(
        octree.decode(unit.payload, slice_level(end, plan.set.grid_bits(), header.slice_depth)));
    ++range;
  }
  depth = octree.level();
  if (range <= plan.set.sps_num_geometry_ranges_minus1 && plan.needs_points()) partial = true;
  return octree.morton();
}

Result<std::vector<std::uint64_t>> SliceDecoder::decode_draco_unit() {
  std::vector<std::uint64_t> codes;
  const auto unit = std::find_if(units.begin(), units.end(),
                                 [](const SliceUnit& u) { return u.type == UnitType::kGeometry; });
  partial = unit == units.end();
  if (partial) return codes;
  if (unit->header.range != 0) return Error{Errc::kOutOfRange, "level_range", unit->offset * 8};
  SLF_TRY(const auto voxels, decode_draco(unit->payload, static_cast<int>(header.slice_depth),
                                          std::uint64_t{header.slice_num_points_minus1} + 1));
  for (const Voxel& v : voxels) codes.push_back(morton(v));
  std::sort(codes.begin(), codes.end());
  if (std::adjacent_find(codes.begin(), codes.end()) != codes.end())
    return Error{Errc::kOutOfRange, "gu_draco", unit->offset * 8};
  return codes;
}

Result<Done> SliceDecoder::decode_geometry(const SequencePlan& plan) {
  int depth = static_cast<int>(header.slice_depth);
  SLF_TRY(auto codes,
          plan.set.sps_geometry_coder == 0 ? decode_octree(plan, depth) : decode_draco_unit());
  const bool all = !partial && depth == static_cast<int>(header.slice_depth);
  if (all && codes.size() != std::size_t{header.slice_num_points_minus1} + 1)
    return Error{Errc::kOutOfRange, "slice_num_points_minus1", 0};
  keep(std::move(codes), depth, plan);
  return Done{};
}

/// Cuts the points to plan.levels and puts them on that grid. Where the geometry is incomplete,
/// cells of the deepest level known stand for their points, which are in the middle of them.
void SliceDecoder::keep(std::vector<std::uint64_t> codes, int depth, const SequencePlan& plan) {
  if (codes.empty()) return;
  const int bits = static_cast<int>(plan.set.grid_bits());
  const int dropped = bits - plan.levels;                            // grid levels below those kept
  const int unknown = static_cast<int>(header.slice_depth) - depth;  // slice levels not decoded
  const bool values = !partial && (plan.planes() > 0 || plan.set.sps_normal_bits > 0);
  if (values) {
    RahtTop top = build_raht_top(codes, 3 * dropped);
    tree_ = std::move(top.tree);
    first_ = std::move(top.first);
  }
  const auto place = [&](std::uint64_t code) {
    const Voxel cell = from_morton(code);
    Voxel v;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int32_t middle = unknown > 0 ? 1 << (unknown - 1) : 0;
      const auto corner = static_cast<std::int32_t>(header.slice_cell[axis] << header.slice_depth);
      v[axis] = (corner + (cell[axis] << unknown) + middle) >> dropped;
    }
    return v;
  };
  if (!values) {
    positions.reserve(unknown == 0 && dropped == 0 ? codes.size() : 0);
    for (const std::uint64_t code : codes)
      if (const Voxel v = place(code); positions.empty() || v != positions.back())
        positions.push_back(v);
    return;
  }
  positions.reserve(tree_.size());
  for (std::size_t row = 0; row < tree_.size(); ++row)
    positions.push_back(place(codes[first_[row]]));
  codes_ = std::move(codes);
}

namespace {

/// All levels of a coefficient unit are below those kept: it is not even opened.
bool unit_begins_below(const SliceUnitHeader& unit, const SequencePlan& plan) {
  return unit.range > 0 && range_end(plan.set.sps_coefficient_range_end, unit.range - 1,
                                     plan.set.grid_bits()) >= static_cast<unsigned>(plan.levels);
}

}  // namespace

/// cu_prediction to the levels of the slice; what is said of levels above its cube has no meaning.
void SliceDecoder::set_modes(const SliceUnitHeader& unit, std::uint32_t end_level,
                             std::uint32_t grid_bits, std::vector<std::uint8_t>& modes) const {
  const std::size_t above = grid_bits - header.slice_depth, count = unit.cu_prediction.size();
  for (std::size_t i = 0; i < count; ++i)
    if (const std::size_t level = end_level - count + i; level >= above)
      modes[level - above] = static_cast<std::uint8_t>(unit.cu_prediction[i]);
}

/// Spec 8.7.4, 8.7.6, 8.8.
Result<Done> SliceDecoder::reconstruct(const SequencePlan& plan, const GroupModes& modes,
                                       std::size_t used, const CoefficientRows& rows,
                                       int threads) const {
  const std::span<std::int32_t> components = rows.values;
  const auto is_predicted = [](const auto& levels) {
    return std::any_of(levels.begin(), levels.end(), [](auto mode) { return mode != 0; });
  };
  if (std::none_of(modes.begin(), modes.end(), is_predicted))
    return raht_inverse(tree_, plan.steps, components, threads, rows.nonzero, used);
  std::vector<std::size_t> group(plan.coded.size());
  for (std::size_t g = 0; g < plan.groups.size(); ++g)
    for (const std::uint16_t place : plan.groups[g]) group[place] = g;
  std::vector<PredictedPlanes> planes;
  for (std::size_t r = 0; r < group.size(); ++r) {
    if (r == 0 || group[r] != group[r - 1]) planes.push_back({3 * r, 3 * r, modes[group[r]]});
    planes.back().end = 3 * r + 3;
  }
  TransformLevels levels(codes_, static_cast<int>(header.slice_depth),
                         static_cast<int>(plan.set.grid_bits()) - plan.levels);
  return raht_inverse_predicted(tree_, levels, planes, plan.steps, components, threads,
                                rows.nonzero, used);
}

Result<Done> SliceDecoder::decode_components(const SequencePlan& plan,
                                             std::span<std::int32_t> components, int threads) {
  const std::size_t planes = plan.planes();
  if (planes == 0) return Done{};
  const SequenceParameterSet& set = plan.set;
  if (set.has_texture()) return decode_texture_units(plan, components, threads);
  const std::uint32_t ranges = set.sps_num_coefficient_ranges_minus1 + 1;
  const std::uint32_t groups = set.num_groups();
  std::uint32_t expected = 0;  // units come by range, then group
  if (tree_.size() > 0) {
    CoefficientModels models(plan.groups, tree_, codes_, first_, set.sps_coefficient_coder == 0);
    std::vector<std::uint8_t> nonzero(tree_.size(), 0), of_unit(tree_.size());
    std::vector<bool> any(plan.groups.size(), false);  // coefficient of a group is not zero
    GroupModes modes(plan.groups.size(), std::vector<std::uint8_t>(header.slice_depth, 0));
    for (const SliceUnit& unit : units) {
      if (unit.type != UnitType::kCoefficients) continue;
      if (unit.header.range * groups + unit.header.group != expected ||
          unit.header.group >= groups || unit.header.range >= ranges)
        return Error{Errc::kOutOfRange, "plane_group", unit.offset * 8};
      ++expected;
      if (unit.header.group >= plan.groups.size() || unit_begins_below(unit.header, plan)) continue;
      // Level l of the slice is joined by splits 3 (depth - 1 - l) .. + 2.
      const auto order_at = [&](std::uint32_t grid_level) {
        const int level = slice_level(grid_level, set.grid_bits(), header.slice_depth);
        return order_end(tree_, 3 * (static_cast<int>(header.slice_depth) - level));
      };
      const std::size_t begin = unit.header.range == 0
                                    ? 0
                                    : order_at(range_end(set.sps_coefficient_range_end,
                                                         unit.header.range - 1, set.grid_bits()));
      const std::uint32_t end_level =
          range_end(set.sps_coefficient_range_end, unit.header.range, set.grid_bits());
      const bool cut = static_cast<int>(end_level) > plan.levels;
      set_modes(unit.header, end_level, set.grid_bits(), modes[unit.header.group]);
      std::fill(of_unit.begin(), of_unit.end(), std::uint8_t{0});
      SLF_CHECK(decode_coefficients(unit.payload, models, {tree_, components, planes, of_unit},
                                    unit.header.group, begin, order_at(end_level), cut));
      for (std::size_t row = 0; row < nonzero.size(); ++row) nonzero[row] |= of_unit[row];
      if (std::find(of_unit.begin(), of_unit.end(), 1) != of_unit.end())
        any[unit.header.group] = true;
    }
    std::size_t used = 0;  // planes up to the last that is not all zero
    for (std::size_t g = 0; g < any.size(); ++g)
      if (any[g]) {
        used = std::max(used, std::size_t{3} * plan.groups[g].back() + 3);
      } else {
        modes[g].clear();  // nothing to predict
      }
    if (used > 0)
      SLF_CHECK(reconstruct(plan, modes, used, {tree_, components, planes, nonzero}, threads));
    if (plan.kept_levels_only())
      for (std::size_t row = 0; row + 1 < first_.size(); ++row)
        to_node_means(components.subspan(row * planes, used), first_[row + 1] - first_[row]);
  }
  partial = partial || expected < ranges * groups;
  return Done{};
}

Result<Done> SliceDecoder::decode_normals(const SequencePlan& plan,
                                          std::span<std::array<std::uint16_t, 2>> normals) {
  const auto unit = std::find_if(units.begin(), units.end(),
                                 [](const SliceUnit& u) { return u.type == UnitType::kNormals; });
  if (unit == units.end() || tree_.size() == 0) {
    partial = true;
    return Done{};
  }
  RangeDecoder decoder(unit->payload);
  NormalModel model(static_cast<int>(plan.set.sps_normal_bits));
  for (std::size_t i = 0, kept = 0; i < first_.back(); ++i) {
    std::array<std::uint16_t, 2> normal{};
    if (decoder.exhausted()) break;
    if (!model.code(decoder, normal))
      return Error{Errc::kOutOfRange, "nu_magnitude", unit->offset * 8};
    if (i == first_[kept])
      normals[kept++] = normal;  // a coarser node has the normal of its first point
  }
  return decoder.finish("nu_normals");
}

Result<Done> SliceDecoder::check_digest(
    std::span<const std::int32_t> components,
    std::span<const std::array<std::uint16_t, 2>> normals) const {
  for (const SliceUnit& unit : units) {
    if (unit.type != UnitType::kDigest) continue;
    const auto digest = slice_digest(positions, components, normals);
    if (unit.payload.size() != digest.size())
      return Error{Errc::kOutOfRange, "digest_sha256", unit.offset * 8};
    if (!std::equal(digest.begin(), digest.end(), unit.payload.begin()))
      return Error{Errc::kChecksum, "digest_sha256", unit.offset * 8};
  }
  return Done{};
}

}  // namespace slf
