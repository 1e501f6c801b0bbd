#include "codec/sequence_plan.h"

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
  SequencePlan plan{set, table, {}, {}, {}, {}, 0, 1, true, false, options.region};
  if (!units.units.empty())
    plan.stream_bytes = units.units.back().offset + units.units.back().bytes;
  plan.complete = units.complete && !set.sps_cut_flag;
  plan.levels = static_cast<int>(least(set.grid_bits(), options.levels, set.sps_cut_levels));
  plan.layers = static_cast<int>(least(set.num_layers(), options.layers, set.sps_cut_layers));
  PlaneGroups groups = plane_groups(set);
  SLF_TRY(plan.transforms, collect_transforms(units, groups));  // 7.11
  const std::size_t asked = least(groups.size(), options.groups, set.sps_cut_groups);
  const std::size_t kept =
      options.means_only ? std::min(asked, groups_of_means(groups, plan.transforms)) : asked;
  SLF_CHECK(read_matrices(units, set, groups, kept, plan.transforms));
  groups.resize(kept);
  CodedFunctions coded = code_functions(std::move(groups), plan.transforms);  // 8.7.1
  plan.groups = std::move(coded.groups);
  plan.coded = std::move(coded.functions);
  if (plan.planes() > options.limits.max_planes)
    return of_sequence(Errc::kLimitExceeded, "sps_num_functions");
  plan.missing = plan.kept_levels_only() || asked < set.num_groups() ||
                 plan.layers < static_cast<int>(set.num_layers());
  plan.whole = !plan.missing && kept == asked;
  const auto steps = function_steps(set);
  for (const std::uint16_t k : plan.coded)
    plan.steps.insert(plan.steps.end(), steps[k].begin(), steps[k].end());
  return plan;
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
