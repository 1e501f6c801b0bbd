// SPDX-License-Identifier: Apache-2.0
#include "capture/other_world.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "base/vec3.h"
#include "capture/box_alignment.h"
#include "capture/photograph_size.h"
#include "capture/world_agreement.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kLeastPoints = 200, kLookedThrough = 2000, kLeastViews = 4;
constexpr int kSmallestSide = 24;    // pixels of a photograph: smaller ones tell nothing
constexpr double kNearUsual = 0.04;  // a scale is a usual one
constexpr double kNoColours = 0.2;   // in common
constexpr double kNearScale = 0.2, kNearShift = 0.2;  // log; of the size
constexpr double kAlmost = 0.85;                      // of the best agreement: a rough cloud
constexpr double kAlike = 0.95;                       // of the best agreement
/// Millimetres, centimetres, inches and feet for metres, and the other way round.
constexpr double kScales[] = {1,  1e-3,   1e3,        0.01,   100,       0.1,
                              10, 0.0254, 1 / 0.0254, 0.3048, 1 / 0.3048};

struct Placing {
  WorldChange change;
  WorldAgreement agreement;
};

/// How much of a change it is: of those that agree alike, as of what is round, the least is meant.
int effort_of(const WorldChange& change) {
  int effort = change.mirrors() ? 3 : 0;
  for (std::size_t k = 0; k < 3; ++k)
    effort += (std::abs(change.axes[k]) != int(k) + 1) + (change.axes[k] < 0);
  return effort + (change.scale != 1 ? 2 : 0) + (change.shift != Vec3{0, 0, 0} ? 3 : 0);
}

std::vector<std::array<int, 3>> all_axes() {
  std::vector<std::array<int, 3>> out;
  std::array<int, 3> order{1, 2, 3};
  do
    for (int signs = 0; signs < 8; ++signs)
      out.push_back({signs & 1 ? -order[0] : order[0], signs & 2 ? -order[1] : order[1],
                     signs & 4 ? -order[2] : order[2]});
  while (std::next_permutation(order.begin(), order.end()));
  return out;
}

WorldAgreement agreement_of(std::span<const Vec3> points, std::span<const WorldView> views,
                            const WorldChange& change) {
  std::vector<Vec3> moved;
  for (const Vec3& point : points) moved.push_back(change.apply(point));
  return world_agreement(moved, views);
}

/// Most cameras see a cloud of this size at this place.
bool may_be_there(const PointsBox& box, std::span<const WorldView> views,
                  const WorldChange& change) {
  std::size_t seen = 0;
  for (const WorldView& view : views) {
    double depth = 0;
    const auto at = view.camera.project(change.apply(box.centre), &depth);
    if (!at) continue;
    const double size = change.scale * box.size * view.camera.fx / depth;
    const double width = view.camera.width, height = view.camera.height;
    seen += (*at)[0] > 0 && (*at)[1] > 0 && (*at)[0] < width && (*at)[1] < height &&
            size > 0.05 * width && size < 3 * width;
  }
  return 2 * seen > views.size();
}

/// With usual scales, where the scale is nearly one.
std::vector<WorldChange> simpler(const WorldChange& found, const PointsBox& box) {
  std::vector<WorldChange> out{found};
  for (const double scale : kScales)
    if (std::abs(found.scale / scale - 1) < kNearUsual) {
      out.push_back(scaled_about(found, box.centre, scale / found.scale));
      out.back().scale = scale;
    }
  return out;
}

/// As many digits as the object has thousandths.
WorldChange in_few_digits(WorldChange change, double size) {
  const auto to = [](double value, double step) { return std::round(value / step) * step; };
  const auto step_of = [](double value) { return std::pow(10, std::floor(std::log10(value))); };
  change.scale = to(change.scale, step_of(change.scale / 1000));
  for (double& s : change.shift) s = to(s, step_of(change.scale * size / 1000));
  return change;
}

/// @param all  usual scales too with which few cameras see the cloud's middle, as in a street
std::vector<WorldChange> all_changes(std::span<const Vec3> points, std::span<const WorldView> views,
                                     const PointsBox& box, bool all) {
  std::vector<WorldChange> out;
  for (const auto& axes : all_axes()) {
    for (const double scale : kScales)
      if (const WorldChange change{axes, scale, {0, 0, 0}};
          all || scale == 1 || may_be_there(box, views, change))
        out.push_back(change);
    if (const auto fitted = aligned_boxes(points, views, axes))
      for (const WorldChange& change : simpler(*fitted, box)) out.push_back(change);
  }
  return out;
}

/// The scale and each shift in smaller and smaller steps, as long as points agree better.
Placing improved(std::span<const Vec3> points, std::span<const WorldView> views, Placing best,
                 const PointsBox& box) {
  const auto attempt = [&](const WorldChange& change) {
    const WorldAgreement agreement = agreement_of(points, views, change);
    if (agreement.score() > best.agreement.score()) best = {change, agreement};
  };
  for (const double step : {0.04, 0.02, 0.01, 0.005, 0.0025})
    for (const double way : {step, -step}) {
      attempt(scaled_about(best.change, box.centre, 1 + way));
      for (std::size_t k = 0; k < 3; ++k) {
        WorldChange change = best.change;
        change.shift[k] += way * best.change.scale * box.size;
        attempt(change);
      }
    }
  return best;
}

/// A cloud that is rough or fat, as a hull, and in the world of the cameras.
bool is_near(const WorldChange& change, const PointsBox& box) {
  if (change.axes != WorldChange{}.axes || std::abs(std::log(change.scale)) > kNearScale)
    return false;
  const Vec3 off = minus(change.apply(box.centre), box.centre);
  return std::sqrt(dot(off, off)) < kNearShift * box.size;
}

