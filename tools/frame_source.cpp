// SPDX-License-Identifier: Apache-2.0
#include "tools/frame_source.h"

#include <algorithm>

#include "slf/frame_inputs.h"
#include "slf/plenoptic.h"
#include "tools/output.h"
#include "tools/text.h"

namespace slf::tools {

namespace {

std::vector<std::uint8_t> bytes_of(const FrameInfo& frame,
                                   const std::vector<std::uint8_t>& stream) {
  const auto first = stream.begin() + static_cast<std::ptrdiff_t>(frame.offset);
  return {first, first + static_cast<std::ptrdiff_t>(frame.bytes)};
}

Outcome open(FrameSource& source, const std::string& file, const PartOptions& part,
             const LimitOptions& given, const CommonOptions& common) {
  if (source.decoder) return Done{};
  const std::string name = input_name(file);
  SLF_TRY(source.stream, read_stream(file, given, common));
  const DecodeOptions options = decode_options(source.stream.info, part, given, common);
  if (options.max_bytes > 0)
    return Failure{kUsage, name + ": --max-bytes and frames do not go together"};
  SLF_TRY(source.decoder, from(name, FrameDecoder::open(source.stream.bytes, options)));
  return Done{};
}

}  // namespace

Result<DecodedFile, Failure> decode_frame(const std::string& file, const PartOptions& part,
                                          const LimitOptions& given, const CommonOptions& common) {
  const std::string name = input_name(file);
  const auto source = part.source ? part.source : std::make_shared<FrameSource>();
  SLF_CHECK(open(*source, file, part, given, common));
  const std::size_t count = source->decoder->frames().size(),
                    frame = static_cast<std::size_t>(part.frame);
  if (const std::size_t last = std::max(frame, source->last); last >= count)
    return no_such_frame(name, last, count);
  Stopwatch watch;
  auto field = source->decoder->decode(frame);
  if (!field)
    return decode_failure(file, field.error(), source->stream,
                          decode_options(source->stream.info, part, given, common));
  DecodedFile decoded{*std::move(field), source->stream.bytes.size(), watch.lap(),
                      source->stream.info.metadata};
  if (is_plenoptic(decoded.metadata))
    decoded.stream = bytes_of(source->decoder->frames()[frame], source->stream.bytes);
  return decoded;
}

Result<std::string, Failure> all_frames(const std::string& file, PartOptions& part,
                                        const LimitOptions& given, const CommonOptions& common) {
  part.source = std::make_shared<FrameSource>();
  SLF_CHECK(open(*part.source, file, part, given, common));
  return "0:" + std::to_string(part.source->decoder->frames().size() - 1);
}

Outcome for_each_frame(const char* verb, const std::string& extension, std::string& output,
                       PartOptions& part, const std::function<Outcome()>& run) {
  if (part.frames.empty()) return run();
  SLF_TRY(const FrameRange range, from("--frames", parse_frame_range(part.frames)));
  const std::string pattern = output;
  if (pattern.empty())
    return Failure{kUsage, std::string(verb) +
                               ": --frames writes a file of each: it needs --output "
                               "with %d in its name (--frame N is one)"};
  if (numbered(pattern, 0, extension) == pattern)
    return Failure{kUsage, std::string(verb) + ": --output " + pattern +
                               " has no %d for the number of a frame"};
  if (!part.source) part.source = std::make_shared<FrameSource>();
  part.source->last = range.last;
  for (std::uint32_t f = range.first; f <= range.last; ++f) {
    part.frame = static_cast<int>(f);
    output = numbered(pattern, part.frame, extension);
    SLF_CHECK(run());
  }
  return Done{};
}

std::vector<double> times_of_last(const PartOptions& part, std::size_t count) {
  if (!part.source || !part.source->decoder) return {};
  const std::vector<FrameInfo>& frames = part.source->decoder->frames();
  const auto last = static_cast<std::size_t>(part.frame);
  if (count > last + 1) return {};
  std::vector<double> times;
  for (std::size_t f = last + 1 - count; f <= last; ++f) times.push_back(frames[f].time);
  return times;
}

nlohmann::ordered_json frame_json(const FrameInfo& f, const std::optional<std::uint64_t>& points) {
  nlohmann::ordered_json json = {
      {"number", f.number}, {"time", f.time},   {"predicted", f.predicted}, {"reference", nullptr},
      {"offset", f.offset}, {"bytes", f.bytes}, {"points", nullptr}};
  if (f.predicted) json["reference"] = f.number - 1;
  if (points) json["points"] = *points;
  return json;
}

std::string frames_text(const std::vector<FrameInfo>& frames) {
  if (frames.size() < 2) return {};
  std::uint64_t predicted = 0, bytes = 0;
  for (const FrameInfo& f : frames) {
    predicted += f.predicted;
    bytes += f.predicted ? f.bytes : 0;
  }
  return text("  frames        %s in %.3f s, %s of them predicted in %s bytes; the first:\n",
              grouped(frames.size()).c_str(), frames.back().time - frames.front().time,
              grouped(predicted).c_str(), grouped(bytes).c_str());
}

std::string frame_table_text(const std::vector<FrameInfo>& frames, const PointsOfFrames& points) {
  if (frames.size() < 2) return {};
  std::string out =
      "\nframes\n      number        time  kind       reference        bytes      points\n";
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameInfo& f = frames[i];
    out += text("%12u %11.3f  %-9s %10s %12s %11s\n", f.number, f.time,
                f.predicted ? "predicted" : "intra",
                f.predicted ? std::to_string(f.number - 1).c_str() : "-", grouped(f.bytes).c_str(),
                points[i] ? grouped(*points[i]).c_str() : "-");
  }
  return out;
}

}  // namespace slf::tools
