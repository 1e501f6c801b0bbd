// SPDX-License-Identifier: Apache-2.0
// A plan as JSON. The way back: plan_reader.cpp.
#include <array>

#include "base/shortest.h"
#include "encoder/parts/planned_scene.h"
#include "encoder/setting_rows.h"

namespace slf {
namespace {

std::string text(double value) { return shortest(value); }

std::string text(const std::string& value) {
  std::string quoted = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) >= 0x20) {
      quoted += c;
    } else {
      constexpr const char* kDigits = "0123456789abcdef";
      quoted += "\\u00";
      quoted += kDigits[static_cast<unsigned char>(c) >> 4];
      quoted += kDigits[c & 15];
    }
  }
  return quoted + "\"";
}

template <class Values>
std::string list(const Values& values) {
  std::string out = "[";
  for (const auto& value : values) {
    if (out.size() > 1) out += ",";
    out += text(static_cast<double>(value));
  }
  return out + "]";
}

std::string pairs(const std::vector<std::pair<std::string, std::string>>& all) {
  std::string out = "[";
  for (const auto& [key, value] : all)
    out += (out.size() > 1 ? ", [" : "[") + text(key) + ", " + text(value) + "]";
  return out + "]";
}

std::string fit_text(const FitSettings& fit) {
  EncoderSettings settings;
  settings.fit = fit;
  const KnownLight& known = fit.environment.known;
  const Vec3& c = known.centre;
  return "{\"settings\": " + pairs(kept_settings(settings, {SettingPart::kFit})) +
         ",\n    \"box\": " + list(std::array<double, 4>{c[0], c[1], c[2], known.half}) +
         ", \"light\": " + list(known.light) + "}";
}

std::string trust_text(const std::vector<CameraTrust>& trust) {
  std::string out = "[";
  for (const CameraTrust& t : trust)
    out += (out.size() > 1 ? ", " : "") +
           list(std::array<double, 5>{double(t.camera), double(t.verdict), double(t.gain[0]),
                                      double(t.gain[1]), double(t.gain[2])});
  return out + "]";
}

std::string transforms_text(const std::vector<PlannedTransform>& transforms) {
  std::string out = "[";
  for (const PlannedTransform& t : transforms) {
    std::vector<std::int32_t> colour;
    for (const auto& row : t.coded.colour) colour.insert(colour.end(), row.begin(), row.end());
    out += out.size() > 1 ? ",\n    {" : "\n    {";
    out +=
        "\"groups\": " + list(std::array<std::size_t, 2>{t.coded.first_group, t.coded.num_groups}) +
        ", \"rank\": " + text(double(t.coded.rank)) +
        ", \"lanes\": " + text(double(t.coded.lanes)) + ", \"colour\": " + list(colour) +
        ", \"precision\": " + list(t.precision) + ",\n     \"matrix\": " + list(t.coded.matrix) +
        "}";
  }
  return out + "]";
}

}  // namespace

std::string write_plan(const ScenePlan& plan) {
  std::vector<std::uint32_t> slices;
  for (const PlannedSlice& s : plan.slices) slices.insert(slices.end(), {s.cells, s.points});
  const Vec3& origin = plan.grid.origin;
  return "{\"slf_plan\": " + text(kPlanVersion) + ",\n  \"settings\": " + pairs(plan.settings) +
         ",\n  \"metadata\": " + pairs(plan.metadata) +
         ",\n  \"capture_cameras\": " + text(double(plan.capture_cameras)) +
         ", \"cameras\": " + list(plan.cameras) + ",\n  \"reduction\": " + list(plan.reduction) +
         ", \"origin\": " + list(plan.origin) + ", \"up\": " + text(int(plan.up)) + ", \"grid\": " +
         list(std::array<double, 4>{origin[0], origin[1], origin[2], plan.grid.step}) +
         ", \"grid_bits\": " + text(plan.grid.bits) + ", \"spacing\": " + text(plan.spacing) +
         ", \"planning_bytes\": " + text(double(plan.planning_bytes)) +
         ",\n  \"points_sha256\": " + text(plan.points_digest) +
         ",\n  \"photographs_sha256\": " + text(plan.photographs_digest) +
         ",\n  \"base_levels\": " + text(plan.base_levels) + ", \"slices\": " + list(slices) +
         ",\n  \"fit\": " + fit_text(plan.fit) + ",\n  \"trust\": " + trust_text(plan.trust) +
         ",\n  \"gamma\": " + list(std::array<int, 2>{plan.gamma_min_q7, plan.gamma_max_q7}) +
         ", \"shift\": " + list(plan.shift) +
         ",\n  \"transforms\": " + transforms_text(plan.transforms) + "}\n";
}

}  // namespace slf
