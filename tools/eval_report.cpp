// SPDX-License-Identifier: Apache-2.0
#include "tools/eval_report.h"

#include <array>
#include <utility>

#include "tools/describe.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

nlohmann::ordered_json picture_json(const PictureQuality& q) {
  return {{"psnr", q.psnr}, {"ssim", q.ssim}, {"ms_ssim", q.ms_ssim}};
}

nlohmann::ordered_json region_json(const PictureRegion& r) {
  return {{"psnr", r.psnr}, {"pixel_share", r.pixel_share}, {"error_share", r.error_share}};
}

nlohmann::ordered_json image_json(const ImageQuality& image) {
  nlohmann::ordered_json json = picture_json(image);
  json["coverage"] = image.coverage;
  json["uncovered_error_share"] = image.uncovered_error_share;
  json["outside_error_share"] = image.outside_error_share;
  json["off_pixels"] = image.off_pixels;
  json["all"] = picture_json(image.all);
  json["regions"] = {{"grazing", region_json(image.grazing)},
                     {"rim", region_json(image.rim)},
                     {"rest", region_json(image.rest)}};
  json["psnr_each"] = image.psnr_each;
  return json;
}

nlohmann::ordered_json gap_json(const Measured& m, bool images) {
  const Quality &before = *m.unquantised, &after = m.quality;
  nlohmann::ordered_json json = {{"points_unquantised", before.points[0].psnr},
                                 {"points_quantised", after.points[0].psnr}};
  if (!images) return json;
  const QualityGap gap = quality_gap(before, after);
  json["pictures_unquantised"] = before.image.psnr;
  json["pictures_quantised"] = after.image.psnr;
  json["error_share"] = {{"points", gap.points},
                         {"splatting", gap.splatting},
                         {"quantisation", gap.quantisation},
                         {"coverage", gap.coverage}};
  return json;
}

std::string image_text(const ImageQuality& image) {
  std::string out =
      text("  images             %s   SSIM %.4f, MS-SSIM %.4f, coverage %.2f %%\n",
           psnr_text(image.psnr).c_str(), image.ssim, image.ms_ssim, 100 * image.coverage);
  out += text("  all their pixels   %s   SSIM %.4f, MS-SSIM %.4f\n",
              psnr_text(image.all.psnr).c_str(), image.all.ssim, image.all.ms_ssim);
  out += text("  off their cameras  %.2f pixels (median)\n", image.off_pixels);
  const std::array<std::pair<const char*, const PictureRegion*>, 3> regions = {
      {{"grazing", &image.grazing}, {"rim", &image.rim}, {"rest", &image.rest}}};
  for (const auto& [name, r] : regions)
    out += text("    %-16s %s   %5.1f %% of the pixels, %5.1f %% of the squared error\n", name,
                psnr_text(r->psnr).c_str(), 100 * r->pixel_share, 100 * r->error_share);
  out += text("    not covered                  %5.1f %% of the squared error on the object\n",
              100 * image.uncovered_error_share);
  return out;
}

std::string gap_text(const Measured& m, bool images) {
  const Quality &before = *m.unquantised, &after = m.quality;
  std::string out = "  gap            unquantised    coded\n";
  out += text("    points          %s %s\n", psnr_text(before.points[0].psnr).c_str(),
              psnr_text(after.points[0].psnr).c_str());
  if (!images) return out;
  const QualityGap gap = quality_gap(before, after);
  out += text("    images          %s %s\n", psnr_text(before.image.psnr).c_str(),
              psnr_text(after.image.psnr).c_str());
  out += text(
      "    squared error on the object: points %.1f %%, splatting %.1f %%, quantisation "
      "%.1f %%, coverage %.1f %%\n",
      100 * gap.points, 100 * gap.splatting, 100 * gap.quantisation, 100 * gap.coverage);
  return out;
}

}  // namespace

nlohmann::ordered_json quality_json(const Measured& m, bool images) {
  nlohmann::ordered_json json = {{"cameras", m.cameras}};
  for (const PointQuality& p : m.quality.points)
    json["points"].push_back({{"delta", p.delta_degrees},
                              {"psnr", p.psnr},
                              {"luma_psnr", p.luma_psnr},
                              {"channel_psnr", p.channel_psnr},
                              {"observations", p.observations}});
  json["image"] = nullptr;
  if (images) json["image"] = image_json(m.quality.image);
  json["gap"] = nullptr;
  if (m.unquantised) json["gap"] = gap_json(m, images);
  return json;
}

std::string quality_text(const Measured& m, bool images) {
  std::string out = text("%s, %zu cameras\n", m.name.c_str(), m.cameras);
  for (const PointQuality& p : m.quality.points)
    out += p.observations == 0
               ? text("  points, delta %-4g no point is seen\n", p.delta_degrees)
               : text("  points, delta %-4g %s   luma %.2f, R %.2f, G %.2f, B %.2f\n",
                      p.delta_degrees, psnr_text(p.psnr).c_str(), p.luma_psnr, p.channel_psnr[0],
                      p.channel_psnr[1], p.channel_psnr[2]);
  if (images) out += image_text(m.quality.image);
  if (m.unquantised) out += gap_text(m, images);
  return out;
}

nlohmann::ordered_json eval_json(const Subject& subject, const std::vector<Measured>& measured,
                                 bool images, double seconds) {
  nlohmann::ordered_json json;
  json["bytes"] = subject.bytes;
  json["points"] = subject.num_points();
  json["bits_per_point"] = bits_per_point(subject.bytes, subject.num_points());
  json["bytes_by_type"] = subject.bytes_by_type;
  json["settings"] = subject.settings;
  json["partial"] = subject.field.partial;
  json["decode"] = subject.decode_seconds;
  json["render"] = nullptr;
  if (images) json["render"] = {{"seconds_per_image", measured[0].quality.render_seconds}};
  for (const Measured& m : measured)
    json[m.name == "input" ? "input" : "held_out"] = quality_json(m, images);
  json["seconds"] = seconds;
  return json;
}

std::string eval_text(const std::string& name, const Subject& subject,
                      const std::vector<Measured>& measured, bool images) {
  const std::size_t points = subject.num_points();
  std::string out = text("%s: %s bytes, %s points, %.2f bits per point\n\n", name.c_str(),
                         grouped(subject.bytes).c_str(), grouped(points).c_str(),
                         bits_per_point(subject.bytes, points));
  for (const Measured& m : measured) out += quality_text(m, images);
  return out + "\n" + subject.bytes_text;
}

}  // namespace slf::tools
