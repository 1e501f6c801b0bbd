// SPDX-License-Identifier: Apache-2.0
#include "capture/box_alignment.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/vec3.h"
#include "capture/quantile.h"

namespace slf {
namespace {

constexpr double kTrim = 0.02;  // of the points at each end of an axis
constexpr int kRounds = 4;
constexpr std::size_t kBoxed = 500;  // points

struct PictureBox {
  double x = 0, y = 0, width = 0, height = 0;  // of the middle
};

PictureBox box_around(const std::vector<double>& x, const std::vector<double>& y) {
  const double x0 = quantile(x, kTrim), x1 = quantile(x, 1 - kTrim);
  const double y0 = quantile(y, kTrim), y1 = quantile(y, 1 - kTrim);
  return {(x0 + x1) / 2, (y0 + y1) / 2, x1 - x0, y1 - y0};
}

PictureBox outline_box(const WorldView& view) {
  std::vector<double> x, y;
  for (const auto& at : view.outline) {
    x.push_back(at[0] + 0.5);
    y.push_back(at[1] + 0.5);
  }
  return box_around(x, y);
}

/// Least squares of lines n.t = d.
class Equations {
 public:
  void add(const Vec3& n, double d) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) matrix_[i][k] += n[i] * n[k];
      right_[i] += n[i] * d;
    }
  }
  std::optional<Vec3> solution() const {
    const double all = determinant(matrix_);
    const double scale = matrix_[0][0] + matrix_[1][1] + matrix_[2][2];
    if (!(std::abs(all) > 1e-9 * scale * scale * scale)) return std::nullopt;
    Vec3 out{};
    for (std::size_t k = 0; k < 3; ++k) {
      auto other = matrix_;
      for (std::size_t i = 0; i < 3; ++i) other[i][k] = right_[i];
      out[k] = determinant(other) / all;
    }
    return out;
  }

 private:
  using Matrix = std::array<Vec3, 3>;
  static double determinant(const Matrix& m) { return dot(m[0], cross(m[1], m[2])); }
  Matrix matrix_{};
  Vec3 right_{};
};

/// Rows of the world's vectors that a step to the right and one down in a picture take.
std::array<Vec3, 2> picture_axes(const Camera& camera) {
  return {camera.rotation[0], camera.rotation[1]};
}

/// Where the middles of all outlines are, seen along their rays.
std::optional<Vec3> common_centre(std::span<const WorldView> views,
                                  const std::vector<PictureBox>& outlines) {
  Equations equations;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const Camera& camera = views[v].camera;
    const Vec3 axis = camera.rotation[2], eye = camera.centre();
    const std::array<double, 2> slope = {(outlines[v].x - camera.cx) / camera.fx,
                                         (outlines[v].y - camera.cy) / camera.fy};
    for (std::size_t k = 0; k < 2; ++k) {
      Vec3 plane = picture_axes(camera)[k];
      for (std::size_t i = 0; i < 3; ++i) plane[i] -= slope[k] * axis[i];
      equations.add(plane, dot(plane, eye));
    }
  }
  return equations.solution();
}

/// One round; false: points are behind cameras.
bool improve(std::span<const Vec3> points, const Vec3& centre, std::span<const WorldView> views,
             const std::vector<PictureBox>& outlines, WorldChange& change) {
  std::vector<double> ratios;
  Equations equations;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const Camera& camera = views[v].camera;
    std::vector<double> x, y;
    for (const Vec3& point : points)
      if (const auto at = camera.project(change.apply(point))) {
        x.push_back((*at)[0]);
        y.push_back((*at)[1]);
      }
    const double depth = camera.in_camera(change.apply(centre))[2];
    const PictureBox box = box_around(x, y);
    if (2 * x.size() < points.size() || !(depth > 0) || !(box.width * box.height > 0)) continue;
    const PictureBox& wanted = outlines[v];
    ratios.push_back(std::sqrt(wanted.width * wanted.height / (box.width * box.height)));
    const std::array<double, 2> off = {(wanted.x - box.x) * depth / camera.fx,
                                       (wanted.y - box.y) * depth / camera.fy};
    for (std::size_t k = 0; k < 2; ++k) equations.add(picture_axes(camera)[k], off[k]);
  }
  const auto shift = equations.solution();
  if (2 * ratios.size() < views.size() || !shift) return false;
  change = scaled_about(change, centre, median(ratios));
  for (std::size_t k = 0; k < 3; ++k) change.shift[k] += (*shift)[k];
  return true;
}

}  // namespace

PointsBox box_of(std::span<const Vec3> points) {
  PointsBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<double> values;
    for (const Vec3& point : points) values.push_back(point[k]);
    const double low = quantile(values, kTrim), high = quantile(values, 1 - kTrim);
    box.centre[k] = (low + high) / 2;
    box.size += (high - low) / 3;
  }
  return box;
}

WorldChange scaled_about(WorldChange change, const Vec3& point, double factor) {
  const Vec3 at = change.apply(point);
  change.scale *= factor;
  const Vec3 moved = change.apply(point);
  for (std::size_t k = 0; k < 3; ++k) change.shift[k] += at[k] - moved[k];
  return change;
}

std::optional<WorldChange> aligned_boxes(std::span<const Vec3> all,
                                         std::span<const WorldView> views,
                                         const std::array<int, 3>& axes) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < all.size(); i += std::max<std::size_t>(all.size() / kBoxed, 1))
    points.push_back(all[i]);
  std::vector<PictureBox> outlines;
  std::vector<double> sizes;
  for (const WorldView& view : views) {
    if (view.outline.empty()) return std::nullopt;
    outlines.push_back(outline_box(view));
  }
  const auto place = common_centre(views, outlines);
  const PointsBox box = box_of(points);
  if (!place || !(box.size > 0)) return std::nullopt;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const double depth = views[v].camera.in_camera(*place)[2];
    if (depth > 0)
      sizes.push_back(depth * std::sqrt(outlines[v].width * outlines[v].height) /
                      views[v].camera.fx);
  }
  const double size = median(sizes);
  if (2 * sizes.size() < views.size() || !(size > 0)) return std::nullopt;
  WorldChange change{axes, size / box.size, {0, 0, 0}};
  const Vec3 now = change.apply(box.centre);
  for (std::size_t k = 0; k < 3; ++k) change.shift[k] = (*place)[k] - now[k];
  for (int round = 0; round < kRounds; ++round)
    if (!improve(points, box.centre, views, outlines, change)) return std::nullopt;
  return change;
}

}  // namespace slf
