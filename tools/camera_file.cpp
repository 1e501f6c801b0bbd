#include "tools/camera_file.h"

#include <charconv>
#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "slf/rotation.h"

namespace slf::tools {
namespace {

using Json = nlohmann::json;

constexpr int kMostPixels = 16384;  // per side

/// A number at rows[i][j]; NaN, which no check lets through, where there is none.
double number_at(const Json& rows, std::size_t i, std::size_t j) {
  if (!rows.is_array() || i >= rows.size() || !rows[i].is_array() || j >= rows[i].size() ||
      !rows[i][j].is_number())
    return std::nan("");
  return rows[i][j].get<double>();
}

int pixels(const Json& entry, const char* key) {
  const auto found = entry.find(key);
  if (found == entry.end() || !found->is_number()) return 0;
  const double value = found->get<double>();
  return value >= 1 && value <= kMostPixels ? static_cast<int>(value) : 0;
}

/// Empty if the camera can be used, else the cause.
std::string parse(const Json& entry, Camera& camera) {
  if (!entry.is_object()) return "is not an object";
  const Json none;
  const auto part = [&](const char* key) -> const Json& {
    const auto found = entry.find(key);
    return found == entry.end() ? none : *found;
  };
  if (part("image").is_string()) camera.name = part("image").get<std::string>();
  camera.width = pixels(entry, "width");
  camera.height = pixels(entry, "height");
  if (camera.width == 0 || camera.height == 0) return "width and height are not 1 to 16384";
  const Json &k = part("K"), &r = part("R"), &t = part("t");
  camera.fx = number_at(k, 0, 0);
  camera.fy = number_at(k, 1, 1);
  camera.cx = number_at(k, 0, 2);
  camera.cy = number_at(k, 1, 2);
  if (!(camera.fx > 0 && camera.fy > 0)) return "K has no positive focal lengths";
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) camera.rotation[i][j] = number_at(r, i, j);
    camera.translation[i] = number_at(Json::array({t}), 0, i);
  }
  if (!is_rotation(camera.rotation)) return "R is not a rotation";
  for (const double value : {camera.fx, camera.fy, camera.cx, camera.cy, camera.translation[0],
                             camera.translation[1], camera.translation[2]})
    if (!std::isfinite(value)) return "K or t has a missing or infinite number";
  return {};
}

/// Index given as a whole number within `count`; -1 otherwise.
int index_of(const std::string& name, std::size_t count) {
  int index = -1;
  const char* end = name.data() + name.size();
  const auto [stopped, error] = std::from_chars(name.data(), end, index);
  const bool whole = error == std::errc() && stopped == end && !name.empty();
  return whole && index >= 0 && static_cast<std::size_t>(index) < count ? index : -1;
}

Failure no_camera(const std::string& file, const std::string& name) {
  return {kInputInvalid, file + ": has no camera " + name};
}

}  // namespace

Result<Camera, Failure> read_camera(const std::string& reference) {
  std::string file = reference, name;
  const std::size_t colon = reference.rfind(':');
  std::error_code ignored;
  if (colon != std::string::npos && !std::filesystem::exists(reference, ignored)) {
    file = reference.substr(0, colon);
    name = reference.substr(colon + 1);
  }
  SLF_TRY(const auto bytes, from(file, read_file(file)));
  const Json root = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
  if (!root.is_object() || !root.contains("cameras") || !root["cameras"].is_array() ||
      root["cameras"].empty())
    return Failure{kInputInvalid, file + ": is not a cameras.json"};
  const Json& list = root["cameras"];
  std::size_t chosen = list.size();
  for (std::size_t i = 0; i < list.size() && chosen == list.size() && !name.empty(); ++i)
    if (list[i].is_object() && list[i].contains("image") && list[i]["image"] == name) chosen = i;
  if (name.empty()) chosen = 0;
  if (chosen == list.size()) {
    const int index = index_of(name, list.size());
    if (index < 0) return no_camera(file, name);
    chosen = static_cast<std::size_t>(index);
  }
  Camera camera;
  const std::string cause = parse(list[chosen], camera);
  if (!cause.empty())
    return Failure{kInputInvalid, file + ": camera " + std::to_string(chosen) + ": " + cause};
  return camera;
}

Result<int, Failure> find_camera(const Capture& capture, const std::string& name,
                                 const std::string& file) {
  for (std::size_t i = 0; i < capture.cameras.size(); ++i)
    if (capture.cameras[i].name == name) return static_cast<int>(i);
  const int index = index_of(name, capture.cameras.size());
  if (index >= 0) return index;
  return no_camera(file, name);
}

Camera resized(Camera camera, int width, int height) {
  const double x = double(width) / camera.width, y = double(height) / camera.height;
  camera.fx *= x;
  camera.cx *= x;
  camera.fy *= y;
  camera.cy *= y;
  camera.width = width;
  camera.height = height;
  return camera;
}

}  // namespace slf::tools
