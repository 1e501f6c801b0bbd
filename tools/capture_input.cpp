// SPDX-License-Identifier: Apache-2.0
#include "tools/capture_input.h"

#include <filesystem>
#include <string>

#include "slf/crop_gaussians.h"
#include "slf/splat_surface.h"
#include "tools/measure_file.h"
#include "tools/splat_input.h"
#include "tools/spooled_input.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

constexpr std::uint64_t kMostSplatBytes = std::uint64_t{1} << 32;

/// The last component of the path, whatever it ends with; never more, so that no machine's paths
/// get into a file.
std::string last_name(const std::string& path) {
  std::error_code ignored;
  std::filesystem::path full = std::filesystem::weakly_canonical(path, ignored);
  if (ignored) full = path;
  return full.filename().empty() ? full.parent_path().filename().string()
                                 : full.filename().string();
}

/// What split_cameras made of "".
std::string split_name(const Capture& capture, const std::string& given) {
  if (!given.empty()) return given;
  return capture.splits.count("dense") ? "dense" : "default";
}

Result<std::vector<int>, Failure> input_cameras(const Capture& capture,
                                                const EncodeOptions& given) {
  if (!capture.cameras.empty()) {
    SLF_TRY(auto cameras, from(given.capture, split_cameras(capture, given.split)));
    if (!cameras.empty()) return cameras;
    return Failure{kInputInvalid, given.capture + ": its split " +
                                      split_name(capture, given.split) + " has no images"};
  }
  if (!given.split.empty())
    return Failure{kUsage, std::string(given.verb) + ": --split " + given.split +
                               ": the capture has no cameras"};
  return std::vector<int>{};
}

/// Points that splats show to the cameras.
Outcome take_splats(const EncodeOptions& given, CaptureInput& input) {
  LimitOptions limits;
  limits.limits.max_stream_bytes = limits.limits.max_memory = kMostSplatBytes;
  SLF_TRY(GaussianFile file, read_splat_file(given.verb, given.points, {}, limits, given.common));
  if (given.world) change_world(*given.world, file.gaussians);
  if (const auto& c = given.crop; !c.empty())
    SLF_CHECK(
        from(given.points, crop(file.gaussians, WorldBox{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}})));
  SLF_TRY(input.capture.cloud,
          from(given.points, surface_of_splats(file.gaussians, input.capture, input.cameras,
                                               given.common.threads)));
  input.capture.mesh = {};
  return Done{};
}

/// Photographs without the object are left out. Black masks are no input, but a mistake.
Outcome check_masks(const EncodeOptions& given, CaptureInput& input) {
  const std::size_t all = input.cameras.size();
  std::string warning =
      leave_out_empty(input.capture, "input", given.common.threads, input.cameras);
  if (warning.empty()) return Done{};
  if (input.cameras.empty())
    return Failure{kInputInvalid,
                   given.capture + ": the masks (or alpha) of all " + std::to_string(all) +
                       " input photographs are black, and 128 and more, white, is the object: "
                       "invert them (mogrify -negate) or take them away"};
  warn(warning, given.common.quiet);
  input.capture.warnings.push_back(std::move(warning));
  return Done{};
}

}  // namespace

Result<CaptureInput, Failure> load_input(const EncodeOptions& given, ProgressLine& line,
                                         PointsWanted wanted) {
  Stopwatch watch;
  if (const Progress progress = line.callback()) progress("load", 0);
  CaptureOptions options;
  const bool splats = !given.points.empty() && is_splat_file(given.points);
  if (!splats) options.points = given.points;
  options.cloud = !splats;
  options.points_needed = wanted == PointsWanted::kNeeded;
  options.may_be_empty = wanted == PointsWanted::kOrNone;
  options.images = given.images;
  options.world = given.world;
  if (const auto& c = given.crop; !c.empty() && !splats)
    options.crop = WorldBox{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}};
  CaptureInput input;
  SLF_TRY(input.capture, from(given.capture, given.frame ? load_frame(*given.frame, options)
                                                         : load_capture(given.capture, options)));
  if (given.up_given) input.capture.up = given.up;
  line.clear();
  for (std::string& warning : input.capture.warnings)
    warning = SpooledInput::named(std::move(warning));
  warn(input.capture.warnings, given.common.quiet);
  SLF_TRY(input.cameras, input_cameras(input.capture, given));
  if (splats) SLF_CHECK(take_splats(given, input));
  SLF_CHECK(check_masks(given, input));
  input.metadata.emplace_back("source", last_name(given.capture));
  if (!input.cameras.empty())
    input.metadata.emplace_back("split", split_name(input.capture, given.split));
  if (!given.crs.empty()) {
    SLF_TRY(input.capture.crs, from(given.crs, read_crs(given.crs)));
  }
  if (!input.capture.crs.empty()) input.metadata.emplace_back("crs", input.capture.crs);
  input.seconds = watch.lap();
  return input;
}

}  // namespace slf::tools
