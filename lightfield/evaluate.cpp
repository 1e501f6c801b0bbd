// One definition of quality. Spec annex D.
#include "slf/evaluate.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "capture/nearest.h"
#include "capture/spacing.h"
#include "lightfield/colour.h"
#include "lightfield/observe_camera.h"
#include "lightfield/render_splats.h"
#include "lightfield/ssim.h"
#include "slf/fit.h"
#include "slf/parallel.h"
#include "slf/render.h"

namespace slf {
namespace {

/// Luma of R, G, B. ITU-R BT.709.
template <class T>
double luma(const T& rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

/// Squared errors of 8-bit values per channel and of luma, and how many values each has.
struct ErrorSum {
  std::array<double, 3> squares{};
  double luma_squares = 0;
  std::uint64_t count = 0;

  void add(const std::array<double, 3>& error) {
    for (std::size_t k = 0; k < 3; ++k) squares[k] += error[k] * error[k];
    luma_squares += luma(error) * luma(error);
    ++count;
  }
  void add_all(const ErrorSum& other) {
    for (std::size_t k = 0; k < 3; ++k) squares[k] += other.squares[k];
    luma_squares += other.luma_squares;
    count += other.count;
  }
  double luma_psnr() const { return psnr(luma_squares, count); }
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

/// One sum per δ′. `seen` holds the views of the smallest; the cone is the observer's own.
std::vector<ErrorSum> point_errors(const ViewMaps& maps, const Capture& capture,
                                   const ObservedPoints& points, const Observations& seen,
                                   const std::vector<double>& deltas, int threads) {
  constexpr std::size_t kGrain = 1024;
  std::vector<Vec3> centres;
  for (const Camera& camera : capture.cameras) centres.push_back(camera.centre());
  std::vector<double> least;
  for (const double delta : deltas) least.push_back(least_cosine(delta));
  std::vector<std::vector<ErrorSum>> parts((maps.num_points() + kGrain - 1) / kGrain,
                                           std::vector<ErrorSum>(deltas.size()));
  parallel_ranges(maps.num_points(), kGrain, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<ErrorSum>& part = parts[begin / kGrain];
    for (std::size_t p = begin; p < end; ++p)
      for (std::uint64_t i = seen.first[p]; i < seen.first[p + 1]; ++i) {
        const auto [theta, gamma] = seen.direction[i];
        const auto radiance = maps.radiance(p, theta, gamma);
        std::array<double, 3> error{};
        for (std::size_t k = 0; k < 3; ++k)
          error[k] = to_display(radiance[k], maps.header().transfer) -
                     to_display(seen.colour[i][k], Transfer::kDisplay);
        const double cosine =
            view_cosine(points.positions[p], points.normals[p], centres[seen.camera[i]]);
        for (std::size_t d = 0; d < deltas.size(); ++d)
          if (cosine >= least[d]) part[d].add(error);
      }
  });
  std::vector<ErrorSum> sums(deltas.size());
  for (const auto& part : parts)
    for (std::size_t d = 0; d < deltas.size(); ++d) sums[d].add_all(part[d]);
  return sums;
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
  SsimSum ssim;
  std::uint64_t object_pixels = 0;
  double seconds = 0;  ///< of the rendering
};

/// @param mask  where the photograph shows the object; on return where both do
ImageErrors compare(const Image& photograph, const Rendering& rendering,
                    std::vector<std::uint8_t>& mask) {
  ImageErrors result;
  const auto channels = static_cast<std::size_t>(photograph.channels);
  std::vector<float> photograph_luma(mask.size()), rendering_luma(mask.size());
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (!mask[i]) continue;
    ++result.object_pixels;
    mask[i] = rendering.coverage[i] >= 128;
    if (!mask[i]) continue;
    const std::uint8_t *is = &rendering.image.data[3 * i], *was = &photograph.data[channels * i];
    result.errors.add({double(is[0]) - was[0], double(is[1]) - was[1], double(is[2]) - was[2]});
    rendering_luma[i] = static_cast<float>(luma(is));
    photograph_luma[i] = static_cast<float>(luma(was));
  }
  result.ssim = ssim(photograph_luma, rendering_luma, mask, photograph.width, photograph.height);
  return result;
}

/// `camera`'s photograph against what the renderer draws.
Result<ImageErrors, InputError> compare_image(const Renderer& renderer, const Capture& capture,
                                              int camera_index, const Surface& surface) {
  SLF_TRY(const Image photograph, load_image(capture, camera_index));
  const Camera& camera = capture.cameras[std::size_t(camera_index)];
  const auto start = std::chrono::steady_clock::now();
  const Rendering rendering = renderer.render(camera);
  const auto end = std::chrono::steady_clock::now();
  auto mask = object_mask(photograph, camera, capture.cloud, surface);
  ImageErrors errors = compare(photograph, rendering, mask);
  errors.seconds = std::chrono::duration<double>(end - start).count();
  return errors;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
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
          auto errors = compare_image(renderer, capture, cameras[i], surface);
          if (errors) {
            each[i] = std::move(*errors);
          } else {
            failures[i] = errors.error();
          }
        }
      },
      [&](std::size_t done) {
        if (progress) progress("images", double(done) / double(cameras.size()));
      });
  ErrorSum pooled;
  SsimSum similar;
  std::uint64_t object_pixels = 0;
  std::vector<double> seconds;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (failures[i]) return *failures[i];
    pooled.add_all(each[i].errors);
    similar.sum += each[i].ssim.sum;
    similar.count += each[i].ssim.count;
    object_pixels += each[i].object_pixels;
    seconds.push_back(each[i].seconds);
    quality.image.psnr_each.push_back(each[i].errors.psnr());
  }
  quality.image.psnr = pooled.psnr();
  quality.image.ssim = similar.sum / double(std::max<std::uint64_t>(similar.count, 1));
  quality.image.coverage = object_pixels > 0 ? double(pooled.count) / double(object_pixels) : 0;
  quality.render_seconds = median(std::move(seconds));
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
  if (settings.deltas_degrees.empty()) return invalid("evaluation needs at least one delta");
  for (const double delta : settings.deltas_degrees)
    if (!(delta >= 0 && delta <= 90)) return invalid("delta must be 0 .. 90 degrees");
  for (const int camera : cameras)
    if (camera < 0 || std::size_t(camera) >= capture.cameras.size())
      return invalid("camera index beyond the capture's cameras");

  const NearestPoints tree(capture.cloud.positions);
  Surface surface = capture_surface(capture, settings.threads);
  if (!(surface.spacing > 0)) surface.spacing = maps.header().grid.step;  // a single point
  const ObservedPoints points = decoded_points(maps, surface, tree, settings.threads);
  ObserveSettings observing;
  observing.delta_degrees =
      *std::min_element(settings.deltas_degrees.begin(), settings.deltas_degrees.end());
  observing.depth_tolerance = settings.depth_tolerance;
  observing.threads = settings.threads;
  SLF_TRY(const Observations seen, observe(capture, cameras, points, capture.cloud.positions,
                                           surface.spacing, observing, progress));

  Quality quality;
  const auto errors =
      point_errors(maps, capture, points, seen, settings.deltas_degrees, settings.threads);
  for (std::size_t d = 0; d < errors.size(); ++d) {
    const ErrorSum& e = errors[d];
    quality.points.push_back({settings.deltas_degrees[d],
                              e.psnr(),
                              e.luma_psnr(),
                              {e.channel_psnr(0), e.channel_psnr(1), e.channel_psnr(2)},
                              e.count});
  }
  if (settings.images) {
    SLF_CHECK(compare_images(maps, capture, cameras, surface, settings.threads, progress, quality));
  }
  return quality;
}

}  // namespace slf
