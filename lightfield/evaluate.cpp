// One definition of quality. Spec annex D.
#include "slf/evaluate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "capture/nearest.h"
#include "capture/spacing.h"
#include "lightfield/colour.h"
#include "lightfield/render_splats.h"
#include "slf/fit.h"
#include "slf/parallel.h"
#include "slf/render.h"

namespace slf {
namespace {

/// Squared errors of 8-bit values per channel, and how many values each channel has.
struct ErrorSum {
  std::array<double, 3> squares{};
  std::uint64_t count = 0;

  void add(const ErrorSum& other) {
    for (std::size_t k = 0; k < 3; ++k) squares[k] += other.squares[k];
    count += other.count;
  }
  double channel_psnr(std::size_t k) const { return psnr(squares[k], count); }
  double psnr() const { return psnr(squares[0] + squares[1] + squares[2], 3 * count); }

 private:
  /// Infinite where nothing differs; NaN where nothing was compared.
  static double psnr(double squares, std::uint64_t count) {
    if (count == 0) return std::numeric_limits<double>::quiet_NaN();
    return 10 * std::log10(255.0 * 255.0 * static_cast<double>(count) / squares);
  }
};

/// The capture's surface: what normals and visibility are judged by.
struct Surface {
  std::vector<std::array<float, 3>> normals;  ///< [capture's points]
  double spacing = 0;                         ///< world units
};

Surface capture_surface(const Capture& capture, int threads) {
  Surface surface;
  surface.spacing = typical_spacing(capture.cloud.positions);
  surface.normals = capture.cloud.normals;
  if (!surface.normals.empty()) return surface;
  std::vector<Vec3> viewpoints;
  for (const Camera& camera : capture.cameras) viewpoints.push_back(camera.centre());
  surface.normals = estimate_normals(capture.cloud, viewpoints, 16, threads);
  return surface;
}

/// Decoded points with the normals of the nearest captured ones.
ObservedPoints decoded_points(const ViewMaps& maps, const Surface& surface,
                              const NearestPoints& tree, int threads) {
  ObservedPoints points;
  points.positions.resize(maps.num_points());
  points.normals.resize(maps.num_points());
  parallel_ranges(maps.num_points(), 1024, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Vec3 world = maps.header().grid.world(maps.positions()[p]);
      points.positions[p] = {float(world[0]), float(world[1]), float(world[2])};
      std::uint32_t nearest = 0;
      tree.nearest(points.positions[p], 1, &nearest, nullptr);
      points.normals[p] = surface.normals[nearest];
    }
  });
  return points;
}

/// 8-bit display value of a grey level of the given transfer.
double to_display(float value, Transfer transfer) {
  const double clamped = std::clamp(static_cast<double>(value), 0.0, 255.0);
  const double display =
      transfer == Transfer::kLinear ? 255 * linear_to_srgb(clamped / 255) : clamped;
  return std::floor(display + 0.5);
}

ErrorSum point_errors(const ViewMaps& maps, const Observations& seen, int threads) {
  constexpr std::size_t kGrain = 1024;
  std::vector<ErrorSum> parts((maps.num_points() + kGrain - 1) / kGrain);
  parallel_ranges(maps.num_points(), kGrain, threads, [&](std::size_t begin, std::size_t end) {
    ErrorSum& part = parts[begin / kGrain];
    for (std::size_t p = begin; p < end; ++p)
      for (std::uint64_t i = seen.first[p]; i < seen.first[p + 1]; ++i) {
        const auto [theta, gamma] = seen.direction[i];
        const auto radiance = maps.radiance(p, theta, gamma);
        for (std::size_t k = 0; k < 3; ++k) {
          const double error = to_display(radiance[k], maps.header().transfer) -
                               to_display(seen.colour[i][k], Transfer::kDisplay);
          part.squares[k] += error * error;
        }
        ++part.count;
      }
  });
  ErrorSum sum;
  for (const ErrorSum& part : parts) sum.add(part);
  return sum;
}

