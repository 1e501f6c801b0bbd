// SPDX-License-Identifier: Apache-2.0
#include "lightfield/render/render_splats.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "base/monitor.h"
#include "base/vec3.h"
#include "lightfield/render/reference_kernel.h"
#include "lightfield/render/splat_band.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr const ReferenceKernel& kSplatKernel = kReferenceKernel;
constexpr double kFilterPixelsSquare = kSplatKernel.filter_pixels * kSplatKernel.filter_pixels;
constexpr double kLargestPixels = 512;  // half width of an ellipse; bounds the work of a close
                                        // camera
constexpr double kSteepestPlane =
    0.75;  // of the inverse depth, that it may change by in an ellipse

Vec3 rotate(const Camera& camera, const Vec3& v) {
  return {dot(camera.rotation[0], v), dot(camera.rotation[1], v), dot(camera.rotation[2], v)};
}

/// The normal in camera axes, turned to the viewer and at least kSplatKernel.flattest towards the
/// eye.
Vec3 facing_normal(const Vec3& normal, const Vec3& to_eye) {
  double cosine = dot(normal, to_eye);
  if (!(dot(normal, normal) > 0.5)) return to_eye;
  const double sign = cosine < 0 ? -1 : 1;
  cosine = std::abs(cosine);
  if (cosine >= kSplatKernel.flattest)
    return {sign * normal[0], sign * normal[1], sign * normal[2]};
  // What is across the view keeps its direction and gets the length that is left.
  Vec3 n;
  const double across = std::sqrt(std::max(1 - cosine * cosine, 1e-12));
  const double scale = std::sqrt(1 - kSplatKernel.flattest * kSplatKernel.flattest) / across;
  for (std::size_t k = 0; k < 3; ++k)
    n[k] = scale * (sign * normal[k] - cosine * to_eye[k]) + kSplatKernel.flattest * to_eye[k];
  return n;
}

/// 2 x 2 symmetric matrix.
struct Spread {
  double uu, uv, vv;
  double determinant() const { return uu * vv - uv * uv; }
};

/// Image of the disc's circle to first order: J (I - n n^T) J^T r^2, J the derivative of
/// projection.
Spread image_spread(const Camera& camera, const Vec3& p, const Vec3& n, double radius) {
  const double z = 1 / p[2];
  const Vec3 ju{camera.fx * z, 0, -camera.fx * p[0] * z * z};
  const Vec3 jv{0, camera.fy * z, -camera.fy * p[1] * z * z};
  const double nu = dot(ju, n), nv = dot(jv, n), r2 = radius * radius;
  return {r2 * (dot(ju, ju) - nu * nu), r2 * (dot(ju, jv) - nu * nv), r2 * (dot(jv, jv) - nv * nv)};
}

}  // namespace

std::optional<Splat> project_disc(const Camera& camera, const Disc& disc, std::uint32_t point) {
  double z = 0;
  const auto image = camera.project(disc.centre, &z);
  if (!image || !(z > disc.radius)) return std::nullopt;
  Vec3 p = rotate(camera, disc.centre);
  for (std::size_t k = 0; k < 3; ++k) p[k] += camera.translation[k];
  const double distance = std::sqrt(dot(p, p));
  const Vec3 to_eye{-p[0] / distance, -p[1] / distance, -p[2] / distance};
  const Vec3 n = facing_normal(rotate(camera, disc.normal), to_eye);
  const double cosine = dot(n, to_eye);

  const Spread disc_spread = image_spread(camera, p, n, disc.radius);
  const Spread s{disc_spread.uu + kFilterPixelsSquare, disc_spread.uv,
                 disc_spread.vv + kFilterPixelsSquare};
  const double half_width = std::sqrt(s.uu), half_height = std::sqrt(s.vv);
  const auto [u, v] = *image;
  if (!(half_width < kLargestPixels && half_height < kLargestPixels)) return std::nullopt;
  if (!(u + half_width > 0 && u - half_width < camera.width && v + half_height > 0 &&
        v - half_height < camera.height))
    return std::nullopt;

  // On the plane n . x = n . p, x = z (x', y', 1): 1 / z is linear in x', y', so in u, v.
  const double plane = dot(n, p);
  double du = n[0] / (plane * camera.fx), dv = n[1] / (plane * camera.fy);
  const double change =
      std::sqrt(std::max(0.0, du * du * s.uu + 2 * du * dv * s.uv + dv * dv * s.vv));
  const double tame = std::min(1.0, kSteepestPlane / (z * std::max(change, 1e-300)));
  const double pixel = z / camera.fx;  // in world units
  const double band = kSplatKernel.band *
                      std::sqrt(disc.radius * disc.radius + kFilterPixelsSquare * pixel * pixel) /
                      std::max(cosine, kSplatKernel.steepest);
  const double inverse = 1 / s.determinant();
  Splat splat;
  splat.u = static_cast<float>(u);
  splat.v = static_cast<float>(v);
  splat.a = static_cast<float>(s.vv * inverse);
  splat.b = static_cast<float>(-s.uv * inverse);
  splat.c = static_cast<float>(s.uu * inverse);
  splat.half_width = static_cast<float>(half_width);
  splat.half_height = static_cast<float>(half_height);
  splat.half_chord = static_cast<float>(1 / std::sqrt(s.vv * inverse));
  splat.slope = static_cast<float>(-s.uv / s.vv);
  splat.inverse_depth = static_cast<float>(1 / z);
  splat.inverse_depth_du = static_cast<float>(tame * du);
  splat.inverse_depth_dv = static_cast<float>(tame * dv);
  splat.inverse_depth_change = static_cast<float>(tame * change);
  splat.fade = static_cast<float>(z * z / band);
  // Area of the surface over that of the disc, times that of the disc over that of the ellipse.
  const double share = disc.area > 0
                           ? disc.area / (disc.radius * disc.radius)
                           : 1 / (kSplatKernel.spacing_reach * kSplatKernel.spacing_reach);
  splat.weight =
      static_cast<float>(share * std::sqrt(std::max(disc_spread.determinant() * inverse, 1e-9)));
  splat.point = point;
  return splat;
}

