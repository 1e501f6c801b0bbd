// SPDX-License-Identifier: Apache-2.0
// slf eval: quality of a file against its capture, by the one definition of slf/evaluate.h.
#include <memory>

#include "slf/frame_inputs.h"
#include "tools/eval_capture.h"
#include "tools/eval_subject.h"
#include "tools/output.h"
#include "tools/plenoptic_quality.h"
#include "tools/splat_input.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

/// A frame of a file against one cloud.
Outcome eval_frame_of_views(EvalOptions given) {
  SLF_TRY(given.frames, open_frames(given.input, given.limits, given.common));
  const std::size_t count = given.frames->decoder->frames().size();
  if (static_cast<std::size_t>(given.frame) >= count || !given.range.empty())
    return Failure{kUsage, input_name(given.input) + ": has " + std::to_string(count) +
                               " frames, from 0 on; of one cloud --frame N measures one"};
  if (!is_plenoptic(given.frames->file.info.metadata))
    return Failure{kInputInvalid, input_name(given.input) + ": was not made of plenoptic clouds, " +
                                      given.capture + " is one"};
  FrameInput cloud;
  cloud.number = static_cast<std::uint32_t>(given.frame);
  cloud.path = given.capture;
  return eval_plenoptic_frames(given, {FrameKind::kClouds, {cloud}});
}

Outcome run_eval(const EvalOptions& given) {
  if (given.frame >= 0 && is_splat_file(given.input))
    return Failure{kUsage, "eval: --frame is of a .slf, and " + given.input + " is none"};
  if (given.frame >= 0 && !holds_frames(given.capture) && count_plenoptic_views(given.capture) > 0)
    return eval_frame_of_views(given);
  if (small_extension(given.capture) == ".ply" && count_plenoptic_views(given.capture) > 0)
    return eval_plenoptic_file({given.input, given.capture, given.limits, given.common});
  if (!given.range.empty() || holds_frames(given.capture)) return eval_frames(given);
  return eval_capture(given);
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

void add_frames_to_judge(CLI::App& verb, EvalOptions& o) {
  verb.add_option("--frame", o.frame,
                  "Frame to measure of a file of several, from 0 on, by its own capture and bytes")
      ->type_name("N")
      ->check(whole_range(0, (std::int64_t{1} << 31) - 1));
  verb.add_option("--frames", o.range,
                  "Numbers of the captures that the frames of a file are measured against, of a "
                  "directory or a pattern as slf encode takes it; default: all")
      ->type_name("A:B");
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
  add_frames_to_judge(*verb, *o);
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
