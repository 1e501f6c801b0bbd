#include "codec/sequence_plan.h"

#include <algorithm>

#include "codec/sequence.h"
#include "codec/transform_units.h"

namespace slf {
namespace {

Result<Done> check_options(const SequenceParameterSet& set, const DecodeOptions& options) {
  if (options.levels < 0 || options.levels > static_cast<int>(set.grid_bits()))
    return Error{Errc::kInvalidArgument, "levels", 0};
  if (options.groups < 0 || options.groups > static_cast<int>(set.num_groups()))
    return Error{Errc::kInvalidArgument, "groups", 0};
  return Done{};
}

/// The smaller of what was asked for and what a cut left, each 0 where there is no limit.
std::size_t least(std::size_t all, int asked, std::uint32_t left) {
  if (asked > 0) all = std::min(all, static_cast<std::size_t>(asked));
  return left > 0 ? std::min(all, std::size_t{left}) : all;
}

}  // namespace

bool SequencePlan::meets_region(const Voxel& node, int level) const {
  if (!region) return true;
  const int below = grid_bits() - level;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t low = std::int64_t{node[axis]} << below;
    const std::int64_t high = low + (std::int64_t{1} << below) - 1;
    if (high < region->low[axis] || low > region->high[axis]) return false;
  }
  return true;
}

Result<SequencePlan> plan_sequence(const Units& units, const SequenceParameterSet& set,
                                   const SliceTable& table, const DecodeOptions& options) {
  SLF_CHECK(check_options(set, options));
  SequencePlan plan{set, table, {}, {}, {}, {}, 0, true, options.region};
  plan.levels = static_cast<int>(least(set.grid_bits(), options.levels, set.sps_cut_levels));
  PlaneGroups groups = plane_groups(set);
  SLF_TRY(plan.transforms, collect_transforms(units, set, groups));  // 7.11
  groups.resize(least(groups.size(), options.groups, set.sps_cut_groups));
  CodedFunctions coded = code_functions(std::move(groups), plan.transforms);  // 8.7.1
  plan.groups = std::move(coded.groups);
  plan.coded = std::move(coded.functions);
  if (plan.planes() > options.limits.max_planes)
    return Error{Errc::kLimitExceeded, "sps_num_functions", 0};
  plan.whole = !plan.kept_levels_only() && plan.groups.size() == set.num_groups();
  const auto steps = function_steps(set);
  for (const std::uint16_t k : plan.coded)
    plan.steps.insert(plan.steps.end(), steps[k].begin(), steps[k].end());
  return plan;
}

Result<Done> check_limits(const SequencePlan& plan, const DecodeLimits& limits) {
  const std::uint64_t points = plan.base_alone() ? plan.table.num_cells() : plan.table.num_points();
  const std::uint64_t bytes_per_point = sizeof(Voxel) + plan.planes() * sizeof(std::int32_t) + 4;
  if (points > limits.max_points) return Error{Errc::kLimitExceeded, "slice_num_points_minus1", 0};
  if (points > limits.max_output_bytes / bytes_per_point)
    return Error{Errc::kLimitExceeded, "sps_num_functions", 0};
  return Done{};
}

LightField empty_field(const SequencePlan& plan) {
  LightField field;
  field.header = header_of(plan.set);
  make_coarser(field.header, plan.levels);
  if (plan.coded.size() != plan.set.sps_num_functions) field.header.coded = plan.coded;
  for (const PlaneTransform& transform : plan.transforms)
    if (!transform.components.empty()) field.header.transforms.push_back(transform);
  field.normals.bits = static_cast<int>(plan.set.sps_normal_bits);
  return field;
}

}  // namespace slf
