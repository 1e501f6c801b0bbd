// SPDX-License-Identifier: Apache-2.0
// slf eval of a sequence: each frame against its capture, and the mean over frames.
#include <algorithm>
#include <cmath>
#include <utility>

#include "slf/frame_inputs.h"
#include "tools/describe.h"
#include "tools/eval_capture.h"
#include "tools/frame_places.h"
#include "tools/output.h"
#include "tools/plenoptic_quality.h"
#include "tools/progress.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

using Qualities = std::vector<const Quality*>;

/// Mean of a number over frames; of those where it is one.
template <class Number>
double mean_over(const Qualities& all, const Number& number) {
  double sum = 0, count = 0;
  for (const Quality* q : all) {
    const double value = number(*q);
    if (std::isnan(value)) continue;
    sum += value;
    ++count;
  }
  return count > 0 ? sum / count : std::nan("");
}

PointQuality mean_points(const Qualities& all, std::size_t delta) {
  const auto mean = [&](auto number) {
    return mean_over(all, [&](const Quality& q) { return double(number(q.points[delta])); });
  };
  PointQuality out;
  out.delta_degrees = all.front()->points[delta].delta_degrees;
  out.psnr = mean([](const PointQuality& p) { return p.psnr; });
  out.luma_psnr = mean([](const PointQuality& p) { return p.luma_psnr; });
  for (std::size_t c = 0; c < 3; ++c)
    out.channel_psnr[c] = mean([c](const PointQuality& p) { return p.channel_psnr[c]; });
  out.observations = static_cast<std::uint64_t>(
      std::llround(mean([](const PointQuality& p) { return p.observations; })));
  return out;
}

template <class Part>
PictureQuality mean_picture(const Qualities& all, const Part& part) {
  return {mean_over(all, [&](const Quality& q) { return part(q.image).psnr; }),
          mean_over(all, [&](const Quality& q) { return part(q.image).ssim; }),
          mean_over(all, [&](const Quality& q) { return part(q.image).ms_ssim; })};
}

PictureRegion mean_region(const Qualities& all, PictureRegion ImageQuality::*region) {
  const auto mean = [&](double PictureRegion::*number) {
    return mean_over(all, [&](const Quality& q) { return q.image.*region.*number; });
  };
  return {mean(&PictureRegion::psnr), mean(&PictureRegion::pixel_share),
          mean(&PictureRegion::error_share)};
}

ImageQuality mean_image(const Qualities& all) {
  const auto mean = [&](double ImageQuality::*number) {
    return mean_over(all, [&](const Quality& q) { return q.image.*number; });
  };
  ImageQuality out;
  static_cast<PictureQuality&>(out) =
      mean_picture(all, [](const ImageQuality& q) -> const PictureQuality& { return q; });
  out.all = mean_picture(all, [](const ImageQuality& q) -> const PictureQuality& { return q.all; });
  out.coverage = mean(&ImageQuality::coverage);
  out.uncovered_error_share = mean(&ImageQuality::uncovered_error_share);
  out.outside_error_share = mean(&ImageQuality::outside_error_share);
  out.off_pixels = mean(&ImageQuality::off_pixels);
  out.grazing = mean_region(all, &ImageQuality::grazing);
  out.rim = mean_region(all, &ImageQuality::rim);
  out.rest = mean_region(all, &ImageQuality::rest);
  for (std::size_t i = 0; i < all.front()->image.psnr_each.size(); ++i)
    out.psnr_each.push_back(mean_over(all, [i](const Quality& q) {
      return i < q.image.psnr_each.size() ? q.image.psnr_each[i] : std::nan("");
    }));
  return out;
}

Quality mean_quality(const Qualities& all) {
  Quality out;
  for (std::size_t d = 0; d < all.front()->points.size(); ++d)
    out.points.push_back(mean_points(all, d));
  out.image = mean_image(all);
  out.render_seconds = mean_over(all, [](const Quality& q) { return q.render_seconds; });
  return out;
}

struct JudgedFrame {
  std::uint32_t number = 0;  ///< of its capture
  std::string name;
  Judged judged;  ///< without its light field
};

