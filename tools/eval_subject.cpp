// SPDX-License-Identifier: Apache-2.0
#include "tools/eval_subject.h"

#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include "slf/gaussian_renderer.h"
#include "slf/parallel.h"
#include "tools/choices.h"
#include "tools/describe.h"
#include "tools/progress.h"
#include "tools/rd/igc/igc.h"
#include "tools/splat_input.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

/// Those that a decode may have.
int threads_of(const CommonOptions& common) {
  return thread_count(common.threads, std::numeric_limits<std::size_t>::max());
}

nlohmann::ordered_json seconds_json(const CommonOptions& common, const DecodeSeconds& seconds,
                                    double total) {
  return {{"threads", threads_of(common)},
          {"geometry", seconds.geometry},
          {"coefficients", seconds.coefficients},
          {"total", total}};
}

/// What takes the bytes is told of a file of one frame alone.
Subject subject_of(const StreamFile& stream, LightField field, std::uint64_t bytes,
                   nlohmann::ordered_json seconds) {
  const bool alone = stream.frames <= 1;
  return Subject{std::move(field),
                 bytes,
                 stream.info.metadata,
                 alone ? bytes_by_type_json(stream.info, stream.bytes.size()) : nlohmann::ordered_json(),
                 settings_json(stream.info),
                 std::move(seconds),
                 alone ? bytes_by_type_text(stream.info, stream.bytes.size()) : ""};
}

/// In place, since the decoder refers to it.
Outcome open_in(FrameStream& frames, const std::string& input, StreamFile file,
                const LimitOptions& limits, const CommonOptions& common) {
  frames.file = std::move(file);
  DecodeOptions options = decode_options(frames.file.info, {}, limits, common);
  options.seconds = &frames.seconds;
  SLF_TRY(frames.decoder, from(input_name(input), FrameDecoder::open(frames.file.bytes, options)));
  return Done{};
}

/// Frame given.frame, by its own bytes.
Result<Subject, Failure> decode_frame_of(FrameStream& frames, const SubjectOptions& given,
                                         const std::string& input) {
  const auto place = static_cast<std::size_t>(given.frame);
  const std::size_t count = frames.decoder->frames().size();
  if (place >= count) return no_such_frame(input_name(input), place, count);
  frames.seconds = {};
  Stopwatch watch;
  auto field = frames.decoder->decode(place);
  if (!field)
    return decode_failure(input, field.error(), frames.file,
                          decode_options(frames.file.info, {}, given.limits, given.common));
  return subject_of(frames.file, *std::move(field), frames.decoder->frames()[place].bytes,
                    seconds_json(given.common, frames.seconds, watch.lap()));
}

Result<Subject, Failure> decode_slf(const SubjectOptions& given, const std::string& input,
                                    std::vector<std::uint8_t> bytes) {
  SLF_TRY(StreamFile stream,
          open_stream(input, std::move(bytes), given.limits, given.common, UnitList::kKept));
  if (given.frame >= 0) {
    FrameStream frames;
    SLF_CHECK(open_in(frames, input, std::move(stream), given.limits, given.common));
    return decode_frame_of(frames, given, input);
  }
  if (stream.frames > 1)
    warn(input_name(input) + ": of " + grouped(stream.frames) +
             " frames the first is measured, against the bytes of all (--frame)",
         given.common.quiet);
  DecodeSeconds seconds;
  DecodeOptions options = decode_options(stream.info, {}, given.limits, given.common);
  options.seconds = &seconds;
  Stopwatch watch;
  auto field = decode(stream.bytes, options);
  if (!field) return decode_failure(input, field.error(), stream, options);
  return subject_of(stream, *std::move(field), stream.bytes.size(),
                    seconds_json(given.common, seconds, watch.lap()));
}

Result<Subject, Failure> decode_igc_file(const SubjectOptions& given, const std::string& input,
                                         const Capture& capture,
                                         std::span<const std::uint8_t> stream) {
  IgcDecodeOptions options;
  options.limits = given.limits.limits;
  options.estimate_normals = given.estimate_normals;
  options.threads = given.common.threads;
  ProgressLine line(given.common.quiet);
  Stopwatch watch;
  SLF_TRY(IgcDecoded decoded,
          from(input_name(input), decode_igc(stream, capture, options, line.callback())));
  const nlohmann::ordered_json decode_seconds = {
      {"threads", threads_of(given.common)}, {"geometry", decoded.seconds_geometry},
      {"images", decoded.seconds_images},    {"observe", decoded.seconds_observe},
      {"fit", decoded.seconds_fit},          {"total", watch.lap()}};
  const nlohmann::ordered_json bytes = {{"geometry", decoded.bytes_geometry},
                                        {"images", decoded.bytes_images},
                                        {"parameters", decoded.bytes_parameters}};
  nlohmann::ordered_json settings;
  for (const auto& [key, value] : decoded.metadata)
    settings[key] = igc_setting_in_words(key, value);
  std::string lines = "bytes by section\n";
  for (const auto& [section, size] : bytes.items())
    lines += text("  %-14s %12s\n", section.c_str(), grouped(size.get<std::uint64_t>()).c_str());
  return Subject{std::move(decoded.light_field),
                 stream.size(),
                 decoded.metadata,
                 bytes,
                 std::move(settings),
                 decode_seconds,
                 std::move(lines)};
}

}  // namespace

Result<Subject, Failure> decode_subject(const std::string& input, const Capture& capture,
                                        const SubjectOptions& given) {
  if (given.frames) {
    SLF_TRY(Subject subject, decode_frame_of(*given.frames, given, input));
    SLF_CHECK(require_view_maps(subject.field, input));
    return subject;
  }
  SLF_TRY(auto stream, read_input(input, given.limits));
  SLF_TRY(Subject subject, is_igc(stream) ? decode_igc_file(given, input, capture, stream)
                                          : decode_slf(given, input, std::move(stream)));
  SLF_CHECK(require_view_maps(subject.field, input));
  return subject;
}

Result<std::shared_ptr<FrameStream>, Failure> open_frames(const std::string& input,
                                                          const LimitOptions& limits,
                                                          const CommonOptions& common) {
  SLF_TRY(StreamFile file, read_stream(input, limits, common));
  auto frames = std::make_shared<FrameStream>();
  SLF_CHECK(open_in(*frames, input, std::move(file), limits, common));
  return frames;
}

DrawPicture pictures_of(Gaussians gaussians) {
  RenderSettings over_black;
  over_black.background = {0, 0, 0};
  over_black.threads = 1;
  const auto kept = std::make_shared<const Gaussians>(std::move(gaussians));
  const auto renderer = std::make_shared<const GaussianRenderer>(*kept, over_black);
  return [kept, renderer](const Camera& camera) { return renderer->render(camera); };
}

Result<SplatSubject, Failure> read_splat_subject(const std::string& input,
                                                 const LimitOptions& limits,
                                                 const CommonOptions& common) {
  Stopwatch watch;
  SLF_TRY(GaussianFile file, read_splat_file("eval", input, {}, limits, common));
  SplatSubject out;
  out.subject.points = file.gaussians.size();
  out.subject.decode_seconds = {{"threads", 1}, {"total", watch.lap()}};
  std::error_code ignored;
  out.subject.bytes = std::filesystem::file_size(input, ignored);
  out.subject.settings = {{"format", file.format}, {"degree", file.gaussians.degree}};
  out.subject.bytes_text = "";
  out.draw = pictures_of(std::move(file.gaussians));
  return out;
}

}  // namespace slf::tools
