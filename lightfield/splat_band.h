// Which splat counts where in an image, and how much: the one definition for pictures and for fits
// to pictures.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "lightfield/render_splats.h"

namespace slf {

constexpr int kBandRows = 16;  // of one band: worked on by one thread, small enough for its cache
constexpr float kCore = 0.8f;  // squared ellipse radius that fixes depth in the first pass
constexpr float kEdgeCoverage = 0.8f;  // on a disc's edge; above a half, since discs overlap and
                                       // the greatest share counts

/// Indices of the splats that touch each band, ascending.
std::vector<std::vector<std::uint32_t>> bin_splats(const std::vector<Splat>& splats, int height);

/// A band of rows. First draw_depth for all its splats, then draw_weights for all in the same
/// order, then normalise.
class SplatBand {
 public:
  /// Writes to its rows of `coverage` and `depth`, [height][width], 0 before.
  SplatBand(std::vector<float>& coverage, std::vector<float>& depth, int width, int height,
            std::size_t index)
      : width_(width),
        first_row_(static_cast<int>(index) * kBandRows),
        rows_(std::min(kBandRows, height - first_row_)),
        coverage_(coverage.data() + first_pixel()),
        depth_(depth.data() + first_pixel()),
        weight_(pixels(), 0),
        nearest_(pixels(), std::numeric_limits<float>::infinity()) {}

  std::size_t first_pixel() const { return std::size_t(first_row_) * std::size_t(width_); }
  std::size_t pixels() const { return std::size_t(rows_) * std::size_t(width_); }

  void draw_depth(const Splat& s) {
    visit(s, kCore, [&](std::size_t pixel, float, float depth, float, float) {
      nearest_[pixel] = std::min(nearest_[pixel], depth);
    });
  }

  /// count(pixel of the band, weight) for the pixels that show the splat.
  template <class Count>
  void draw_weights(const Splat& s, Count&& count) {
    visit(s, 1.0f, [&](std::size_t pixel, float r2, float depth, float du, float dv) {
      if (coverage_[pixel] < 1)
        coverage_[pixel] = std::max(coverage_[pixel], edge_coverage(s, r2, du, dv));
      if (depth > nearest_[pixel] + s.thickness) return;
      const float square = (1 - r2) * (1 - r2);
      const float weight = s.weight * square * (s.softness + (1 - s.softness) * square * square);
      count(pixel, weight);
      weight_[pixel] += weight;
      depth_[pixel] += weight * depth;
    });
  }

  /// scale(pixel of the band, what its weights must be multiplied by to have the sum 1), where
  /// there are any.
  template <class Scale>
  void normalise(Scale&& scale) {
    for (std::size_t i = 0; i < pixels(); ++i) {
      if (!(weight_[i] > 0)) {
        depth_[i] = std::numeric_limits<float>::infinity();
        continue;
      }
      scale(i, 1 / weight_[i]);
      depth_[i] *= 1 / weight_[i];
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
  float* coverage_;
  float* depth_;
  std::vector<float> weight_;
  std::vector<float> nearest_;
};

}  // namespace slf
