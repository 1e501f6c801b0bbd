// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/silhouettes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "capture/object_mask.h"
#include "capture/object_outline.h"
#include "encoder/fit/observe_camera.h"
#include "encoder/fit/observe_depth.h"
#include "encoder/measure/picture_background.h"
#include "slf/parallel.h"

namespace slf {
namespace {

using Pixel = std::array<double, 2>;

constexpr std::uint8_t kObject = 24;      // grey levels from the background: shows the object
constexpr double kMostUnlike = 0.1;       // of the border beside the object, for a plain background
constexpr double kSlack = 2;              // pixels: what a moved point may be off the outline
constexpr double kFarthest = 40;          // pixels: from outline to outline
constexpr double kRim = 1;                // spacings: nothing is this far outwards at an outline
constexpr double kLeastRimCosine = -0.2;  // of what may be an outline: a point's normal is
constexpr double kMostRimCosine = 0.4;    // about at a right angle to the view
constexpr double kInside = 1.5;           // spacings, and pixels: nearer to the outline a fat cloud
                                          // and a photograph's blur uncover nothing

/// As fat as closes the holes between points, and no fatter.
DepthSettings coverage_settings(double spacing) { return {1, 0.6 * spacing, 2.5}; }

bool inside(const Camera& camera, const Pixel& at) {
  return at[0] >= 0 && at[0] < camera.width && at[1] >= 0 && at[1] < camera.height;
}

std::size_t sample_of(const Camera& camera, const Pixel& at) {
  return std::size_t(at[1]) * std::size_t(camera.width) + std::size_t(at[0]);
}

bool covered(const DepthBuffer& buffer, const Pixel& at) { return buffer.hides(at, 1e30, 1); }

std::vector<std::uint8_t> outline_of(const Camera& camera, const SurfacePoints& points,
                                     double spacing) {
  const DepthBuffer buffer(camera, points.positions, coverage_settings(spacing));
  std::vector<std::uint8_t> object;
  object.reserve(std::size_t(camera.width) * std::size_t(camera.height));
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) object.push_back(covered(buffer, {x + 0.5, y + 0.5}));
  return object;
}

std::uint8_t difference(const std::uint8_t* sample, const std::array<std::uint8_t, 3>& from) {
  int squares = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const int apart = int(sample[c]) - int(from[c]);
    squares += apart * apart;
  }
  return std::uint8_t(std::lround(std::sqrt(squares / 3.0)));
}

/// Whether what is seen beside the object, at the picture's border, is one colour.
bool is_plain(const Silhouette& silhouette, const std::vector<std::uint8_t>& object) {
  const int width = silhouette.camera->width, height = silhouette.camera->height;
  std::size_t beside = 0, unlike = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; x += y == 0 || y + 1 == height ? 1 : std::max(width - 1, 1)) {
      const std::size_t i = std::size_t(y) * std::size_t(width) + std::size_t(x);
      if (object[i] != 0) continue;
      ++beside;
      unlike += silhouette.difference[i] > kObject;
    }
  return beside > 0 && double(unlike) <= kMostUnlike * double(beside);
}

Silhouette silhouette_of(const Camera& camera, const Image& image, bool alpha_is_mask,
                         const SurfacePoints& points, double spacing) {
  Silhouette silhouette;
  silhouette.camera = &camera;
  const auto object = outline_of(camera, points, spacing);
  const auto background = picture_background(image, object, alpha_is_mask);
  const auto channels = std::size_t(image.channels);
  silhouette.difference.resize(object.size());
  for (std::size_t i = 0; i < object.size(); ++i) {
    const std::uint8_t* sample = &image.data[i * channels];
    const bool nothing = channels == 4 && !shows_object(sample[3]);
    silhouette.difference[i] = nothing ? 0 : difference(sample, background);
  }
  if (!is_plain(silhouette, object)) silhouette.difference.clear();
  for (std::size_t i = 0; i < silhouette.difference.size(); ++i)
    if (object[i] == 0) silhouette.difference[i] = 0;
  silhouette.object = object_outline(image, Background::kCertain);
  return silhouette;
}

/// What a pixel of the object counts there: at least `least`, if the photograph tells.
std::uint8_t counted(const Silhouette& silhouette, const Pixel& at, std::uint8_t least) {
  const std::uint8_t value = silhouette.at(at);
  if (least == 0 || silhouette.object.empty() || !inside(*silhouette.camera, at)) return value;
  const bool shown = silhouette.object[sample_of(*silhouette.camera, at)] != 0;
  return shown ? std::max(value, least) : std::uint8_t{0};
}

/// A point at the outline of the surface, in a picture.
struct RimPoint {
  Pixel at{};
  Pixel outwards{};   ///< unit: where its normal points to
  double pixels = 0;  ///< that it moves by, moved along its normal by a spacing
};

std::optional<RimPoint> at_rim(const Camera& camera, const DepthBuffer& buffer,
                               const Float3& position, const Float3& normal, const Vec3& centre,
                               double spacing) {
  const double cosine = view_cosine(position, normal, centre);
  if (!(cosine >= kLeastRimCosine && cosine <= kMostRimCosine)) return {};
  double z = 0;
  const auto at = camera.project({position[0], position[1], position[2]}, &z);
  if (!at || !inside(camera, *at) || buffer.hides(*at, z, std::max(cosine, 0.2))) return {};
  const Float3 raised = along(position, float(spacing), normal);
  const auto to = camera.project({raised[0], raised[1], raised[2]}, nullptr);
  if (!to) return {};
  RimPoint rim{*at, {(*to)[0] - (*at)[0], (*to)[1] - (*at)[1]}, 0};
  rim.pixels = std::hypot(rim.outwards[0], rim.outwards[1]);
  if (!(rim.pixels > 0)) return {};
  for (double& x : rim.outwards) x /= rim.pixels;
  const double beyond = kRim * rim.pixels + 0.5;
  const Pixel outside{(*at)[0] + beyond * rim.outwards[0], (*at)[1] + beyond * rim.outwards[1]};
  if (!inside(camera, outside) || covered(buffer, outside)) return {};
  return rim;
}

