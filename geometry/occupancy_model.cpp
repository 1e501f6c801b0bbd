#include "geometry/occupancy_model.h"

#include <algorithm>
#include <bit>

#include "bitstream/multiversion.h"

namespace slf {
namespace {

constexpr int kFirstWeight =
    8000;  // of 65536; found on the clouds of docs/rate.md, as the next two
constexpr int kMixerRate = 32;
constexpr std::uint32_t kCountLimit = 255;

/// log2 of the number of contexts of each prediction; where hashed, the most. Spec table 8-3.
constexpr std::array<int, 11> kContextBits = {11, 15, 18, 18, 15, 14, 18, 12, 12, 12, 18};
constexpr std::array<bool, 11> kHashed = {false, false, true,  true,  false, false,
                                          true,  false, false, false, true};

constexpr std::uint64_t bit_at(int x, int y, int z) {
  return std::uint64_t{1} << (x + 4 * y + 16 * z);
}

/// The children of direction d's neighbour that lie in the window, as (child, window bit) pairs.
struct WindowPart {
  int size = 0;
  std::array<std::uint8_t, 8> child{};
  std::array<std::uint64_t, 8> bit{};
  std::uint64_t all = 0;
};
constexpr std::array<WindowPart, 27> kWindowParts = [] {
  std::array<WindowPart, 27> parts{};
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x) {
        const int d = direction_index((x + 1) / 2 - 1, (y + 1) / 2 - 1, (z + 1) / 2 - 1);
        WindowPart& part = parts[static_cast<std::size_t>(d)];
        const int child = ((x + 1) & 1) | ((y + 1) & 1) << 1 | ((z + 1) & 1) << 2;
        part.child[static_cast<std::size_t>(part.size)] = static_cast<std::uint8_t>(child);
        part.bit[static_cast<std::size_t>(part.size)] = bit_at(x, y, z);
        part.all |= bit_at(x, y, z);
        ++part.size;
      }
  return parts;
}();

/// Cells of the 3 x 3 x 3 window of a child that differ from it in at most `most` coordinates.
constexpr std::uint64_t window_mask(int most) {
  std::uint64_t mask = 0;
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x) {
        const int differ = (x != 1) + (y != 1) + (z != 1);
        if (differ >= 1 && differ <= most) mask |= bit_at(x, y, z);
      }
  return mask;
}
constexpr std::uint64_t kFacesAndEdges = window_mask(2), kAllAround = window_mask(3);

/// Bit 0: the lower half along the axis holds a child, bit 1: the upper.
unsigned occupied_halves(unsigned occupancy, unsigned axis) {
  constexpr std::array<unsigned, 3> kLower = {0x55, 0x33, 0x0F};
  return (occupancy & kLower[axis] ? 1u : 0u) | (occupancy & ~kLower[axis] ? 2u : 0u);
}

/// The 2 x 2 columns along the axis that hold a child, the lower of the other axes first.
unsigned occupied_columns(unsigned o, unsigned axis) {
  if (axis == 2) return (o | o >> 4) & 15;
  if (axis == 1) return ((o | o >> 2) & 3) | ((o | o >> 2) >> 2 & 12);
  const unsigned m = o | o >> 1;
  return (m & 1) | (m >> 1 & 2) | (m >> 2 & 4) | (m >> 3 & 8);
}

/// Spec 8.4.4: `bits` upper bits of a product, after folding.
std::uint32_t hash(std::uint64_t a, std::uint64_t b, int bits) {
  std::uint64_t h = a * 0x9E3779B97F4A7C15u + b * 0xC2B2AE3D27D4EB4Fu;
  h = (h ^ h >> 32) * 0x9E3779B97F4A7C15u;
  return static_cast<std::uint32_t>(h >> (64 - bits));
}

}  // namespace

OccupancyModel::OccupancyModel(std::uint64_t points)
    : by_siblings_(kFirstWeight), by_density_(kFirstWeight), by_faces_(kFirstWeight) {
  const int useful = std::max(static_cast<int>(std::bit_width(points)) + 4, 10);
  for (std::size_t i = 0; i < kContexts; ++i) {
    context_bits_[i] = kHashed[i] ? std::min(kContextBits[i], useful) : kContextBits[i];
    contexts_[i].resize(std::size_t{1} << context_bits_[i]);
  }
}

NodeContext OccupancyModel::node_context(const OctreeLevel& nodes, std::size_t n, int level) {
  NodeContext context;
  context.level = static_cast<std::uint32_t>(level);
  for (std::size_t d = 0; d < 27; ++d) {
    const std::int32_t neighbour = nodes.neighbours[n][d];
    if (neighbour < 0 || d == kSelf) continue;
    context.neighbours |= 1u << d;
    const WindowPart& part = kWindowParts[d];
    if (static_cast<std::size_t>(neighbour) >= n) {
      context.unknown |= part.all;
      continue;
    }
    const unsigned occupancy = nodes.occupancy[static_cast<std::size_t>(neighbour)];
    for (std::size_t i = 0; i < static_cast<std::size_t>(part.size); ++i)
      if (occupancy >> part.child[i] & 1u) context.occupied |= part.bit[i];
  }
  const auto latest = history_.at(nodes.morton[n]);
  for (unsigned axis = 0; axis < 3; ++axis) {
    context.halves |= occupied_halves(latest[axis], axis) << (2 * axis);
    context.columns[axis] = occupied_columns(latest[3 + axis], axis);
  }
  return context;
}

