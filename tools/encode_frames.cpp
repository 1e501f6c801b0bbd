// SPDX-License-Identifier: Apache-2.0
#include "tools/encode_frames.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "slf/frame_inputs.h"
#include "slf/frames.h"
#include "slf/gaussian_frames.h"
#include "slf/plenoptic_frames.h"
#include "tools/capture_input.h"
#include "tools/describe_frames.h"
#include "tools/frame_loader.h"
#include "tools/output.h"
#include "tools/progress.h"
#include "tools/scene_options.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

/// Clouds may have colours of views.
FrameKind kind_of(const FrameInputs& inputs, const PlenopticVerbOptions& plenoptic) {
  if (inputs.kind != FrameKind::kClouds || plenoptic.as == "colour") return inputs.kind;
  const bool views =
      std::any_of(inputs.frames.begin(), inputs.frames.end(),
                  [](const FrameInput& f) { return count_plenoptic_views(f.path) > 0; });
  if (!views) return inputs.kind;
  const bool maps =
      plenoptic.as == "viewmaps" || (plenoptic.as == "auto" && !plenoptic.hold_out.empty());
  return maps ? FrameKind::kViewMaps : FrameKind::kPlanes;
}

Result<FrameSettings, Failure> frame_settings(const FrameOptions& frames) {
  FrameSettings own{frames.group, frames.rate, !frames.refit, frames.part.empty()};
  SLF_TRY(const ScenePart part, part_of(frames.part));
  own.part = part.index;
  own.parts = part.count;
  return own;
}

/// What the command line says of the captures is kept as of one of them: slf eval reads it.
Outcome add_metadata(const EncodeOptions& given, Metadata& metadata) {
  if (!given.crs.empty()) {
    SLF_TRY(std::string crs, from(given.crs, read_crs(given.crs)));
    metadata.emplace(metadata.begin(), "crs", std::move(crs));
  }
  if (!given.split.empty()) metadata.emplace(metadata.begin(), "split", given.split);
  return Done{};
}

/// What there is to code, and how.
struct FrameJob {
  const FrameInputs& inputs;
  PlenopticSettings settings;
  FrameSettings frames;
};

/// By what the frames are.
Result<PlannedFrames, InputError> plan_of(FrameLoader& loader, const FrameJob& job,
                                          const Progress& progress) {
  const std::size_t count = job.inputs.frames.size();
  const EncoderSettings& settings = job.settings.encoder;
  switch (job.inputs.kind) {
    case FrameKind::kSplats:
      return plan_gaussian_frames(count, loader.splats(), settings, job.frames, progress);
    case FrameKind::kPlanes:
    case FrameKind::kViewMaps:
      return plan_plenoptic_frames(count, loader.views(), job.settings, job.frames, progress);
    default:
      return plan_frames(count, loader.captures(), settings, job.frames, progress);
  }
}

Result<EncodedFrames, InputError> encoded_of(FrameLoader& loader, const FrameJob& job,
                                             const TakeFrame& take, const Progress& progress) {
  const std::size_t count = job.inputs.frames.size();
  const EncoderSettings& settings = job.settings.encoder;
  switch (job.inputs.kind) {
    case FrameKind::kSplats:
      return encode_gaussian_frames(count, loader.splats(), settings, job.frames, take, progress);
    case FrameKind::kPlanes:
    case FrameKind::kViewMaps:
      return encode_plenoptic_frames(count, loader.views(), job.settings, job.frames, take,
                                     progress);
    default:
      return encode_frames(count, loader.captures(), settings, job.frames, take, progress);
  }
}

}  // namespace

void add_frames(CLI::App& verb, FrameOptions& options) {
  const char* group = "Frames in time";
  verb.add_option(
          "--frames", options.range,
          "Numbers of the frames to encode, of a directory (frame_0001/ and on, or NAME_0001.ply "
          "and on, clouds or splats) or of a pattern of their names (NAME_%04d.ply)")
      ->type_name("A:B")
      ->group(group);
  verb.add_option("--group", options.group,
                  "Frames from one that is not predicted to the next: what a lost byte can cost")
      ->type_name("N")
      ->capture_default_str()
      ->check(whole_range(1, 4096))
      ->group(group);
  verb.add_option("--rate", options.rate, "Frames a second")
      ->type_name("F")
      ->capture_default_str()
      ->check(range(0.001, 10000))
      ->group(group);
  verb.add_flag("--refit-still", options.refit,
                "Fit every frame anew, also points where no photograph shows a change: these keep "
                "the view map of the frame before otherwise")
      ->group(group);
}

bool is_frame_input(const EncodeOptions& given, const FrameOptions& frames) {
  return !frames.range.empty() || holds_frames(given.capture);
}

Outcome encode_frame_list(const EncodeOptions& given, const FrameOptions& frames) {
  if (given.common.json && given.output == "-")
    return Failure{kUsage, "encode: --json and --output - both want standard output"};
  std::optional<FrameRange> range;
  if (!frames.range.empty()) {
    SLF_TRY(range, from("--frames", parse_frame_range(frames.range)));
  }
  SLF_TRY(FrameInputs inputs, from(given.capture, list_frames(given.capture, range)));
  inputs.kind = kind_of(inputs, frames.plenoptic);
  SLF_CHECK(check_frame_options(frames.options, given, inputs.kind));
  SLF_TRY(PlenopticSettings settings, plenoptic_settings(given, frames.plenoptic));
  SLF_CHECK(add_metadata(given, settings.encoder.metadata));
  SLF_CHECK(check_output(given.output, "encode", std::array{".slf"}));
  SLF_TRY(const FrameSettings own, frame_settings(frames));
  ProgressLine line(given.common.quiet);
  FrameLoader loader(given, inputs, frames.plenoptic.views, line);
  const FrameJob job{inputs, std::move(settings), own};
  if (frames.dry_run) {
    auto planned = plan_of(loader, job, line.callback());
    line.clear();
    SLF_TRY(const PlannedFrames plan, loader.from_frames(std::move(planned)));
    return report_plan(given, inputs, plan, own);
  }
  std::vector<std::uint8_t> stream;
  const auto take = [&](std::size_t, std::span<const std::uint8_t> bytes) {
    stream.insert(stream.end(), bytes.begin(), bytes.end());
    return Result<Done, InputError>(Done{});
  };
  auto encoded = encoded_of(loader, job, take, line.callback());
  line.clear();
  SLF_TRY(const EncodedFrames all, loader.from_frames(std::move(encoded)));
  warn(all.warnings, given.common.quiet);
  SLF_CHECK(save(given.output, stream.data(), stream.size()));
  return report_frames(given, inputs, all, stream.size(), own);
}

}  // namespace slf::tools