/// Where a photograph shows the object, 0 or 1 per pixel: its alpha, else where the capture's own
/// points project, each a disc that reaches the next ones.
std::vector<std::uint8_t> object_mask(const Image& photograph, const Camera& camera,
                                      const PointCloud& cloud, const Surface& surface) {
  std::vector<std::uint8_t> mask(std::size_t(photograph.width) * std::size_t(photograph.height));
  if (photograph.channels == 4) {
    for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = photograph.data[4 * i + 3] >= 128;
    return mask;
  }
  std::vector<Splat> splats;
  for (std::size_t p = 0; p < cloud.positions.size(); ++p) {
    const auto& at = cloud.positions[p];
    const auto& n = surface.normals[p];
    const Disc disc{{at[0], at[1], at[2]}, {n[0], n[1], n[2]}, surface.spacing};
    if (const auto splat = project_disc(camera, disc, static_cast<std::uint32_t>(p)))
      splats.push_back(*splat);
  }
  const SplatImage covered = rasterise(splats, camera.width, camera.height, 1, [](std::uint32_t) {
    return std::array<float, 3>{0, 0, 0};
  });
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = covered.coverage[i] >= 0.5f;
  return mask;
}

struct ImageErrors {
  ErrorSum errors;
  std::uint64_t object_pixels = 0;
};

ImageErrors compare(const Image& photograph, const Rendering& rendering,
                    const std::vector<std::uint8_t>& mask) {
  ImageErrors result;
  const auto channels = static_cast<std::size_t>(photograph.channels);
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (!mask[i]) continue;
    ++result.object_pixels;
    if (rendering.coverage[i] < 128) continue;
    ++result.errors.count;
    for (std::size_t k = 0; k < 3; ++k) {
      const int error = rendering.image.data[3 * i + k] - photograph.data[channels * i + k];
      result.errors.squares[k] += error * error;
    }
  }
  return result;
}

/// Renders every camera and compares; one camera per thread.
Result<Done, InputError> compare_images(const ViewMaps& maps, const Capture& capture,
                                        std::span<const int> cameras, const Surface& surface,
                                        int threads, const Progress& progress, Quality& quality) {
  RenderSettings render_settings;
  render_settings.threads = 1;
  const Renderer renderer(maps, render_settings);
  std::vector<ImageErrors> each(cameras.size());
  std::vector<std::optional<InputError>> failures(cameras.size());
  parallel_ranges(
      cameras.size(), 1, threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const auto photograph = load_image(capture, cameras[i]);
          if (!photograph) {
            failures[i] = photograph.error();
            continue;
          }
          const Camera& camera = capture.cameras[std::size_t(cameras[i])];
          each[i] = compare(*photograph, renderer.render(camera),
                            object_mask(*photograph, camera, capture.cloud, surface));
        }
      },
      [&](std::size_t done) {
        if (progress) progress("images", double(done) / double(cameras.size()));
      });
  ErrorSum pooled;
  std::uint64_t object_pixels = 0;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (failures[i]) return *failures[i];
    pooled.add(each[i].errors);
    object_pixels += each[i].object_pixels;
    quality.image_psnr_each.push_back(each[i].errors.psnr());
  }
  quality.image_psnr = pooled.psnr();
  quality.coverage = object_pixels > 0 ? double(pooled.count) / double(object_pixels) : 0;
  return Done{};
}

}  // namespace

Result<Quality, InputError> evaluate(const ViewMaps& maps, const Capture& capture,
                                     std::span<const int> cameras, const EvaluateSettings& settings,
                                     const Progress& progress) {
  const auto invalid = [](const char* why) { return InputError{Errc::kInvalidArgument, why}; };
  if (cameras.empty()) return invalid("evaluation needs at least one camera");
  if (capture.cloud.positions.empty()) return invalid("evaluation needs the capture's points");
  if (maps.num_points() == 0) return invalid("the light field has no points");
  for (const int camera : cameras)
    if (camera < 0 || std::size_t(camera) >= capture.cameras.size())
      return invalid("camera index beyond the capture's cameras");

  const NearestPoints tree(capture.cloud.positions);
  Surface surface = capture_surface(capture, settings.threads);
  if (!(surface.spacing > 0)) surface.spacing = maps.header().grid.step;  // a single point
  ObserveSettings observing;
  observing.delta_degrees = settings.delta_degrees;
  observing.depth_tolerance = settings.depth_tolerance;
  observing.threads = settings.threads;
  SLF_TRY(const Observations seen,
          observe(capture, cameras, decoded_points(maps, surface, tree, settings.threads),
                  capture.cloud.positions, surface.spacing, observing, progress));

  Quality quality;
  const ErrorSum errors = point_errors(maps, seen, settings.threads);
  quality.point_psnr = errors.psnr();
  for (std::size_t k = 0; k < 3; ++k) quality.channel_psnr[k] = errors.channel_psnr(k);
  quality.observations = errors.count;
  if (settings.images) {
    SLF_CHECK(compare_images(maps, capture, cameras, surface, settings.threads, progress, quality));
  }
  return quality;
}

}  // namespace slf
