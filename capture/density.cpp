// SPDX-License-Identifier: Apache-2.0
// From the cameras' pixels to the grid's step.
#include "capture/density.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numeric>
#include <utility>
#include <vector>

#include "capture/densify.h"
#include "capture/mesh_sampling.h"
#include "capture/mesh_triangles.h"
#include "capture/nearest.h"
#include "capture/quantile.h"
#include "capture/thin_layer.h"

namespace slf {

namespace {

using Floats = std::array<float, 3>;

constexpr std::size_t kSampledPoints = 1000;
constexpr double kMostCells = (1 << 21) - 2;  // along an axis: 21 bits
constexpr double kFacing = 0.5;  // least cosine: a slanted view resolves one direction less
// How much finer than the cloud a grid may be, over the distance of the fourth neighbour: half a
// spacing puts points nearer to the surface and merges none, and costs positions alone.
constexpr double kVoxelPerSpacing = 0.46;
// Share of the voxel that photographs ask for: points nearer to each other are merged, others are
// kept, each where it is. (can, 256 x 256, Q = 48: 37,810 B 28.33 dB kept, 42,022 B 27.94 merged.)
constexpr double kDense = 0.8;
// The fourth neighbours of a cloud of voxels are no farther, in voxels.
constexpr double kSparsestVoxels = 8;
// Voxels between points of the cloud: what is between is a guess. On a given grid more may be asked
// for, as long as the cells looked at are bounded.
constexpr double kMostDensified = 4, kMostCellsLookedAt = 1 << 30;

std::size_t stride_of(std::size_t points) {
  return std::max<std::size_t>((points + kSampledPoints - 1) / kSampledPoints, 1);
}

/// The median, not the mean: clouds of structure from motion have points far from the others.
double median_spacing(std::span<const Floats> points) {
  if (points.size() < 2) return 0;
  const int k = static_cast<int>(std::min<std::size_t>(points.size(), 5));  // itself and four more
  const NearestPoints tree(points);
  std::array<std::uint32_t, 5> index{};
  std::array<float, 5> squared{};
  std::vector<double> distances;
  for (std::size_t p = 0; p < points.size(); p += stride_of(points.size())) {
    tree.nearest(points[p], k, index.data(), squared.data());
    distances.push_back(std::sqrt(static_cast<double>(squared[static_cast<std::size_t>(k - 1)])));
  }
  return median(std::move(distances));
}

double largest_extent(std::span<const Floats> points) {
  double extent = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    double low = double{points[0][k]}, high = low;
    for (const Floats& p : points) {
      low = std::min(low, double{p[k]});
      high = std::max(high, double{p[k]});
    }
    extent = std::max(extent, high - low);
  }
  return extent;
}

/// The largest whole number that all differences of coordinates are multiples of; 1 of one point.
double pitch_of(std::span<const Floats> points) {
  std::uint64_t pitch = 0;
  for (const Floats& p : points)
    for (std::size_t k = 0; k < 3 && pitch != 1; ++k)
      pitch = std::gcd(pitch,
                       static_cast<std::uint64_t>(std::abs(double{p[k]} - double{points[0][k]})));
  return static_cast<double>(std::max<std::uint64_t>(pitch, 1));
}

/// The voxel that keeps whole numbers apart. Voxels stay what they are, sparse ones too (those of
/// 12 bits have a third of their neighbours). Whole millimetres of a scan are no voxels: half a
/// spacing.
double voxel_of_whole_numbers(std::span<const Floats> points, double spacing, double held) {
  const double pitch = pitch_of(points);
  return spacing <= kSparsestVoxels * pitch ? pitch
                                            : std::max(std::floor(held / pitch), 1.0) * pitch;
}

bool whole_numbers(std::span<const Floats> points) {
  return std::all_of(points.begin(), points.end(), [](const Floats& p) {
    return std::all_of(p.begin(), p.end(), [](float x) { return x == std::floor(x); });
  });
}

Result<VoxelCloud, InputError> voxelise_mesh(const Mesh& mesh, int bits, double voxel_size) {
  SLF_TRY(const Grid grid,
          choose_grid(bounding_box(mesh), mesh.triangles.size(), bits, voxel_size));
  SLF_TRY(const PointCloud points, sample_mesh(mesh, grid));
  if (points.positions.empty())
    return InputError{Errc::kInvalidInput, "mesh: no face has an area on this grid"};
  return voxelise_on(points, grid);
}

Result<VoxelCloud, InputError> voxelise_densely(const PointCloud& cloud, double spacing, int bits,
                                                double voxel_size, int threads) {
  SLF_TRY(const VoxelCloud coarse, voxelise(cloud, bits, voxel_size));  // for its grid and checks
  const double around = 2 * spacing / coarse.grid.step + 3;             // cells, per axis
  if (around * around * around * double(cloud.positions.size()) > kMostCellsLookedAt)
    return InputError{Errc::kInvalidInput, "densify: the grid is too fine for the cloud"};
  PointCloud dense = densify(cloud, spacing, coarse.grid, threads);
  return dense.positions.size() < coarse.positions.size() ? coarse
                                                          : voxelise_on(dense, coarse.grid);
}

struct View {
  const Camera* camera;
  Vec3 centre;
  double focal;
};

/// World units that a pixel of this view spans at the point; 0: it does not see it.
double span_of_pixel(const View& view, const Vec3& point, const Floats* normal) {
  double depth = 0;
  const auto image = view.camera->project(point, &depth);
  if (!image || (*image)[0] < 0 || (*image)[1] < 0 || (*image)[0] > view.camera->width ||
      (*image)[1] > view.camera->height)
    return 0;
  if (normal != nullptr) {
    double along = 0, squared = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double to_camera = view.centre[k] - point[k];
      along += to_camera * double{(*normal)[k]};
      squared += to_camera * to_camera;
    }
    if (!(along >= kFacing * std::sqrt(squared))) return 0;
  }
  return depth / view.focal;
}

}  // namespace

