// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/terrace_points.h"

#include <span>
#include <unordered_set>

#include "slf/parallel.h"
#include "tools/synth/shading.h"

namespace slf::synth {
namespace {

constexpr std::size_t kTileLines = 1 << 13;   // lattice lines of a tile, about
constexpr std::size_t kPieceLines = 1 << 20;  // of the tiles that are sampled at once
/// As in sample_points.cpp: round solids have crossings a little past the turn from axis to axis.
constexpr double kRoundOverlap = 0.88;
constexpr double kCalibration = 4e5;  // points at least that a step is measured with

/// Rows of the lattice lines along `axis` that meet a solid; of a round one all three axes at once.
struct Tile {
  std::uint32_t solid;
  std::size_t axis;
  std::int64_t first, last;  // rows, last excluded
};

struct Lattice {
  Vec3 low;
  double step;

  std::int64_t from(double at, std::size_t axis) const {
    return static_cast<std::int64_t>(std::ceil((at - low[axis]) / step));
  }
  double at(std::int64_t line, std::size_t axis) const {
    return low[axis] + step * static_cast<double>(line);
  }
  std::uint64_t voxel_of(const Vec3& p) const {
    std::uint64_t number = 0;
    for (std::size_t k = 0; k < 3; ++k)
      number = number << 21 |
               (static_cast<std::uint64_t>(std::floor((p[k] - low[k]) / step + 1.5)) & 0x1fffff);
    return number;
  }
};

bool is_round(const Solid& solid) {
  return solid.shape == Shape::kSphere || solid.shape == Shape::kCylinder;
}

class Sampler {
 public:
  Sampler(const Terrace& terrace, double step)
      : terrace_(
            terrace),  // From a corner of the ground's upper side; what is below is never seen.
        lattice_{{terrace.plan().low_x(), terrace.plan().low_y(), 0}, step} {}

  const Solid& solid(std::size_t i) const { return terrace_.tree().solids()[i]; }

  /// Lines along the axis that may meet the solid.
  std::size_t lines(const Solid& s, std::size_t axis, std::int64_t& first,
                    std::int64_t& last) const {
    const std::size_t across = (axis + 1) % 3, up = (axis + 2) % 3;
    first = lattice_.from(s.low[up], up);
    last = lattice_.from(s.high[up], up);
    const std::int64_t columns =
        lattice_.from(s.high[across], across) - lattice_.from(s.low[across], across);
    return static_cast<std::size_t>(std::max<std::int64_t>(columns, 0));
  }

  /// Tiles of a solid, appended; the number of their lines.
  std::size_t split(std::uint32_t index, std::vector<Tile>& tiles) const {
    const Solid& s = solid(index);
    std::size_t sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::int64_t first = 0, last = 0;
      const std::size_t columns = lines(s, axis, first, last);
      if (columns == 0 || last <= first) continue;
      sum += columns * static_cast<std::size_t>(last - first);
      if (is_round(s)) continue;
      const auto rows = static_cast<std::int64_t>(std::max<std::size_t>(1, kTileLines / columns));
      for (std::int64_t row = first; row < last; row += rows)
        tiles.push_back({index, axis, row, std::min(row + rows, last)});
    }
    if (is_round(s) && sum > 0) tiles.push_back({index, 0, 0, 0});
    return sum;
  }

  std::vector<SurfacePoint> sample(const Tile& tile) const {
    const Solid& s = solid(tile.solid);
    std::vector<SurfacePoint> certain, overlap;
    if (!is_round(s)) {
      rows(s, tile.axis, tile.first, tile.last, certain, overlap);
      return certain;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::int64_t first = 0, last = 0;
      lines(s, axis, first, last);
      rows(s, axis, first, last, certain, overlap);
    }
    std::unordered_set<std::uint64_t> taken;  // asked, never iterated
    for (const SurfacePoint& point : certain) taken.insert(lattice_.voxel_of(point.position));
    for (const SurfacePoint& point : overlap)
      if (taken.insert(lattice_.voxel_of(point.position)).second) certain.push_back(point);
    return certain;
  }

