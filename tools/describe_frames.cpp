// SPDX-License-Identifier: Apache-2.0
#include "tools/describe_frames.h"

#include <algorithm>
#include <cstdio>

#include "tools/frame_choices.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

nlohmann::ordered_json frame_json(const EncodedFrame& f, std::uint32_t number) {
  return {{"number", number}, {"predicted", f.predicted}, {"points", f.points},
          {"held", f.held},   {"bytes", f.bytes},         {"seconds", f.seconds}};
}

/// Which frames of the part would be predicted: none without points, none behind such a one.
std::vector<bool> predicted_of(const PlannedFrames& plan, const FrameSettings& settings) {
  std::vector<bool> predicted;
  for (std::size_t i = 0; i < plan.part.count; ++i) {
    const std::size_t f = plan.part.first + i;
    const bool begins = f % static_cast<std::size_t>(settings.group) == 0;
    predicted.push_back(!begins &&
                        (plan.trained || (plan.points[f] > 0 && plan.points[f - 1] > 0)));
  }
  return predicted;
}

nlohmann::ordered_json plan_json(const FrameInputs& inputs, const PlannedFrames& plan,
                                 const FrameSettings& settings,
                                 const std::vector<bool>& predicted) {
  auto frames = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < predicted.size(); ++i) {
    const std::size_t f = plan.part.first + i;
    frames.push_back({{"number", inputs.frames[f].number},
                      {"input", inputs.frames[f].name()},
                      {"predicted", bool(predicted[i])},
                      {"points", plan.points[f]},
                      {"cameras", plan.cameras[f]}});
  }
  return {{"dry_run", true},
          {"kind", words_of(inputs.kind)},
          {"trained", plan.trained},
          {"grid", plan.trained ? nlohmann::ordered_json()
                                : nlohmann::ordered_json{{"bits", plan.grid.bits},
                                                         {"step", plan.grid.step}}},
          {"rate", settings.rate},
          {"group", settings.group},
          {"frames", std::move(frames)}};
}

std::string plan_text(const FrameInputs& inputs, const PlannedFrames& plan,
                      const FrameSettings& settings, const std::vector<bool>& predicted) {
  const std::size_t first = plan.part.first, count = plan.part.count;
  const bool splats = inputs.kind == FrameKind::kSplats;
  const auto points = plan.points.begin() + static_cast<std::ptrdiff_t>(first);
  const auto [least, most] =
      std::minmax_element(points, points + static_cast<std::ptrdiff_t>(count));
  const auto num_predicted = std::count(predicted.begin(), predicted.end(), true);
  std::string out =
      text("frames        %zu, %u to %u, %td predicted\n", count, inputs.frames[first].number,
           inputs.frames[first + count - 1].number, num_predicted);
  if (count < plan.points.size()) out += text("part          of %zu frames\n", plan.points.size());
  out += text("time          %.3f s at %g frames a second\n",
              static_cast<double>(count) / settings.rate, settings.rate);
  out += text("%-13s %s to %s a frame\n", splats ? "splats" : "points", grouped(*least).c_str(),
              grouped(*most).c_str());
  if (inputs.kind == FrameKind::kCaptures)
    out += text("cameras       %zu a frame\n", plan.cameras[first]);
  if (plan.trained) return out + "splats        photographs train them, and so find their grid\n";
  return out + text("grid          %d bits, voxels of %.4g\n", plan.grid.bits, plan.grid.step);
}

}  // namespace

Outcome report_plan(const EncodeOptions& given, const FrameInputs& inputs,
                    const PlannedFrames& plan, const FrameSettings& settings) {
  const std::vector<bool> predicted = predicted_of(plan, settings);
  if (given.common.json) return print(plan_json(inputs, plan, settings, predicted));
  return print(plan_text(inputs, plan, settings, predicted));
}

Outcome report_frames(const EncodeOptions& given, const FrameInputs& inputs,
                      const EncodedFrames& encoded, std::size_t bytes,
                      const FrameSettings& settings) {
  const double rate = settings.rate;
  const std::size_t first = frames_of_part(inputs.frames.size(), settings).first;
  const bool splats = inputs.kind == FrameKind::kSplats;
  std::size_t predicted = 0, points = 0, held = 0, left_out = 0;
  std::uint64_t of_predicted = 0;
  double seconds = 0;
  for (const EncodedFrame& f : encoded.frames) {
    predicted += f.predicted;
    of_predicted += f.predicted ? f.bytes : 0;
    seconds += f.seconds;
    points += f.points;
    held += f.held;
    left_out += f.left_out;
  }
  const std::size_t count = encoded.frames.size();
  if (given.common.json) {
    nlohmann::ordered_json json = {
        {"bytes", bytes}, {"q", encoded.q}, {"rate", rate}, {"trained", encoded.trained}};
    if (!encoded.as.empty()) json.update({{"as", encoded.as}, {"exact", encoded.exact}});
    for (std::size_t f = 0; f < count; ++f) {
      json["frames"].push_back(frame_json(encoded.frames[f], inputs.frames[first + f].number));
      if (splats) json["frames"].back()["left_out"] = encoded.frames[f].left_out;
    }
    return print(json);
  }
  if (given.common.quiet) return Done{};
  std::string out = text("frames        %zu, %zu predicted\n", count, predicted);
  if (splats)
    out += text("splats        %s a frame (%s that no pixel shows left out)\n",
                grouped(points / count).c_str(), grouped(left_out / count).c_str());
  if (encoded.trained) out += "surface       splats, trained by photographs\n";
  if (held > 0)
    out += text("still         %.1f %% of %s of the frame before\n",
                1e2 * static_cast<double>(held) / static_cast<double>(points),
                encoded.trained ? "splats are those" : "points keep the view map");
  if (!encoded.as.empty())
    out += text("coded as      %s\n", encoded.as == "planes" ? "planes" : "view maps");
  out += encoded.exact ? text("quality       exact\n") : text("quality       Q %.4g\n", encoded.q);
  out += text("bytes         %s a frame that is not predicted, %s one that is\n",
              grouped((bytes - of_predicted) / std::max<std::size_t>(count - predicted, 1)).c_str(),
              grouped(of_predicted / std::max<std::size_t>(predicted, 1)).c_str());
  out += text("seconds       %.2f, %.2f a frame\n", seconds, seconds / static_cast<double>(count));
  out += text("file          %s bytes, %.0f kbit/s at %g frames a second\n", grouped(bytes).c_str(),
              8e-3 * static_cast<double>(bytes) * rate / static_cast<double>(count), rate);
  std::fputs(out.c_str(), stderr);
  return Done{};
}

}  // namespace slf::tools
