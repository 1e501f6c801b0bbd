// SPDX-License-Identifier: Apache-2.0
#include "capture/world_agreement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "capture/object_outline.h"
#include "capture/photograph_size.h"
#include "capture/quantile.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kMostViews = 12;
constexpr double kMegapixels = 0.03;         // of a small photograph
constexpr std::size_t kOutlinePixels = 256;  // that are looked at
constexpr double kPointsInCell = 8;
constexpr double kMostDifference = 96;  // grey levels; greater ones count as that
constexpr double kOfOutlines = 0.4;     // of the agreement; colours have the rest
constexpr double kLeastSeen = 0.1;      // of the points, by two views

WorldView view_of(const Camera& camera, const Image& image) {
  WorldView view{camera, {}, object_outline(image), {}};
  const auto channels = std::size_t(image.channels);
  for (std::size_t i = 0; i < image.data.size(); i += channels)
    view.colours.push_back(
        {float(image.data[i]), float(image.data[i + 1]), float(image.data[i + 2])});
  const auto shown = std::size_t(std::count(view.object.begin(), view.object.end(), 1));
  const std::size_t every = std::max<std::size_t>(shown / kOutlinePixels, 1);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < view.object.size(); ++i)
    if (view.object[i] && seen++ % every == 0)
      view.outline.push_back({int(i) % image.width, int(i) / image.width});
  return view;
}

/// Where points are in a picture; what lies outside of it has no pixel.
struct Placed {
  static constexpr std::int32_t kOutside = -1;
  std::vector<std::int32_t> pixel;
  std::vector<double> depth;
};

/// Cells of a picture, a few points in each.
class Cells {
 public:
  Cells(const WorldView& view, const Placed& placed) : width_(view.camera.width) {
    std::vector<int> x, y;
    for (const std::int32_t pixel : placed.pixel)
      if (pixel != Placed::kOutside) {
        x.push_back(pixel % width_);
        y.push_back(pixel / width_);
      }
    if (x.empty()) return;
    const auto count = double(x.size());
    const double area = double(1 + quantile(x, 0.95) - quantile(x, 0.05)) *
                        double(1 + quantile(y, 0.95) - quantile(y, 0.05));
    side_ = std::max(1.0, std::sqrt(area * kPointsInCell / count));
    across_ = int(width_ / side_) + 1;
    nearest_.assign(std::size_t(across_) * std::size_t(int(view.camera.height / side_) + 1),
                    std::numeric_limits<double>::infinity());
  }

  bool empty() const { return nearest_.empty(); }
  std::int32_t cell(int x, int y) const { return int(y / side_) * across_ + int(x / side_); }
  std::int32_t cell(std::int32_t pixel) const { return cell(pixel % width_, pixel / width_); }
  double& nearest(std::int32_t cell) { return nearest_[std::size_t(cell)]; }
  bool hit(std::int32_t cell) const { return std::isfinite(nearest_[std::size_t(cell)]); }
  double side() const { return side_; }

 private:
  int width_, across_ = 0;
  double side_ = 1;
  std::vector<double> nearest_;
};

Placed placed_in(const WorldView& view, std::span<const Vec3> points) {
  Placed out;
  for (const Vec3& point : points) {
    double depth = 0;
    const auto at = view.camera.project(point, &depth);
    const bool in = at && (*at)[0] >= 0 && (*at)[1] >= 0 && (*at)[0] < view.camera.width &&
                    (*at)[1] < view.camera.height;
    out.pixel.push_back(in ? int((*at)[1]) * view.camera.width + int((*at)[0]) : Placed::kOutside);
    out.depth.push_back(depth);
  }
  return out;
}

/// Sums over the colours that views see of one point.
struct PointColours {
  double count = 0, squares = 0;
  std::array<double, 3> sum{};

  void add(const std::array<float, 3>& colour) {
    ++count;
    for (std::size_t k = 0; k < 3; ++k) {
      sum[k] += double(colour[k]);
      squares += double(colour[k]) * double(colour[k]);
    }
  }
  double variance() const {  // over the colours, unbiased
    double mean_squares = 0;
    for (const double s : sum) mean_squares += s * s / count;
    return std::max(0.0, squares - mean_squares) / (count - 1);
  }
};

