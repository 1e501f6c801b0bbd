// slf encode: photographs and points, or a coloured cloud, to an .slf file.
#include <filesystem>
#include <memory>

#include "tools/describe.h"
#include "tools/encode_options.h"
#include "tools/output.h"
#include "tools/progress.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

/// The last component of the path, whatever it ends with; never more, so that no machine's paths
/// get into a file.
std::string last_name(const std::string& path) {
  std::error_code ignored;
  std::filesystem::path full = std::filesystem::weakly_canonical(path, ignored);
  if (ignored) full = path;
  return full.filename().empty() ? full.parent_path().filename().string()
                                 : full.filename().string();
}

nlohmann::ordered_json report_json(const Encoded& e, const StreamInfo& info, std::size_t cameras,
                                   double load) {
  nlohmann::ordered_json json;
  json["bytes"] = e.stream.size();
  json["points"] = e.points;
  json["merged"] = e.merged;
  json["bits_per_point"] = bits_per_point(e.stream.size(), e.points);
  json["bytes_by_type"] = bytes_by_type_json(info);
  json["cameras"] = cameras;
  json["observations"] = e.observations;
  json["unobserved_points"] = e.unobserved_points;
  json["seconds"] = {
      {"load", load},
      {"voxelise", e.seconds_voxelise},
      {"observe", e.seconds_observe},
      {"fit", e.seconds_fit},
      {"code", e.seconds_code},
      {"total", load + e.seconds_voxelise + e.seconds_observe + e.seconds_fit + e.seconds_code}};
  json["peak_memory_mib"] = peak_memory_mib();
  json["settings"] = settings_json(info);
  return json;
}

std::string report_text(const Encoded& e, std::size_t cameras, double load) {
  const auto percent = [](std::size_t part, std::size_t whole) {
    return 100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(whole, 1));
  };
  std::string out;
  out +=
      text("points        %s (%s merged)\n", grouped(e.points).c_str(), grouped(e.merged).c_str());
  if (cameras > 0) {
    out += text("cameras       %zu\n", cameras);
    out += text("observations  %s (%.1f per point; %.1f %% of points unseen)\n",
                grouped(e.observations).c_str(), percent(e.observations, e.points) / 100,
                percent(e.unobserved_points, e.points));
  }
  out += text("seconds       load %.2f, voxelise %.2f, observe %.2f, fit %.2f, code %.2f\n", load,
              e.seconds_voxelise, e.seconds_observe, e.seconds_fit, e.seconds_code);
  out += text("peak memory   %.0f MiB\n", peak_memory_mib());
  out += text("file          %s bytes, %.2f bits per point\n", grouped(e.stream.size()).c_str(),
              bits_per_point(e.stream.size(), e.points));
  return out;
}

Result<std::vector<int>, Failure> input_cameras(const Capture& capture,
                                                const EncodeOptions& given) {
  if (!capture.cameras.empty()) return from(given.capture, split_cameras(capture, given.split));
  if (!given.split.empty())
    return Failure{kUsage, "encode: --split " + given.split + ": the capture has no cameras"};
  return std::vector<int>{};
}

/// What split_cameras made of "".
std::string split_name(const Capture& capture, const std::string& given) {
  if (!given.empty()) return given;
  return capture.splits.count("dense") ? "dense" : "default";
}

Outcome run_encode(const EncodeOptions& given) {
  if (given.common.json && given.output == "-")
    return Failure{kUsage, "encode: --json and --output - both want standard output"};
  SLF_TRY(EncoderSettings settings, resolved(given));
  SLF_CHECK(check_output(given.output));
  ProgressLine line(given.common.quiet);
  const Progress progress = line.callback();
  Stopwatch watch;
  if (progress) progress("load", 0);
  CaptureOptions options;
  options.points = given.points;
  SLF_TRY(Capture capture, from(given.capture, load_capture(given.capture, options)));
  if (given.up_given) capture.up = given.up;
  line.clear();
  warn(capture.warnings, given.common.quiet);
  SLF_TRY(const std::vector<int> cameras, input_cameras(capture, given));
  const double load = watch.lap();
  settings.metadata.insert(settings.metadata.begin(), {"source", last_name(given.capture)});
  if (!cameras.empty())
    settings.metadata.insert(settings.metadata.begin() + 1,
                             {"split", split_name(capture, given.split)});
  SLF_TRY(const Encoded encoded, from(given.capture, encode(capture, cameras, settings, progress)));
  line.clear();
  warn(encoded.warnings, given.common.quiet);
  SLF_CHECK(save(given.output, encoded.stream.data(), encoded.stream.size()));
  if (given.common.json) {
    SLF_TRY(const StreamInfo info, from(given.output, read_info(encoded.stream)));
    return print(report_json(encoded, info, cameras.size(), load));
  }
  if (!given.common.quiet) std::fputs(report_text(encoded, cameras.size(), load).c_str(), stderr);
  return Done{};
}

}  // namespace

void add_encode(CLI::App& program, Run& run) {
  auto* verb = program.add_subcommand("encode", "From photographs and points to an .slf file");
  auto o = std::make_shared<EncodeOptions>();
  add_encode_options(*verb, *o);
  verb->callback([&run, o] { run = [o] { return run_encode(*o); }; });
}

}  // namespace slf::tools