namespace {

/// Colours [splats] of those that are in a list; the fourth is 0 and makes a sum one instruction.
std::vector<std::array<float, 4>> colours_of(const std::vector<Splat>& splats,
                                             const std::vector<std::vector<std::uint32_t>>& shown,
                                             int threads, const ColourSource& source,
                                             const std::atomic<bool>* ended) {
  std::vector<std::uint8_t> in_list(splats.size(), 0);
  for (const auto& list : shown)
    for (const std::uint32_t i : list) in_list[i] = 1;
  std::vector<std::array<float, 4>> colours(splats.size());
  parallel_ranges(splats.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
    if (is_ended(ended)) return;
    std::vector<std::uint32_t> points;
    for (std::size_t i = begin; i < end; ++i)
      if (in_list[i]) points.push_back(splats[i].point);
    std::vector<std::array<float, 3>> own(points.size());
    source(points, own);
    for (std::size_t i = begin, next = 0; i < end; ++i)
      if (in_list[i]) {
        std::copy(own[next].begin(), own[next].end(), colours[i].begin());
        ++next;
      }
  });
  return colours;
}

/// What a band is drawn in.
struct BandScratch {
  BandSums sums;
  SplatImage rows;
};

/// Memory that the ranges of work take in turn, so that there is one per thread and not per band.
class ScratchPool {
 public:
  std::unique_ptr<BandScratch> take() {
    std::unique_ptr<BandScratch> scratch;
    monitor_.change([&] {
      if (free_.empty()) return;
      scratch = std::move(free_.back());
      free_.pop_back();
    });
    return scratch ? std::move(scratch) : std::make_unique<BandScratch>();
  }
  void give(std::unique_ptr<BandScratch>&& scratch) {
    monitor_.change([&] { free_.push_back(std::move(scratch)); });
  }

 private:
  Monitor monitor_;
  std::vector<std::unique_ptr<BandScratch>> free_;
};

void take_rows(const SplatBand& band, BandSums& sums, SplatImage& rows) {
  rows.colour.assign(band.pixels(), {0, 0, 0});
  rows.coverage.assign(band.pixels(), 0);
  rows.depth.assign(band.pixels(), std::numeric_limits<float>::infinity());
  band.take(sums, [&](std::size_t pixel, const BlockSums& own, std::size_t lane) {
    const float scale = 1 / own.weight[lane];
    rows.colour[pixel] = {own.red[lane] * scale, own.green[lane] * scale, own.blue[lane] * scale};
    rows.coverage[pixel] = own.coverage[lane];
    rows.depth[pixel] = own.weight[lane] / own.inverse_depth[lane];
  });
}

}  // namespace

void rasterise(const std::vector<Splat>& splats, int width, int height, int threads,
               const ColourSource& source, const RowSink& sink, const std::atomic<bool>* ended) {
  const auto bins = bin_splats(splats, height);
  std::vector<std::vector<std::uint32_t>> shown(bins.size());
  std::vector<SplatBand> bands;
  bands.reserve(bins.size());
  for (std::size_t i = 0; i < bins.size() && !is_ended(ended); ++i)
    bands.emplace_back(width, height, i);
  parallel_ranges(bands.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end && !is_ended(ended); ++i)
      shown[i] = bands[i].find_shown(splats, bins[i]);
  });
  const auto colours = colours_of(splats, shown, threads, source, ended);
  ScratchPool pool;
  parallel_ranges(bins.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    auto scratch = pool.take();
    for (std::size_t i = begin; i < end && !is_ended(ended); ++i) {
      bands[i].blend(splats, shown[i], colours, scratch->sums);
      bands[i].cover(splats, shown[i], bins[i], scratch->sums);
      take_rows(bands[i], scratch->sums, scratch->rows);
      sink(bands[i].first_pixel(), scratch->rows);
    }
    pool.give(std::move(scratch));
  });
}

SplatImage rasterise(const std::vector<Splat>& splats, int width, int height, int threads,
                     const ColourSource& source) {
  const std::size_t pixels = std::size_t(width) * std::size_t(height);
  SplatImage image;
  image.colour.resize(pixels);
  image.coverage.resize(pixels);
  image.depth.resize(pixels);
  rasterise(splats, width, height, threads, source,
            [&](std::size_t first_pixel, const SplatImage& rows) {
              const auto at = static_cast<std::ptrdiff_t>(first_pixel);
              std::copy(rows.colour.begin(), rows.colour.end(), image.colour.begin() + at);
              std::copy(rows.coverage.begin(), rows.coverage.end(), image.coverage.begin() + at);
              std::copy(rows.depth.begin(), rows.depth.end(), image.depth.begin() + at);
            });
  return image;
}

SplatImage rasterise(const std::vector<Splat>& splats, int width, int height, int threads,
                     const std::function<std::array<float, 3>(std::uint32_t)>& colour) {
  return rasterise(splats, width, height, threads,
                   ColourSource([&](std::span<const std::uint32_t> points,
                                    std::span<std::array<float, 3>> colours) {
                     std::transform(points.begin(), points.end(), colours.begin(), colour);
                   }));
}

}  // namespace slf
