// SPDX-License-Identifier: Apache-2.0
#include "tools/capture_input.h"

#include <string>

#include "slf/crop_gaussians.h"
#include "slf/input_cameras.h"
#include "slf/splat_surface.h"
#include "tools/splat_input.h"
#include "tools/spooled_input.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

constexpr std::uint64_t kMostSplatBytes = std::uint64_t{1} << 32;

/// Cameras of the split, in the words of the command line.
Result<std::vector<int>, Failure> split_of(const Capture& capture, const EncodeOptions& given) {
  auto cameras = input_cameras(capture, given.split);
  if (!cameras && capture.cameras.empty())
    return Failure{kUsage, std::string(given.verb) + ": " + cameras.error().message};
  return from(given.capture, std::move(cameras));
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
  SLF_TRY(std::string warning,
          from(given.capture,
               leave_out_empty_inputs(input.capture, given.common.threads, input.cameras)));
  if (warning.empty()) return Done{};
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
  SLF_TRY(input.cameras, split_of(input.capture, given));
  if (splats) SLF_CHECK(take_splats(given, input));
  SLF_CHECK(check_masks(given, input));
  if (!given.crs.empty()) {
    SLF_TRY(input.capture.crs, from(given.crs, read_crs(given.crs)));
  }
  input.metadata = input_metadata(input.capture, input.cameras, given.split, given.capture);
  input.seconds = watch.lap();
  return input;
}

}  // namespace slf::tools
