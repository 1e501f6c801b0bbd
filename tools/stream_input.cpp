// SPDX-License-Identifier: Apache-2.0
#include "tools/stream_input.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "slf/capture.h"
#include "slf/frames.h"
#include "slf/plenoptic.h"
#include "tools/frame_source.h"
#include "tools/heap.h"
#include "tools/part_input.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

/// The voxel whose cell holds a coordinate; any beyond the grid for one beyond it.
std::int32_t voxel_at(double coordinate, double origin, double step) {
  const double voxel = std::floor((coordinate - origin) / step + 0.5);
  return static_cast<std::int32_t>(std::clamp(voxel, -1.0, double{1 << 22}));
}

VoxelBox voxel_box(const Grid& grid, const std::vector<double>& corners) {
  VoxelBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax(corners[axis], corners[axis + 3]);
    box.low[axis] = voxel_at(low, grid.origin[axis], grid.step);
    box.high[axis] = voxel_at(high, grid.origin[axis], grid.step);
  }
  return box;
}

std::string missing(const StreamInfo& info) {
  std::string what = "partial: ";
  if (!info.complete) what += "it ends before its end unit";
  if (info.cut) what += info.complete ? "parts were cut off" : ", and parts were cut off";
  return what + "; what is missing counts as zero, and no digest is checked";
}

/// How many frames a stream has; 1 where nothing moves.
Result<std::size_t, Failure> count_frames(const std::string& file,
                                          std::span<const std::uint8_t> bytes,
                                          const StreamInfo& info, const DecodeLimits& limits) {
  if (info.units.size() < 2 || info.units[1].type != "frame") return std::size_t{1};
  SLF_TRY(const auto frames, from(input_name(file), list_frames(bytes, limits)));
  return frames.size();
}

std::string mebibytes(std::uint64_t bytes) { return grouped((bytes + (1 << 20) - 1) >> 20); }

}  // namespace

Failure no_such_frame(const std::string& name, std::size_t frame, std::size_t count) {
  return Failure{kUsage, name + ": frame " + std::to_string(frame) + " is asked for, but it has " +
                             std::to_string(count) +
                             ", counted from 0 whatever number the first one has"};
}

void add_limits(CLI::App& verb, LimitOptions& options) {
  const char* group = "Limits (a file beyond them is refused by its headers, exit code 5)";
  DecodeLimits& limits = options.limits;
  const auto take = [&limits](std::uint64_t bytes) {
    limits.max_memory = bytes;  // a file in it may be as large
    limits.max_stream_bytes = std::max(DecodeLimits{}.max_stream_bytes, bytes);
  };
  verb.add_option_function<std::uint64_t>(
          "--max-memory", take,
          "Bytes that decoding may take at most, all counted; K, M and G are powers of "
          "1024. slf info tells what a file takes")
      ->type_name("BYTES")
      ->default_str("1G")
      ->transform(byte_range(1, std::int64_t{1} << 60))
      ->group(group);
  verb.add_option("--max-points", limits.max_points, "Points of a file at most")
      ->type_name("N")
      ->capture_default_str()
      ->check(whole_range(1, std::int64_t{1} << 38))
      ->group(group);
  verb.add_option("--max-values-per-byte", limits.max_values_per_byte,
                  "Values of components for every byte of a file, beyond the first 4,194,304")
      ->type_name("N")
      ->capture_default_str()
      ->check(whole_range(1, std::int64_t{1} << 32))
      ->group(group);
  verb.add_option("--max-work", limits.max_work,
                  "Steps of decoding at most: 8 for every node that the octrees may have, 1 for "
                  "every value of a component, 1 for 64 bytes of what each of several slices "
                  "starts from; a core does some 10^8 a second")
      ->type_name("N")
      ->capture_default_str()
      ->check(whole_range(1, std::int64_t{1} << 60))
      ->group(group);
  verb.add_flag("--strict", options.strict,
                "Refuse a file that is partial: cut short, or with parts left out")
      ->group(group);
}

bool is_partial(const StreamInfo& info) { return !info.complete || info.cut.has_value(); }

Outcome check_whole(const std::string& file, const StreamInfo& info, const LimitOptions& given,
                    const CommonOptions& common) {
  if (!is_partial(info)) return Done{};
  const std::string what = input_name(file) + ": " + missing(info);
  if (given.strict) return Failure{kInputInvalid, what + " (--strict)"};
  warn(what, common.quiet);
  return Done{};
}

Result<std::vector<std::uint8_t>, Failure> read_input(const std::string& file,
                                                      const LimitOptions& given) {
  const DecodeLimits& limits = given.limits;
  auto bytes = read_file(file, std::min(limits.max_stream_bytes, limits.max_memory));
  if (!bytes && bytes.error().code == Errc::kLimitExceeded &&
      limits.max_memory < limits.max_stream_bytes)
    return Failure{kLimitExceeded, input_name(file) + ": larger than the " +
                                       grouped(limits.max_memory) + " bytes of --max-memory"};
  return from(input_name(file), std::move(bytes));
}

Result<StreamFile, Failure> read_stream(const std::string& file, const LimitOptions& given,
                                        const CommonOptions& common, UnitList units) {
  SLF_TRY(auto bytes, read_input(file, given));
  return open_stream(file, std::move(bytes), given, common, units);
}