double pixel_on_surface(const Capture& capture, std::span<const int> cameras,
                        std::span<const Floats> points, std::span<const Floats> normals) {
  std::vector<View> views;
  for (const int c : cameras) {
    const Camera& camera = capture.cameras[static_cast<std::size_t>(c)];
    views.push_back({&camera, camera.centre(), std::sqrt(camera.fx * camera.fy)});
  }
  std::vector<double> sharpest;
  for (std::size_t p = 0; p < points.size(); p += stride_of(points.size())) {
    const Vec3 point{double{points[p][0]}, double{points[p][1]}, double{points[p][2]}};
    double least = 0;
    for (const View& view : views) {
      const double span = span_of_pixel(view, point, normals.empty() ? nullptr : &normals[p]);
      if (span > 0 && (least == 0 || span < least)) least = span;
    }
    if (least > 0) sharpest.push_back(least);
  }
  return median(std::move(sharpest));
}

Result<VoxelCloud, InputError> voxelise_geometry(const Capture& capture, const PointCloud& cloud,
                                                 std::span<const int> cameras, int bits,
                                                 double voxel_size, DensifySettings densify,
                                                 int threads) {
  const bool surface = !capture.mesh.triangles.empty();
  Density density;
  if (bits == 0 && voxel_size == 0) {
    density = choose_density(capture, cameras, cloud.normals.empty() ? DensifySettings{} : densify);
    voxel_size = density.voxel_size;
    if (voxel_size == 0) bits = 1;  // a single point, or all at one place
  } else {
    density.pixel =
        pixel_on_surface(capture, cameras, capture.cloud.positions, capture.cloud.normals);
    density.densified = densify.mode == Densify::kOn && !surface && !cloud.normals.empty();
    if (density.densified) density.spacing = median_spacing(cloud.positions);
  }
  const bool automatic = density.voxel_size > 0;
  const auto on_grid = [&] {
    return surface             ? voxelise_mesh(capture.mesh, bits, voxel_size)
           : density.densified ? voxelise_densely(cloud, density.spacing, bits, voxel_size, threads)
                               : voxelise(cloud, bits, voxel_size);
  };
  SLF_TRY(VoxelCloud voxels, on_grid());
  const double most = double(kMostAutomaticPoints), count = double(voxels.positions.size());
  if (automatic && density.pixel > 0 && count > most) {
    voxel_size *= std::sqrt(count / most);
    SLF_TRY(voxels, on_grid());
  }
  if (automatic && !surface && density.merged && !voxels.normals.empty()) thin_layer(cloud, voxels);
  density.voxel_size = voxels.grid.step;
  voxels.density = density;
  return voxels;
}

std::string merged_warning(const VoxelCloud& cloud, std::size_t points) {
  constexpr double kFew = 0.02;
  if (cloud.density.merged || cloud.density.densified ||
      double(cloud.merged) <= kFew * double(points))
    return {};
  char text[160];
  std::snprintf(text, sizeof text,
                "%zu of %zu points are nearer to another than a voxel and merged with it: "
                "--voxel-size %.4g keeps more of them apart",
                cloud.merged, points, cloud.density.voxel_size / 2);
  return text;
}

std::string density_warning(const Density& density) {
  const double wanted = kPixelsPerVoxel * density.pixel;
  if (wanted == 0 || density.densified || density.voxel_size <= 1.001 * wanted) return {};
  char text[160];
  std::snprintf(text, sizeof text,
                "the photographs resolve more than %s: a voxel is %.2f pixels, not %.2f%s",
                density.limited_by_cloud ? "the cloud has" : "2^20 points can show",
                density.voxel_size / density.pixel, kPixelsPerVoxel,
                density.limited_by_cloud ? " (--densify on makes up points between)" : "");
  return text;
}

Density choose_density(const Capture& capture, std::span<const int> cameras,
                       DensifySettings densify) {
  const PointCloud& cloud = capture.cloud;
  Density density;
  if (cloud.positions.empty()) return density;
  density.pixel = pixel_on_surface(capture, cameras, cloud.positions, cloud.normals);
  const bool surface = !capture.mesh.triangles.empty() && density.pixel > 0;
  if (!surface) density.spacing = median_spacing(cloud.positions);
  const double resolved =
      surface ? automatic_step(capture.mesh, density.pixel) : kPixelsPerVoxel * density.pixel;
  const double held = kVoxelPerSpacing * density.spacing;
  density.limited_by_cloud = held > resolved;
  density.merged = surface || density.spacing < kDense * resolved;
  density.voxel_size = density.merged ? resolved : held;
  if (!density.merged && resolved > 0 && density.spacing > resolved)
    density.densified =
        densify.mode == Densify::kOn ||
        (densify.mode == Densify::kAuto && density.spacing >= densify.from * resolved &&
         !whole_numbers(cloud.positions) && on_even_surface(cloud, density.spacing));
  if (density.densified) density.voxel_size = std::max(resolved, density.spacing / kMostDensified);
  const double extent = largest_extent(cloud.positions);
  if (extent > 0) density.voxel_size = std::clamp(density.voxel_size, extent / kMostCells, extent);
  if (!density.merged && !density.densified && whole_numbers(cloud.positions))
    density.voxel_size =
        std::max(voxel_of_whole_numbers(cloud.positions, density.spacing, density.voxel_size),
                 std::ceil(extent / kMostCells));
  return density;
}

}  // namespace slf
