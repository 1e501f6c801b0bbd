// SPDX-License-Identifier: Apache-2.0
// slf encode: photographs and points, or a coloured cloud, to an .slf file.
#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "tools/capture_input.h"
#include "tools/describe.h"
#include "tools/describe_exposure.h"
#include "tools/encode_frames.h"
#include "tools/encode_options.h"
#include "tools/encode_splats.h"
#include "tools/interrupt.h"
#include "tools/measure_file.h"
#include "tools/output.h"
#include "tools/plenoptic_options.h"
#include "tools/progress.h"
#include "tools/scene_options.h"
#include "tools/splat_input.h"
#include "tools/spooled_input.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

/// The input cameras that do not count as they are.
nlohmann::ordered_json camera_check_json(const Encoded& e, const Capture& capture) {
  auto json = nlohmann::ordered_json::array();
  for (const CameraTrust& t : e.cameras)
    if (t.verdict != CameraVerdict::kKept)
      json.push_back({{"image", capture.cameras[std::size_t(t.camera)].name},
                      {"verdict", t.verdict == CameraVerdict::kDropped ? "dropped" : "gain"},
                      {"gain", t.gain},
                      {"agreement", t.agreement},
                      {"peer_agreement", t.peer_agreement},
                      {"reason", reason_of(t)}});
  return json;
}

/// Where the step came from.
nlohmann::ordered_json step_json(const ChosenStep& step) {
  const bool chosen = step.origin == ChosenStep::kChosen;
  nlohmann::ordered_json json = {{"chosen", chosen}, {"reason", reason_of(step)}};
  if (chosen)
    json.update({{"loss", step.loss},
                 {"held_out_psnr", step.held_out},
                 {"cameras", step.cameras},
                 {"points", step.points}});
  return json;
}

nlohmann::ordered_json report_json(const Encoded& e, const StreamInfo& info,
                                   const CaptureInput& input, const FilePictures& pictures) {
  const std::size_t cameras = input.cameras.size();
  const double load = input.seconds;
  nlohmann::ordered_json json;
  json["bytes"] = e.stream.size();
  json["q"] = e.q;
  if (info.coefficient_coder == "texture") json["q"] = nullptr;  // --texture-qp has its place
  json["quality"] = step_json(e.step);
  json["grid"] = density_json(e.grid, e.density);
  json["points"] = e.points;
  json["merged"] = e.merged;
  json["surface"] = surface_json(e.surface);
  json["bits_per_point"] = bits_per_point(e.stream.size(), e.points);
  json["bytes_by_type"] = bytes_by_type_json(info, e.stream.size());
  json["cameras"] = cameras;
  json["exposure"] = exposure_json(e.exposure);
  json["poses"] = poses_json(e.poses);
  json["camera_check"] = camera_check_json(e, input.capture);
  json["observations"] = e.observations;
  json["unobserved_points"] = e.unobserved_points;
  json["pictures"] = nullptr;
  if (cameras > 0)
    json["pictures"] = {{"psnr", pictures.psnr},
                        {"cameras", pictures.cameras},
                        {"off_pixels", pictures.off_pixels}};
  if (e.fit.settings.pictures.rounds > 0)
    json["pictures"].update({{"psnr_before", e.pictures.psnr_before},
                             {"psnr_after", e.pictures.psnr_after},
                             {"pull", e.pictures.pull},
                             {"held_out_before", e.pictures.held_out_before},
                             {"held_out_after", e.pictures.held_out_after}});
  json["seconds"] = {
      {"load", load},
      {"exposure", e.exposure.seconds},
      {"poses", e.poses.seconds},
      {"surface", e.surface.seconds()},
      {"voxelise", e.seconds_voxelise},
      {"observe", e.seconds_observe},
      {"choose", e.seconds_choose},
      {"fit", e.seconds_fit},
      {"pictures", e.seconds_pictures},
      {"quality", e.step.seconds},
      {"code", e.seconds_code},
      {"measure", pictures.seconds},
      {"total", load + e.exposure.seconds + e.poses.seconds + e.surface.seconds() +
                    e.seconds_voxelise + e.seconds_observe + e.seconds_choose + e.seconds_fit +
                    e.seconds_pictures + e.step.seconds + e.seconds_code}};
  json["peak_memory_mib"] = peak_memory_mib();
  json["settings"] = settings_json(info);
  std::vector<std::string> warnings = input.capture.warnings;
  warnings.insert(warnings.end(), e.warnings.begin(), e.warnings.end());
  json["warnings"] = std::move(warnings);
  return json;
}

