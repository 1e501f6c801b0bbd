// SPDX-License-Identifier: Apache-2.0
// slf eval: quality of a file against its capture, by the one definition of slf/evaluate.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include "slf/evaluate.h"
#include "slf/frame_inputs.h"
#include "tools/choices.h"
#include "tools/eval_report.h"
#include "tools/eval_subject.h"
#include "tools/measure_file.h"
#include "tools/options.h"
#include "tools/output.h"
#include "tools/plenoptic_options.h"
#include "tools/progress.h"
#include "tools/splat_input.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

struct EvalOptions {
  std::string input, capture, points, images, split, unquantised, error_maps;
  std::optional<WorldChange> world;
  int frame = -1;  ///< of a file of several
  bool split_given = false, no_images = false, estimate_normals = false;
  EvaluateSettings settings;
  std::optional<double> min_psnr, min_image_psnr;
  LimitOptions limits;
  CommonOptions common;

  SubjectOptions decode() const { return {limits, common, frame, estimate_normals}; }
};

std::string metadata_value(const Metadata& metadata, const std::string& key) {
  for (const auto& [name, value] : metadata)
    if (name == key) return value;
  return {};
}

Outcome report_measured(const EvalOptions& given, const Subject& subject,
                        const std::vector<Measured>& measured, double seconds) {
  const bool images = given.settings.images;
  if (given.common.json) return print(eval_json(subject, measured, images, seconds));
  return print(eval_text(input_name(given.input), subject, measured, images));
}

/// A frame without points has nothing to measure.
Outcome report_empty(const EvalOptions& given, const Subject& subject) {
  if (given.common.json)
    return print(nlohmann::ordered_json{{"points", 0}, {"bytes", subject.bytes}});
  return print(input_name(given.input) + ": the frame has no points, nothing is measured\n");
}

/// The floors of --min-psnr and --min-image-psnr, on the held-out cameras, else on the input.
Outcome check_floors(const EvalOptions& given, const std::vector<Measured>& measured) {
  const Measured& judged = measured.back();
  const auto check = [&](const char* what, double psnr, std::optional<double> floor) -> Outcome {
    if (!floor || psnr >= *floor) return Done{};
    return Failure{kQualityFailed,
                   text("%s: %s PSNR %.2f dB (%s) is below %g dB", input_name(given.input).c_str(),
                        what, psnr, judged.name.c_str(), *floor)};
  };
  if (given.min_psnr) SLF_CHECK(check("point", judged.quality.points[0].psnr, given.min_psnr));
  return check("image", judged.quality.image.psnr, given.min_image_psnr);
}

Result<Capture, Failure> read_capture(const EvalOptions& given) {
  CaptureOptions options;
  options.points = given.points;
  options.world = given.world;
  options.points_needed = false;
  options.may_be_empty = true;
  options.images = given.images;
  SLF_TRY(Capture capture, from(given.capture, load_capture(given.capture, options)));
  warn(capture.warnings, given.common.quiet);
  if (capture.cameras.empty())
    return Failure{kInputInvalid, given.capture + ": has no cameras to compare with"};
  return capture;
}

/// What a set of cameras says of a file.
using Judge = std::function<Result<Quality, InputError>(
    std::span<const int> cameras, const EvaluateSettings& settings, const Progress& progress)>;

Judge judge_of(const ViewMaps& maps, const Capture& capture) {
  return [&](std::span<const int> cameras, const EvaluateSettings& settings,
             const Progress& progress) {
    return evaluate(maps, capture, cameras, settings, progress);
  };
}

/// The images that a file was made from: of its split, or the one that is asked for, without those
/// that the encoder dropped as of something else.
Result<std::vector<int>, Failure> input_of(const EvalOptions& given, const Capture& capture,
                                           const Metadata& metadata) {
  const std::string split = given.split_given ? given.split : metadata_value(metadata, "split");
  SLF_TRY(std::vector<int> input, from(given.capture, split_cameras(capture, split)));
  if (given.split_given) return input;
  std::istringstream dropped(metadata_value(metadata, "cameras_dropped"));
  for (int camera = 0; dropped >> camera;) std::erase(input, camera);
  return input;
}

