// SPDX-License-Identifier: Apache-2.0
// slf eval of plenoptic clouds that are frames in time.
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "slf/plenoptic_frames.h"
#include "tools/describe.h"
#include "tools/eval_subject.h"
#include "tools/plenoptic_quality.h"
#include "tools/progress.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

/// A frame against its cloud.
struct JudgedCloud {
  std::uint32_t number = 0;
  std::string name;
  std::uint64_t bytes = 0;
  std::size_t points = 0;
  std::vector<std::array<double, 3>> psnr = {};  // [groups] means over views; none without points
};

/// Options that are of photographs.
Outcome check_no_photographs(const EvalOptions& given) {
  for (const auto& [option, is_given] : {std::pair{"--points", !given.points.empty()},
                                         {"--points-world", given.world.has_value()},
                                         {"--images", !given.images.empty()},
                                         {"--split", given.split_given},
                                         {"--unquantised", !given.unquantised.empty()},
                                         {"--error-map", !given.error_maps.empty()},
                                         {"--match-exposure", given.settings.match_exposure},
                                         {"--align-cameras", given.settings.align_cameras},
                                         {"--min-psnr", given.min_psnr.has_value()},
                                         {"--min-image-psnr", given.min_image_psnr.has_value()}})
    if (is_given)
      return Failure{kUsage, std::string("eval: ") + option +
                                 " is for photographs, and these frames are clouds of views"};
  return Done{};
}

Result<JudgedCloud, Failure> judge_cloud(const EvalOptions& given, const FrameInput& input,
                                         std::size_t place, const std::vector<ViewGroup>& groups) {
  const std::string name = input_name(given.input), file = input.path.string();
  FrameStream& stream = *given.frames;
  const FrameInfo& info = stream.decoder->frames()[place];
  SLF_TRY(const LightField field, from(name, stream.decoder->decode(place)));
  JudgedCloud judged{input.number, input.name(), info.bytes, field.num_points()};
  if (input.is_empty && field.num_points() == 0) return judged;
  const auto bytes =
      std::span<const std::uint8_t>(stream.file.bytes)
          .subspan(static_cast<std::size_t>(info.offset), static_cast<std::size_t>(info.bytes));
  std::vector<std::string> warnings;
  SLF_TRY(const PlenopticCloud cloud,
          from(name, decode_plenoptic(bytes, field, stream.file.info.metadata, &warnings,
                                      given.common.threads)));
  if (input.is_empty)
    return Failure{kInputInvalid, file + ": has no points, and frame " + std::to_string(place) +
                                      " of " + name + " has"};
  SLF_TRY(PlenopticCloud original, from(file, read_plenoptic(file, {}, nullptr)));
  warn(warnings, given.common.quiet);
  auto placed = on_grid_of_voxels(std::move(original), cloud.grid);
  if (!placed) return Failure{kInputInvalid, file + ": " + placed.error().message};
  SLF_TRY(const PlenopticQuality quality, from(file, measure_plenoptic(cloud, *placed)));
  for (const ViewGroup& group : groups) {
    auto& psnr = judged.psnr.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) psnr[c] = mean_of(quality, group.views, c);
  }
  return judged;
}

/// Over frames with points; where some are exact, of the others.
std::array<double, 3> mean_over_frames(const std::vector<JudgedCloud>& frames, std::size_t group) {
  std::array<double, 3> mean{};
  for (std::size_t c = 0; c < 3; ++c) {
    double sum = 0, count = 0;
    for (const JudgedCloud& frame : frames) {
      if (frame.psnr.empty() || !std::isfinite(frame.psnr[group][c])) continue;
      sum += frame.psnr[group][c];
      ++count;
    }
    mean[c] = count > 0 ? sum / count : std::numeric_limits<double>::infinity();
  }
  return mean;
}

bool is_exact(const std::array<double, 3>& psnr) {
  return std::isinf(psnr[0]) && std::isinf(psnr[1]) && std::isinf(psnr[2]);
}

nlohmann::ordered_json psnr_json(const std::array<double, 3>& psnr) {
  nlohmann::ordered_json json = {{"exact", is_exact(psnr)}};
  for (const double p : psnr)
    json["mean"].push_back(std::isfinite(p) ? nlohmann::ordered_json(p) : nullptr);
  return json;
}

