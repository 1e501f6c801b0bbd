// Which splat counts where in an image, and how much: the one definition for pictures and for fits
// to pictures.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "lightfield/reference_kernel.h"
#include "lightfield/render_splats.h"

namespace slf {

constexpr int kBandRows = 32;  // of one band: worked on by one thread, small enough for its cache

/// Indices of the splats that touch each band, ascending.
std::vector<std::vector<std::uint32_t>> bin_splats(const std::vector<Splat>& splats, int height);

/// A band of rows. Its functions are called in this order.
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
        nearest_(pixels(), 0),
        farthest_(std::size_t(width + kBlock - 1) / kBlock, std::numeric_limits<float>::infinity()),
        open_(farthest_.size(), 0) {}

  std::size_t first_pixel() const { return std::size_t(first_row_) * std::size_t(width_); }
  std::size_t pixels() const { return std::size_t(rows_) * std::size_t(width_); }

  /// First of all.
  void draw_depths(const std::vector<Splat>& splats, const std::vector<std::uint32_t>& shown) {
    for (const std::uint32_t i : shown) draw_depth(splats[i]);
    const auto width = std::size_t(width_);
    for (std::size_t row = 0; row < pixels(); row += width)
      for (std::size_t i = 0; i < width; ++i)
        farthest_[i / kBlock] = std::min(farthest_[i / kBlock], nearest_[row + i]);
  }

  /// Those splats that any pixel shows.
  std::vector<std::uint32_t> shown(const std::vector<Splat>& splats,
                                   const std::vector<std::uint32_t>& all) const {
    std::vector<std::uint32_t> list;
    for (const std::uint32_t i : all)
      if (shows(splats[i])) list.push_back(i);
    return list;
  }

  /// count(splat, pixel of the band, weight) for what shows, splat by splat in the order given.
  template <class Count>
  void draw_weights(const std::vector<Splat>& splats, const std::vector<std::uint32_t>& shown,
                    Count&& count) {
    for (const std::uint32_t i : shown)
      draw_weight(splats[i], [&](std::size_t pixel, float weight) { count(i, pixel, weight); });
  }

