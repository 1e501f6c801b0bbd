// SPDX-License-Identifier: Apache-2.0
// What became of a capture's points before they were coded.
#include "tools/describe.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

const char* outcome_word(RefineReport::Outcome outcome) {
  switch (outcome) {
    case RefineReport::kNotAsked:
      return "off";
    case RefineReport::kTooFewCameras:
      return "too few cameras";
    case RefineReport::kTooManyPoints:
      return "too many points";
    case RefineReport::kTooFewPoints:
      return "too few points";
    case RefineReport::kNoGain:
      return "no gain";
    case RefineReport::kMended:
      return "mended";
    case RefineReport::kOutdone:
      return "outdone by splats";
  }
  return "";
}

nlohmann::ordered_json mended_json(const RefineReport& r) {
  nlohmann::ordered_json json;
  json["outcome"] = outcome_word(r.outcome);
  if (r.outcome != RefineReport::kMended) return json;
  json["points_before"] = r.points_before;
  json["points_after"] = r.points_after;
  json["moved"] = r.moved;
  json["median_move_voxels"] = r.median_move;
  json["max_move_voxels"] = r.max_move;
  json["removed"] = r.removed;
  json["added"] = r.added;
  json["kept_back"] = r.kept_back;
  json["held_out_psnr_before"] = r.held_out_before;
  json["held_out_psnr_after"] = r.held_out_after;
  return json;
}

std::string mended_text(const RefineReport& r) {
  if (r.outcome == RefineReport::kNotAsked) return {};
  if (r.outcome != RefineReport::kMended)
    return text("surface       as captured (%s)\n", outcome_word(r.outcome));
  return text(
      "surface       mended: %s points moved, median %.1f and at most %.1f voxels; %s removed, %s "
      "added;\n              held-out photographs predicted with %.2f dB, %.2f before\n",
      grouped(r.moved).c_str(), r.median_move, r.max_move, grouped(r.removed).c_str(),
      grouped(r.added).c_str(), r.held_out_after, r.held_out_before);
}

}  // namespace

nlohmann::ordered_json surface_json(const SurfaceReport& r) {
  nlohmann::ordered_json json;
  json["start"] = word_of(r.start);
  json["kept"] = word_of(r.kept);
  json["points_before"] = r.points_before;
  json["points_after"] = r.points_after;
  json["mended"] = mended_json(r.mended);
  json["trained"] = nullptr;
  if (r.untrained.empty() && r.surfels > 0) json["trained"] = {{"surfels", r.surfels}};
  json["untrained"] = r.untrained;
  for (const char* judged : {"before", "trained", "splats"})
    json[std::string("held_out_psnr_") += judged] = nullptr;
  if (r.before_psnr > 0) json["held_out_psnr_before"] = r.before_psnr;
  if (r.before_psnr > 0 && r.trained_psnr > 0) json["held_out_psnr_trained"] = r.trained_psnr;
  const auto trial = [](const TrialFile& f) {
    nlohmann::ordered_json out{{"psnr", f.psnr}, {"ssim", f.ssim}, {"bytes", f.bytes}};
    if (f.splats > 0) out["splats"] = f.splats;
    if (f.inside_psnr > 0) out["inside"] = {{"psnr", f.inside_psnr}, {"ssim", f.inside_ssim}};
    return out;
  };
  if (r.as_splats.bytes > 0) {
    json["held_out_psnr_splats"] = r.as_splats.psnr;
    json["trial_splats"] = trial(r.as_splats);
  }
  if (r.as_surface.bytes > 0) json["trial_surface"] = trial(r.as_surface);
  if (!r.more_splats.empty()) json["trials_of_more_splats"] = nlohmann::ordered_json::array();
  for (const TrialFile& more : r.more_splats) json["trials_of_more_splats"].push_back(trial(more));
  return json;
}

std::string surface_text(const SurfaceReport& r) {
  std::string judged, from;
  if (r.start == StartId::kHull) from = " of the outlines' hull";
  if (r.start == StartId::kVolume) from = " anywhere before the cameras";
  if (r.before_psnr > 0)
    judged = text("held-out photographs drawn with %.2f dB %s", r.before_psnr,
                  r.mended.outcome == RefineReport::kMended ? "mended" : "given");
  if (r.trained_psnr > 0) judged += text(", %.2f trained", r.trained_psnr);
  if (!judged.empty() && r.as_splats.bytes > 0) judged += text("; splats %.2f", r.as_splats.psnr);
  if (r.as_surface.bytes > 0)
    judged +=
        text(";\n              a file of %s bytes %.2f, SSIM %.3f; splats %s bytes, SSIM %.3f",
             grouped(r.as_surface.bytes).c_str(), r.as_surface.psnr, r.as_surface.ssim,
             grouped(r.as_splats.bytes).c_str(), r.as_splats.ssim);
  const auto tried = [&](const TrialFile& f) {
    judged += text("%s%s splats in a file of %s bytes %.2f dB, SSIM %.3f",
                   judged.empty() ? "" : ";\n              ", grouped(f.splats).c_str(),
                   grouped(f.bytes).c_str(), f.psnr, f.ssim);
  };
  if (!r.more_splats.empty()) tried(r.as_splats);
  for (const TrialFile& trial : r.more_splats) tried(trial);
  if (r.kept == Surface::kSplats)
    return text("surface       none: %s splats, trained from %s points%s%s%s\n",
                grouped(r.surfels).c_str(), grouped(r.points_before).c_str(), from.c_str(),
                judged.empty() ? "" : ";\n              ", judged.c_str());
  if (r.kept == Surface::kTrained)
    return text("surface       trained: %s surfels, %s points for %s%s%s%s\n",
                grouped(r.surfels).c_str(), grouped(r.points_after).c_str(),
                grouped(r.points_before).c_str(), from.c_str(),
                judged.empty() ? "" : ";\n              ", judged.c_str());
  std::string out = mended_text(r.mended);
  if (!judged.empty()) out += "              " + judged + "\n";
  return out;
}

}  // namespace slf::tools
