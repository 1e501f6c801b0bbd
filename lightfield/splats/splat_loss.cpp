// SPDX-License-Identifier: Apache-2.0
// What the harmonics of splats lose of the colours along directions.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lightfield/harmonics.h"
#include "lightfield/splats/splat_axes.h"
#include "lightfield/splats/splat_directions.h"
#include "slf/parallel.h"
#include "slf/splats.h"

namespace slf {
namespace {

constexpr std::size_t kProbes = 233;  // another number and turn than the fit's: none in common
constexpr double kTurn = 1;
constexpr std::size_t kSplatsPerRange = 256;

/// Sums over a run of points, weighted.
struct Sums {
  std::array<double, 3> squares{}, one_colour{};
  double weight = 0;

  void operator+=(const Sums& other) {
    for (std::size_t c = 0; c < 3; ++c) {
      squares[c] += other.squares[c];
      one_colour[c] += other.one_colour[c];
    }
    weight += other.weight;
  }
};

class LossOfPoint {
 public:
  LossOfPoint(const SplatCloud& splats, std::span<const Vec3> directions)
      : splats_(splats), directions_(directions), rows_(directions.size()) {
    const Harmonics harmonics(splats.degree);
    for (std::size_t j = 0; j < directions.size(); ++j) {
      turned_.push_back(turned(splats.axes, directions[j]));
      const Vec3& v = turned_.back();
      harmonics.evaluate(Vec3{-v[0], -v[1], -v[2]}, rows_[j].data());
      for (float& h : rows_[j]) h *= static_cast<float>(255 / std::sqrt(4 * std::numbers::pi));
    }
  }

  /// @param colours  [directions] 0 .. 255
  void add(std::size_t p, const std::array<float, 3>* colours, Sums& sums) const {
    std::array<double, 3> first{}, second{};
    double total = 0;
    for (std::size_t j = 0; j < rows_.size(); ++j) {
      const double w = double{weight_of(splats_.normals[p], splats_.front[p], turned_[j])};
      if (w == 0) continue;
      const auto splat = colour(p, rows_[j]);
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = double{colours[j][c]};
        sums.squares[c] += w * (splat[c] - value) * (splat[c] - value);
        first[c] += w * value;
        second[c] += w * value * value;
      }
      total += w;
    }
    sums.weight += total;
    if (total > 0)
      for (std::size_t c = 0; c < 3; ++c)
        sums.one_colour[c] += std::max(0.0, second[c] - first[c] * first[c] / total);
  }

 private:
  std::array<double, 3> colour(std::size_t p, const std::array<float, 16>& row) const {
    const std::size_t count = splats_.num_harmonics();
    const float* coefficient = &splats_.harmonics[p * 3 * count];
    std::array<float, 3> rgb{127.5f, 127.5f, 127.5f};
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t c = 0; c < 3; ++c) rgb[c] += row[k] * coefficient[3 * k + c];
    return {double{std::clamp(rgb[0], 0.0f, 255.0f)}, double{std::clamp(rgb[1], 0.0f, 255.0f)},
            double{std::clamp(rgb[2], 0.0f, 255.0f)}};
  }

  const SplatCloud& splats_;
  std::span<const Vec3> directions_;
  std::vector<Vec3> turned_;  // axes of the file, from the point to the eye
  std::vector<std::array<float, 16>> rows_;
};

double psnr(double squares, double weight) {
  return 10 * std::log10(255.0 * 255 * weight / squares);
}

}  // namespace

SplatLoss splat_loss(const ViewMaps& maps, const SplatCloud& splats, int threads) {
  const std::vector<Vec3> directions = even_directions(kProbes, kTurn);
  const DirectionSampler sampler(maps, directions);
  const LossOfPoint loss(splats, directions);
  std::vector<Sums> parts((splats.size() + kSplatsPerRange - 1) / kSplatsPerRange);
  parallel_ranges(splats.size(), kSplatsPerRange, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<std::array<float, 3>> colours;
    sampler.sample(begin, end, colours);
    for (std::size_t p = begin; p < end; ++p)
      loss.add(p, &colours[(p - begin) * directions.size()], parts[begin / kSplatsPerRange]);
  });
  Sums all;
  for (const Sums& part : parts) all += part;
  SplatLoss out;
  double squares = 0, one_colour = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    out.channel_psnr[c] = psnr(all.squares[c], all.weight);
    squares += all.squares[c];
    one_colour += all.one_colour[c];
  }
  out.psnr = psnr(squares, 3 * all.weight);
  out.psnr_one_colour = psnr(one_colour, 3 * all.weight);
  return out;
}

}  // namespace slf