/// What all frames say together: means over those with points, of the cameras that each names.
std::vector<Measured> mean_measured(const std::vector<JudgedFrame>& frames) {
  std::vector<Measured> means;
  for (const char* name : {"input", "held out"}) {
    Measured mean;
    Qualities coded, unquantised;
    for (const JudgedFrame& frame : frames)
      for (const Measured& m : frame.judged.measured) {
        if (m.name != name) continue;
        mean.name = name;
        mean.cameras = m.cameras;
        coded.push_back(&m.quality);
        if (m.unquantised) unquantised.push_back(&*m.unquantised);
      }
    if (coded.empty()) continue;
    mean.quality = mean_quality(coded);
    if (!unquantised.empty()) mean.unquantised = mean_quality(unquantised);
    means.push_back(std::move(mean));
  }
  return means;
}

Subject subject_of_all(const std::vector<JudgedFrame>& frames, std::uint64_t bytes) {
  Subject all;
  all.bytes = bytes;
  all.settings = frames.front().judged.subject.settings;
  all.decode_seconds = frames.front().judged.subject.decode_seconds;
  for (const char* stage : {"geometry", "coefficients", "total"}) {
    double seconds = 0;
    for (const JudgedFrame& frame : frames)
      seconds += frame.judged.subject.decode_seconds[stage].get<double>();
    all.decode_seconds[stage] = seconds;
  }
  for (const JudgedFrame& frame : frames) {
    all.points += frame.judged.subject.num_points();
    all.field.partial = all.field.partial || frame.judged.subject.field.partial;
  }
  return all;
}

nlohmann::ordered_json sequence_json(const std::vector<JudgedFrame>& frames, const Subject& all,
                                     const std::vector<Measured>& means, bool images,
                                     double seconds) {
  nlohmann::ordered_json json = eval_json(all, means, images, seconds);
  json.erase("bytes_by_type");
  for (const JudgedFrame& frame : frames) {
    const auto& [subject, measured, taken] = frame.judged;
    nlohmann::ordered_json one = {{"number", frame.number}, {"input_name", frame.name}};
    if (measured.empty()) {
      one.update({{"bytes", subject.bytes}, {"points", 0}});
    } else {
      one.update(eval_json(subject, measured, images, taken));
      one.erase("bytes_by_type");
      one.erase("settings");
    }
    json["frames"].push_back(std::move(one));
  }
  return json;
}

std::string line_of(const JudgedFrame& frame, bool images) {
  const Subject& subject = frame.judged.subject;
  std::string out = text("  %-16s %12s %11s", frame.name.c_str(), grouped(subject.bytes).c_str(),
                         grouped(subject.num_points()).c_str());
  if (frame.judged.measured.empty()) return out + "   no points\n";
  const Quality& q = frame.judged.measured.back().quality;
  if (!q.points.empty()) out += "   " + psnr_text(q.points[0].psnr);
  if (images) out += "   " + psnr_text(q.image.psnr) + text("   %.4f", q.image.ssim);
  return out + "\n";
}

std::string sequence_text(const std::string& name, const std::vector<JudgedFrame>& frames,
                          const Subject& all, const std::vector<Measured>& means, bool images) {
  std::string out =
      text("%s: %zu frames, %s bytes, %s points, %.2f bits per point\n\n", name.c_str(),
           frames.size(), grouped(all.bytes).c_str(), grouped(all.num_points()).c_str(),
           bits_per_point(all.bytes, all.num_points()));
  out += text("each, %s\n  %-16s %12s %11s   points%s\n", means.back().name.c_str(), "frame",
              "bytes", "points", images ? "       images       SSIM" : "");
  for (const JudgedFrame& frame : frames) out += line_of(frame, images);
  out += "\nmean over frames\n";
  for (const Measured& m : means) out += quality_text(m, images);
  return out;
}