/// Where the photograph's outline is, pixels outwards of a rim point; nothing: not near.
std::optional<double> photographed_outline(const Silhouette& silhouette, const RimPoint& rim) {
  constexpr double kStep = 0.5;
  const auto shows = [&](double out) {
    const Pixel at{rim.at[0] + out * rim.outwards[0], rim.at[1] + out * rim.outwards[1]};
    return counted(silhouette, at, 255) > kObject;
  };
  const bool here = shows(0);
  const double step = here ? kStep : -kStep;
  for (double out = step; std::abs(out) <= kFarthest; out += step)
    if (shows(out) != here) return out - 0.5 * step;
  return {};
}

/// The least of what counts around: 0 at the object's outline.
float least_around(const Silhouette& silhouette, const Pixel& at, double pixels,
                   std::uint8_t least) {
  std::uint8_t found = 255;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      found = std::min(found, counted(silhouette, {at[0] + pixels * x, at[1] + pixels * y}, least));
  return float(found);
}

}  // namespace

std::uint8_t Silhouette::at(const std::array<double, 2>& image) const {
  if (difference.empty() || !inside(*camera, image)) return 0;
  return difference[sample_of(*camera, image)];
}

Result<std::vector<Silhouette>, InputError> load_silhouettes(const Capture& capture,
                                                             std::span<const int> cameras,
                                                             const SurfacePoints& points,
                                                             double spacing, int threads) {
  std::vector<Silhouette> silhouettes(cameras.size());
  std::vector<std::optional<InputError>> failures(cameras.size());
  parallel_ranges(cameras.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto camera = std::size_t(cameras[i]);
      const auto image = load_image(capture, cameras[i]);
      const bool has_mask =
          camera < capture.mask_files.size() && !capture.mask_files[camera].empty();
      if (image)
        silhouettes[i] = silhouette_of(capture.cameras[camera], *image, has_mask, points, spacing);
      else
        failures[i] = image.error();
    }
  });
  for (const auto& failure : failures)
    if (failure) return *failure;
  return silhouettes;
}

std::vector<OffsetLimits> outline_limits(std::span<const Silhouette> silhouettes,
                                         const SurfacePoints& points, double spacing, int threads) {
  std::vector<std::vector<std::pair<std::uint32_t, OffsetLimits>>> each(silhouettes.size());
  parallel_ranges(silhouettes.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Silhouette& silhouette = silhouettes[i];
      if (silhouette.difference.empty()) continue;
      const Camera& camera = *silhouette.camera;
      const DepthBuffer buffer(camera, points.positions, coverage_settings(spacing));
      const Vec3 centre = camera.centre();
      for (std::size_t p = 0; p < points.size(); ++p) {
        const auto rim =
            at_rim(camera, buffer, points.positions[p], points.normals[p], centre, spacing);
        if (!rim) continue;
        const auto out = photographed_outline(silhouette, *rim);
        if (!out) continue;
        const double pixel = spacing / rim->pixels;
        each[i].push_back(
            {std::uint32_t(p),
             {float(std::min(*out - kSlack, 0.0) * pixel), float((*out + kSlack) * pixel)}});
      }
    }
  });
  std::vector<OffsetLimits> limits(points.size());
  for (const auto& list : each)
    for (const auto& [p, limit] : list) {
      limits[p].least = std::max(limits[p].least, limit.least);
      limits[p].most = std::min(limits[p].most, limit.most);
    }
  // Where photographs disagree, nothing that one of them shows is uncovered.
  for (OffsetLimits& limit : limits) limit.most = std::max(limit.most, limit.least);
  return limits;
}

HeldOutErrors uncovered_errors(std::span<const Silhouette> silhouettes, const SurfacePoints& before,
                               const SurfacePoints& after, double spacing, int threads,
                               std::uint8_t least) {
  struct Lost {
    std::uint32_t point;
    float cosine, square;
  };
  std::vector<std::vector<Lost>> each(silhouettes.size());
  parallel_ranges(silhouettes.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Silhouette& silhouette = silhouettes[i];
      if (silhouette.difference.empty()) continue;
      const Camera& camera = *silhouette.camera;
      const DepthSettings depth = coverage_settings(spacing);
      const DepthBuffer was(camera, before.positions, depth), is(camera, after.positions, depth);
      const Vec3 centre = camera.centre();
      const double focal = std::max(camera.fx, camera.fy);
      for (std::size_t p = 0; p < before.size(); ++p) {
        const Float3& position = before.positions[p];
        const double cosine = view_cosine(position, before.normals[p], centre);
        if (!(cosine > 0)) continue;
        double z = 0;
        const auto at = camera.project({position[0], position[1], position[2]}, &z);
        if (!at || !inside(camera, *at) || covered(is, *at) || was.hides(*at, z, cosine)) continue;
        const float value =
            least_around(silhouette, *at, kInside * std::max(1.0, spacing * focal / z), least);
        if (value > kObject) each[i].push_back({std::uint32_t(p), float(cosine), value * value});
      }
    }
  });
  HeldOutErrors errors;
  errors.squares.assign(before.size(), 0);
  errors.views.assign(before.size(), 0);
  for (const auto& list : each)
    for (const Lost& lost : list) {
      errors.squares[lost.point] += lost.cosine * lost.square;
      errors.views[lost.point] += lost.cosine;
    }
  return errors;
}

}  // namespace slf