/// The share of the variance of colours that lies between points and not within one (ICC, Fisher
/// 1925); 0: too few are seen twice.
double common_share(const std::vector<PointColours>& points) {
  double within = 0, seen = 0;
  PointColours all;
  for (const PointColours& point : points) {
    if (point.count < 2) continue;
    ++seen;
    within += std::min(point.variance(), kMostDifference * kMostDifference);
    ++all.count;  // each point has the same weight
    all.squares += point.squares / point.count;
    for (std::size_t k = 0; k < 3; ++k) all.sum[k] += point.sum[k] / point.count;
  }
  if (seen < 20 || seen < kLeastSeen * double(points.size())) return 0;
  const double total = all.variance() + 1;  // a grey level of noise
  return std::max(0.0, 1 - within / seen / total);
}

struct Cover {
  double in_picture = 0, on_object = 0, outline = 0, covered = 0;
};

/// What one view sees of the points.
void look(const WorldView& view, std::span<const Vec3> points, std::vector<PointColours>& colours,
          Cover& cover) {
  Placed placed = placed_in(view, points);
  Cells cells(view, placed);
  cover.outline += double(view.outline.size());
  if (cells.empty()) return;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (placed.pixel[p] == Placed::kOutside) continue;
    double& nearest = cells.nearest(cells.cell(placed.pixel[p]));
    nearest = std::min(nearest, placed.depth[p]);
  }
  for (const auto& [x, y] : view.outline) cover.covered += cells.hit(cells.cell(x, y));
  for (std::size_t p = 0; p < points.size(); ++p) {
    const std::int32_t pixel = placed.pixel[p];
    if (pixel == Placed::kOutside) continue;
    const bool object = view.object.empty() || view.object[std::size_t(pixel)];
    ++cover.in_picture;
    cover.on_object += object;
    // A slope of 60 degrees stays within twice a cell.
    const double behind = 2 * cells.side() * placed.depth[p] / view.camera.fx;
    if (object && placed.depth[p] <= cells.nearest(cells.cell(pixel)) + behind)
      colours[p].add(view.colours[std::size_t(pixel)]);
  }
}

}  // namespace

std::vector<WorldView> world_views(const Capture& capture, int threads) {
  const Capture photographs = photographs_alone(capture);
  const std::optional<Capture> within = photographs_within(photographs, kMegapixels);
  const Capture& small = within ? *within : photographs;
  const std::size_t all = small.cameras.size();
  std::vector<WorldView> views(std::min(all, kMostViews));
  parallel_ranges(views.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t camera = i * all / views.size();
      if (const auto image = load_image(small, int(camera)))
        views[i] = view_of(small.cameras[camera], *image);
    }
  });
  std::erase_if(views, [](const WorldView& view) { return view.colours.empty(); });
  // A few that do not tell the object are not worth the outlines of the others.
  const auto outlined = std::size_t(std::count_if(
      views.begin(), views.end(), [](const WorldView& view) { return !view.object.empty(); }));
  const bool drop = 5 * outlined >= 4 * views.size();
  std::erase_if(views, [&](const WorldView& view) { return drop && view.object.empty(); });
  if (!drop)
    for (WorldView& view : views) view.object.clear(), view.outline.clear();
  return views;
}

double WorldAgreement::score() const {
  return outlines ? on_object * covered * (kOfOutlines + (1 - kOfOutlines) * common) : common;
}

WorldAgreement world_agreement(std::span<const Vec3> points, std::span<const WorldView> views) {
  std::vector<PointColours> colours(points.size());
  Cover cover;
  for (const WorldView& view : views) look(view, points, colours, cover);
  WorldAgreement out;
  if (points.empty() || views.empty() || cover.in_picture == 0) return out;
  out.in_view = cover.in_picture / double(points.size() * views.size());
  out.on_object = cover.on_object / cover.in_picture;
  out.outlines = cover.outline > 0;
  out.covered = cover.outline == 0 ? 1 : cover.covered / cover.outline;
  out.common = common_share(colours);
  return out;
}

}  // namespace slf
