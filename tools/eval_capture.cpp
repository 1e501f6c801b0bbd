// SPDX-License-Identifier: Apache-2.0
#include "tools/eval_capture.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <sstream>
#include <utility>

#include "slf/input_cameras.h"
#include "tools/measure_file.h"
#include "tools/output.h"
#include "tools/progress.h"
#include "tools/splat_input.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

std::string metadata_value(const Metadata& metadata, const std::string& key) {
  for (const auto& [name, value] : metadata)
    if (name == key) return value;
  return {};
}

Result<Capture, Failure> read_capture(const EvalOptions& given) {
  CaptureOptions options;
  options.points = given.points;
  options.world = given.world;
  options.points_needed = false;
  options.may_be_empty = true;
  options.images = given.images;
  SLF_TRY(Capture capture,
          from(given.capture, given.input_frame ? load_frame(*given.input_frame, options)
                                                : load_capture(given.capture, options)));
  warn(capture.warnings, given.common.quiet);
  if (capture.cameras.empty())
    return Failure{kInputInvalid, given.capture + ": has no cameras to compare with"};
  return capture;
}

/// DIR/NUMBER_NAME.png of every camera's error map; the folders of its name become part of the
/// file's, and its extension is left out.
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

/// What a set of cameras says of a file.
using Judge = std::function<Result<Quality, InputError>(
    std::span<const int> cameras, const EvaluateSettings& settings, const Progress& progress)>;

Judge judge_of(const ViewMaps& maps, const Capture& capture) {
  return [&](std::span<const int> cameras, const EvaluateSettings& settings,
             const Progress& progress) {
    return evaluate(maps, capture, cameras, settings, progress);
  };
}

/// The images that a file was made from: of its split, without those that the encoder dropped as of
/// something else.
Result<std::vector<int>, Failure> input_of(const EvalOptions& given, const Capture& capture,
                                           const Metadata& metadata) {
  const std::string split = metadata_value(metadata, "split");
  SLF_TRY(std::vector<int> input, from(given.capture, split_cameras(capture, split)));
  std::istringstream dropped(metadata_value(metadata, "cameras_dropped"));
  for (int camera = 0; dropped >> camera;) std::erase(input, camera);
  return input;
}

/// @param metadata     of the file
/// @param unquantised  or none
Result<std::vector<Measured>, Failure> measure(const EvalOptions& given, const Capture& capture,
                                               const Metadata& metadata, const Judge& judge,
                                               const Judge& unquantised) {
  SLF_TRY(std::vector<int> held_out, from(given.capture, split_cameras(capture, "evaluation")));
  const auto erase_those_of = [&](const std::vector<int>& some) {
    return std::erase_if(
        held_out, [&](int i) { return std::find(some.begin(), some.end(), i) != some.end(); });
  };
  std::vector<int> input;
  if (given.split_given) {
    SLF_TRY(input, from(given.capture, split_cameras(capture, given.split)));
    erase_those_of(input);
  } else {
    SLF_TRY(input, input_of(given, capture, metadata));
    if (const std::size_t known = erase_those_of(input); known > 0)
      warn(std::to_string(known) + " evaluation images were input and are not held out",
           given.common.quiet);
  }

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
Result<Judged, Failure> judge_splats(const EvalOptions& given, const Capture& capture,
                                     SplatSubject splats) {
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
  SLF_TRY(auto measured, measure(given, capture, splats.subject.metadata, judge, {}));
  return Judged{std::move(splats.subject), std::move(measured), watch.lap()};
}

}  // namespace

Result<Judged, Failure> judge_capture(const EvalOptions& given) {
  if (!given.error_maps.empty()) SLF_CHECK(make_directory(given.error_maps));
  SLF_TRY(Capture capture, read_capture(given));
  if (is_splat_file(given.input)) {
    SLF_TRY(SplatSubject splats, read_splat_subject(given.input, given.limits, given.common));
    return judge_splats(given, capture, std::move(splats));
  }
  SLF_TRY(Subject subject, decode_subject(given.input, capture, given.decode()));
  if (subject.field.num_points() == 0) return Judged{std::move(subject), {}, 0};
  if (capture.cloud.positions.empty()) {
    warn(given.capture + ": no points: judged on the file's own", given.common.quiet);
    capture = with_points_of(subject.field, std::move(capture), given.common.threads);
  }
  if (has_gaussians(subject.field.header)) {
    SLF_TRY(Gaussians gaussians,
            from(input_name(given.input), gaussians_of(subject.field, given.common.threads)));
    subject.points = gaussians.size();
    return judge_splats(given, capture, {std::move(subject), pictures_of(std::move(gaussians))});
  }
  const ViewMaps maps(subject.field, given.common.threads);
  std::optional<Subject> unquantised;
  std::optional<ViewMaps> unquantised_maps;
  if (!given.unquantised.empty()) {
    SLF_TRY(unquantised, decode_subject(given.unquantised, capture, given.decode_unquantised()));
    unquantised_maps.emplace(unquantised->field, given.common.threads);
  }
  Stopwatch watch;
  SLF_TRY(auto measured,
          measure(given, capture, subject.metadata, judge_of(maps, capture),
                  unquantised_maps ? judge_of(*unquantised_maps, capture) : Judge{}));
  return Judged{std::move(subject), std::move(measured), watch.lap()};
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

Outcome eval_capture(const EvalOptions& given) {
  SLF_TRY(const Judged judged, judge_capture(given));
  const bool images = given.settings.images;
  const auto& [subject, measured, seconds] = judged;
  const std::string name = input_name(given.input);
  if (measured.empty()) {
    if (given.common.json)
      return print(nlohmann::ordered_json{{"points", 0}, {"bytes", subject.bytes}});
    return print(name + ": the frame has no points, nothing is measured\n");
  }
  SLF_CHECK(given.common.json ? print(eval_json(subject, measured, images, seconds))
                              : print(eval_text(name, subject, measured, images)));
  return check_floors(given, measured);
}

}  // namespace slf::tools
