// SPDX-License-Identifier: Apache-2.0
// Slices of a plan, one after the other, to a part.
#include <cstdio>

#include "base/stopwatch.h"
#include "encoder/parts/depth_maps.h"
#include "encoder/parts/encode_slice.h"
#include "encoder/parts/planned_scene.h"
#include "encoder/parts/scene_cameras.h"
#include "encoder/parts/scene_parts.h"
#include "encoder/parts/scene_points.h"
#include "encoder/parts/work_directory.h"

namespace slf {
namespace {

namespace fs = std::filesystem;

/// Slices [first, last) of a part: those whose middle points are in its share.
std::array<std::size_t, 2> slices_of(const ScenePlan& plan, const ScenePart& part) {
  const auto share = [&](int index) {
    std::uint64_t before = 0;
    std::size_t slice = 0;
    const std::uint64_t wanted =
        plan.points() * static_cast<std::uint64_t>(index) / static_cast<std::uint64_t>(part.count);
    while (slice < plan.slices.size() && before + plan.slices[slice].points / 2 < wanted)
      before += plan.slices[slice++].points;
    return slice;
  };
  return {share(part.index), share(part.index + 1)};
}

/// The slice, where it was coded before for this plan.
bool take_finished(const fs::path& file, const SceneParts& of, std::size_t slice,
                   SceneParts& parts) {
  const auto bytes = read_file(file);
  if (!bytes) return false;
  auto there = read_part({file.string(), *bytes});
  if (!there || there->plan != of.plan || there->slices.size() <= slice || !there->slices[slice])
    return false;
  parts.slices[slice] = std::move(there->slices[slice]);
  return true;
}

std::string line_of(const CodedSlice& slice) {
  char text[160];
  std::snprintf(text, sizeof text,
                "slice %zu: %zu points, %zu around, %zu cameras, %zu observations, %zu unseen",
                slice.slice, slice.points, slice.around, slice.cameras, slice.observations,
                slice.unobserved);
  return text;
}

/// How far a slice is, in a stage of it.
double done_of_slice(const std::string& stage, double fraction) {
  if (stage == "observe") return 0.2 * fraction;
  if (stage == "fit") return 0.2 + 0.4 * fraction;
  if (stage == "code") return 0.95;
  return 0.6 + 0.3 * fraction;
}

/// The scene's cloud, where the directory does not have it.
Result<Done, InputError> restore_points(const Capture& capture, const ScenePlan& plan,
                                        const SceneWork& work) {
  if (has_points(plan, work)) return Done{};
  if (capture.cloud.positions.empty())
    return InputError{Errc::kInvalidInput, "the points of the plan are not in " +
                                               work.directory.string() +
                                               ", and the capture was opened without its own"};
  SLF_TRY(const EncoderSettings settings,
          scene_settings(plan.settings, !plan.cameras.empty(), work.threads));
  SLF_CHECK(check_planning(plan, work));
  SLF_TRY(const ScenePoints points,
          store_points(capture, plan.cameras, settings, {0, plan.grid.step}, work.directory));
  if (points.stored.digest == plan.points_digest) return Done{};
  return InputError{Errc::kInvalidInput, "the capture's points are not those of the plan"};
}

Result<Done, InputError> check(const Capture& capture, const ScenePlan& plan, const ScenePart& part,
                               const SceneWork& work) {
  if (part.count < 1 || part.count > kMostParts || part.index < 0 || part.index >= part.count)
    return InputError{Errc::kInvalidArgument, "part: 1/n to n/n, of 4096 at the most"};
  if (capture.cameras.size() != plan.capture_cameras)
    return InputError{Errc::kInvalidInput,
                      "the capture has " + std::to_string(capture.cameras.size()) +
                          " cameras, that of the plan " + std::to_string(plan.capture_cameras)};
  if (digest_of_photographs(capture, plan.origin) != plan.photographs_digest)
    return InputError{Errc::kInvalidInput,
                      "the capture's photographs or calibrations are not those of the plan"};
  if (plan.reduction.size() != plan.capture_cameras)
    return InputError{Errc::kInvalidInput, "plan: reduction: not of as many cameras"};
  SLF_CHECK(check_memory(plan, work));
  SLF_CHECK(make_directory(work.directory));
  return restore_points(capture, plan, work);
}

}  // namespace

bool has_points(const ScenePlan& plan, const SceneWork& work) {
  return static_cast<bool>(PointStore::open(work.directory, plan.points_digest, plan.points()));
}

Result<std::vector<std::uint8_t>, InputError> encode_part(const Capture& given,
                                                          const ScenePlan& plan,
                                                          const ScenePart& part,
                                                          const SceneWork& work,
                                                          const Progress& progress) {
  SLF_CHECK(check_capture(given, plan.cameras));
  SLF_CHECK(check(given, plan, part, work));
  const Capture capture = scene_cameras(given, plan, cache_of(plan, work));
  SLF_TRY(const auto scene, open_scene(plan, work));
  SLF_TRY(const DepthMaps depth,
          DepthMaps::in(work.directory, capture, scene->cells, plan, scene->settings));
  SLF_TRY(const SceneParts none, parts_of(*scene));
  SceneParts parts = none;
  SLF_TRY(const SceneBase no_base, code_base(none, work.threads));  // of files that we read again
  const auto slices = slices_of(plan, part);
  const std::size_t first = slices[0], last = slices[1];
  for (std::size_t s = first; s < last; ++s) {
    const fs::path file = scene->directory / ("slice-" + std::to_string(s) + ".slf");
    const auto tell = [&](const char* stage, double fraction) {
      if (progress)
        progress("slices",
                 (double(s - first) + done_of_slice(stage, fraction)) / double(last - first));
    };
    tell("observe", 0);
    if (work.resume && take_finished(file, none, s, parts)) continue;
    Stopwatch watch;
    SLF_TRY(CodedSlice slice, encode_slice(*scene, capture, depth, s, tell));
    const std::string report = line_of(slice);
    SceneParts one = none;
    add_slice(one, std::move(slice));
    SLF_TRY(const auto bytes, join(one, no_base, true));
    SLF_CHECK(write_file(file, bytes.data(), bytes.size()));
    parts.slices[s] = std::move(one.slices[s]);
    if (work.log) {
      char end[64];
      std::snprintf(end, sizeof end, ", %zu bytes, %.1f s", bytes.size(), watch.lap());
      work.log(report + end);
    }
  }
  if (progress) progress("slices", 1);
  SLF_TRY(const SceneBase base, code_base(parts, work.threads));
  return join(parts, base, true);
}

Result<MergedScene, InputError> merge_parts(std::span<const PartStream> given, bool allow_missing,
                                            int threads, const DecodeLimits& limits) {
  if (given.empty()) return InputError{Errc::kInvalidArgument, "merge: no part is given"};
  SLF_TRY(SceneParts parts, read_part(given[0], limits.max_memory));
  std::uint64_t taken = std::min(memory_of(parts), limits.max_memory);
  for (const PartStream& part : given.subspan(1)) {
    SLF_TRY(SceneParts more, read_part(part, limits.max_memory - taken));
    taken = std::min(taken + memory_of(more), limits.max_memory);
    SLF_CHECK(combine(parts, std::move(more)));
  }
  if (taken >= limits.max_memory)
    return InputError{Errc::kLimitExceeded, "merge: the parts take more memory than the limit"};
  MergedScene merged;
  merged.missing = parts.missing();
  if (!merged.missing.empty() && !allow_missing) {
    std::string list;
    for (std::size_t i = 0; i < merged.missing.size() && i < 10; ++i)
      list.append(" ").append(std::to_string(merged.missing[i]));
    if (merged.missing.size() > 10) list.append(" ...");
    std::string cause = "of " + std::to_string(parts.slices.size()) + " slices ";
    cause.append(std::to_string(merged.missing.size())).append(" are missing:").append(list);
    return InputError{Errc::kInvalidInput, std::move(cause)};
  }
  SLF_TRY(const SceneBase base, code_base(parts, threads));
  SLF_TRY(merged.stream, join(parts, base, false));
  return merged;
}

}  // namespace slf
