// SPDX-License-Identifier: Apache-2.0
// slf igc: photographs by a video codec and points by ours, for comparison. Paper IV-F.
#include <array>
#include <memory>

#include "tools/capture_input.h"
#include "tools/choices.h"
#include "tools/describe.h"
#include "tools/encode_options.h"
#include "tools/output.h"
#include "tools/progress.h"
#include "tools/rd/igc/igc.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

struct IgcOptions {
  EncodeOptions encode;
  IgcSettings igc;  ///< its slf comes from `encode`
};

nlohmann::ordered_json settings_json(const IgcSettings& s, int grid_bits) {
  nlohmann::ordered_json json;
  json["codec"] = igc_codec_name(s.codec);
  json["qp"] = s.qp;
  json["chroma"] = s.chroma == IgcChroma::k420 ? "420" : "444";
  json["speed"] = s.speed.empty() ? "default" : s.speed;
  json["preset"] = s.slf.preset == Preset::kPaper ? "paper" : "default";
  json["grid_bits"] = grid_bits;
  json["functions"] = s.slf.fit.basis.num_functions();
  json["lambda"] = s.slf.fit.lambda;
  json["beta"] = s.slf.fit.beta;
  json["iterations"] = s.slf.fit.iterations;
  json["penalise_dc"] = s.slf.fit.penalise_dc;
  return json;
}

nlohmann::ordered_json igc_json(const IgcEncoded& e, const CaptureInput& input,
                                const IgcSettings& settings) {
  nlohmann::ordered_json json;
  json["bytes"] = e.stream.size();
  json["grid"] = density_json(e.grid, e.density);
  json["points"] = e.points;
  json["surface"] = surface_json(e.surface);
  json["cameras"] = input.cameras.size();
  json["bytes_by_type"] = {{"geometry", e.bytes_geometry},
                           {"images", e.bytes_images},
                           {"parameters", e.bytes_parameters}};
  json["seconds"] = {{"load", input.seconds},
                     {"surface", e.surface.seconds()},
                     {"voxelise", e.seconds_voxelise},
                     {"geometry", e.seconds_geometry},
                     {"images", e.seconds_images},
                     {"total", input.seconds + e.surface.seconds() + e.seconds_voxelise +
                                   e.seconds_geometry + e.seconds_images}};
  json["peak_memory_mib"] = peak_memory_mib();
  json["settings"] = settings_json(settings, e.grid.bits);
  return json;
}

std::string igc_text(const IgcEncoded& e, const CaptureInput& input) {
  std::string out = surface_text(e.surface) + density_text(e.grid, e.density);
  out +=
      text("points        %s (%s merged)\n", grouped(e.points).c_str(), grouped(e.merged).c_str());
  out += text("cameras       %zu\n", input.cameras.size());
  out += text("seconds       load %.2f, voxelise %.2f, geometry %.2f, images %.2f\n", input.seconds,
              e.seconds_voxelise, e.seconds_geometry, e.seconds_images);
  out += text("peak memory   %.0f MiB\n", peak_memory_mib());
  out += text("file          %s bytes: geometry %s, images %s, parameters %s\n",
              grouped(e.stream.size()).c_str(), grouped(e.bytes_geometry).c_str(),
              grouped(e.bytes_images).c_str(), grouped(e.bytes_parameters).c_str());
  return out;
}

Outcome run_igc(const IgcOptions& given) {
  const EncodeOptions& options = given.encode;
  if (options.common.json && options.output == "-")
    return Failure{kUsage, "igc: --json and --output - both want standard output"};
  IgcSettings settings = given.igc;
  SLF_TRY(settings.slf, resolved(options));
  SLF_CHECK(check_output(options.output, "igc", std::array{".igc"}));
  ProgressLine line(options.common.quiet);
  SLF_TRY(const CaptureInput input, load_input(options, line));
  settings.slf.metadata.insert(settings.slf.metadata.begin(), input.metadata.begin(),
                               input.metadata.end());
  SLF_TRY(const IgcEncoded encoded, from(options.capture, encode_igc(input.capture, input.cameras,
                                                                     settings, line.callback())));
  line.clear();
  SLF_CHECK(save(options.output, encoded.stream.data(), encoded.stream.size()));
  if (options.common.json) return print(igc_json(encoded, input, settings));
  if (!options.common.quiet) std::fputs(igc_text(encoded, input).c_str(), stderr);
  return Done{};
}

}  // namespace

void add_igc(CLI::App& program, Run& run) {
  auto* verb = program.add_subcommand(
      "igc", "Image-plus-geometry coding, to compare with: photographs by a video codec");
  auto o = std::make_shared<IgcOptions>();
  o->encode.verb = "igc";
  add_igc_options(*verb, o->encode);
  const auto images = [](CLI::Option* option) { option->group("Images (paper IV-F)"); };
  images(add_igc_codec_choice(*verb, o->igc.codec));
  images(verb->add_option("--qp", o->igc.qp, "HEVC: QP, 0 to 51; AV1: quality level, 0 to 63")
             ->capture_default_str()
             ->check(whole_range(0, 63)));
  images(add_igc_chroma_choice(*verb, o->igc.chroma));
  images(verb->add_option("--speed", o->igc.speed,
                          "HEVC: x265 preset, ultrafast to veryslow; AV1: 0 (slow) to 8")
             ->type_name("NAME")
             ->default_str("medium, 4"));
  verb->callback([&run, o] { run = [o] { return run_igc(*o); }; });
}

}  // namespace slf::tools
