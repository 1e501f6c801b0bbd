#include "lightfield/render_splats.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "slf/parallel.h"

namespace slf {
namespace {

constexpr int kBandRows = 16;  // rasterised by one thread, small enough for its cache
constexpr double kLargestPixels =
    512;                            // half width of an ellipse; bounds the work of a close camera
constexpr double kFlattest = 0.15;  // cosine to the view; flatter discs are tilted towards the eye,
                                    // as voxels have a thickness
constexpr double kFilter = 1.0;     // pixels: radius added (in squares) to every ellipse
constexpr float kCore = 0.8f;       // squared ellipse radius that fixes depth in the first pass
constexpr double kSoftest = 0.5;  // share of the wide kernel in discs of 3 pixels and more: narrow
                                  // kernels are sharper, but show each disc of a close-up
constexpr float kEdgeCoverage = 0.8f;  // on a disc's edge; above a half, since discs overlap and
                                       // the greatest share counts
constexpr double kThickness = 1.5;     // depth tolerance in disc radii, over the cosine

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

namespace {

/// Rows first_row .. first_row + rows - 1 of the image.
class Band {
 public:
  Band(SplatImage& image, int width, int first_row, int rows)
      : width_(width), first_row_(first_row), rows_(rows) {
    const std::size_t at = std::size_t(first_row) * std::size_t(width);
    colour_ = image.colour.data() + at;
    coverage_ = image.coverage.data() + at;
    weight_.assign(std::size_t(rows) * std::size_t(width), 0);
    depth_ = image.depth.data() + at;
    nearest_.assign(std::size_t(rows) * std::size_t(width), std::numeric_limits<float>::infinity());
  }

  void draw_depth(const Splat& s) {
    visit(s, kCore, [&](std::size_t pixel, float, float depth, float, float) {
      nearest_[pixel] = std::min(nearest_[pixel], depth);
    });
  }

  template <class Colour>
  void draw_colour(const Splat& s, Colour&& colour_of) {
    bool shown = false;
    std::array<float, 3> colour{};
    visit(s, 1.0f, [&](std::size_t pixel, float r2, float depth, float du, float dv) {
      if (coverage_[pixel] < 1)
        coverage_[pixel] = std::max(coverage_[pixel], edge_coverage(s, r2, du, dv));
      if (depth > nearest_[pixel] + s.thickness) return;
      if (!shown) colour = colour_of(s.point);
      shown = true;
      const float square = (1 - r2) * (1 - r2);
      const float weight = s.weight * square * (s.softness + (1 - s.softness) * square * square);
      for (std::size_t k = 0; k < 3; ++k) colour_[pixel][k] += weight * colour[k];
      weight_[pixel] += weight;
      depth_[pixel] += weight * depth;
    });
  }

  void normalise() {
    for (std::size_t i = 0; i < nearest_.size(); ++i) {
      if (!(weight_[i] > 0)) {
        depth_[i] = std::numeric_limits<float>::infinity();
        continue;
      }
      const float scale = 1 / weight_[i];
      for (float& c : colour_[i]) c *= scale;
      depth_[i] *= scale;
    }
  }

 private:
  /// Share of the pixel that the disc covers: distance to its edge in pixels, to first order.
  static float edge_coverage(const Splat& s, float r2, float du, float dv) {
    if (r2 < 0.04f) return 1;
    const float gu = s.a * du + s.b * dv, gv = s.b * du + s.c * dv, r = std::sqrt(r2);
    const float inside = (s.edge - r) * r / std::sqrt(gu * gu + gv * gv);
    return std::clamp(kEdgeCoverage + inside, 0.0f, 1.0f);
  }

  /// visitor(pixel, squared ellipse radius, depth, offset) for pixel centres with that radius below
  /// `limit`.
  template <class Visitor>
  void visit(const Splat& s, float limit, Visitor&& visitor) const {
    const int top = std::max(first_row_, static_cast<int>(std::ceil(s.v - s.half_height - 0.5f)));
    const int bottom =
        std::min(first_row_ + rows_ - 1, static_cast<int>(std::floor(s.v + s.half_height - 0.5f)));
    const int first = std::max(0, static_cast<int>(std::ceil(s.u - s.half_width - 0.5f)));
    const int last = std::min(width_ - 1, static_cast<int>(std::floor(s.u + s.half_width - 0.5f)));
    for (int row = top; row <= bottom; ++row) {
      const float dv = static_cast<float>(row) + 0.5f - s.v;
      const float row_square = s.c * dv * dv, row_mixed = 2 * s.b * dv;
      const float row_inverse = s.inverse_depth + s.inverse_depth_dv * dv;
      const std::size_t start = std::size_t(row - first_row_) * std::size_t(width_);
      for (int column = first; column <= last; ++column) {
        const float du = static_cast<float>(column) + 0.5f - s.u;
        const float r2 = du * (s.a * du + row_mixed) + row_square;
        if (r2 >= limit) continue;
        const float inverse = row_inverse + s.inverse_depth_du * du;
        visitor(start + std::size_t(column), r2,
                1 / std::min(std::max(inverse, s.farthest), s.nearest), du, dv);
      }
    }
  }

  int width_, first_row_, rows_;
  std::array<float, 3>* colour_;
  float* coverage_;
  float* depth_;
  std::vector<float> weight_;
  std::vector<float> nearest_;
};

/// Indices of the splats that touch each band, ascending.
std::vector<std::vector<std::uint32_t>> bin_splats(const std::vector<Splat>& splats, int height) {
  std::vector<std::vector<std::uint32_t>> bins(std::size_t((height + kBandRows - 1) / kBandRows));
  for (std::size_t i = 0; i < splats.size(); ++i) {
    const Splat& s = splats[i];
    const int top = std::max(0, static_cast<int>(std::floor(s.v - s.half_height)) / kBandRows);
    const int bottom = std::min(static_cast<int>(bins.size()) - 1,
                                static_cast<int>(std::floor(s.v + s.half_height)) / kBandRows);
    for (int band = top; band <= bottom; ++band)
      bins[std::size_t(band)].push_back(static_cast<std::uint32_t>(i));
  }
  return bins;
}

}  // namespace

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
      const int first_row = static_cast<int>(i) * kBandRows;
      Band band(image, width, first_row, std::min(kBandRows, height - first_row));
      for (const std::uint32_t s : bins[i]) band.draw_depth(splats[s]);
      for (const std::uint32_t s : bins[i]) band.draw_colour(splats[s], colour);
      band.normalise();
    }
  });
  return image;
}

}  // namespace slf
