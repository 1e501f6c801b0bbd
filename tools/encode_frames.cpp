// SPDX-License-Identifier: Apache-2.0
#include "tools/encode_frames.h"

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "slf/frame_inputs.h"
#include "slf/frames.h"
#include "slf/gaussian_frames.h"
#include "slf/plenoptic.h"
#include "tools/capture_input.h"
#include "tools/describe_frames.h"
#include "tools/frame_loader.h"
#include "tools/output.h"
#include "tools/progress.h"
#include "tools/scene_options.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

/// Colours of views are not left out without a word.
Outcome check_one_colour(const FrameInputs& inputs, const FrameOptions& frames) {
  if (inputs.kind != FrameKind::kClouds || frames.as == "colour") return Done{};
  for (const FrameInput& frame : inputs.frames)
    if (const std::size_t views = count_plenoptic_views(frame.path); views > 0)
      return Failure{kUsage, "encode: " + frame.path.string() + " has colours of " +
                                 std::to_string(views) +
                                 " views, and frames one: --as colour takes red, green, blue; "
                                 "alone, without --frames, it is coded whole"};
  return Done{};
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

/// By what the frames are.
Result<PlannedFrames, InputError> plan_of(FrameLoader& loader, const FrameInputs& inputs,
                                          const EncoderSettings& settings, const FrameSettings& own,
                                          const Progress& progress) {
  const std::size_t count = inputs.frames.size();
  return inputs.kind == FrameKind::kSplats
             ? plan_gaussian_frames(count, loader.splats(), settings, own, progress)
             : plan_frames(count, loader.captures(), settings, own, progress);
}

Result<EncodedFrames, InputError> encoded_of(FrameLoader& loader, const FrameInputs& inputs,
                                             const EncoderSettings& settings,
                                             const FrameSettings& own, const TakeFrame& take,
                                             const Progress& progress) {
  const std::size_t count = inputs.frames.size();
  return inputs.kind == FrameKind::kSplats
             ? encode_gaussian_frames(count, loader.splats(), settings, own, take, progress)
             : encode_frames(count, loader.captures(), settings, own, take, progress);
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
  SLF_TRY(const FrameInputs inputs, from(given.capture, list_frames(given.capture, range)));
  SLF_CHECK(check_frame_options(frames.options, given, inputs.kind));
  SLF_CHECK(check_one_colour(inputs, frames));
  SLF_TRY(EncoderSettings settings, resolved(given));
  SLF_CHECK(add_metadata(given, settings.metadata));
  SLF_CHECK(check_output(given.output, "encode", std::array{".slf"}));
  SLF_TRY(const FrameSettings own, frame_settings(frames));
  ProgressLine line(given.common.quiet);
  FrameLoader loader(given, inputs, line);
  if (frames.dry_run) {
    auto planned = plan_of(loader, inputs, settings, own, line.callback());
    line.clear();
    SLF_TRY(const PlannedFrames plan, loader.from_frames(std::move(planned)));
    return report_plan(given, inputs, plan, own);
  }
  std::vector<std::uint8_t> stream;
  const auto take = [&](std::size_t, std::span<const std::uint8_t> bytes) {
    stream.insert(stream.end(), bytes.begin(), bytes.end());
    return Result<Done, InputError>(Done{});
  };
  auto encoded = encoded_of(loader, inputs, settings, own, take, line.callback());
  line.clear();
  SLF_TRY(const EncodedFrames all, loader.from_frames(std::move(encoded)));
  warn(all.warnings, given.common.quiet);
  SLF_CHECK(save(given.output, stream.data(), stream.size()));
  return report_frames(given, inputs, all, stream.size(), own);
}

}  // namespace slf::tools
