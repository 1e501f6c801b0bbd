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

/// Where a step failed first, in stream order, or the number of slices.
struct Failure {
  std::size_t slice;
  Result<Done> result;
};

/// Runs step(i) for every slice, on several threads where there are several slices.
template <class Step>
Failure for_each_slice(std::size_t count, int threads, Step step) {
  std::vector<std::optional<Error>> errors(count);
  parallel_ranges(count, 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (auto done = step(i); !done) errors[i] = done.error();
  });
  for (std::size_t i = 0; i < count; ++i)
    if (errors[i]) return {i, *errors[i]};
  return {count, Done{}};
}

/// Slices that are worked on at a time: what they need beside their output is let go of after.
struct Batch {
  std::span<SliceDecoder> slices;
  std::vector<std::size_t> first;  ///< [slices + 1] points of the light field
};

/// Cells coarser than a slice's cube may belong to several slices: the first has it.
void drop_repeated_cell(SliceDecoder& slice, const std::vector<Voxel>& positions) {
  if (!slice.positions.empty() && !positions.empty() && slice.positions.front() == positions.back())
    slice.drop();
}

/// Room for all points that the slices say there are, unless that is out of proportion.
void reserve_points(const std::vector<SliceDecoder>& slices, const SequencePlan& plan,
                    LightField& field) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 30;
  std::size_t points = 0;
  for (const SliceDecoder& slice : slices)
    points += std::size_t{slice.header.slice_num_points_minus1} + 1;
  if (slices.size() > 1)
    points = std::min(points, kMostBytes / (sizeof(std::int32_t) * (plan.planes() + 1)));
  field.positions.reserve(points);
  field.components.reserve(points * plan.planes());
  advise_huge_pages(field.components.data(), points * plan.planes() * sizeof(std::int32_t));
}

/// Points of a batch that is decoded so far, in order, with components and normals of zero.
Batch append_points(std::span<SliceDecoder> slices, const SequencePlan& plan, LightField& field) {
  Batch batch{slices, {field.num_points()}};
  for (SliceDecoder& slice : slices) {
    drop_repeated_cell(slice, field.positions);
    field.positions.insert(field.positions.end(), slice.positions.begin(), slice.positions.end());
    batch.first.push_back(field.num_points());
  }
  field.components.resize(field.num_points() * plan.planes());
  field.normals.octahedral.resize(field.normals.bits > 0 ? field.num_points() : 0);
  return batch;
}

/// Components and normals of every slice into its part of `field`, and the digests over them.
Result<Done> decode_values(const Batch& batch, const SequencePlan& plan, int threads,
                           LightField& field) {
  const int plane_threads = batch.slices.size() > 1 ? 1 : threads;
  const auto decode_slice = [&](std::size_t i) -> Result<Done> {
    SliceDecoder& slice = batch.slices[i];
    const std::size_t first = batch.first[i], points = batch.first[i + 1] - first,
                      planes = plan.planes();
    const auto components = std::span(field.components).subspan(first * planes, points * planes);
    std::span<std::array<std::uint16_t, 2>> normals;
    SLF_CHECK(slice.decode_components(plan, components, plane_threads));
    if (field.normals.bits > 0) {
      normals = std::span(field.normals.octahedral).subspan(first, points);
      SLF_CHECK(slice.decode_normals(plan, normals));
    }
    if (!slice.partial && plan.whole) SLF_CHECK(slice.check_digest(components, normals));
    slice.drop();
    return Done{};
  };
  return for_each_slice(batch.slices.size(), threads, decode_slice).result;
}

/// The slices after `begin` to work on at a time: one a thread, or more that are small, so that
/// threads which are done early have another. What a point needs beside its output is some 40
/// bytes.
std::size_t batch_size(const std::vector<SliceDecoder>& slices, std::size_t begin, int threads) {
  constexpr std::size_t kMostPoints = std::size_t{1} << 19;
  const auto least = static_cast<std::size_t>(thread_count(threads, slices.size() - begin));
  std::size_t count = 0, points = 0;
  for (; begin + count < slices.size(); ++count) {
    points += std::size_t{slices[begin + count].header.slice_num_points_minus1} + 1;
    if (count >= least && points > kMostPoints) break;
  }
  return count;
}

/// Slices batch by batch.
Result<Done> decode_slices(std::vector<SliceDecoder>& slices, const SequencePlan& plan, int threads,
                           DecodeSeconds& seconds, LightField& field) {
  Stopwatch watch;
  for (std::size_t begin = 0, count = 0; begin < slices.size(); begin += count) {
    count = batch_size(slices, begin, threads);
    const auto some = std::span(slices).subspan(begin, count);
    const Failure geometry = for_each_slice(some.size(), threads, [&](std::size_t i) {
      return some[i].decode_geometry(plan);  // 8.4 - 8.6
    });
    if (begin == 0 && geometry.slice > 0 && !some[0].partial && !plan.kept_levels_only())
      reserve_points(slices, plan, field);
    const Batch batch = append_points(some.first(geometry.slice), plan, field);  // 8.9
    seconds.geometry += watch.lap();
    SLF_CHECK(decode_values(batch, plan, threads, field));  // 8.7 - 8.10, 7.9
    SLF_CHECK(geometry.result);  // of a slice behind those: the first error is that of any threads
    seconds.coefficients += watch.lap();
  }
  return Done{};
}

/// The header of what comes out.
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
  LightField field = empty_field(plan);
  DecodeSeconds seconds;
  SLF_CHECK(decode_slices(slices, plan, options.threads, seconds, field));
  field.partial = is_partial(units, plan, slices);  // 8.9
  if (options.seconds != nullptr) *options.seconds = seconds;
  return field;
}

}  // namespace slf