/// @param metadata     of the file
/// @param unquantised  or none
Result<std::vector<Measured>, Failure> measure(const EvalOptions& given, const Capture& capture,
                                               const Metadata& metadata, const Judge& judge,
                                               const Judge& unquantised) {
  SLF_TRY(std::vector<int> input, input_of(given, capture, metadata));
  SLF_TRY(std::vector<int> held_out, from(given.capture, split_cameras(capture, "evaluation")));
  const std::size_t all = held_out.size();
  std::erase_if(held_out,
                [&](int i) { return std::find(input.begin(), input.end(), i) != input.end(); });
  if (held_out.size() < all)
    warn(std::to_string(all - held_out.size()) +
             " evaluation images were input and are not held out",
         given.common.quiet);

  for (auto& [which, cameras] : {std::pair{"input", &input}, std::pair{"held-out", &held_out}})
    if (const auto w = leave_out_empty(capture, which, given.common.threads, *cameras); !w.empty())
      warn(w, given.common.quiet);
  EvaluateSettings settings = given.settings;
  settings.threads = given.common.threads;
  ProgressLine line(given.common.quiet);
  std::vector<Measured> measured;
  for (const std::vector<int>* cameras :
       std::array<const std::vector<int>*, 2>{&input, &held_out}) {
    if (cameras->empty()) continue;
    Measured& m = measured.emplace_back();
    m.name = cameras == &input ? "input" : "held out";
    m.cameras = cameras->size();
    settings.error_map = error_map_writer(given.error_maps, capture);
    SLF_TRY(m.quality, from(given.capture, judge(*cameras, settings, line.callback())));
    if (!unquantised) continue;
    settings.error_map = {};
    SLF_TRY(m.unquantised, from(given.capture, unquantised(*cameras, settings, line.callback())));
  }
  if (measured.empty())
    return Failure{kInputInvalid, given.capture + ": its splits have no images to compare with"};
  return measured;
}

/// Splats: pictures alone.
Outcome eval_splats(const EvalOptions& given, const Capture& capture, const SplatSubject& splats) {
  if (given.no_images || given.min_psnr || !given.unquantised.empty())
    return Failure{kUsage,
                   "eval: --no-images, --min-psnr and --unquantised are for light fields, "
                   "and " +
                       given.input + " holds splats"};
  const Judge judge = [&](std::span<const int> cameras, const EvaluateSettings& settings,
                          const Progress& progress) {
    return evaluate_pictures(splats.draw, capture, cameras, settings, progress);
  };
  Stopwatch watch;
  SLF_TRY(const auto measured, measure(given, capture, splats.subject.metadata, judge, {}));
  SLF_CHECK(report_measured(given, splats.subject, measured, watch.lap()));
  return check_floors(given, measured);
}

/// A directory of frames holds a capture for each.
Outcome check_one_capture(const EvalOptions& given) {
  if (!holds_frames(given.capture)) return Done{};
  const auto inputs = list_frames(given.capture);
  const std::string first = inputs ? inputs->frames.front().path.string() : given.capture + "/...";
  return Failure{kUsage, "eval: " + given.capture +
                             " holds frames, of which one is measured at a time: --frame 0 with " +
                             first + ", and on"};
}

Outcome run_eval(const EvalOptions& given) {
  if (small_extension(given.capture) == ".ply" && count_plenoptic_views(given.capture) > 0)
    return eval_plenoptic_file({given.input, given.capture, given.limits, given.common});
  SLF_CHECK(check_one_capture(given));
  if (!given.error_maps.empty()) SLF_CHECK(make_directory(given.error_maps));
  SLF_TRY(Capture capture, read_capture(given));
  if (is_splat_file(given.input)) {
    SLF_TRY(const SplatSubject splats, read_splat_subject(given.input, given.limits, given.common));
    return eval_splats(given, capture, splats);
  }
  SLF_TRY(Subject subject, decode_subject(given.input, capture, given.decode()));
  if (subject.field.num_points() == 0) return report_empty(given, subject);
  if (capture.cloud.positions.empty()) {
    warn(given.capture + ": no points: judged on the file's own", given.common.quiet);
    capture = with_points_of(subject.field, std::move(capture), given.common.threads);
  }
  if (has_gaussians(subject.field.header)) {
    SLF_TRY(Gaussians gaussians,
            from(input_name(given.input), gaussians_of(subject.field, given.common.threads)));
    subject.splats = gaussians.size();
    return eval_splats(given, capture, {std::move(subject), pictures_of(std::move(gaussians))});
  }
  const ViewMaps maps(subject.field, given.common.threads);
  std::optional<Subject> unquantised;
  std::optional<ViewMaps> unquantised_maps;
  if (!given.unquantised.empty()) {
    SLF_TRY(unquantised, decode_subject(given.unquantised, capture, given.decode()));
    unquantised_maps.emplace(unquantised->field, given.common.threads);
  }
  Stopwatch watch;
  SLF_TRY(const auto measured,
          measure(given, capture, subject.metadata, judge_of(maps, capture),
                  unquantised_maps ? judge_of(*unquantised_maps, capture) : Judge{}));
  SLF_CHECK(report_measured(given, subject, measured, watch.lap()));
  return check_floors(given, measured);
}

