// The decoder's main path. Spec clause 8; steps and names are mirrored in codec/pack.cpp.
#include "slf/decoder.h"

#include <algorithm>
#include <optional>

#include "bitstream/huge_pages.h"
#include "bitstream/index.h"
#include "codec/sequence.h"
#include "codec/slice_units.h"
#include "codec/stopwatch.h"
#include "codec/transform_units.h"
#include "slf/parallel.h"

namespace slf {
namespace {

Result<SequencePlan> plan_sequence(const Units& units, const SequenceParameterSet& set,
                                   const DecodeOptions& options) {
  SequencePlan plan{set, {}, {}, {}, {}, static_cast<int>(set.grid_bits()), true};
  if (options.levels < 0 || options.levels > plan.levels)
    return Error{Errc::kInvalidArgument, "levels", 0};
  if (options.groups < 0 || options.groups > static_cast<int>(set.num_groups()))
    return Error{Errc::kInvalidArgument, "groups", 0};
  if (options.levels > 0) plan.levels = options.levels;
  PlaneGroups groups = plane_groups(set);
  SLF_TRY(plan.transforms, collect_transforms(units, set, groups));  // 7.11
  if (options.groups > 0) groups.resize(static_cast<std::size_t>(options.groups));
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

/// The sum of what the slices say they hold, checked before any of it is decoded.
Result<Done> check_limits(const std::vector<SliceDecoder>& slices, const SequencePlan& plan,
                          const DecodeLimits& limits) {
  std::uint64_t points = 0;
  for (const SliceDecoder& slice : slices)
    points += std::uint64_t{slice.header.slice_num_points_minus1} + 1;
  const std::uint64_t bytes_per_point = sizeof(Voxel) + plan.planes() * sizeof(std::int32_t) + 4;
  if (points > limits.max_points) return Error{Errc::kLimitExceeded, "slice_num_points_minus1", 0};
  if (points > limits.max_output_bytes / bytes_per_point)
    return Error{Errc::kLimitExceeded, "sps_num_functions", 0};
  return Done{};
}

/// Runs step(i) for every slice, on several threads where there are several slices; the error of
/// the first slice in stream order that has one.
template <class Step>
Result<Done> for_each_slice(std::size_t count, int threads, Step step) {
  std::vector<std::optional<Error>> errors(count);
  parallel_ranges(count, 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (auto done = step(i); !done) errors[i] = done.error();
  });
  for (const auto& error : errors)
    if (error) return *error;
  return Done{};
}

/// Occupancy of every slice to positions and transform trees.
Result<Done> decode_geometry(std::vector<SliceDecoder>& slices, const SequencePlan& plan,
                             int threads) {
  return for_each_slice(slices.size(), threads,
                        [&](std::size_t i) { return slices[i].decode_geometry(plan); });
}

/// Cells coarser than a slice's cube may belong to several slices: the first has it.
void drop_repeated_cells(std::vector<SliceDecoder>& slices) {
  const Voxel* last = nullptr;
  for (SliceDecoder& slice : slices) {
    if (slice.positions.empty()) continue;
    if (last != nullptr && slice.positions.front() == *last) {
      slice.drop();
    } else {
      last = &slice.positions.back();
    }
  }
}

/// The header and the points of all slices; components and normals are zero.
LightField gather_points(const std::vector<SliceDecoder>& slices, const SequencePlan& plan) {
  LightField field;
  field.header = header_of(plan.set);
  field.header.grid = coarser_grid(field.header.grid, plan.levels);
  if (plan.coded.size() != plan.set.sps_num_functions) field.header.coded = plan.coded;
  for (const PlaneTransform& transform : plan.transforms)
    if (!transform.components.empty()) field.header.transforms.push_back(transform);
  for (const SliceDecoder& slice : slices)
    field.positions.insert(field.positions.end(), slice.positions.begin(), slice.positions.end());
  assign_zeros(field.components, field.num_points() * plan.planes());
  field.normals.bits = static_cast<int>(plan.set.sps_normal_bits);
  field.normals.octahedral.assign(field.normals.bits > 0 ? field.num_points() : 0, {});
  return field;
}

/// Components and normals of every slice into its part of `field`, and the digests over them.
Result<Done> decode_values(std::vector<SliceDecoder>& slices, const SequencePlan& plan, int threads,
                           LightField& field) {
  std::vector<std::size_t> first{0};
  for (const SliceDecoder& slice : slices) first.push_back(first.back() + slice.positions.size());
  const int plane_threads = slices.size() > 1 ? 1 : threads;
  return for_each_slice(slices.size(), threads, [&](std::size_t i) -> Result<Done> {
    const std::size_t points = first[i + 1] - first[i], planes = plan.planes();
    const auto components = std::span(field.components).subspan(first[i] * planes, points * planes);
    std::span<std::array<std::uint16_t, 2>> normals;
    SLF_CHECK(slices[i].decode_components(plan, components, plane_threads));
    if (field.normals.bits > 0) {
      normals = std::span(field.normals.octahedral).subspan(first[i], points);
      SLF_CHECK(slices[i].decode_normals(plan, normals));
    }
    if (slices[i].partial || !plan.whole) return Done{};
    return slices[i].check_digest(components, normals);
  });
}

bool is_partial(const Units& units, const SequencePlan& plan,
                const std::vector<SliceDecoder>& slices) {
  return !units.complete || !plan.whole ||
         std::any_of(slices.begin(), slices.end(), [](const auto& slice) { return slice.partial; });
}

}  // namespace

Result<LightField> decode(std::span<const std::uint8_t> stream, const DecodeOptions& options) {
  if (stream.size() > options.limits.max_stream_bytes)
    return Error{Errc::kLimitExceeded, "stream", 0};
  SLF_TRY(const Units units, split_units(stream, options.max_bytes));    // 7.1
  SLF_TRY(const SequenceParameterSet set, find_sequence(units));         // 7.2
  SLF_CHECK(check_index(units));                                         // 7.7
  SLF_TRY(auto slices, collect_slices(units, set));                      // 7.3
  SLF_TRY(const SequencePlan plan, plan_sequence(units, set, options));  // 8.2
  SLF_CHECK(check_limits(slices, plan, options.limits));                 // 9
  Stopwatch watch;
  DecodeSeconds seconds;
  SLF_CHECK(decode_geometry(slices, plan, options.threads));  // 8.4 - 8.6
  drop_repeated_cells(slices);                                // 8.9
  LightField field = gather_points(slices, plan);             // 6.1, 6.2
  seconds.geometry = watch.lap();
  SLF_CHECK(decode_values(slices, plan, options.threads, field));  // 8.7 - 8.10, 7.9
  field.partial = is_partial(units, plan, slices);                 // 8.9
  seconds.coefficients = watch.lap();
  if (options.seconds != nullptr) *options.seconds = seconds;
  return field;
}

}  // namespace slf
