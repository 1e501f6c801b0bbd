// SPDX-License-Identifier: Apache-2.0
#include "lightfield/render/splat_band.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/multiversion.h"
#include "lightfield/render/reference_kernel.h"

namespace slf {
namespace {

constexpr const ReferenceKernel& kKernel = kReferenceKernel;
constexpr auto kCore = float(kKernel.core);
constexpr float kCoreReach = 0.6324556f;  // ellipse radius
static_assert(kKernel.core == 0.4);       // its square
constexpr auto kFilterSquare = float(kKernel.filter_pixels * kKernel.filter_pixels);

/// 1 at the nearest surface, 0 where the splat is hidden.
void set_nearness(const Splat& s, const Lanes& nearest, const Lanes& inverse_depth, Lanes& near) {
  const Lanes behind = (nearest - inverse_depth) * s.fade;
  near = 1 - (behind > 0 ? behind : Lanes{});
  near = near > 0 ? near : Lanes{};
}

}  // namespace

[[gnu::always_inline]] inline SplatBand::TileBox SplatBand::tiles_of(const Splat& s) const {
  const auto tile = [](float x, int size) {
    return std::size_t(std::clamp(static_cast<int>(x), 0, size - 1) / 8);
  };
  const float v = s.v - static_cast<float>(first_row_);
  return {tile(s.u - s.half_width, width_), tile(s.u + s.half_width, width_),
          tile(v - s.half_height, rows_), tile(v + s.half_height, rows_)};
}

/// visit(block of the band, squared ellipse radius, offset, inverse depth) for all blocks with
/// pixel centres of a radius below `reach`, and some others. Chords of an ellipse along the rows
/// have their middles on a line and are no longer than that through its centre.
template <class Visit>
[[gnu::always_inline]] inline void SplatBand::visit(const Splat& s, float reach,
                                                    Visit&& visit) const {
  const float v = s.v - static_cast<float>(first_row_);
  const float height = reach * s.half_height, half_chord = reach * s.half_chord;
  const int top = std::max(0, static_cast<int>(v - height + 0.5f)) / 2 * 2;
  const int bottom = std::min(rows_ - 1, static_cast<int>(v + height - 0.5f));
  const float twice_b = 2 * s.b;
  for (int row = top; row <= bottom; row += 2) {
    const float dv_top = static_cast<float>(row) + 0.5f - v;
    const float middle_top = s.u - 0.5f - s.slope * dv_top, middle_bottom = middle_top - s.slope;
    const float left = std::min(middle_top, middle_bottom) - half_chord;
    const float right = std::max(middle_top, middle_bottom) + half_chord;
    const int first = std::max(0, static_cast<int>(left + 1)) / 4;
    const int last = std::min(width_ - 1, static_cast<int>(right)) >> 2;
    const Lanes dv = dv_top + kRows;
    const Lanes mixed = twice_b * dv, square = s.c * dv * dv;
    const Lanes inverse_row = s.inverse_depth + s.inverse_depth_dv * dv;
    const std::size_t start = std::size_t(row / 2) * blocks_;
    for (int block = first; block <= last; ++block) {
      const Lanes du = (static_cast<float>(4 * block) + 0.5f - s.u) + kColumns;
      const Lanes r2 = du * (s.a * du + mixed) + square;
      const Lanes inverse = inverse_row + s.inverse_depth_du * du;
      if (visit(start + std::size_t(block), r2, du, dv, inverse)) return;
    }
  }
}

inline void SplatBand::draw_depth(const Splat& s) {
  visit(s, kCoreReach,
        [&](std::size_t i, const Lanes& r2, const Lanes&, const Lanes&, const Lanes& inverse) {
          Lanes& nearest = nearest_[i].nearest;
          const Lanes own = r2 < kCore ? inverse : Lanes{};
          nearest = own > nearest ? own : nearest;
          return false;
        });
}

inline void SplatBand::find_farthest() {
  for (std::size_t tile = 0; tile < farthest_.size(); ++tile) {
    Lanes least = nearest_[block_of(tile, 0)].nearest;
    for (std::size_t i = 1; i < kTilePairs * kTileBlocks; ++i) {
      const Lanes& own = nearest_[block_of(tile, i)].nearest;
      least = own < least ? own : least;
    }
    farthest_[tile] = least[0];
    for (std::size_t lane = 1; lane < 8; ++lane)
      farthest_[tile] = std::min(farthest_[tile], least[lane]);
  }
}

/// At the pixel of the splat's centre, if it is in the band.
inline bool SplatBand::shows_at_centre(const Splat& s) const {
  const float v = s.v - static_cast<float>(first_row_);
  if (!(s.u >= 0 && v >= 0)) return false;
  const auto column = static_cast<std::size_t>(s.u), row = static_cast<std::size_t>(v);
  if (column >= std::size_t(width_) || row >= std::size_t(rows_)) return false;
  const float du = static_cast<float>(column) + 0.5f - s.u, dv = static_cast<float>(row) + 0.5f - v;
  const float inverse = s.inverse_depth + s.inverse_depth_du * du + s.inverse_depth_dv * dv;
  const Lanes& nearest = nearest_[row / 2 * blocks_ + column / 4].nearest;
  const bool inside = du * (s.a * du + 2 * s.b * dv) + s.c * dv * dv < 1;
  return inside && (nearest[row % 2 * 4 + column % 4] - inverse) * s.fade < 1;
}

inline bool SplatBand::shows_anywhere(const Splat& s) const {
  bool shows = false;
  visit(s, 1.0f,
        [&](std::size_t i, const Lanes& r2, const Lanes&, const Lanes&, const Lanes& inverse) {
          shows = any((r2 < 1.0f) & ((nearest_[i].nearest - inverse) * s.fade < 1.0f));
          return shows;
        });
  return shows;
}

SLF_MULTIVERSION_ALL std::vector<std::uint32_t> SplatBand::find_shown(
    const std::vector<Splat>& splats, const std::vector<std::uint32_t>& all) {
  for (const std::uint32_t i : all) draw_depth(splats[i]);
  find_farthest();
  std::vector<std::uint32_t> shown(all.size());
  std::size_t count = 0;
  for (const std::uint32_t i : all) {
    const Splat& s = splats[i];
    const TileBox box = tiles_of(s);
    float farthest = std::numeric_limits<float>::infinity();
    for (std::size_t y = box.top; y <= box.bottom; ++y)
      for (std::size_t x = box.left; x <= box.right; ++x)
        farthest = std::min(farthest, farthest_[y * tiles_ + x]);
    if ((farthest - s.inverse_depth - s.inverse_depth_change) * s.fade >= 1) continue;
    if (!shows_at_centre(s) && !shows_anywhere(s)) continue;
    for (std::size_t y = box.top; y <= box.bottom; ++y)
      for (std::size_t x = box.left; x <= box.right; ++x) touched_[y * tiles_ + x] = 1;
    shown[count++] = i;
  }
  shown.resize(count);
  return shown;
}

template <class Add>
[[gnu::always_inline]] inline void SplatBand::draw_weight(const Splat& s, BandSums& sums,
                                                          Add&& add) const {
  visit(s, 1.0f,
        [&](std::size_t i, const Lanes& r2, const Lanes&, const Lanes&, const Lanes& inverse) {
          Lanes near;
          set_nearness(s, nearest_[i].nearest, inverse, near);
          const Lanes inside = r2 < 1.0f ? 1 - r2 : Lanes{};
          static_assert(kKernel.exponent == 4);
          const Lanes kernel = inside * inside * near;
          const Lanes weight = s.weight * (kernel * kernel);
          BlockSums& own = sums.blocks[i];
          own.weight += weight;
          own.inverse_depth += weight * inverse;
          add(i, weight, own);
          return false;
        });
}

SLF_MULTIVERSION_ALL void SplatBand::blend(const std::vector<Splat>& splats,
                                           const std::vector<std::uint32_t>& shown,
                                           const std::vector<std::array<float, 4>>& colours,
                                           BandSums& sums) const {
  if (sums.blocks.size() < nearest_.size()) sums.blocks.resize(nearest_.size());
  for (const std::uint32_t i : shown) {
    const std::array<float, 4> colour = colours[i];
    draw_weight(splats[i], sums, [&](std::size_t, const Lanes& weight, BlockSums& own) {
      own.red += weight * colour[0];
      own.green += weight * colour[1];
      own.blue += weight * colour[2];
    });
  }
}

SLF_MULTIVERSION_ALL void SplatBand::list(const std::vector<Splat>& splats,
                                          const std::vector<std::uint32_t>& shown, BandSums& sums,
                                          std::vector<SplatEntry>& entries) const {
  if (sums.blocks.size() < nearest_.size()) sums.blocks.resize(nearest_.size());
  for (const std::uint32_t i : shown)
    draw_weight(splats[i], sums, [&](std::size_t block, const Lanes& weight, BlockSums&) {
      if (!any(weight > 0.0f)) return;
      const std::size_t pixel = first_pixel_of(block);
      for (std::size_t lane = 0; lane < 8; ++lane)
        if (weight[lane] > 0)
          entries.push_back(
              {i, static_cast<std::uint32_t>(pixel + lane / 4 * std::size_t(width_) + lane % 4),
               weight[lane]});
    });
}

/// Looks for pixels that show something but are not wholly covered.
inline void SplatBand::find_open(const BandSums& sums, OpenPixels& open) const {
  for (std::size_t tile = 0; tile < open.tiles.size(); ++tile) {
    if (open.tiles[tile] == 0) continue;
    std::uint8_t found = 0;
    for (std::size_t i = 0; i < kTilePairs * kTileBlocks; ++i) {
      const std::size_t block = block_of(tile, i);
      const BlockSums& own = sums.blocks[block];
      open.blocks[block] = any((own.coverage < 1.0f) & (own.weight > 0.0f));
      found |= open.blocks[block];
    }
    open.tiles[tile] = found;
  }
}

inline void SplatBand::cover_by_density(BandSums& sums) const {
  // The integral of (1 - r^2)^n over the unit circle is pi / (n + 1).
  constexpr auto kGain = float(kKernel.density_gain * (kKernel.exponent + 1) / std::numbers::pi);
  for (std::size_t tile = 0; tile < touched_.size(); ++tile) {
    if (touched_[tile] == 0) continue;
    for (std::size_t i = 0; i < kTilePairs * kTileBlocks; ++i) {
      BlockSums& own = sums.blocks[block_of(tile, i)];
      const Lanes density = kGain * own.weight - float(kKernel.density_offset);
      const Lanes positive = density > 0 ? density : Lanes{};
      own.coverage = positive < 1.0f ? positive : Lanes{} + 1;
    }
  }
}

/// Share of each pixel that the disc covers: distance to its edge in pixels, to first order.
inline void SplatBand::cover_by_disc(const Splat& s, BandSums& sums, const OpenPixels& open) const {
  const TileBox box = tiles_of(s);
  std::uint8_t wanted = 0;
  for (std::size_t y = box.top; y <= box.bottom; ++y)
    for (std::size_t x = box.left; x <= box.right; ++x) wanted |= open.tiles[y * tiles_ + x];
  if (wanted == 0) return;
  constexpr auto kShare = float(kKernel.disc_share);
  // Within this squared radius the disc covers pixels in every direction: S has the eigenvalues
  // that are 1 over those of its inverse.
  const float half = (s.a - s.c) / 2;
  const float minor = 1 / ((s.a + s.c) / 2 + std::sqrt(half * half + s.b * s.b));
  const float inner = std::max(
      0.0f, (kShare * std::sqrt(std::max(0.0f, minor - kFilterSquare)) - 0.5f) / std::sqrt(minor));
  const float full = inner * inner;
  // At the centre the direction is that in which the ellipse is narrow, along an axis.
  const float at_centre =
      0.5f + kShare * std::sqrt(std::max(0.0f, 1 / std::max(s.a, s.c) - kFilterSquare));
  visit(s, 1.0f,
        [&](std::size_t i, const Lanes& r2, const Lanes& du, const Lanes& dv, const Lanes&) {
          if (open.blocks[i] == 0) return false;
          BlockSums& own = sums.blocks[i];
          const LaneMask wanting = (own.coverage < 1.0f) & (own.weight > 0.0f) & (r2 < 1.0f);
          if (!any(wanting)) return false;
          // In this direction the ellipse reaches sqrt(square / r2), the disc itself less by the
          // filter. Across the edge: along the gradient of r^2 / 2.
          const Lanes square = du * du + dv * dv;
          const Lanes gu = s.a * du + s.b * dv, gv = s.b * du + s.c * dv;
          const Lanes gradient = gu * gu + gv * gv;
          const Lanes beyond = square / r2 - kFilterSquare;
          Lanes distance, reach, slope;
          set_root(square, distance);
          set_root(beyond > 0 ? beyond : Lanes{}, reach);
          set_root(square * gradient, slope);
          Lanes share = 0.5f + (kShare * reach - distance) * r2 / slope;
          share = r2 > full ? share : Lanes{} + 1;
          share = square < 1e-4f ? Lanes{} + at_centre : share;
          share = share < 1.0f ? share : Lanes{} + 1;
          own.coverage = (wanting & (share > own.coverage)) ? share : own.coverage;
          return false;
        });
}

SLF_MULTIVERSION_ALL void SplatBand::cover(const std::vector<Splat>& splats,
                                           const std::vector<std::uint32_t>& shown,
                                           const std::vector<std::uint32_t>& all,
                                           BandSums& sums) const {
  OpenPixels open{touched_, std::vector<std::uint8_t>(nearest_.size(), 0)};
  cover_by_density(sums);
  find_open(sums, open);
  for (const std::uint32_t i : shown) cover_by_disc(splats[i], sums, open);
  find_open(sums, open);
  auto done = shown.begin();  // in the order of `all`
  for (const std::uint32_t i : all) {
    if (done != shown.end() && *done == i) {
      ++done;
      continue;
    }
    cover_by_disc(splats[i], sums, open);
  }
}

}  // namespace slf