  void colour(const Tile& tile, const std::vector<SurfacePoint>& surface, PointCloud& cloud) const {
    const auto to_float = [](const Vec3& v) {
      return std::array<float, 3>{static_cast<float>(v[0]), static_cast<float>(v[1]),
                                  static_cast<float>(v[2])};
    };
    for (const SurfacePoint& point : surface) {
      cloud.positions.push_back(to_float(point.position));
      cloud.normals.push_back(to_float(point.normal));
      const Colour light = terrace_.diffuse(solid(tile.solid), point, lattice_.step);
      auto& stored = cloud.colours.emplace_back();
      for (std::size_t k = 0; k < 3; ++k)
        stored[k] = static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(light[k])));
    }
  }

 private:
  void rows(const Solid& s, std::size_t axis, std::int64_t first, std::int64_t last,
            std::vector<SurfacePoint>& certain, std::vector<SurfacePoint>& overlap) const {
    const std::size_t across = (axis + 1) % 3, up = (axis + 2) % 3;
    const std::int64_t left = lattice_.from(s.low[across], across),
                       right = lattice_.from(s.high[across], across);
    Ray ray{{}, {0, 0, 0}};
    ray.direction[axis] = 1;
    ray.origin[axis] = s.low[axis] - 1;
    for (std::int64_t row = first; row < last; ++row)
      for (std::int64_t column = left; column < right; ++column) {
        ray.origin[across] = lattice_.at(column, across);
        ray.origin[up] = lattice_.at(row, up);
        const auto c = chord(s, Probe(ray));
        if (!c) continue;
        keep({ray.at(c->enter), c->enter_normal}, axis, certain, overlap);
        keep({ray.at(c->leave), c->leave_normal}, axis, certain, overlap);
      }
  }
  void keep(const SurfacePoint& point, std::size_t axis, std::vector<SurfacePoint>& certain,
            std::vector<SurfacePoint>& overlap) const {
    const Vec3& n = point.normal;
    const double largest = std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])});
    const double along = std::abs(n[axis]);
    if (along < kRoundOverlap * largest || !terrace_.exposed(point)) return;
    (along >= largest ? certain : overlap).push_back(point);
  }

  const Terrace& terrace_;
  Lattice lattice_;
};

/// Calls visit(tiles, share of the scene) with the tiles of as many solids as make a piece, or with
/// a part of those of a large one.
template <class Visit>
void pieces(const Sampler& sampler, std::size_t solids, Visit&& visit) {
  std::vector<Tile> tiles;
  std::size_t lines = 0;
  for (std::size_t i = 0; i < solids; ++i) {
    lines += sampler.split(static_cast<std::uint32_t>(i), tiles);
    if (lines < kPieceLines && i + 1 < solids) continue;
    constexpr std::size_t kMostTiles = 2 * kPieceLines / kTileLines;
    for (std::size_t t = 0; t < tiles.size();) {
      // There are more small solids in a piece, and fewer lines in a tile.
      const std::size_t some =
          lines < 2 * kPieceLines ? tiles.size() : std::min(tiles.size() - t, kMostTiles);
      visit(std::span<const Tile>(tiles).subspan(t, some), double(i + 1) / double(solids));
      t += some;
    }
    tiles.clear();
    lines = 0;
  }
}

std::size_t count_points(const Terrace& terrace, double step, int threads) {
  const Sampler sampler(terrace, step);
  std::size_t sum = 0;
  pieces(sampler, terrace.tree().solids().size(), [&](std::span<const Tile> tiles, double) {
    std::vector<std::size_t> counts(tiles.size());
    parallel_ranges(tiles.size(), 16, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) counts[t] = sampler.sample(tiles[t]).size();
    });
    for (const std::size_t count : counts) sum += count;
  });
  return sum;
}

}  // namespace

double terrace_step(const Terrace& terrace, int points, int threads) {
  // Twice the ground's area is near enough to begin with. A step that is coarser than what is to be
  // sampled tells little of it, so it is measured with a fine one.
  const double wanted = std::max(kCalibration, points / 8.0);
  const Plan& plan = terrace.plan();
  double step = std::sqrt(2 * 4 * plan.low_x() * plan.low_y() / wanted);
  const auto count = static_cast<double>(count_points(terrace, step, threads));
  return step * std::sqrt(count / points);
}

void sample_terrace(const Terrace& terrace, double step, int threads,
                    const std::function<void(const PointCloud& piece, double done)>& take) {
  const Sampler sampler(terrace, step);
  pieces(sampler, terrace.tree().solids().size(), [&](std::span<const Tile> tiles, double done) {
    std::vector<PointCloud> clouds(tiles.size());
    parallel_ranges(tiles.size(), 4, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        sampler.colour(tiles[t], sampler.sample(tiles[t]), clouds[t]);
    });
    PointCloud piece;
    for (const PointCloud& c : clouds) {
      piece.positions.insert(piece.positions.end(), c.positions.begin(), c.positions.end());
      piece.normals.insert(piece.normals.end(), c.normals.begin(), c.normals.end());
      piece.colours.insert(piece.colours.end(), c.colours.begin(), c.colours.end());
    }
    take(piece, done);
  });
}

}  // namespace slf::synth