SLF_MULTIVERSION
std::uint32_t OccupancyModel::predict(const NodeContext& node, unsigned child, unsigned coded) {
  const unsigned siblings = 1u << child | coded;  // 1 .. 255: which child, and the ones before it
  const int cx = child & 1, cy = child >> 1 & 1, cz = child >> 2 & 1;

  // The 3 x 3 x 3 cells around the child: known occupied (siblings included), not known yet.
  std::uint64_t own = 0;
  for (unsigned c = 0; c < child; ++c)
    own |= std::uint64_t{coded >> c & 1u} << (21 + (c & 1) + 4 * (c >> 1 & 1) + 16 * (c >> 2));
  const int base = cx + 4 * cy + 16 * cz;
  const std::uint64_t occupied = (node.occupied | own) >> base & kAllAround;
  const std::uint64_t unknown = node.unknown >> base & kAllAround;

  // Faces towards the outside of the node (0 empty, 1 occupied, 2 unknown each) and the inside.
  const std::array<std::uint64_t, 3> outer = {bit_at(2 * cx, 1, 1), bit_at(1, 2 * cy, 1),
                                              bit_at(1, 1, 2 * cz)};
  const std::array<std::uint64_t, 3> inner = {bit_at(2 - 2 * cx, 1, 1), bit_at(1, 2 - 2 * cy, 1),
                                              bit_at(1, 1, 2 - 2 * cz)};
  unsigned outer_faces = 0, inner_faces = 0;
  for (std::size_t i = 3; i-- > 0;) {
    outer_faces = 3 * outer_faces + (occupied & outer[i] ? 1u : unknown & outer[i] ? 2u : 0u);
    inner_faces = 2 * inner_faces + (occupied & inner[i] ? 1u : 0u);
  }
  const unsigned faces = outer_faces * 8 + inner_faces;  // < 216

  // The seven neighbours of the node that touch the child.
  const int ox = 2 * cx - 1, oy = 2 * cy - 1, oz = 2 * cz - 1;
  const auto has = [&](int dx, int dy, int dz) {
    return node.neighbours >> direction_index(dx, dy, dz) & 1u;
  };
  const unsigned corner = has(ox, 0, 0) | has(0, oy, 0) << 1 | has(0, 0, oz) << 2 |
                          has(ox, oy, 0) << 3 | has(ox, 0, oz) << 4 | has(0, oy, oz) << 5 |
                          has(ox, oy, oz) << 6;

  const auto num_occupied = static_cast<unsigned>(std::popcount(occupied));
  const auto num_unknown = static_cast<unsigned>(std::popcount(unknown));
  const auto num_siblings = std::min(static_cast<unsigned>(std::popcount(coded)), 3u);
  const auto num_neighbours = static_cast<unsigned>(std::popcount(node.neighbours));
  const auto& column = node.columns;

  const std::array<std::uint32_t, kContexts> index = {
      // spec table 8-3
      faces * 8 + child,
      siblings << 7 | corner,
      hash(node.neighbours, siblings, context_bits_[2]),
      hash(occupied & kFacesAndEdges, (unknown & kFacesAndEdges) << 3 | child, context_bits_[3]),
      ((num_occupied * 27 + num_unknown) * 8 + child) * 4 + num_siblings,
      node.halves << 8 | siblings,
      hash(column[0] << 8 | column[1] << 4 | column[2], siblings, context_bits_[6]),
      column[0] << 8 | siblings,
      column[1] << 8 | siblings,
      column[2] << 8 | siblings,
      hash(occupied, unknown << 3 | child, context_bits_[10])};
  for (std::size_t i = 0; i < kContexts; ++i) {
    selected_[i] = &contexts_[i][index[i]];
    inputs_[i] = selected_[i]->count() == 0 ? 0 : stretch(selected_[i]->p1());
  }
  inputs_[kContexts] = 256;

  const int sum = by_siblings_.mix(inputs_, siblings * 8 + std::min(num_neighbours / 3, 7u)) +
                  by_density_.mix(inputs_, num_occupied * 22 + node.level) +
                  by_faces_.mix(inputs_, faces);
  return static_cast<std::uint32_t>(std::clamp(squash(sum / 3), 1, 65535));
}

SLF_MULTIVERSION
void OccupancyModel::update(unsigned bit) {
  by_siblings_.update(inputs_, bit, kMixerRate);
  by_density_.update(inputs_, bit, kMixerRate);
  by_faces_.update(inputs_, bit, kMixerRate);
  for (AdaptiveBit* context : selected_) context->update(bit, kCountLimit);
}

}  // namespace slf
