// SPDX-License-Identifier: Apache-2.0
// slf encode of a plenoptic cloud.
#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "tools/describe.h"
#include "tools/output.h"
#include "tools/plenoptic_options.h"
#include "tools/progress.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

constexpr std::array<std::pair<const char*, PlenopticCoding>, 3> kWays{
    {{"auto", PlenopticCoding::kAuto},
     {"planes", PlenopticCoding::kPlanes},
     {"viewmaps", PlenopticCoding::kViewMaps}}};

PlenopticCoding way_of(const std::string& word) {
  for (const auto& [name, way] : kWays)
    if (word == name) return way;
  return PlenopticCoding::kAuto;
}

/// Options that choose photographs, or a part of a capture.
Outcome check_alone(const EncodeOptions& given) {
  for (const auto& [option, is_given] : {std::pair{"--points", !given.points.empty()},
                                         {"--points-world", given.world.has_value()},
                                         {"--images", !given.images.empty()},
                                         {"--crop", !given.crop.empty()},
                                         {"--split", !given.split.empty()},
                                         {"--crs", !given.crs.empty()}})
    if (is_given)
      return Failure{kUsage, std::string("encode: ") + option + ": " + given.capture +
                                 " is a plenoptic cloud, which has views in place of photographs "
                                 "(--as colour takes red, green, blue alone)"};
  return Done{};
}

struct Run {
  PlenopticCloud cloud;  // without its points
  std::size_t points = 0;
  PlenopticEncoded encoded;
  StreamInfo info;
  double load = 0;
};

nlohmann::ordered_json plenoptic_json(const Run& run) {
  const PlenopticEncoded& e = run.encoded;
  const PlenopticBits bits = plenoptic_bits(run.info, e.stream.size());
  return {{"bytes", e.stream.size()},
          {"points", run.points},
          {"merged", run.cloud.merged},
          {"views", run.cloud.views},
          {"own_colour", run.cloud.own_colour},
          {"as", e.as == PlenopticCoding::kPlanes ? "planes" : "viewmaps"},
          {"reason", e.reason},
          {"exact", e.exact},
          {"q", e.q},
          {"grid_bits", run.cloud.grid.bits},
          {"bits_per_point",
           {{"geometry", bits.geometry}, {"colour", bits.colour}, {"file", bits.file}}},
          {"bytes_by_type", bytes_by_type_json(run.info, e.stream.size())},
          {"correction_bytes", e.rest_bytes},
          {"seconds", {{"load", run.load}, {"fit", e.seconds_fit}, {"code", e.seconds_code}}},
          {"peak_memory_mib", peak_memory_mib()},
          {"settings", settings_json(run.info)}};
}

std::string plenoptic_text(const Run& run) {
  const PlenopticEncoded& e = run.encoded;
  const PlenopticBits bits = plenoptic_bits(run.info, e.stream.size());
  std::string out = text("taken         %s\n", run.cloud.taken.c_str());
  out += text("points        %s (%s merged), %d bits\n", grouped(run.points).c_str(),
              grouped(run.cloud.merged).c_str(), run.cloud.grid.bits);
  out +=
      text("coded as      %s, %s: %s\n", e.as == PlenopticCoding::kPlanes ? "planes" : "view maps",
           e.exact ? "exact" : text("step %.4g", e.q).c_str(), e.reason.c_str());
  out += text("seconds       load %.2f, fit %.2f, code %.2f\n", run.load, e.seconds_fit,
              e.seconds_code);
  out += text("peak memory   %.0f MiB\n", peak_memory_mib());
  out += text("file          %s bytes, %.3f bits per point: geometry %.3f, colour %.3f\n",
              grouped(e.stream.size()).c_str(), bits.file, bits.geometry, bits.colour);
  return out;
}

}  // namespace

PlenopticBits plenoptic_bits(const StreamInfo& info, std::uint64_t bytes) {
  std::uint64_t geometry = 0, colour = 0;
  for (const UnitInfo& unit : info.units) {
    if (unit.type == "geometry") geometry += unit.bytes;
    if (unit.type == "coefficients" || unit.type == "refinement" || unit.type == "transform" ||
        unit.type.rfind("type ", 0) == 0)  // corrections
      colour += unit.bytes;
  }
  return {bits_per_point(geometry, info.num_points), bits_per_point(colour, info.num_points),
          bits_per_point(bytes, info.num_points)};
}

