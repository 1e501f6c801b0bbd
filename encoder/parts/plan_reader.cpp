// SPDX-License-Identifier: Apache-2.0
// A plan from JSON, every number within its range. Mirror of plan_writer.cpp.
#include <array>
#include <cmath>

#include "capture/json.h"
#include "encoder/parts/planned_scene.h"
#include "encoder/setting_rows.h"

namespace slf {
namespace {

constexpr std::uint64_t kMostPlanBytes = std::uint64_t{64} << 20;

using Numbers = Result<std::vector<double>, InputError>;

/// The numbers of a list, each within a range.
Numbers numbers(const JsonView& json, const char* name, double low, double high) {
  SLF_TRY(const JsonView list, json.at(name));
  SLF_TRY(const auto items, list.items());
  std::vector<double> values;
  for (const JsonView& item : items) {
    SLF_TRY(const double value, item.number());
    if (!(value >= low && value <= high)) return item.error("out of range");
    values.push_back(value);
  }
  return values;
}

Numbers numbers(const JsonView& json, const char* name, std::size_t count, double low,
                double high) {
  SLF_TRY(auto values, numbers(json, name, low, high));
  if (values.size() != count)
    return InputError{
        Errc::kInvalidInput,
        json.at(name)->error(std::to_string(count) + " numbers are expected").message};
  return values;
}

Numbers whole(const JsonView& json, const char* name, double low, double high) {
  SLF_TRY(auto values, numbers(json, name, low, high));
  for (const double v : values)
    if (v != std::floor(v)) return json.at(name)->error("whole numbers are expected");
  return values;
}

Result<double, InputError> number(const JsonView& json, const char* name, double low, double high) {
  SLF_TRY(const JsonView at, json.at(name));
  SLF_TRY(const double value, at.number());
  if (!(value >= low && value <= high)) return at.error("out of range");
  return value;
}

Result<int, InputError> integer(const JsonView& json, const char* name, int low, int high) {
  SLF_TRY(const double value, number(json, name, low, high));
  if (value != std::floor(value)) return json.at(name)->error("a whole number is expected");
  return static_cast<int>(value);
}

Result<Metadata, InputError> read_pairs(const JsonView& json, const char* name) {
  SLF_TRY(const JsonView list, json.at(name));
  SLF_TRY(const auto items, list.items());
  Metadata all;
  for (const JsonView& item : items) {
    SLF_TRY(const auto pair, item.items(2));
    SLF_TRY(auto key, pair[0].string());
    SLF_TRY(auto value, pair[1].string());
    all.emplace_back(std::move(key), std::move(value));
  }
  return all;
}

constexpr double kLarge = 1e300, kMostLight = 1e6, kMostGain = 100;

Result<FitSettings, InputError> read_fit(const JsonView& json) {
  EncoderSettings settings;
  SLF_TRY(const auto pairs, read_pairs(json, "settings"));
  if (const auto put = put_settings(pairs, {SettingPart::kFit}, settings); !put)
    return json.at("settings")->error(put.error().message);
  FitSettings& fit = settings.fit;
  SLF_TRY(const auto box, numbers(json, "box", 4, -kLarge, kLarge));
  fit.environment.known = {{box[0], box[1], box[2]}, box[3], {}};
  SLF_TRY(const auto light, numbers(json, "light", -kMostLight, kMostLight));
  for (const double x : light) fit.environment.known.light.push_back(static_cast<float>(x));
  const int degree = fit.environment.degree;
  const bool lit = box[3] > 0 && degree > 0;
  if (light.size() != (lit ? std::size_t(3 * (degree + 1) * (degree + 1)) : 0))
    return json.at("light")->error("not of the environment's degree");
  return fit;
}

Result<std::vector<CameraTrust>, InputError> read_trust(const JsonView& json, std::size_t cameras) {
  SLF_TRY(const auto items, json.items());
  std::vector<CameraTrust> all;
  for (const JsonView& item : items) {
    SLF_TRY(const auto values, item.items(5));
    std::array<double, 5> v{};
    for (std::size_t i = 0; i < 5; ++i) {
      SLF_TRY(v[i], values[i].number());
    }
    if (!(v[0] >= 0 && v[0] < double(cameras) && v[1] >= 0 && v[1] <= 2))
      return item.error("out of range");
    CameraTrust trust;
    trust.camera = int(v[0]);
    trust.verdict = static_cast<CameraVerdict>(int(v[1]));
    for (std::size_t c = 0; c < 3; ++c) {
      if (!(v[2 + c] >= 0 && v[2 + c] <= kMostGain)) return item.error("out of range");
      trust.gain[c] = static_cast<float>(v[2 + c]);
    }
    all.push_back(trust);
  }
  return all;
}

Result<PlannedTransform, InputError> read_transform(const JsonView& json) {
  PlannedTransform t;
  SLF_TRY(const auto groups, numbers(json, "groups", 2, 0, 16));
  t.coded.first_group = std::size_t(groups[0]);
  t.coded.num_groups = std::size_t(groups[1]);
  SLF_TRY(const int rank, integer(json, "rank", 1, 4096));
  SLF_TRY(const int lanes, integer(json, "lanes", 1, 3));
  if (lanes == 2) return json.at("lanes")->error("1 or 3");
  t.coded.rank = std::size_t(rank);
  t.coded.lanes = std::size_t(lanes);
  SLF_TRY(const auto colour, numbers(json, "colour", 9, -512, 512));
  for (std::size_t i = 0; i < 9; ++i) t.coded.colour[i / 3][i % 3] = std::int32_t(colour[i]);
  SLF_TRY(const auto precision, whole(json, "precision", 0, PlaneTransform::kFractionBits));
  for (const double x : precision) t.precision.push_back(static_cast<std::uint8_t>(x));
  SLF_TRY(const auto matrix,
          whole(json, "matrix", -PlaneTransform::kEntryLimit, PlaneTransform::kEntryLimit));
  if (matrix.size() > PlaneTransform::kMaxEntries) return json.at("matrix")->error("too large");
  for (const double x : matrix) t.coded.matrix.push_back(static_cast<std::int32_t>(x));
  return t;
}

Result<std::string, InputError> digest_at(const JsonView& json, const char* name) {
  SLF_TRY(const JsonView digest, json.at(name));
  SLF_TRY(std::string text, digest.string());
  if (text.size() != 64 || text.find_first_not_of("0123456789abcdef") != std::string::npos)
    return digest.error("64 hexadecimal digits are expected");
  return text;
}

Result<Done, InputError> read_scene(const JsonView& json, ScenePlan& plan) {
  SLF_TRY(const int cameras, integer(json, "capture_cameras", 0, 65536));
  plan.capture_cameras = std::size_t(cameras);
  SLF_TRY(const auto used, whole(json, "cameras", 0, cameras - 1));
  for (const double c : used) plan.cameras.push_back(int(c));
  SLF_TRY(const auto reduction, whole(json, "reduction", 0, 6));
  if (reduction.size() != plan.capture_cameras)
    return json.at("reduction")->error("one for every camera is expected");
  for (const double r : reduction) plan.reduction.push_back(int(r));
  SLF_TRY(const auto origin, numbers(json, "origin", 3, -kLarge, kLarge));
  plan.origin = {origin[0], origin[1], origin[2]};
  SLF_TRY(const int up, integer(json, "up", 0, 6));
  plan.up = static_cast<UpAxis>(up);
  SLF_TRY(const auto grid, numbers(json, "grid", 4, -kLarge, kLarge));
  plan.grid.origin = {grid[0], grid[1], grid[2]};
  plan.grid.step = grid[3];
  if (!(plan.grid.step > 0)) return json.at("grid")->error("the step is not above 0");
  SLF_TRY(plan.grid.bits, integer(json, "grid_bits", 2, 21));
  SLF_TRY(plan.spacing, number(json, "spacing", plan.grid.step, kLarge));
  SLF_TRY(const double planning, number(json, "planning_bytes", 0, 1e15));
  plan.planning_bytes = static_cast<std::uint64_t>(planning);
  SLF_TRY(plan.points_digest, digest_at(json, "points_sha256"));
  SLF_TRY(plan.photographs_digest, digest_at(json, "photographs_sha256"));
  SLF_TRY(plan.base_levels, integer(json, "base_levels", 1, plan.grid.bits - 1));
  SLF_TRY(const auto slices, whole(json, "slices", 1, kMostSlicePoints));
  if (slices.empty() || slices.size() % 2 != 0 || slices.size() > 2u << 16)
    return json.at("slices")->error("cells and points of each are expected");
  for (std::size_t i = 0; i < slices.size(); i += 2)
    plan.slices.push_back({std::uint32_t(slices[i]), std::uint32_t(slices[i + 1])});
  return Done{};
}

Result<ScenePlan, InputError> read_plan(const JsonView& json) {
  ScenePlan plan;
  SLF_CHECK(json.expect_object());
  SLF_TRY(const double version, number(json, "slf_plan", 1, 1e9));
  if (version != kPlanVersion) return json.at("slf_plan")->error("a plan of another version");
  SLF_TRY(plan.settings, read_pairs(json, "settings"));
  SLF_TRY(plan.metadata, read_pairs(json, "metadata"));
  SLF_CHECK(read_scene(json, plan));
  SLF_TRY(const JsonView fit, json.at("fit"));
  SLF_TRY(plan.fit, read_fit(fit));
  SLF_TRY(const JsonView trust, json.at("trust"));
  SLF_TRY(plan.trust, read_trust(trust, plan.capture_cameras));
  SLF_TRY(const auto gamma, whole(json, "gamma", -127, 127));
  if (gamma.size() != 2 || gamma[0] > gamma[1]) return json.at("gamma")->error("two, ascending");
  plan.gamma_min_q7 = int(gamma[0]);
  plan.gamma_max_q7 = int(gamma[1]);
  SLF_TRY(const auto shift, whole(json, "shift", 0, 15));
  for (const double s : shift) plan.shift.push_back(int(s));
  if (plan.shift.size() != std::size_t(plan.fit.basis.num_functions()))
    return json.at("shift")->error("one for every function is expected");
  SLF_TRY(const JsonView transforms, json.at("transforms"));
  SLF_TRY(const auto items, transforms.items());
  if (items.size() > 2) return transforms.error("at most two");
  for (const JsonView& item : items) {
    SLF_TRY(auto transform, read_transform(item));
    plan.transforms.push_back(std::move(transform));
  }
  return plan;
}

}  // namespace

Result<ScenePlan, InputError> read_plan(const std::filesystem::path& file) {
  SLF_TRY(const auto bytes, read_file(file, kMostPlanBytes));
  SLF_TRY(const JsonValue value, parse_json(file.string(), bytes));
  return read_plan(JsonView(value, file.string()));
}

}  // namespace slf