/// Options of one frame: it alone is spoken of from now on.
Result<EvalOptions, Failure> options_of(const EvalOptions& given, const FrameInput& frame,
                                        std::size_t place) {
  EvalOptions own = given;
  own.capture = frame.path.string();
  own.input_frame = frame;
  own.frame = static_cast<int>(place);
  own.points = file_of_frame(given.points, frame);
  SLF_TRY(own.images, images_of_frame(given.images, frame));
  if (!given.error_maps.empty()) own.error_maps = inside(given.error_maps, frame.name());
  return own;
}

Outcome check_counts(const EvalOptions& given, const FrameInputs& inputs, std::size_t frames) {
  if (inputs.frames.size() == frames) return Done{};
  return Failure{kUsage,
                 input_name(given.input) + " has " + std::to_string(frames) + " frames, and " +
                     given.capture + " " + std::to_string(inputs.frames.size()) +
                     ": --frames A:B says which of these it was made from; --frame 0 with " +
                     inputs.frames.front().path.string() + " measures one alone"};
}

Result<std::vector<JudgedFrame>, Failure> judge_all(const EvalOptions& given,
                                                    const FrameInputs& inputs) {
  ProgressLine line(given.common.quiet);
  const Progress progress = line.callback();
  std::vector<JudgedFrame> frames;
  const std::size_t count = inputs.frames.size();
  for (std::size_t f = 0; f < count; ++f) {
    SLF_TRY(EvalOptions own, options_of(given, inputs.frames[f], f));
    own.common.quiet = given.common.quiet || f > 0;  // warnings of one capture are those of all
    if (progress) progress("frames", static_cast<double>(f) / static_cast<double>(count));
    SLF_TRY(Judged judged, judge_capture(own));
    const LightField field = std::exchange(judged.subject.field, {});
    judged.subject.points = std::max(judged.subject.points, field.num_points());
    judged.subject.field.partial = field.partial;
    frames.push_back({inputs.frames[f].number, inputs.frames[f].name(), std::move(judged)});
  }
  line.clear();
  return frames;
}

}  // namespace

Outcome eval_frames(const EvalOptions& options) {
  EvalOptions given = options;
  std::optional<FrameRange> range;
  if (!given.range.empty()) {
    SLF_TRY(range, from("--frames", parse_frame_range(given.range)));
  }
  SLF_TRY(const FrameInputs inputs, from(given.capture, list_frames(given.capture, range)));
  if (inputs.kind == FrameKind::kSplats)
    return Failure{kUsage, "eval: frames are measured against captures, and those of " +
                               given.capture + " are splats"};
  SLF_TRY(given.frames, open_frames(given.input, given.limits, given.common));
  if (!given.unquantised.empty()) {
    SLF_TRY(given.unquantised_frames, open_frames(given.unquantised, given.limits, given.common));
  }
  const std::size_t count = given.frames->decoder->frames().size();
  SLF_CHECK(check_counts(given, inputs, count));
  const bool of_views = is_plenoptic(given.frames->file.info.metadata);
  if (of_views && inputs.kind != FrameKind::kClouds)
    return Failure{kUsage, input_name(given.input) + ": was made of plenoptic clouds, and " +
                               given.capture + " has none"};
  if (given.frame >= 0) {
    const auto place = static_cast<std::size_t>(given.frame);
    if (place >= count) return no_such_frame(input_name(given.input), place, count);
    if (of_views) return eval_plenoptic_frames(given, {inputs.kind, {inputs.frames[place]}});
    SLF_TRY(const EvalOptions own, options_of(given, inputs.frames[place], place));
    return eval_capture(own);
  }
  if (of_views) return eval_plenoptic_frames(given, inputs);
  Stopwatch watch;
  SLF_TRY(const std::vector<JudgedFrame> frames, judge_all(given, inputs));
  const std::vector<Measured> means = mean_measured(frames);
  if (means.empty())
    return Failure{kInputInvalid, input_name(given.input) + ": no frame has points to measure"};
  const Subject all = subject_of_all(frames, given.frames->file.bytes.size());
  const bool images = given.settings.images;
  SLF_CHECK(given.common.json
                ? print(sequence_json(frames, all, means, images, watch.lap()))
                : print(sequence_text(input_name(given.input), frames, all, means, images)));
  return check_floors(given, means);
}

}  // namespace slf::tools
