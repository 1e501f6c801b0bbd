// SPDX-License-Identifier: Apache-2.0
#include "codec/decoder/request.h"

#include <algorithm>
#include <span>

#include "codec/sequence.h"
#include "codec/transform_units.h"

namespace slf {
namespace {

Result<Done> check_options(const SequenceParameterSet& set, const DecodeOptions& options) {
  if (options.levels < 0 || options.levels > static_cast<int>(set.grid_bits()))
    return Error{Errc::kInvalidArgument, "levels"};
  if (options.groups < 0 || options.groups > static_cast<int>(set.num_groups()))
    return Error{Errc::kInvalidArgument, "groups"};
  if (options.layers < 0 || options.layers > static_cast<int>(set.num_layers()))
    return Error{Errc::kInvalidArgument, "layers"};
  return Done{};
}

/// The smaller of what was asked for and what a cut left, each 0 where there is no limit.
std::size_t least(std::size_t all, int asked, std::uint32_t left) {
  if (asked > 0) all = std::min(all, static_cast<std::size_t>(asked));
  return left > 0 ? std::min(all, std::size_t{left}) : all;
}

/// Groups up to the last with a part in function 0, which alone has a mean.
std::size_t groups_of_means(const PlaneGroups& groups, std::span<const PlaneTransform> transforms) {
  std::size_t end = 0;
  while (end < groups.size() && groups[end++].front() != 0) {
  }
  for (const PlaneTransform& t : transforms)
    if (t.first_group < end && end < t.first_group + t.num_groups)
      end = t.first_group + t.num_groups;
  return end;
}

/// Groups, and what stands in them.
Result<Done> choose_groups(const Units& units, const DecodeOptions& options, Request& request) {
  const SequenceParameterSet& set = request.stream.set;
  PlaneGroups groups = plane_groups(set);
  SLF_TRY(request.transforms, collect_transforms(units, groups));  // 7.11
  const std::size_t asked = least(groups.size(), options.groups, set.sps_cut_groups);
  const std::size_t kept =
      options.means_only ? std::min(asked, groups_of_means(groups, request.transforms)) : asked;
  SLF_CHECK(read_matrices(units, set, groups, kept, request.transforms));
  groups.resize(kept);
  CodedFunctions coded = code_functions(std::move(groups), request.transforms);  // 8.7.1
  request.groups = std::move(coded.groups);
  request.coded = std::move(coded.functions);
  const auto steps = function_steps(set);
  for (const std::uint16_t k : request.coded)
    request.steps.insert(request.steps.end(), steps[k].begin(), steps[k].end());
  request.groups_missing = asked < set.num_groups();
  request.all_groups = kept == asked;
  return Done{};
}

}  // namespace

std::uint64_t most_values(const DecodeLimits& limits, std::uint64_t bytes) {
  const std::uint64_t each = limits.max_values_per_byte;
  if (each >= DecodeLimits::kNone >> 32) return DecodeLimits::kNone;
  return DecodeLimits::kFreeValues + each * bytes;
}

bool Request::wants(const UnitSlot& slot) const {
  const auto most = static_cast<std::uint32_t>(keeps_all_levels() ? stream.grid_bits() : levels);
  if (slot.owner == Owner::kSlice && base_alone()) return false;
  if (slot.type == UnitType::kGeometry)
    return needs_points() || kept != nullptr || stream.set.geometry_begin(slot.range) < most;
  if (has_values(slot.type))
    return slot.group < groups.size() && stream.set.coefficient_begin(slot.range) < most &&
           slot.layer < static_cast<std::uint32_t>(layers);
  return slot.type == UnitType::kNormals;
}

bool Request::meets_region(const Voxel& low, const Voxel& high, int level) const {
  if (!region) return true;
  const int below = stream.grid_bits() - level;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t first = std::int64_t{low[axis]} << below;
    const std::int64_t last = ((std::int64_t{high[axis]} + 1) << below) - 1;
    if (last < region->low[axis] || first > region->high[axis]) return false;
  }
  return true;
}

