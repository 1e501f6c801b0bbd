// SPDX-License-Identifier: Apache-2.0
#include "tools/eval_subject.h"

#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include "slf/frames.h"
#include "slf/gaussian_renderer.h"
#include "slf/parallel.h"
#include "tools/choices.h"
#include "tools/describe.h"
#include "tools/output.h"
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

/// @param bytes  receives those of the frame
Result<LightField> frame_of_stream(const StreamFile& stream, int frame,
                                   const DecodeOptions& options, std::uint64_t& bytes) {
  SLF_TRY(FrameDecoder decoder, FrameDecoder::open(stream.bytes, options));
  const auto place = static_cast<std::size_t>(frame);
  if (place < decoder.frames().size()) bytes = decoder.frames()[place].bytes;
  return decoder.decode(place);
}

Result<Subject, Failure> decode_slf(const SubjectOptions& given, const std::string& input,
                                    std::vector<std::uint8_t> bytes) {
  SLF_TRY(const StreamFile stream,
          open_stream(input, std::move(bytes), given.limits, given.common));
  const StreamInfo& info = stream.info;
  if (given.frame < 0 && stream.frames > 1)
    warn(input_name(input) + ": of " + grouped(stream.frames) +
             " frames the first is measured, against the bytes of all (--frame)",
         given.common.quiet);
  if (given.frame >= 0 && static_cast<std::size_t>(given.frame) >= stream.frames)
    return Failure{kUsage, input_name(input) + ": frame " + std::to_string(given.frame) +
                               " is asked for, but it has " + std::to_string(stream.frames) +
                               ", from 0 on"};
  DecodeSeconds seconds;
  DecodeOptions options = decode_options(info, {}, given.limits, given.common);
  options.seconds = &seconds;
  Stopwatch watch;
  std::uint64_t bytes_of_subject = stream.bytes.size();
  auto field = given.frame < 0 ? decode(stream.bytes, options)
                               : frame_of_stream(stream, given.frame, options, bytes_of_subject);
  if (!field) return decode_failure(input, field.error(), stream, options);
  const nlohmann::ordered_json decode_seconds = {{"threads", threads_of(given.common)},
                                                 {"geometry", seconds.geometry},
                                                 {"coefficients", seconds.coefficients},
                                                 {"total", watch.lap()}};
  return Subject{*std::move(field),
                 bytes_of_subject,
                 info.metadata,
                 bytes_by_type_json(info),
                 settings_json(info),
                 decode_seconds,
                 bytes_by_type_text(info, stream.bytes.size())};
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
  SLF_TRY(auto stream, read_input(input, given.limits));
  SLF_TRY(Subject subject, is_igc(stream) ? decode_igc_file(given, input, capture, stream)
                                          : decode_slf(given, input, std::move(stream)));
  SLF_CHECK(require_view_maps(subject.field, input));
  return subject;
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
  out.subject.splats = file.gaussians.size();
  out.subject.decode_seconds = {{"threads", 1}, {"total", watch.lap()}};
  std::error_code ignored;
  out.subject.bytes = std::filesystem::file_size(input, ignored);
  out.subject.settings = {{"format", file.format}, {"degree", file.gaussians.degree}};
  out.subject.bytes_text = "";
  out.draw = pictures_of(std::move(file.gaussians));
  return out;
}

std::function<Result<Done, InputError>(int, const Image&)> error_map_writer(
    const std::string& directory, const Capture& capture) {
  if (directory.empty()) return {};
  return [directory, &capture](int camera, const Image& map) {
    const std::string& image = capture.cameras[std::size_t(camera)].name;
    std::string name = std::filesystem::path(image).replace_extension().string();
    std::replace(name.begin(), name.end(), '/', '_');
    return write_png(inside(directory, text("%04d_", camera) + name + ".png"), map);
  };
}

}  // namespace slf::tools
