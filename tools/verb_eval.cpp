// slf eval: quality of a file against its capture, by the one definition of slf/evaluate.h.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "slf/evaluate.h"
#include "tools/describe.h"
#include "tools/options.h"
#include "tools/progress.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

struct EvalOptions {
  std::string input, capture, points, split;
  bool split_given = false, no_images = false;
  EvaluateSettings settings;
  std::optional<double> min_psnr;
  CommonOptions common;
};

/// One set of cameras and what was measured on it.
struct Measured {
  std::string name;  ///< "input", "held out"
  std::size_t cameras = 0;
  Quality quality;
};

std::string metadata_value(const StreamInfo& info, const std::string& key) {
  for (const auto& [name, value] : info.metadata)
    if (name == key) return value;
  return {};
}

nlohmann::ordered_json quality_json(const Measured& m, bool images) {
  nlohmann::ordered_json json = {{"cameras", m.cameras},
                                 {"point_psnr", m.quality.point_psnr},
                                 {"channel_psnr", m.quality.channel_psnr},
                                 {"observations", m.quality.observations}};
  if (!images) return json;
  json["image_psnr"] = m.quality.image_psnr;
  json["coverage"] = m.quality.coverage;
  json["image_psnr_each"] = m.quality.image_psnr_each;
  return json;
}

std::string quality_text(const Measured& m, bool images) {
  std::string out = text("  %-9s %4zu cameras   point PSNR %6.2f dB (R %.2f, G %.2f, B %.2f)",
                         m.name.c_str(), m.cameras, m.quality.point_psnr, m.quality.channel_psnr[0],
                         m.quality.channel_psnr[1], m.quality.channel_psnr[2]);
  if (images)
    out += text("   image PSNR %6.2f dB, coverage %.2f %%", m.quality.image_psnr,
                100 * m.quality.coverage);
  return out + "\n";
}

Outcome report(const EvalOptions& given, const StreamInfo& info, std::uint64_t bytes,
               const std::vector<Measured>& measured, double seconds) {
  const bool images = given.settings.images;
  if (given.common.json) {
    nlohmann::ordered_json json;
    json["bytes"] = bytes;
    json["points"] = info.num_points;
    json["bits_per_point"] = bits_per_point(bytes, info.num_points);
    json["bytes_by_type"] = bytes_by_type_json(info);
    json["delta"] = given.settings.delta_degrees;
    json["input"] = quality_json(measured[0], images);
    if (measured.size() > 1) json["held_out"] = quality_json(measured[1], images);
    json["seconds"] = seconds;
    return print(json);
  }
  std::string out = text(
      "%s: %s bytes, %s points, %.2f bits per point\n\nquality, delta %g degrees\n",
      input_name(given.input).c_str(), grouped(bytes).c_str(), grouped(info.num_points).c_str(),
      bits_per_point(bytes, info.num_points), given.settings.delta_degrees);
  for (const Measured& m : measured) out += quality_text(m, images);
  return print(out + "\n" + bytes_by_type_text(info, bytes));
}

/// The floor of --min-psnr, on the held-out cameras, else on the input.
Outcome check_floor(const EvalOptions& given, const std::vector<Measured>& measured) {
  if (!given.min_psnr) return Done{};
  const Measured& judged = measured.back();
  if (judged.quality.point_psnr >= *given.min_psnr) return Done{};
  return Failure{kQualityFailed,
                 text("%s: point PSNR %.2f dB (%s) is below %g dB", input_name(given.input).c_str(),
                      judged.quality.point_psnr, judged.name.c_str(), *given.min_psnr)};
}

Result<std::vector<Measured>, Failure> measure(const EvalOptions& given, const StreamInfo& info,
                                               const LightField& field) {
  CaptureOptions options;
  options.points = given.points;
  SLF_TRY(const Capture capture, from(given.capture, load_capture(given.capture, options)));
  warn(capture.warnings, given.common.quiet);
  if (capture.cameras.empty())
    return Failure{kInputInvalid, given.capture + ": has no cameras to compare with"};
  const std::string split = given.split_given ? given.split : metadata_value(info, "split");
  SLF_TRY(const std::vector<int> input, from(given.capture, split_cameras(capture, split)));
  SLF_TRY(std::vector<int> held_out, from(given.capture, split_cameras(capture, "evaluation")));
  const std::size_t all = held_out.size();
  std::erase_if(held_out,
                [&](int i) { return std::find(input.begin(), input.end(), i) != input.end(); });
  if (held_out.size() < all)
    warn(std::to_string(all - held_out.size()) +
             " evaluation images were input and are not held out",
         given.common.quiet);

  EvaluateSettings settings = given.settings;
  settings.threads = given.common.threads;
  ProgressLine line(given.common.quiet);
  const ViewMaps maps(field, settings.threads);
  std::vector<Measured> measured;
  const std::vector<int>& judged = held_out;
  for (const std::vector<int>* cameras : {&input, &judged}) {
    if (cameras->empty()) continue;
    SLF_TRY(Quality quality,
            from(given.capture, evaluate(maps, capture, *cameras, settings, line.callback())));
    measured.push_back(
        {cameras == &input ? "input" : "held out", cameras->size(), std::move(quality)});
  }
  return measured;
}

Outcome run_eval(const EvalOptions& given) {
  SLF_TRY(const auto stream, from(input_name(given.input), read_file(given.input)));
  SLF_TRY(const StreamInfo info, from(input_name(given.input), read_info(stream)));
  DecodeOptions options;
  options.threads = given.common.threads;
  SLF_TRY(const LightField field, from(input_name(given.input), decode(stream, options)));
  SLF_CHECK(require_view_maps(field, given.input));
  Stopwatch watch;
  SLF_TRY(const auto measured, measure(given, info, field));
  SLF_CHECK(report(given, info, stream.size(), measured, watch.lap()));
  return check_floor(given, measured);
}

}  // namespace

void add_eval(CLI::App& program, Run& run) {
  auto* verb =
      program.add_subcommand("eval", "Measure a file against the capture it was made from");
  auto o = std::make_shared<EvalOptions>();
  verb->add_option("FILE", o->input, "The .slf file; - is standard input")
      ->type_name("")
      ->required();
  verb->add_option("CAPTURE", o->capture, "The capture (see slf encode --help)")
      ->type_name("")
      ->required();
  verb->add_option("--points", o->points, "PLY cloud to use in place of the capture's own")
      ->type_name("FILE");
  verb->add_option("--split", o->split,
                   "Input images; default: what the file says it was made from")
      ->type_name("NAME")
      ->each([o = o.get()](const std::string&) { o->split_given = true; });
  verb->add_option("--delta-eval", o->settings.delta_degrees,
                   "A view is judged up to 90 - DELTA degrees from the normal; degrees")
      ->capture_default_str()
      ->check(range(0, 90));
  verb->add_option("--depth-tolerance", o->settings.depth_tolerance,
                   "Hidden if deeper than the depth buffer by more, in point spacings")
      ->capture_default_str()
      ->check(range(0, 1000));
  verb->add_flag("--no-images", o->no_images, "Point PSNR alone: render no images");
  verb->add_option("--min-psnr", o->min_psnr,
                   "Exit with code 8 if the held-out point PSNR is below; dB")
      ->check(range(0, 1000));
  add_threads(*verb, o->common);
  add_quiet(*verb, o->common);
  add_json(*verb, o->common);
  verb->callback([&run, o] {
    o->settings.images = !o->no_images;
    run = [o] { return run_eval(*o); };
  });
}

}  // namespace slf::tools