Result<Request> request_of(const Units& units, const SceneUnits& scene,
                           const DecodeOptions& options, const GroupRequest* group) {
  const SequenceParameterSet& set = scene.stream.set;
  SLF_CHECK(check_options(set, options));
  Request request(scene.stream);
  request.region = options.region;
  request.most_values = most_values(options.limits, scene.stream.bytes);
  request.levels = static_cast<int>(least(set.grid_bits(), options.levels, set.sps_cut_levels));
  request.layers = static_cast<int>(least(set.num_layers(), options.layers, set.sps_cut_layers));
  if (group == nullptr) {
    SLF_CHECK(choose_groups(units, options, request));
  } else {
    static_cast<GroupRequest&>(request) = *group;
  }
  if (request.planes() > options.limits.max_planes)
    return of_sequence(Errc::kLimitExceeded, "sps_num_functions");
  request.missing = request.groups_missing || request.kept_levels_only() ||
                    request.layers < static_cast<int>(set.num_layers());
  request.whole = !request.missing && request.all_groups;
  if (options.progress)
    request.watch =
        std::make_shared<DecodeProgress>(options.progress, bytes_wanted(scene, request, false));
  return request;
}

std::uint64_t bytes_wanted(const SceneUnits& scene, const Request& request, bool values) {
  std::uint64_t bytes = 0;
  const auto add = [&](const PartUnits& units, std::span<const UnitSlot> slots) {
    for (std::size_t place = 0; place < units.size(); ++place)
      if (request.wants(slots[place]) && (!values || has_values(slots[place].type)))
        bytes += units[place].payload.size();
  };
  add(scene.base, scene.stream.slots(Owner::kBase));
  for (const PartUnits& slice : scene.slices) add(slice, scene.stream.slots(Owner::kSlice));
  return bytes;
}

std::vector<std::uint8_t> choose_slices_by_box(const Request& request,
                                               const std::vector<CellBox>& boxes) {
  const auto corner = [&](std::size_t s, std::size_t at) {
    const auto* box = boxes[s].data() + at;
    return Voxel{static_cast<std::int32_t>(box[0]), static_cast<std::int32_t>(box[1]),
                 static_cast<std::int32_t>(box[2])};
  };
  return choose_slices(request, [&](std::size_t s) {
    return boxes.size() != request.stream.table.slices.size() ||
           request.meets_region(corner(s, 0), corner(s, 3), request.stream.base_levels());
  });
}

bool wants_unit(const Request& request, const std::vector<std::uint8_t>& chosen, UnitType type,
                const SliceUnitHeader& ids) {
  if (!request.wants(slot_of(type, ids))) return false;
  return ids.of_base() || (ids.slice_id < chosen.size() && chosen[ids.slice_id]);
}

SequenceParameterSet cut_sequence(const Request& request, const std::vector<std::uint8_t>& chosen,
                                  const std::vector<std::uint8_t>& present) {
  SequenceParameterSet set = request.stream.set;
  const bool all_groups = request.groups.size() == set.num_groups(),
             all_layers = request.layers == static_cast<int>(set.num_layers());
  bool left_out = false, cells_stand_for_some = false;
  for (std::size_t s = 0; s < chosen.size(); ++s) {
    left_out = left_out || !chosen[s];
    cells_stand_for_some = cells_stand_for_some || (chosen[s] && !present[s]);
  }
  set.sps_cut_flag = 1;
  set.sps_cut_levels = static_cast<std::uint32_t>(request.levels);
  set.sps_cut_groups = all_groups ? 0 : static_cast<std::uint32_t>(request.groups.size());
  set.sps_cut_layers = all_layers ? 0 : static_cast<std::uint32_t>(request.layers);
  set.sps_cut_slices_flag =
      set.sps_cut_slices_flag || (left_out && (!cells_stand_for_some || request.base_alone()));
  return set;
}

LightField empty_field(const Request& request) {
  const SequenceParameterSet& set = request.stream.set;
  LightField field;
  field.header = header_of(set);
  make_coarser(field.header, request.levels);
  if (request.coded.size() != set.sps_num_functions) field.header.coded = request.coded;
  for (const PlaneTransform& transform : request.transforms)
    if (!transform.components.empty()) field.header.transforms.push_back(transform);
  field.normals.bits = static_cast<int>(set.sps_normal_bits);
  return field;
}

}  // namespace slf