std::string report_text(const Encoded& e, const CaptureInput& input, const FilePictures& pictures) {
  const std::size_t cameras = input.cameras.size(), all = input.capture.cameras.size();
  const double load = input.seconds;
  const auto percent = [](std::size_t part, std::size_t whole) {
    return 100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(whole, 1));
  };
  std::string out = exposure_text(e.exposure) + poses_text(e.poses) + surface_text(e.surface) +
                    density_text(e.grid, e.density);
  out +=
      text("points        %s (%s merged)\n", grouped(e.points).c_str(), grouped(e.merged).c_str());
  if (cameras > 0) {
    const std::size_t used = used_cameras(e, input.cameras).size();
    out += text("cameras       %zu", used);
    if (used < all) out += text(" of the capture's %zu", all);
    if (used < cameras) out += text(", %zu dropped", cameras - used);
    out += "\n";
    if (e.observations > 0)
      out += text("observations  %s (%.1f per point; %.1f %% of points unseen)\n",
                  grouped(e.observations).c_str(), percent(e.observations, e.points) / 100,
                  percent(e.unobserved_points, e.points));
    out += pictures_text(pictures, e, used);
  }
  if (e.step.origin != ChosenStep::kGiven && e.step.origin != ChosenStep::kTexture)
    out += text("quality       Q %.4g, %s\n", e.q, reason_of(e.step).c_str());
  out += text(
      "seconds       load %.2f, exposure %.2f, surface %.2f, voxelise %.2f, observe %.2f, choose "
      "%.2f, fit %.2f, "
      "pictures %.2f, quality %.2f, code %.2f, measure %.2f\n",
      load, e.exposure.seconds, e.surface.seconds(), e.seconds_voxelise, e.seconds_observe,
      e.seconds_choose, e.seconds_fit, e.seconds_pictures, e.step.seconds, e.seconds_code,
      pictures.seconds);
  out += text("peak memory   %.0f MiB\n", peak_memory_mib());
  out += text("file          %s bytes, %.2f bits per point\n", grouped(e.stream.size()).c_str(),
              bits_per_point(e.stream.size(), e.points));
  return out;
}

/// What a cloud has no use for, whatever its value.
bool is_of_photographs(const std::string& name) {
  if (name == "surface-seconds" || name == "surface-memory") return true;
  if (name == "effort") return false;  // of anything: the presets are told by it
  const auto& settings = encoder_settings();
  return std::any_of(settings.begin(), settings.end(), [&](const SettingInfo& setting) {
    return setting.name == name && setting.frames == SettingInfo::kFramesOfPhotographs &&
           setting.frame_values.empty();
  });
}

/// Points alone cannot be mended or trained.
Outcome check_surface(const EncodeOptions& given, const CaptureInput& input) {
  if (!input.cameras.empty()) return Done{};
  const auto refused = [&](const std::string& option) {
    return Failure{kUsage,
                   "encode: " + option + " is for photographs, and " + given.capture + " has none"};
  };
  if (!given.images.empty()) return refused("--images");
  for (const auto& [name, value] : given.given) {
    if (name == "surface" && value != "given" && value != "auto")
      return refused("--surface " + value);
    if ((name == "match-exposure" || name == "refine-cameras") && value == "on")
      return refused("--" + name + " on");
    if (is_of_photographs(name)) return refused("--" + name);
  }
  return Done{};
}

/// A training that leaves checkpoints is interrupted between two of them, not in one.
Progress interruptible(Progress draw) {
  return [draw = std::move(draw)](const char* stage, double fraction) {
    if (interrupt_pending()) exit_cancelled();
    if (draw) draw(stage, fraction);
  };
}

