#include "lightfield/render_splats.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "lightfield/splat_band.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr double kLargestPixels =
    512;                            // half width of an ellipse; bounds the work of a close camera
constexpr double kFlattest = 0.15;  // cosine to the view; flatter discs are tilted towards the eye,
                                    // as voxels have a thickness
constexpr double kFilter = 1.0;     // pixels: radius added (in squares) to every ellipse
constexpr double kSoftest = 0.5;  // share of the wide kernel in discs of 3 pixels and more: narrow
                                  // kernels are sharper, but show each disc of a close-up
constexpr double kThickness = 1.5;  // depth tolerance in disc radii, over the cosine

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vec3 rotate(const Camera& camera, const Vec3& v) {
  return {dot(camera.rotation[0], v), dot(camera.rotation[1], v), dot(camera.rotation[2], v)};
}

/// The normal in camera axes, turned to the viewer and at least kFlattest towards the eye.
Vec3 facing_normal(const Vec3& normal, const Vec3& to_eye) {
  double cosine = dot(normal, to_eye);
  if (!(dot(normal, normal) > 0.5)) return to_eye;
  const double sign = cosine < 0 ? -1 : 1;
  cosine = std::abs(cosine);
  if (cosine >= kFlattest) return {sign * normal[0], sign * normal[1], sign * normal[2]};
  // What is across the view keeps its direction and gets the length that is left.
  Vec3 n;
  const double across = std::sqrt(std::max(1 - cosine * cosine, 1e-12));
  const double scale = std::sqrt(1 - kFlattest * kFlattest) / across;
  for (std::size_t k = 0; k < 3; ++k)
    n[k] = scale * (sign * normal[k] - cosine * to_eye[k]) + kFlattest * to_eye[k];
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
  const Spread s{disc_spread.uu + kFilter * kFilter, disc_spread.uv,
                 disc_spread.vv + kFilter * kFilter};
  const double half_width = std::sqrt(s.uu), half_height = std::sqrt(s.vv);
  const auto [u, v] = *image;
  if (!(half_width < kLargestPixels && half_height < kLargestPixels)) return std::nullopt;
  if (!(u + half_width > 0 && u - half_width < camera.width && v + half_height > 0 &&
        v - half_height < camera.height))
    return std::nullopt;

  // On the plane n . x = n . p, x = z (x', y', 1): 1 / z is linear in x', y', so in u, v.
  const double plane = dot(n, p);
  const double depth_extent = disc.radius * std::sqrt(std::max(1 - n[2] * n[2], 0.0));
  const double inverse = 1 / s.determinant();
  Splat splat;
  splat.u = static_cast<float>(u);
  splat.v = static_cast<float>(v);
  splat.a = static_cast<float>(s.vv * inverse);
  splat.b = static_cast<float>(-s.uv * inverse);
  splat.c = static_cast<float>(s.uu * inverse);
  splat.half_width = static_cast<float>(half_width);
  splat.half_height = static_cast<float>(half_height);
  splat.inverse_depth = static_cast<float>(1 / z);
  splat.inverse_depth_du = static_cast<float>(n[0] / (plane * camera.fx));
  splat.inverse_depth_dv = static_cast<float>(n[1] / (plane * camera.fy));
  splat.nearest = static_cast<float>(1 / std::max(z - depth_extent, 0.25 * z));
  splat.farthest = static_cast<float>(1 / (z + depth_extent));
  splat.thickness = static_cast<float>(kThickness * disc.radius / std::max(cosine, 0.3));
  splat.weight = static_cast<float>(std::sqrt(std::max(disc_spread.determinant() * inverse, 1e-9)));
  // Half a pixel within the ellipse, so that its antialiased edge is inside the box.
  const double minor = (s.uu + s.vv) / 2 - std::hypot((s.uu - s.vv) / 2, s.uv);
  const double major = s.uu + s.vv - minor;
  splat.softness = static_cast<float>(kSoftest * std::clamp(std::sqrt(major) / 1.5 - 1, 0.0, 1.0));
  splat.edge = static_cast<float>(std::min(0.85, 1 - 0.5 / std::sqrt(minor)));
  splat.point = point;
  return splat;
}

SplatImage rasterise(const std::vector<Splat>& splats, int width, int height, int threads,
                     const std::function<std::array<float, 3>(std::uint32_t)>& colour) {
  const std::size_t pixels = std::size_t(width) * std::size_t(height);
  SplatImage image;
  image.colour.assign(pixels, {0, 0, 0});
  image.coverage.assign(pixels, 0);
  image.depth.assign(pixels, 0);
  const auto bins = bin_splats(splats, height);
  parallel_ranges(bins.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      SplatBand band(image.coverage, image.depth, width, height, i);
      std::array<float, 3>* const colours = image.colour.data() + band.first_pixel();
      for (const std::uint32_t s : bins[i]) band.draw_depth(splats[s]);
      for (const std::uint32_t s : bins[i]) {
        bool shown = false;
        std::array<float, 3> own{};
        band.draw_weights(splats[s], [&](std::size_t pixel, float weight) {
          if (!shown) own = colour(splats[s].point);
          shown = true;
          for (std::size_t k = 0; k < 3; ++k) colours[pixel][k] += weight * own[k];
        });
      }
      band.normalise([&](std::size_t pixel, float scale) {
        for (float& c : colours[pixel]) c *= scale;
      });
    }
  });
  return image;
}

}  // namespace slf
