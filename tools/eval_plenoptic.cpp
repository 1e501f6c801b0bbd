// SPDX-License-Identifier: Apache-2.0
// slf eval of a plenoptic cloud: bits per point, and PSNR of every view.
#include <algorithm>
#include <cmath>

#include "tools/describe.h"
#include "tools/plenoptic_quality.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

nlohmann::ordered_json number_json(double psnr) {
  return std::isfinite(psnr) ? nlohmann::ordered_json(psnr) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json group_json(const PlenopticQuality& quality, const ViewGroup& group) {
  nlohmann::ordered_json json = {{"views", group.views}};
  json["exact"] = std::all_of(group.views.begin(), group.views.end(), [&](std::size_t v) {
    return std::isinf(quality.views[v].yuv[0]) && std::isinf(quality.views[v].yuv[1]) &&
           std::isinf(quality.views[v].yuv[2]);
  });
  for (std::size_t c = 0; c < 3; ++c)
    json["mean"].push_back(number_json(mean_of(quality, group.views, c)));
  return json;
}

std::string psnr_column(double psnr) { return std::isinf(psnr) ? "  exact" : text("%7.2f", psnr); }

std::string yuv_line(const std::string& name, double y, double u, double v) {
  return text("  %-14s %s %s %s\n", name.c_str(), psnr_column(y).c_str(), psnr_column(u).c_str(),
              psnr_column(v).c_str());
}

std::string plenoptic_quality_text(const std::string& file, const PlenopticBits& bits,
                                   const PlenopticQuality& quality,
                                   const std::vector<ViewGroup>& groups) {
  std::string out = text("%s: %s points, %zu views\n", file.c_str(),
                         grouped(quality.points).c_str(), quality.views.size());
  out += text("bits per point %.3f: geometry %.3f, colour %.3f\n", bits.file, bits.geometry,
              bits.colour);
  out += "PSNR, dB              Y       U       V\n";
  for (const ViewGroup& group : groups) {
    for (const std::size_t v : group.views) {
      const auto& yuv = quality.views[v].yuv;
      out += yuv_line("view " + std::to_string(v), yuv[0], yuv[1], yuv[2]);
    }
    out += yuv_line(std::string("mean, ") + group.name, mean_of(quality, group.views, 0),
                    mean_of(quality, group.views, 1), mean_of(quality, group.views, 2));
  }
  return out;
}

}  // namespace

std::vector<ViewGroup> view_groups(std::size_t views, const std::vector<int>& held_out) {
  std::vector<ViewGroup> groups{{"coded", {}}, {"held out", {}}};
  for (std::size_t v = 0; v < views; ++v) {
    const bool out = std::find(held_out.begin(), held_out.end(), int(v)) != held_out.end();
    groups[out ? 1 : 0].views.push_back(v);
  }
  if (groups[1].views.empty()) groups.pop_back();
  return groups;
}

double mean_of(const PlenopticQuality& quality, const std::vector<std::size_t>& views,
               std::size_t channel) {
  double sum = 0;
  for (const std::size_t v : views) sum += quality.views[v].yuv[channel];
  return sum / static_cast<double>(views.size());
}

Outcome eval_plenoptic_file(const PlenopticEval& given) {
  SLF_TRY(DecodedFile decoded, decode_file(given.input, {}, given.limits, given.common));
  if (!is_plenoptic(decoded.metadata))
    return Failure{kInputInvalid, input_name(given.input) +
                                      ": was not made of a plenoptic cloud, " + given.cloud +
                                      " is one"};
  SLF_TRY(const StreamInfo info, from(given.input, read_info(decoded.stream, given.limits.limits)));
  std::vector<std::string> warnings;
  SLF_TRY(const PlenopticCloud cloud,
          from(input_name(given.input),
               decode_plenoptic(decoded.stream, decoded.field, decoded.metadata, &warnings,
                                given.common.threads)));
  decoded.field = {};  // room for the original
  PlenopticOptions options;
  options.grid_bits = cloud.grid.bits;
  SLF_TRY(const PlenopticCloud original,
          from(given.cloud, read_plenoptic(given.cloud, options, &warnings)));
  warn(warnings, given.common.quiet);
  SLF_TRY(const PlenopticQuality quality, from(given.cloud, measure_plenoptic(cloud, original)));
  const auto groups = view_groups(quality.views.size(), held_out_views(decoded.metadata));
  const std::uint64_t size = decoded.stream.size();  // of a file of frames the first
  const PlenopticBits bits = plenoptic_bits(info, size);
  if (!given.common.json)
    return print(plenoptic_quality_text(input_name(given.input), bits, quality, groups));
  nlohmann::ordered_json json = {
      {"bytes", size},
      {"points", quality.points},
      {"bits_per_point",
       {{"geometry", bits.geometry}, {"colour", bits.colour}, {"file", bits.file}}},
      {"seconds_decode", decoded.seconds},
      {"peak_memory_mib", peak_memory_mib()}};
  for (const ViewQuality& view : quality.views)
    json["views"].push_back(
        {number_json(view.yuv[0]), number_json(view.yuv[1]), number_json(view.yuv[2])});
  json["coded"] = group_json(quality, groups[0]);
  json["held_out"] = groups.size() > 1 ? group_json(quality, groups[1]) : nullptr;
  return print(json);
}

}  // namespace slf::tools