Outcome run_encode(const EncodeOptions& given, const SceneOptions& scene) {
  if (scene.resume && scene.work.empty())
    return Failure{kUsage, "encode: --resume needs --work, the directory of the earlier run"};
  if (given.common.json && given.output == "-")
    return Failure{kUsage, "encode: --json and --output - both want standard output"};
  SLF_TRY(EncoderSettings settings, resolved(given));
  if (scene.resume && settings.surface_seconds > 0)
    return Failure{kUsage,
                   "encode: --resume: a training of --surface-seconds keeps nothing to go "
                   "on with"};
  settings.work = scene.work;
  settings.resume = scene.resume;
  SLF_CHECK(check_output(given.output, "encode", std::array{".slf"}));
  if (is_splat_file(given.capture)) return encode_splats(given, std::move(settings));
  ProgressLine line(given.common.quiet);
  std::optional<DeferInterrupts> defer;
  if (!scene.work.empty()) defer.emplace();
  const Progress progress = defer ? interruptible(line.callback()) : line.callback();
  SLF_TRY(const CaptureInput input, load_input(given, line, PointsWanted::kOrPhotographs));
  SLF_CHECK(check_surface(given, input));
  settings.metadata.insert(settings.metadata.begin(), input.metadata.begin(), input.metadata.end());
  SLF_TRY(Encoded encoded,
          from(given.capture, encode(input.capture, input.cameras, settings, progress)));
  line.clear();
  warn(encoded.warnings, given.common.quiet);
  SLF_CHECK(save(given.output, encoded.stream.data(), encoded.stream.size()));
  FilePictures pictures;
  if (!input.cameras.empty() && (given.common.json || !given.common.quiet)) {
    Capture matched = input.capture;
    matched.gains = encoded.exposure.gains;
    take_poses(encoded.poses, matched);
    SLF_TRY(pictures, measure_file(encoded, matched, used_cameras(encoded, input.cameras),
                                   given.common.threads));
    const std::vector<std::string> said = picture_warnings(pictures, encoded, settings);
    warn(said, given.common.quiet);
    encoded.warnings.insert(encoded.warnings.end(), said.begin(), said.end());
  }
  if (given.common.json) {
    SLF_TRY(const StreamInfo info, from(given.output, read_info(encoded.stream)));
    return print(report_json(encoded, info, input, pictures));
  }
  if (!given.common.quiet) std::fputs(report_text(encoded, input, pictures).c_str(), stderr);
  return Done{};
}

struct AllOptions {
  EncodeOptions encode;
  SceneOptions scene;
  PlenopticVerbOptions plenoptic;
  FrameOptions frames;
};

/// A file of splats is coded at once.
Outcome check_scene_options(const AllOptions& o) {
  const bool given = o.scene.in_parts() || !o.scene.work.empty();
  if (!given || !is_splat_file(o.encode.capture)) return Done{};
  return Failure{
      kUsage,
      "encode: --memory, --work, --log, --plan, --part and --dry-run are for photographs and "
      "clouds, and " +
          o.encode.capture + " holds splats"};
}

/// By what the capture is.
Outcome encode_any(const AllOptions& o) {
  if (is_frame_input(o.encode, o.frames)) return encode_frame_list(o.encode, o.frames);
  if (!o.frames.given.empty())
    return Failure{kUsage, "encode: " + o.frames.given + " is for frames in time, and " +
                               o.encode.capture + " is one light field"};
  if (is_plenoptic_input(o.encode, o.plenoptic))
    return encode_plenoptic_file(o.encode, o.plenoptic, o.scene.memory);
  if (o.plenoptic.given() && o.plenoptic.as != "colour")
    return Failure{
        kUsage,
        "encode: --as, --views and --hold-out are of plenoptic clouds, and " + o.encode.capture +
            " has no views (docs/plenoptic.md: a PLY with more than one triple of 8-bit colours)"};
  SLF_CHECK(check_scene_options(o));
  return o.scene.in_parts() ? encode_scene(o.encode, o.scene) : run_encode(o.encode, o.scene);
}

}  // namespace

void add_encode(CLI::App& program, Run& run) {
  auto* verb = program.add_subcommand("encode", "From photographs and points to an .slf file");
  auto o = std::make_shared<AllOptions>();
  add_encode_options(*verb, o->encode);
  CLI::Option* capture = verb->get_option("CAPTURE");
  capture->description(capture->get_description() +
                       ", a scan or Gaussian splats; - is a cloud, a scan or splats on standard "
                       "input");
  add_scene(*verb, o->scene);
  add_plenoptic(*verb, o->plenoptic);
  add_frames(*verb, o->frames);
  verb->callback([&run, o, verb] {
    for (const char* option : {"--group", "--rate", "--refit-still"})
      if (verb->count(option) > 0) o->frames.given = option;
    o->frames.options = given_options(*verb);
    run = [o]() -> Outcome {
      o->frames.part = o->scene.part;
      o->frames.plenoptic = o->plenoptic;
      o->frames.dry_run = o->scene.dry_run;
      const auto stream = SpooledInput::stream_of(o->encode.capture);
      if (!stream) return encode_any(*o);
      if (SpooledInput::stream_of(o->encode.points) == stream)
        return Failure{kUsage, "encode: CAPTURE and --points both want standard input"};
      SLF_TRY(const SpooledInput input, SpooledInput::read(*stream));
      o->encode.capture = input.path();
      Outcome done = encode_any(*o);
      if (!done) return Failure{done.error().code, SpooledInput::named(done.error().message)};
      return done;
    };
  });
}

}  // namespace slf::tools
