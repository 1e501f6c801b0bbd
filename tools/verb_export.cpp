// SPDX-License-Identifier: Apache-2.0
// slf export: a light field for programs that do not know .slf.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "slf/splats.h"
#include "tools/dump.h"
#include "tools/frame_source.h"
#include "tools/options.h"
#include "tools/output.h"
#include "tools/splat_input.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

const std::map<std::string, SplatFormat> kExportFormats{{".ply", SplatFormat::kPly},
                                                        {".glb", SplatFormat::kGlb},
                                                        {".spz", SplatFormat::kSpz},
                                                        {".sog", SplatFormat::kSog}};

struct ExportOptions {
  std::string input, output, format, axes = "auto";
  int spz_version = 0;  // 0: 2 of light fields, 3 of splats
  bool mean = false;
  SplatSettings splats;
  bool degree_given = false, size_given = false;
  PartOptions part;
  LimitOptions limits;
  CommonOptions common;
};

SplatFormat spz_of(int version) {
  if (version == 4) return SplatFormat::kSpz4;
  return version == 3 ? SplatFormat::kSpz3 : SplatFormat::kSpz;
}

/// ".ply": by --format, else by the name.
std::string extension_of(const ExportOptions& given) {
  return given.format.empty() ? small_extension(given.output) : "." + given.format;
}

std::optional<SplatFormat> format_of(const ExportOptions& given) {
  const auto found = kExportFormats.find(extension_of(given));
  if (found == kExportFormats.end()) return std::nullopt;
  return found->second == SplatFormat::kSpz ? spz_of(given.spz_version) : found->second;
}

SplatSettings splat_settings(const ExportOptions& given, SplatFormat format) {
  SplatSettings settings = given.splats;
  settings.threads = given.common.threads;
  if (given.axes == "world") settings.axes = SplatAxes::kWorld;
  if (given.axes == "y-up") settings.axes = SplatAxes::kYUp;
  if (given.axes == "y-down") settings.axes = SplatAxes::kYDown;
  if (given.axes == "auto") settings.axes = axes_of(format);
  return settings;
}

/// null for what no number can say: nothing is lost.
nlohmann::ordered_json decibels(double psnr) {
  return std::isfinite(psnr) ? nlohmann::ordered_json(psnr) : nlohmann::ordered_json(nullptr);
}

void warn_of_origin(const Vec3& origin) {
  if (origin != Vec3{0, 0, 0})
    warn(text("positions are from %.17g, %.17g, %.17g of the world, since floats cannot hold them",
              origin[0], origin[1], origin[2]),
         false);
}

Outcome report_splats(const ExportOptions& given, const SplatCloud& splats, std::size_t bytes,
                      const SplatLoss& loss, bool partial) {
  const double each = static_cast<double>(bytes) / static_cast<double>(splats.size());
  if (given.common.json)
    return print(
        nlohmann::ordered_json{{"splats", splats.size()},
                               {"degree", splats.degree},
                               {"bytes", bytes},
                               {"bytes_per_splat", each},
                               {"origin", splats.origin},
                               {"psnr", decibels(loss.psnr)},
                               {"channel_psnr",
                                {decibels(loss.channel_psnr[0]), decibels(loss.channel_psnr[1]),
                                 decibels(loss.channel_psnr[2])}},
                               {"psnr_one_colour", decibels(loss.psnr_one_colour)},
                               {"partial", partial}});
  if (given.common.quiet) return Done{};
  std::fprintf(
      stderr,
      "%s splats, %s bytes (%.1f each); colours over directions: PSNR %.2f dB with harmonics "
      "up to degree %d, %.2f dB with one colour a point%s\n",
      grouped(splats.size()).c_str(), grouped(bytes).c_str(), each, loss.psnr, splats.degree,
      loss.psnr_one_colour, partial ? "; PARTIAL" : "");
  warn_of_origin(splats.origin);
  return Done{};
}

