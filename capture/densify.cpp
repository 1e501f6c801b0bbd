// SPDX-License-Identifier: Apache-2.0
#include "capture/densify.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "capture/nearest.h"
#include "capture/quantile.h"
#include "capture/resample.h"

namespace slf {
namespace {

// In spacings. Swept on a thinned can; what matters is that a gap of a square lattice of points
// (0.71) is within reach and that a rim is not carried on much beyond its last point.
constexpr double kReach = 0.57, kSupport = 0.9, kGap = 0.8, kOffCentre = 0.48, kOffPlane = 0.15;

// Flatness of a point's twelve neighbours: thickness over width; evenness: the ninth decile of
// spacings over the median. A sphere of 100 points has 0.15, a cloud in a volume 0.6.
constexpr double kFlat = 0.2, kEven = 2;
constexpr std::size_t kSamples = 1000, kNear = 13;

/// Thickness of these points about their mean.
double thickness_over_width(const PointCloud& cloud, std::span<const std::uint32_t> of) {
  Eigen::Matrix<double, 3, Eigen::Dynamic> at(3, static_cast<Eigen::Index>(of.size()));
  for (std::size_t i = 0; i < of.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      at(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) =
          double{cloud.positions[of[i]][k]};
  at.colwise() -= at.rowwise().mean().eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(at * at.transpose(),
                                                              Eigen::EigenvaluesOnly);
  const auto& spread = solver.eigenvalues();  // ascending
  return spread[1] > 0 ? std::sqrt(std::max(spread[0], 0.0) / spread[1]) : 1;
}

}  // namespace

PointCloud densify(const PointCloud& cloud, double spacing, const Grid& grid, int threads) {
  SurfacePoints points{cloud.positions, cloud.normals, {}};
  points.source.resize(points.size());
  std::iota(points.source.begin(), points.source.end(), 0u);
  const double steps = std::max(spacing / grid.step, 1.0);
  ResampleSettings settings;
  settings.around = static_cast<int>(std::ceil(kGap * steps + 0.5));
  settings.reach = kReach * steps;
  settings.support = kSupport * steps + 0.5;
  settings.rim = kGap * steps + 0.3;
  settings.off_plane = kOffPlane * steps + 0.9;
  settings.off_centre = kOffCentre * steps;
  settings.on_lattice = true;
  settings.threads = threads;
  const std::int64_t size = std::int64_t{1} << grid.bits;
  SurfacePoints dense = resample(points, {grid.origin, grid.step, {size, size, size}}, settings);
  PointCloud out{std::move(dense.positions), std::move(dense.normals), {}};
  if (!cloud.colours.empty())
    for (const std::uint32_t p : dense.source) out.colours.push_back(cloud.colours[p]);
  return out;
}

bool on_even_surface(const PointCloud& cloud, double spacing) {
  if (cloud.positions.size() < kNear) return false;
  const NearestPoints tree(cloud.positions);
  const std::size_t stride = std::max<std::size_t>(cloud.positions.size() / kSamples, 1);
  std::vector<double> thickness, distances;
  std::array<std::uint32_t, kNear> near{};
  std::array<float, kNear> squared{};
  for (std::size_t p = 0; p < cloud.positions.size(); p += stride) {
    tree.nearest(cloud.positions[p], int(kNear), near.data(), squared.data());
    thickness.push_back(thickness_over_width(cloud, near));
    distances.push_back(std::sqrt(double{squared[4]}));
  }
  return quantile(std::move(thickness), 0.5) < kFlat &&
         quantile(std::move(distances), 0.9) < kEven * spacing;
}

}  // namespace slf