void add_plenoptic(CLI::App& verb, PlenopticVerbOptions& options) {
  const std::string group = "Plenoptic clouds (a PLY with a colour for each view)";
  verb.add_option(
          "--as", options.as,
          "planes: each view a function of its own, exact without -q; viewmaps: functions of "
          "direction, fitted to the views; auto: planes, viewmaps with --hold-out; colour: "
          "red, green, blue alone. The same of frames in time")
      ->type_name("WAY")
      ->check(CLI::IsMember({"auto", "planes", "viewmaps", "colour"}))
      ->capture_default_str()
      ->group(group);
  verb.add_option("--views", options.views,
                  "JSON of the positions of views, [[x,y,z], ...], in units of the cloud; default: "
                  "comment lines \"view 0 X Y Z\" of the PLY")
      ->type_name("FILE")
      ->group(group);
  verb.add_option("--hold-out", options.hold_out,
                  "Views that view maps are not fitted to: slf eval says how they are predicted")
      ->type_name("VIEW,...")
      ->delimiter(',')
      ->check(whole_range(0, static_cast<std::int64_t>(kMostViews) - 1))
      ->group(group);
}

bool is_plenoptic_input(const EncodeOptions& given, const PlenopticVerbOptions& plenoptic) {
  return plenoptic.as != "colour" &&
         (small_extension(given.capture) == ".ply" || plenoptic.given()) &&
         count_plenoptic_views(given.capture) > 0;
}

Result<PlenopticSettings, Failure> plenoptic_settings(const EncodeOptions& given,
                                                      const PlenopticVerbOptions& plenoptic) {
  PlenopticSettings settings;
  SLF_TRY(settings.encoder, resolved(given));
  settings.as = way_of(plenoptic.as);
  // A degree that is asked for is kept.
  if (std::any_of(given.given.begin(), given.given.end(),
                  [](const auto& setting) { return setting.first == "degree"; }))
    settings.memory = 0;
  settings.hold_out = plenoptic.hold_out;
  std::sort(settings.hold_out.begin(), settings.hold_out.end());
  return settings;
}

Outcome encode_plenoptic_file(const EncodeOptions& given, const PlenopticVerbOptions& plenoptic,
                              std::uint64_t memory) {
  if (given.common.json && given.output == "-")
    return Failure{kUsage, "encode: --json and --output - both want standard output"};
  SLF_CHECK(check_alone(given));
  SLF_TRY(PlenopticSettings settings, plenoptic_settings(given, plenoptic));
  settings.most_memory = memory;
  SLF_CHECK(check_output(given.output, "encode", std::array{".slf"}));
  settings.encoder.metadata.insert(
      settings.encoder.metadata.begin(),
      {"source", std::filesystem::path(given.capture).filename().string()});
  ProgressLine line(given.common.quiet);
  Stopwatch watch;
  Run run;
  std::vector<std::string> warnings;
  SLF_TRY(run.cloud,
          from(given.capture,
               read_plenoptic(given.capture, {plenoptic.views, settings.encoder.grid_bits},
                              &warnings)));
  run.load = watch.lap();
  line.clear();
  warn(warnings, given.common.quiet);
  run.points = run.cloud.num_points();
  auto positions = std::exchange(run.cloud.positions, {});
  auto colours = std::exchange(run.cloud.colours, {});
  PlenopticCloud cloud = run.cloud;
  cloud.positions = std::move(positions);
  cloud.colours = std::move(colours);
  SLF_TRY(run.encoded,
          from(given.capture, encode_plenoptic(std::move(cloud), settings, line.callback())));
  line.clear();
  SLF_CHECK(save(given.output, run.encoded.stream.data(), run.encoded.stream.size()));
  SLF_TRY(run.info, from(given.output, read_info(run.encoded.stream, DecodeLimits::none())));
  if (given.common.json) return print(plenoptic_json(run));
  if (!given.common.quiet) std::fputs(plenoptic_text(run).c_str(), stderr);
  return Done{};
}

}  // namespace slf::tools
