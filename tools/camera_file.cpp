// SPDX-License-Identifier: Apache-2.0
#include "tools/camera_file.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <vector>

#include <nlohmann/json.hpp>

#include "slf/rotation.h"

namespace slf::tools {
namespace {

using Json = nlohmann::json;

constexpr int kMostPixels = 16384;  // per side
constexpr int kMostDepth = 64;      // of JSON, as of captures

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

/// Without its folders, without its extension, without both.
bool goes_by(const std::string& image, const std::string& name) {
  const std::filesystem::path path(image);
  return image == name || path.filename() == name || path.stem() == name ||
         std::filesystem::path(path).replace_extension() == name;
}

/// The camera of a photograph's name, whole, or so much of it that it is one alone's; else of its
/// number.
Result<std::size_t, Failure> chosen_camera(const std::vector<std::string>& images,
                                           const std::string& name, const std::string& file) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (images[i] == name) return i;
    if (goes_by(images[i], name)) found.push_back(i);
  }
  if (found.size() == 1) return found[0];
  if (found.size() > 1)
    return Failure{kInputInvalid, file + ": camera " + name + " may be " + images[found[0]] +
                                      " or " + images[found[1]]};
  const int index = index_of(name, images.size());
  if (index >= 0) return static_cast<std::size_t>(index);
  return Failure{kInputInvalid, file + ": has no camera " + name + "; its " +
                                    std::to_string(images.size()) + " are named as " +
                                    (images.empty() ? "" : images[0]) + ", or numbered from 0"};
}

/// Nothing that is nested deeper is kept; null where the file is no JSON.
Result<Json, Failure> read_json(const std::string& file) {
  SLF_TRY(const auto bytes, from(file, read_file(file)));
  bool deep = false;
  const auto keep = [&](int depth, Json::parse_event_t event, const Json&) {
    const bool opens =
        event == Json::parse_event_t::array_start || event == Json::parse_event_t::object_start;
    deep = deep || (opens && depth >= kMostDepth);
    return depth <= kMostDepth;
  };
  Json root = Json::parse(bytes.begin(), bytes.end(), keep, false);
  if (deep)
    return Failure{kInputInvalid, file + ": nested deeper than " + std::to_string(kMostDepth)};
  return root;
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
  SLF_TRY(const Json root, read_json(file));
  if (!root.is_object() || !root.contains("cameras") || !root["cameras"].is_array() ||
      root["cameras"].empty())
    return Failure{kInputInvalid, file + ": is not a cameras.json"};
  const Json& list = root["cameras"];
  std::vector<std::string> images;
  for (const Json& entry : list) {
    const bool named = entry.is_object() && entry.contains("image") && entry["image"].is_string();
    images.push_back(named ? entry["image"].get<std::string>() : std::string());
  }
  std::size_t chosen = 0;
  if (!name.empty()) {
    SLF_TRY(chosen, chosen_camera(images, name, file));
  }
  Camera camera;
  const std::string cause = parse(list[chosen], camera);
  if (!cause.empty())
    return Failure{kInputInvalid, file + ": camera " + std::to_string(chosen) + ": " + cause};
  return camera;
}

Result<int, Failure> find_camera(const Capture& capture, const std::string& name,
                                 const std::string& file) {
  std::vector<std::string> images;
  for (const Camera& camera : capture.cameras) images.push_back(camera.name);
  SLF_TRY(const std::size_t chosen, chosen_camera(images, name, file));
  return static_cast<int>(chosen);
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