void add_inputs(CLI::App& verb, EvalOptions& o) {
  verb.add_option("FILE", o.input, "A .slf or .igc, - of standard input; or Gaussian splats")
      ->type_name("")
      ->required();
  verb.add_option("CAPTURE", o.capture, "The capture (slf encode --help), or the plenoptic cloud")
      ->type_name("")
      ->required();
  verb.add_flag("--match-exposure", o.settings.match_exposure,
                "Give each rendering its photograph's exposure first; points stay as they are");
  verb.add_flag("--align-cameras", o.settings.align_cameras,
                "Move each picture onto its photograph first, by 4 pixels at most");
}

}  // namespace

void add_eval(CLI::App& program, Run& run) {
  auto* verb =
      program.add_subcommand("eval", "Measure a file against the capture it was made from");
  auto o = std::make_shared<EvalOptions>();
  add_inputs(*verb, *o);
  add_points(*verb, o->points, o->world);
  verb->add_option("--images", o->images,
                   "Folder of the photographs, where they are not where the capture says")
      ->type_name("DIR");
  verb->add_option("--split", o->split,
                   "Input images; default: what the file says it was made from")
      ->type_name("NAME")
      ->each([o = o.get()](const std::string&) { o->split_given = true; });
  verb->add_option("--delta-eval", o->settings.deltas_degrees,
                   "Views up to 90 - DELTA degrees from the normal are judged, once for each DELTA "
                   "of a list; degrees")
      ->type_name("DELTA,...")
      ->delimiter(',')
      ->capture_default_str()
      ->check(range(0, 90));
  verb->add_option("--depth-tolerance", o->settings.depth_tolerance,
                   "Hidden if deeper than the depth buffer by more, in point spacings")
      ->capture_default_str()
      ->check(range(0, 1000));
  verb->add_option("--frame", o->frame,
                   "Frame to measure of a file of several, from 0 on, by its own capture and bytes")
      ->type_name("N")
      ->check(whole_range(0, (std::int64_t{1} << 31) - 1));
  verb->add_flag("--estimate-normals", o->estimate_normals,
                 "An .igc file: normals from its points; default: the capture's, as a gift");
  auto* no_images =
      verb->add_flag("--no-images", o->no_images, "Point PSNR alone: render no images");
  verb->add_option("--unquantised", o->unquantised,
                   "The same capture encoded with the same settings and a tiny Q (-q 0.05): tells "
                   "what is lost to points, splatting, quantisation and coverage apart")
      ->type_name("FILE");
  verb->add_option("--error-map", o->error_maps,
                   "Directory, made if it is missing: a PNG of each image, photograph, rendering, "
                   "and 128 + 4 times their difference")
      ->type_name("DIR")
      ->excludes(no_images);
  verb->add_option("--min-psnr", o->min_psnr,
                   "Exit with code 8 if the held-out point PSNR (of the first DELTA) is below; dB")
      ->check(range(0, 1000));
  verb->add_option("--min-image-psnr", o->min_image_psnr,
                   "The same of the image PSNR, where both show the object; dB")
      ->check(range(0, 1000))
      ->excludes(no_images);
  add_limits(*verb, o->limits);
  add_threads(*verb, o->common);
  add_quiet(*verb, o->common);
  verb->get_option("--quiet")->description("No progress, no warnings; the report is the result");
  add_json(*verb, o->common);
  verb->callback([&run, o] {
    o->settings.images = !o->no_images;
    run = [o] { return run_eval(*o); };
  });
}

}  // namespace slf::tools