/// The same file as slf decode writes.
Outcome export_points(const ExportOptions& given) {
  PartOptions part = given.part;
  part.means_only = true;
  SLF_TRY(const DecodedFile decoded, decode_file(given.input, part, given.limits, given.common));
  SLF_CHECK(require_view_maps(decoded.field, given.input));
  SLF_CHECK(require_cloud_grid(decoded.field, given.input));
  SLF_CHECK(save(given.output, mean_cloud(decoded.field, given.common.threads)));
  if (given.common.json)
    return print(nlohmann::ordered_json{{"points", decoded.field.num_points()},
                                        {"partial", decoded.field.partial}});
  if (!given.common.quiet)
    std::fprintf(stderr, "%s points with their mean colour%s\n",
                 grouped(decoded.field.num_points()).c_str(),
                 decoded.field.partial ? ", PARTIAL" : "");
  return Done{};
}

/// Splats in another format. Their turns are any, which SPZ 3 holds better.
Outcome convert_splats(const ExportOptions& given, GaussianFile file, SplatFormat format) {
  if (given.mean || given.axes != "auto" || given.size_given)
    return Failure{kUsage, "export: --mean, --axes and --size are for light fields, and " +
                               given.input + " holds splats"};
  if (given.degree_given) keep_degree(file.gaussians, given.splats.degree);
  if (format == SplatFormat::kSpz && given.spz_version == 0) format = SplatFormat::kSpz3;
  const std::size_t count = file.gaussians.size();
  const int degree = file.gaussians.degree;
  const Vec3 origin = file.gaussians.origin;
  SLF_TRY(const auto bytes, from(given.input, gaussian_file(std::move(file.gaussians), format,
                                                            given.common.threads)));
  SLF_CHECK(save(given.output, bytes.data(), bytes.size()));
  const double each = static_cast<double>(bytes.size()) / static_cast<double>(count);
  if (given.common.json)
    return print(nlohmann::ordered_json{{"input_format", file.format},
                                        {"splats", count},
                                        {"origin", origin},
                                        {"left_out", file.left_out},
                                        {"mended", file.mended},
                                        {"degree", degree},
                                        {"bytes", bytes.size()},
                                        {"bytes_per_splat", each}});
  if (given.common.quiet) return Done{};
  std::fprintf(stderr, "%s splats of %s, %s bytes (%.1f each)\n", grouped(count).c_str(),
               file.format.c_str(), grouped(bytes.size()).c_str(), each);
  warn_of_origin(origin);
  return Done{};
}

/// Fitting harmonics takes more than decoding: some 33 us of one core a point.
Outcome check_work(const ExportOptions& given, std::uint64_t points) {
  constexpr std::uint64_t kStepsOfPoint = 3300;  // of DecodeLimits::max_work
  const std::uint64_t most = given.limits.limits.max_work;
  if (points <= most / kStepsOfPoint) return Done{};
  return Failure{kLimitExceeded, input_name(given.input) + ": splats of its " + grouped(points) +
                                     " points take " + grouped(points * kStepsOfPoint) +
                                     " steps, more than the " + grouped(most) + " of --max-work"};
}

Outcome export_splats(const ExportOptions& given, SplatFormat format) {
  const std::string name = input_name(given.input);
  SLF_TRY(const DecodedFile decoded,
          decode_file(given.input, given.part, given.limits, given.common));
  SLF_CHECK(require_view_maps(decoded.field, given.input));
  if (decoded.field.num_points() == 0 && !given.part.frames.empty()) {
    warn(text("%s: frame %d has no points, and no file", name.c_str(), given.part.frame),
         given.common.quiet);
    return Done{};
  }
  SLF_CHECK(check_work(given, decoded.field.num_points()));
  if (has_gaussians(decoded.field.header)) {
    SLF_TRY(Gaussians gaussians, from(name, gaussians_of(decoded.field, given.common.threads)));
    return convert_splats(given, {std::move(gaussians), "slf"}, format);
  }
  const ViewMaps maps(decoded.field, given.common.threads);
  SLF_TRY(const SplatCloud splats, from(name, make_splats(maps, splat_settings(given, format))));
  SLF_TRY(const auto bytes, from(name, splat_file(splats, format, given.common.threads)));
  SLF_CHECK(save(given.output, bytes.data(), bytes.size()));
  if (given.common.quiet && !given.common.json) return Done{};
  return report_splats(
      given, splats, bytes.size(),
      splat_loss(maps, as_stored(splats, format, given.common.threads), given.common.threads),
      decoded.field.partial);
}

