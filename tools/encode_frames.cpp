// SPDX-License-Identifier: Apache-2.0
#include "tools/encode_frames.h"

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "slf/frame_inputs.h"
#include "slf/frames.h"
#include "tools/capture_input.h"
#include "tools/output.h"
#include "tools/progress.h"
#include "tools/scene_options.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

nlohmann::ordered_json frame_json(const EncodedFrame& f, std::uint32_t number) {
  return {{"number", number}, {"predicted", f.predicted}, {"points", f.points},
          {"held", f.held},   {"bytes", f.bytes},         {"seconds", f.seconds}};
}

Outcome report_frames(const EncodeOptions& given, const FrameInputs& inputs,
                      const EncodedFrames& encoded, std::size_t bytes,
                      const FrameSettings& settings) {
  const double rate = settings.rate;
  const std::size_t first = frames_of_part(inputs.frames.size(), settings).first;
  std::size_t predicted = 0, points = 0, held = 0;
  std::uint64_t of_predicted = 0;
  double seconds = 0;
  for (const EncodedFrame& f : encoded.frames) {
    predicted += f.predicted;
    of_predicted += f.predicted ? f.bytes : 0;
    seconds += f.seconds;
    points += f.points;
    held += f.held;
  }
  const std::size_t count = encoded.frames.size();
  if (given.common.json) {
    nlohmann::ordered_json json = {{"bytes", bytes}, {"q", encoded.q}, {"rate", rate}};
    for (std::size_t f = 0; f < count; ++f)
      json["frames"].push_back(frame_json(encoded.frames[f], inputs.frames[first + f].number));
    return print(json);
  }
  if (given.common.quiet) return Done{};
  std::string out = text("frames        %zu, %zu predicted\n", count, predicted);
  if (held > 0)
    out += text("still         %.1f %% of points keep the view map of the frame before\n",
                1e2 * static_cast<double>(held) / static_cast<double>(points));
  out += text("quality       Q %.4g\n", encoded.q);
  out += text("bytes         %s a frame that is not predicted, %s one that is\n",
              grouped((bytes - of_predicted) / std::max<std::size_t>(count - predicted, 1)).c_str(),
              grouped(of_predicted / std::max<std::size_t>(predicted, 1)).c_str());
  out += text("seconds       %.2f, %.2f a frame\n", seconds, seconds / static_cast<double>(count));
  out += text("file          %s bytes, %.0f kbit/s at %g frames a second\n", grouped(bytes).c_str(),
              8e-3 * static_cast<double>(bytes) * rate / static_cast<double>(count), rate);
  std::fputs(out.c_str(), stderr);
  return Done{};
}

/// Captures are loaded by the program, with their warnings: the first one's alone, all are alike.
class FrameLoader {
 public:
  FrameLoader(const EncodeOptions& given, const FrameInputs& inputs, ProgressLine& line)
      : given_(given), inputs_(inputs), line_(line) {}

  Result<LoadedFrame, InputError> load(std::size_t f) {
    EncodeOptions options = given_;
    options.capture = inputs_.frames[f].path.string();
    options.common.quiet = given_.common.quiet || loaded_;
    auto input = load_input(options, line_, PointsWanted::kOrNone);
    if (!input) {
      failure_ = input.error();
      return InputError{Errc::kInvalidInput, failure_->message};
    }
    loaded_ = true;
    return LoadedFrame{std::move(input->capture), std::move(input->cameras)};
  }
  /// Why a frame could not be loaded, with the exit code.
  const std::optional<Failure>& failure() const { return failure_; }

 private:
  const EncodeOptions& given_;
  const FrameInputs& inputs_;
  ProgressLine& line_;
  bool loaded_ = false;
  std::optional<Failure> failure_;
};

}  // namespace

void add_frames(CLI::App& verb, FrameOptions& options) {
  const char* group = "Frames in time";
  verb.add_option(
          "--frames", options.range,
          "Numbers of the frames to encode, of a directory (frame_0001/ and on, or NAME_0001.ply "
          "and on) or of a pattern of their names (NAME_%04d.ply)")
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
  SLF_TRY(const EncoderSettings settings, resolved(given));
  SLF_CHECK(check_output(given.output, "encode", std::array{".slf"}));
  std::optional<FrameRange> range;
  if (!frames.range.empty()) {
    SLF_TRY(range, from("--frames", parse_frame_range(frames.range)));
  }
  SLF_TRY(const FrameInputs inputs, from(given.capture, list_frames(given.capture, range)));
  FrameSettings own{frames.group, frames.rate, !frames.refit, frames.part.empty()};
  SLF_TRY(const ScenePart part, part_of(frames.part));
  own.part = part.index;
  own.parts = part.count;
  ProgressLine line(given.common.quiet);
  FrameLoader loader(given, inputs, line);
  std::vector<std::uint8_t> stream;
  const auto take = [&](std::size_t, std::span<const std::uint8_t> bytes) {
    stream.insert(stream.end(), bytes.begin(), bytes.end());
    return Result<Done, InputError>(Done{});
  };
  auto encoded = encode_frames(
      inputs.frames.size(), [&](std::size_t f) { return loader.load(f); }, settings, own, take,
      line.callback());
  line.clear();
  if (!encoded && loader.failure()) return *loader.failure();
  SLF_TRY(const EncodedFrames all, from(given.capture, std::move(encoded)));
  warn(all.warnings, given.common.quiet);
  SLF_CHECK(save(given.output, stream.data(), stream.size()));
  return report_frames(given, inputs, all, stream.size(), own);
}

}  // namespace slf::tools