std::string psnr_columns(const std::array<double, 3>& psnr) {
  std::string out;
  for (const double p : psnr) out += std::isinf(p) ? "   exact" : text(" %7.2f", p);
  return out;
}

/// Names of groups as keys.
const char* key_of(const ViewGroup& group) {
  return group.name == std::string("coded") ? "coded" : "held_out";
}

nlohmann::ordered_json clouds_json(const std::vector<JudgedCloud>& frames,
                                   const std::vector<ViewGroup>& groups, std::uint64_t bytes,
                                   std::size_t points) {
  nlohmann::ordered_json json = {
      {"bytes", bytes}, {"points", points}, {"bits_per_point", bits_per_point(bytes, points)}};
  for (std::size_t g = 0; g < groups.size(); ++g) {
    json[key_of(groups[g])] = psnr_json(mean_over_frames(frames, g));
    json[key_of(groups[g])]["views"] = groups[g].views;
  }
  for (const JudgedCloud& frame : frames) {
    nlohmann::ordered_json one = {{"number", frame.number},
                                  {"input_name", frame.name},
                                  {"bytes", frame.bytes},
                                  {"points", frame.points}};
    for (std::size_t g = 0; g < frame.psnr.size(); ++g)
      one[key_of(groups[g])] = psnr_json(frame.psnr[g]);
    if (frame.points > 0) one["bits_per_point"] = bits_per_point(frame.bytes, frame.points);
    json["frames"].push_back(std::move(one));
  }
  return json;
}

std::string clouds_text(const std::string& name, const std::vector<JudgedCloud>& frames,
                        const std::vector<ViewGroup>& groups, std::uint64_t bytes,
                        std::size_t points) {
  std::string out = text("%s: %zu frames, %s bytes, %s points, %.3f bits per point\n", name.c_str(),
                         frames.size(), grouped(bytes).c_str(), grouped(points).c_str(),
                         bits_per_point(bytes, points));
  for (std::size_t g = 0; g < groups.size(); ++g) {
    out += text("\n%s: mean PSNR of %zu views, dB\n  %-20s %12s %11s %7s %7s %7s %7s\n",
                groups[g].name, groups[g].views.size(), "frame", "bytes", "points", "bits", "Y",
                "U", "V");
    for (const JudgedCloud& frame : frames) {
      out += text("  %-20s %12s %11s", frame.name.c_str(), grouped(frame.bytes).c_str(),
                  grouped(frame.points).c_str());
      out += frame.psnr.empty() ? "  no points"
                                : text(" %7.3f", bits_per_point(frame.bytes, frame.points)) +
                                      psnr_columns(frame.psnr[g]);
      out += "\n";
    }
    out += text("  %-20s %12s %11s %7s", "mean over frames", "", "", "") +
           psnr_columns(mean_over_frames(frames, g)) + "\n";
  }
  return out;
}

}  // namespace

Outcome eval_plenoptic_frames(const EvalOptions& given, const FrameInputs& inputs) {
  SLF_CHECK(check_no_photographs(given));
  const FrameStream& stream = *given.frames;
  const Metadata& metadata = stream.file.info.metadata;
  SLF_TRY(const std::size_t views, from(input_name(given.input), count_views_of(metadata)));
  const auto groups = view_groups(views, held_out_views(metadata));
  std::vector<JudgedCloud> frames;
  std::uint64_t bytes = 0;
  std::size_t points = 0;
  {
    ProgressLine line(given.common.quiet);
    const Progress progress = line.callback();
    for (std::size_t f = 0; f < inputs.frames.size(); ++f) {
      if (progress)
        progress("frames", static_cast<double>(f) / static_cast<double>(inputs.frames.size()));
      const std::size_t place = given.frame >= 0 ? static_cast<std::size_t>(given.frame) : f;
      SLF_TRY(JudgedCloud judged, judge_cloud(given, inputs.frames[f], place, groups));
      bytes += judged.bytes;
      points += judged.points;
      frames.push_back(std::move(judged));
    }
    line.clear();
  }
  if (points == 0)
    return Failure{kInputInvalid, input_name(given.input) + ": no frame has points to measure"};
  return given.common.json
             ? print(clouds_json(frames, groups, bytes, points))
             : print(clouds_text(input_name(given.input), frames, groups, bytes, points));
}

}  // namespace slf::tools