Result<StreamFile, Failure> open_stream(const std::string& file, std::vector<std::uint8_t> bytes,
                                        const LimitOptions& given, const CommonOptions& common,
                                        UnitList units) {
  SLF_TRY(StreamInfo info, from(input_name(file), read_info(bytes, given.limits)));
  SLF_CHECK(check_whole(file, info, given, common));
  SLF_TRY(const std::size_t frames, count_frames(file, bytes, info, given.limits));
  if (units == UnitList::kNone) std::vector<UnitInfo>().swap(info.units);
  return StreamFile{std::move(bytes), std::move(info), frames};
}

Outcome check_frames(const std::string& file, const StreamFile& stream, const LimitOptions& given) {
  if (stream.frames < 2) return Done{};
  const std::string name = input_name(file);
  DecodeOptions all;
  all.limits = given.limits;
  SLF_TRY(const auto frames, from(name, list_frames(stream.bytes, given.limits)));
  // What is checked is copied: some groups at a time, not the whole file a second time.
  const std::size_t some = stream.bytes.size() / 16;
  for (std::size_t first = 0, f = 0; f < frames.size(); ++f) {
    const bool last = f + 1 == frames.size();
    const bool enough = frames[f].offset + frames[f].bytes - frames[first].offset >= some;
    if (!last && (frames[f + 1].predicted || !enough)) continue;
    SLF_CHECK(from(name, truncate_frames(stream.bytes, first, f, all)));
    first = f + 1;
  }
  return Done{};
}

DecodeOptions decode_options(const StreamInfo& info, const PartOptions& part,
                             const LimitOptions& given, const CommonOptions& common) {
  DecodeOptions options;
  options.limits = given.limits;
  options.threads = common.threads;
  options.levels = part.levels;
  options.groups = part.groups;
  options.layers = part.layers;
  options.means_only = part.means_only && !is_plenoptic(info.metadata);  // who has views to show
  options.max_bytes = part.max_bytes;
  if (!part.region.empty()) options.region = voxel_box(info.header.grid, part.region);
  return options;
}

Failure decode_failure(const std::string& file, const Error& error, const StreamFile& stream,
                       const DecodeOptions& options) {
  const auto cost = decode_cost(stream.bytes, options);
  const auto beyond = [&](const char* limit) {
    return cost && error.code == Errc::kLimitExceeded && std::strcmp(error.element, limit) == 0;
  };
  const std::string name = input_name(file) + ": ";
  // The headers of the whole file were read: what is cut off is cut off by --max-bytes.
  const bool too_few = options.max_bytes > 0 && !cost && error.code == Errc::kTruncated;
  if (too_few || std::strcmp(error.element, "max_bytes") == 0)
    return {kUsage, name + "--max-bytes " + std::to_string(options.max_bytes) +
                        " has no room for its headers"};
  if (options.region && beyond("max_memory"))
    return {kLimitExceeded, name + "what the region meets takes more than the " +
                                mebibytes(options.limits.max_memory) + " MiB of --max-memory"};
  if (beyond("max_memory"))
    return {kLimitExceeded, name + "decoding takes up to " + mebibytes(cost->memory_most) +
                                " MiB, more than the " + mebibytes(options.limits.max_memory) +
                                " MiB of --max-memory"};
  if (beyond("max_points"))
    return {kLimitExceeded, name + "holds " + grouped(stream.info.num_points) +
                                " points, more than the " + grouped(options.limits.max_points) +
                                " of --max-points"};
  if (beyond("max_values_per_byte"))
    return {kLimitExceeded, name + "says more values than " +
                                grouped(options.limits.max_values_per_byte) +
                                " for each of its bytes (--max-values-per-byte)"};
  if (beyond("max_work"))
    return {kLimitExceeded, name + "decoding takes up to " + grouped(cost->work) +
                                " steps, more than the " + grouped(options.limits.max_work) +
                                " of --max-work"};
  return failure_of(error, input_name(file));
}

Result<DecodedFile, Failure> decode_file(const std::string& file, const PartOptions& part,
                                         const LimitOptions& given, const CommonOptions& common) {
  share_heap();
  if (part.frame >= 0) return decode_frame(file, part, given, common);
  if (auto decoded = decode_part_alone(file, part, given, common)) return *std::move(decoded);
  SLF_TRY(StreamFile stream, read_stream(file, given, common));
  if (stream.frames > 1)
    warn(input_name(file) + ": " + kOneLightField + ": of " + grouped(stream.frames) +
             " the first is taken",
         common.quiet);
  const DecodeOptions options = decode_options(stream.info, part, given, common);
  Stopwatch watch;
  auto field = decode(stream.bytes, options);
  if (!field) return decode_failure(file, field.error(), stream, options);
  DecodedFile decoded{*std::move(field), stream.bytes.size(), watch.lap(), stream.info.metadata};
  if (!is_plenoptic(decoded.metadata)) return decoded;
  if (stream.frames > 1) {
    SLF_TRY(const auto frames, from(input_name(file), list_frames(stream.bytes)));
    stream.bytes.resize(static_cast<std::size_t>(frames.front().bytes));
  }
  decoded.stream = std::move(stream.bytes);
  return decoded;
}

Outcome require_view_maps(const LightField& field, const std::string& file) {
  if (!field.header.grid.fits_floats())
    return Failure{kInputInvalid, input_name(file) +
                                      ": its grid lies beyond what pictures and splats can hold "
                                      "(slf decode --dump writes its integers)"};
  if (field.header.has_basis && field.header.num_functions > 0) return Done{};
  const char* what =
      field.header.num_functions == 0 ? "geometry alone" : "integer planes without a basis";
  return Failure{kInputInvalid, input_name(file) + ": holds " + what +
                                    ", so it has no colours (slf decode reads it)"};
}

}  // namespace slf::tools