Outcome run_export(const ExportOptions& given) {
  const auto format = format_of(given);
  if (!format)
    return Failure{kUsage, "export: --output " + given.output +
                               " ends in none of .ply, .glb, .spz, .sog, and there is no --format"};
  if (given.mean && *format != SplatFormat::kPly)
    return Failure{kUsage, "export: --mean writes points, as PLY alone"};
  if (given.spz_version != 0 && *format != spz_of(given.spz_version))
    return Failure{kUsage, "export: --spz-version is for .spz, and " + given.output + " is none"};
  if (given.common.json && given.output == "-")
    return Failure{kUsage, "export: --json and --output - both want standard output"};
  const std::string extension = extension_of(given);
  const auto by = given.format.empty() ? FormatBy::kName : FormatBy::kOption;
  SLF_CHECK(check_output(given.output, "export", std::array{extension.c_str()}, by));
  if (is_splat_file(given.input)) {
    SLF_TRY(GaussianFile file,
            read_splat_file("export", given.input, given.part, given.limits, given.common));
    return convert_splats(given, std::move(file), *format);
  }
  return given.mean ? export_points(given) : export_splats(given, *format);
}

}  // namespace

void add_export(CLI::App& program, Run& run) {
  auto* verb = program.add_subcommand(
      "export",
      "Write Gaussian splats (PLY, glTF, SPZ, SOG) or coloured points for other programs");
  auto o = std::make_shared<ExportOptions>();
  verb->add_option("FILE", o->input,
                   "The .slf file, or Gaussian splats (PLY, SPZ, SOG, splat, ksplat, glTF); - is a "
                   ".slf on standard input")
      ->type_name("")
      ->required();
  verb->add_option("-o,--output", o->output,
                   "y.ply (3-D Gaussian splatting), y.glb (KHR_gaussian_splatting), y.spz or y.sog "
                   "(PlayCanvas); - is standard output")
      ->type_name("FILE")
      ->required();
  verb->add_option("--format", o->format, "In place of the name's extension")
      ->type_name("")
      ->check(CLI::IsMember({"ply", "glb", "spz", "sog"}));
  verb->add_option("--spz-version", o->spz_version,
                   "2 (every reader knows it), 3 (finer turns) or 4 (zstd); default 2 of light "
                   "fields, 3 of splats")
      ->type_name("")
      ->check(whole_range(2, 4));
  verb->add_option("--degree", o->splats.degree, "Degree of the harmonics")
      ->capture_default_str()
      ->check(whole_range(0, 3));
  auto* size =
      verb->add_option("--size", o->splats.size,
                       "Standard deviation of a splat, in distances between neighbouring points")
          ->capture_default_str()
          ->check(range(0.1, 4));
  auto* axes =
      verb->add_option("--axes", o->axes,
                       "auto: y down in PLY and SOG, y up in the others; world: as in the .slf")
          ->type_name("")
          ->capture_default_str()
          ->check(CLI::IsMember({"auto", "world", "y-up", "y-down"}));
  verb->add_flag("--mean", o->mean,
                 "PLY of points with the colour averaged over all directions, not of splats; world "
                 "axes, as slf decode writes it")
      ->excludes(size)
      ->excludes(axes)
      ->excludes(verb->get_option("--degree"));
  add_part(*verb, o->part);
  add_frames_to_show(*verb, o->part);
  add_limits(*verb, o->limits);
  add_threads(*verb, o->common);
  add_quiet(*verb, o->common);
  add_json(*verb, o->common);
  verb->callback([&run, o, verb] {
    o->degree_given = verb->count("--degree") > 0;
    o->size_given = verb->count("--size") > 0;
    run = [o] {
      return for_each_frame("export", o->format.empty() ? ".ply" : "." + o->format, o->output,
                            o->part, [&] { return run_export(*o); });
    };
  });
}

}  // namespace slf::tools
