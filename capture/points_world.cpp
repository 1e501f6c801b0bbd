// SPDX-License-Identifier: Apache-2.0
#include "slf/points_world.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include "base/vec3.h"
#include "capture/change_world.h"

namespace slf {
namespace {

std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

/// 1, 2, 3, their negatives; 0: no axis.
int axis_of(std::string name) {
  int sign = 1;
  if (!name.empty() && (name[0] == '-' || name[0] == '+')) {
    sign = name[0] == '-' ? -1 : 1;
    name.erase(0, 1);
  }
  return name.size() == 1 && name[0] >= 'x' && name[0] <= 'z' ? sign * (name[0] - 'x' + 1) : 0;
}

std::optional<double> finite_number(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

Vec3 WorldChange::apply(const Vec3& at) const {
  Vec3 out = shift;
  for (std::size_t k = 0; k < 3; ++k) {
    const double value = scale * at[std::size_t(std::abs(axes[k]) - 1)];
    out[k] += axes[k] < 0 ? -value : value;
  }
  return out;
}

bool WorldChange::mirrors() const {
  const bool turned = (axes[0] < 0) != ((axes[1] < 0) != (axes[2] < 0));
  const bool even = std::abs(axes[1]) == std::abs(axes[0]) % 3 + 1;  // a rotation of x, y, z
  return turned == even;
}

std::string text_of(const WorldChange& change) {
  std::string out;
  for (const int axis : change.axes)
    out += std::string(out.empty() ? "" : ",") + (axis < 0 ? "-" : "") + "xyz"[std::abs(axis) - 1];
  const bool shifted = change.shift != Vec3{0, 0, 0};
  const auto add = [&out](double number) { (out += ',') += short_number(number); };
  if (change.scale != 1 || shifted) add(change.scale);
  if (shifted)
    for (const double s : change.shift) add(s);
  return out;
}

Result<WorldChange, InputError> parse_world_change(const std::string& text) {
  const InputError error{Errc::kInvalidArgument,
                         text +
                             ": not three axes, a scale and a shift, as x,-z,y or "
                             "x,y,z,0.001 or x,y,z,1,0,0,2.5"};
  const std::vector<std::string> parts = parts_of(text);
  if (parts.size() != 3 && parts.size() != 4 && parts.size() != 7) return error;
  WorldChange change;
  unsigned seen = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    change.axes[k] = axis_of(parts[k]);
    if (change.axes[k] == 0) return error;
    seen |= 1U << std::abs(change.axes[k]);
  }
  if (seen != 0b1110) return error;
  for (std::size_t i = 3; i < parts.size(); ++i) {
    const auto value = finite_number(parts[i]);
    if (!value || (i == 3 && !(*value > 0))) return error;
    (i == 3 ? change.scale : change.shift[i - 4]) = *value;
  }
  return change;
}

void change_world(const WorldChange& change, Mesh& mesh) {
  const WorldChange axes{change.axes, 1, {0, 0, 0}}, about_origin{change.axes, change.scale, {}};
  PointCloud& points = mesh.vertices;
  for (auto& at : points.positions) at = to_float(about_origin.apply(to_double(at)));
  for (auto& normal : points.normals) normal = to_float(axes.apply(to_double(normal)));
  points.origin = change.apply(points.origin);
  if (!change.mirrors()) return;
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

}  // namespace slf