  /// All splats of the band count, hidden ones too; those that show come first, as they leave
  /// little to do.
  void draw_coverage(const std::vector<Splat>& splats, const std::vector<std::uint32_t>& shown,
                     const std::vector<std::uint32_t>& all) {
    cover_by_density();
    find_open();
    for (const std::uint32_t i : shown) draw_cover(splats[i]);
    find_open();
    for (const std::uint32_t i : all) draw_cover(splats[i]);
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
      depth_[i] = weight_[i] / depth_[i];
    }
  }

 private:
  static constexpr float kCoreReach = 0.6324555f;  // ellipse radius
  static_assert(kReferenceKernel.core == 0.4);     // its square
  static constexpr int kBlock = 8;  // columns that are looked at together for pixels not covered

  void draw_depth(const Splat& s) {
    visit(s, kCoreReach, [&](std::size_t pixel, float, float du, float dv) {
      nearest_[pixel] = std::max(nearest_[pixel], inverse_depth(s, du, dv));
    });
  }

  /// First and last block of columns that the splat may touch.
  std::array<std::size_t, 2> blocks_of(const Splat& s) const {
    const auto block = [&](float u) {
      return std::size_t(std::clamp(static_cast<int>(u), 0, width_ - 1) / kBlock);
    };
    return {block(s.u - s.half_width), block(s.u + s.half_width)};
  }

  bool shows(const Splat& s) const {
    const auto [first, last] = blocks_of(s);
    float farthest = farthest_[first];
    for (std::size_t i = first + 1; i <= last; ++i) farthest = std::min(farthest, farthest_[i]);
    if ((farthest - s.inverse_depth - s.inverse_depth_change) * s.fade >= 1) return false;
    return find(s, 1.0f, [&](std::size_t pixel, float, float du, float dv) {
      return nearness(s, pixel, inverse_depth(s, du, dv)) > 0;
    });
  }

  /// 1 at the nearest surface, 0 or less where the splat is hidden.
  float nearness(const Splat& s, std::size_t pixel, float inverse) const {
    return 1 - std::max(0.0f, (nearest_[pixel] - inverse) * s.fade);
  }

  template <class Count>
  void draw_weight(const Splat& s, Count&& count) {
    visit(s, 1.0f, [&](std::size_t pixel, float r2, float du, float dv) {
      const float inverse = inverse_depth(s, du, dv);
      const float near = nearness(s, pixel, inverse);
      if (!(near > 0)) return;
      static_assert(kReferenceKernel.exponent == 4);
      const float kernel = (1 - r2) * (1 - r2) * near;
      const float weight = s.weight * kernel * kernel;
      count(pixel, weight);
      weight_[pixel] += weight;
      depth_[pixel] += weight * inverse;
    });
  }

  void cover_by_density() {
    // The integral of (1 - r^2)^n over the unit circle is pi / (n + 1).
    constexpr auto kGain =
        float(kReferenceKernel.density_gain * (kReferenceKernel.exponent + 1) / std::numbers::pi);
    for (std::size_t i = 0; i < pixels(); ++i) {
      if (!(weight_[i] > 0)) continue;
      coverage_[i] =
          std::clamp(kGain * weight_[i] - float(kReferenceKernel.density_offset), 0.0f, 1.0f);
    }
  }

  /// Blocks of columns with pixels that show something but are not wholly covered.
  void find_open() {
    std::fill(open_.begin(), open_.end(), std::uint8_t{0});
    for (std::size_t i = 0; i < pixels(); ++i)
      if (coverage_[i] < 1 && weight_[i] > 0) open_[i % std::size_t(width_) / kBlock] = 1;
  }

  void draw_cover(const Splat& s) {
    const auto [first, last] = blocks_of(s);
    bool open = false;
    for (std::size_t i = first; i <= last; ++i) open = open || open_[i] != 0;
    if (!open) return;
    visit(s, 1.0f, [&](std::size_t pixel, float r2, float du, float dv) {
      if (coverage_[pixel] < 1 && weight_[pixel] > 0)
        coverage_[pixel] = std::max(coverage_[pixel], disc_cover(s, r2, du, dv));
    });
  }

  static float inverse_depth(const Splat& s, float du, float dv) {
    return s.inverse_depth + s.inverse_depth_du * du + s.inverse_depth_dv * dv;
  }

  /// Share of the pixel that the disc covers: distance to its edge in pixels, to first order.
  static float disc_cover(const Splat& s, float r2, float du, float dv) {
    constexpr auto kShare = float(kReferenceKernel.disc_share);
    constexpr auto kFilterSquare =
        float(kReferenceKernel.filter_pixels * kReferenceKernel.filter_pixels);
    if (r2 <= s.full) return 1;
    // In this direction the ellipse reaches sqrt(square / r2), the disc itself less by the filter.
    const float square = du * du + dv * dv;
    if (square < 1e-4f) {
      const float reach2 = 1 / std::max(s.a, s.c) - kFilterSquare;
      return std::min(1.0f, 0.5f + kShare * std::sqrt(std::max(0.0f, reach2)));
    }
    const float distance = std::sqrt(square);
    const float reach = std::sqrt(std::max(0.0f, square / r2 - kFilterSquare));
    // Across the edge: along the gradient of r^2 / 2.
    const float gu = s.a * du + s.b * dv, gv = s.b * du + s.c * dv;
    const float across = r2 / (distance * std::sqrt(gu * gu + gv * gv));
    return std::clamp(0.5f + (kShare * reach - distance) * across, 0.0f, 1.0f);
  }

  // Without a call into the library, which has no better code for every processor.
  static int floor_of(float x) {
    const int i = static_cast<int>(x);
    return i - (static_cast<float>(i) > x);
  }
  static int ceil_of(float x) {
    const int i = static_cast<int>(x);
    return i + (static_cast<float>(i) < x);
  }

  /// visitor(pixel, squared ellipse radius, offset) for pixel centres with a radius below `reach`.
  template <class Visitor>
  void visit(const Splat& s, float reach, Visitor&& visitor) const {
    find(s, reach, [&](std::size_t pixel, float r2, float du, float dv) {
      visitor(pixel, r2, du, dv);
      return false;
    });
  }

  /// Whether `wanted` says so of one of these.
  template <class Wanted>
  bool find(const Splat& s, float reach, Wanted&& wanted) const {
    const float height = reach * s.half_height, per_a = 1 / s.a;
    const int top = std::max(first_row_, ceil_of(s.v - height - 0.5f));
    const int bottom = std::min(first_row_ + rows_ - 1, floor_of(s.v + height - 0.5f));
    for (int row = top; row <= bottom; ++row) {
      const float dv = static_cast<float>(row) + 0.5f - s.v;
      // a du^2 + 2 b dv du + c dv^2 = reach^2 at the ends of the row.
      const float mixed = s.b * dv, row_square = s.c * dv * dv;
      const float root = mixed * mixed - s.a * (row_square - reach * reach);
      if (!(root > 0)) continue;
      const float half = std::sqrt(root) * per_a, middle = s.u - mixed * per_a - 0.5f;
      const int first = std::max(0, ceil_of(middle - half));
      const int last = std::min(width_ - 1, floor_of(middle + half));
      const std::size_t start = std::size_t(row - first_row_) * std::size_t(width_);
      for (int column = first; column <= last; ++column) {
        const float du = static_cast<float>(column) + 0.5f - s.u;
        const float r2 = std::min(1.0f, du * (s.a * du + 2 * mixed) + row_square);
        if (wanted(start + std::size_t(column), r2, du, dv)) return true;
      }
    }
    return false;
  }

  int width_, first_row_, rows_;
  float* coverage_;
  float* depth_;  // sum of weighted inverse depths until normalise()
  std::vector<float> weight_;
  std::vector<float> nearest_;      // greatest inverse depth
  std::vector<float> farthest_;     // [blocks of columns] least of nearest_
  std::vector<std::uint8_t> open_;  // [blocks] has a pixel that is not wholly covered
};

}  // namespace slf