/// That of the least effort among the best.
Placing least_of(std::vector<Placing> placings) {
  double most = 0;
  for (const Placing& p : placings) most = std::max(most, p.agreement.score());
  std::erase_if(placings, [&](const Placing& p) { return p.agreement.score() < kAlike * most; });
  const auto before = [](const Placing& a, const Placing& b) {
    const int effort = effort_of(a.change), other = effort_of(b.change);
    return effort != other ? effort < other : a.agreement.score() > b.agreement.score();
  };
  const auto best = std::min_element(placings.begin(), placings.end(), before);
  return best == placings.end() ? Placing{} : *best;
}

/// Nothing, of no agreement, where the points need but a little.
Placing best_of(std::span<const Vec3> points, std::span<const WorldView> views, bool all,
                int threads) {
  const PointsBox box = box_of(points);
  std::vector<Placing> placings;
  for (const WorldChange& change : all_changes(points, views, box, all))
    placings.push_back({change, {}});
  parallel_ranges(placings.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      placings[i].agreement = agreement_of(points, views, placings[i].change);
  });
  double near = 0;
  for (const Placing& p : placings)
    if (is_near(p.change, box)) near = std::max(near, p.agreement.score());
  const Placing best = least_of(std::move(placings));
  if (near > kAlmost * best.agreement.score()) return {};
  if (best.change.shift == Vec3{0, 0, 0}) return best;
  placings = {improved(points, views, best, box)};
  for (const WorldChange& change : simpler(placings[0].change, box))
    placings.push_back({change, agreement_of(points, views, change)});
  Placing found = least_of(std::move(placings));
  found.change = in_few_digits(found.change, box.size);
  return found;
}

/// Nothing is to be mended.
bool agrees(const WorldAgreement& a, bool outlines) {
  return outlines ? a.on_object > 0.9 && a.covered > 0.9 : a.common > 0.8;
}

bool much_better(const WorldAgreement& than, const WorldAgreement& a) {
  if (a.score() < 0.3 || a.score() < 1.3 * than.score() + 0.05) return false;
  const double outlines = than.on_object * than.covered;
  return a.common > than.common + 0.15 || a.on_object * a.covered > 1.3 * outlines;
}

bool disagrees(const WorldAgreement& a, bool outlines) {
  return outlines && a.covered * a.on_object < 0.1 && a.common < kNoColours;
}

/// "y and z are exchanged, ": what a person calls it.
std::string words_of(const WorldChange& change) {
  std::string out;
  const std::array<int, 3>& axes = change.axes;
  int own = 0, turned = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    own += std::abs(axes[k]) == int(k) + 1;
    turned += axes[k] < 0;
  }
  if (own == 1)
    for (std::size_t k = 0; k < 3; ++k)
      if (std::abs(axes[k]) == int(k) + 1)
        out += std::string() + "xyz"[(k + 1) % 3 < (k + 2) % 3 ? (k + 1) % 3 : (k + 2) % 3] +
               " and " + "xyz"[(k + 1) % 3 < (k + 2) % 3 ? (k + 2) % 3 : (k + 1) % 3] +
               " are exchanged, ";
  if (own == 0) out += "axes are exchanged, ";
  if (turned > 0)
    out += std::to_string(turned) + (turned > 1 ? " axes are" : " axis is") + " turned round, ";
  if (change.scale != 1) out += "units are others, ";
  if (change.shift != Vec3{0, 0, 0}) out += "the origin is another, ";
  return out;
}

}  // namespace

std::string OtherWorld::warning() const {
  char text[400];
  if (!change)
    std::snprintf(text, sizeof text,
                  "the points are not where the photographs show the object (agreement %.0f %%): "
                  "are they in the world of the cameras? --points-world turns, scales and shifts "
                  "them",
                  100 * given);
  else
    std::snprintf(text, sizeof text,
                  "the points are in another world than the cameras (%sagreement %.0f %%): "
                  "--points-world=%s brings them together (%.0f %%)",
                  words_of(*change).c_str(), 100 * given, text_of(*change).c_str(), 100 * changed);
  return text;
}

std::optional<OtherWorld> other_world(std::span<const Vec3> points, const Capture& capture,
                                      int threads) {
  if (points.size() < kLeastPoints || capture.cameras.size() < kLeastViews) return std::nullopt;
  for (const Camera& camera : capture.cameras)
    if (std::min(camera.width, camera.height) < kSmallestSide) return std::nullopt;
  std::vector<Vec3> sample;
  const std::size_t count = std::min(points.size(), kLookedThrough);
  for (std::size_t i = 0; i < count; ++i) sample.push_back(points[i * points.size() / count]);
  Capture from_origin = photographs_alone(capture);  // points are the world's
  for (Camera& camera : from_origin.cameras) camera = moved(std::move(camera), capture.origin);
  const std::vector<WorldView> views = world_views(from_origin, threads);
  if (views.size() < kLeastViews) return std::nullopt;
  const bool outlines = !views.front().outline.empty();
  const WorldAgreement given = world_agreement(sample, views);
  if (agrees(given, outlines)) return std::nullopt;
  const Placing best = best_of(sample, views, !outlines && given.common < kNoColours, threads);
  if (much_better(given, best.agreement))
    return OtherWorld{best.change, given.score(), best.agreement.score()};
  if (disagrees(given, outlines)) return OtherWorld{std::nullopt, given.score(), 0};
  return std::nullopt;
}

}  // namespace slf
