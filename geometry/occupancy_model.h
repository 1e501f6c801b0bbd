// The probabilities of child occupancy. One description for decoder and encoder. Spec 8.4.2.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "entropy/adaptive_bit.h"
#include "entropy/logistic.h"
#include "geometry/occupancy_history.h"
#include "geometry/octree_levels.h"

namespace slf {

/// What the decisions of one node have in common. Windows are 4 x 4 x 4 cells of the child level
/// around the node's own 2 x 2 x 2; bit x + 4 y + 16 z with x, y, z = 0 .. 3.
struct NodeContext {
  std::uint32_t neighbours = 0;  ///< bit d: the neighbour in direction d is occupied
  std::uint64_t occupied = 0;    ///< window: cells known to be occupied
  std::uint64_t unknown = 0;     ///< window: cells of neighbours that are not coded yet
  std::uint32_t halves = 0;      ///< history along x, y, z: which halves were occupied, 2 bits each
  std::array<std::uint32_t, 3>
      columns{};  ///< history of (y,z), (x,z), (x,y): occupied columns, 4 bits
  std::uint32_t level = 0;
};

class OccupancyModel {
 public:
  /// points: of the slice; hashed contexts are as many as they can fill.
  explicit OccupancyModel(std::uint64_t points);

  void start_level(int level) { history_.start_level(level); }

  /// Codes the occupancy of node n. The nodes before it are known. The encoder passes the
  /// occupancy, the decoder 0; both get it back: 1 .. 255.
  template <class Coder>
  std::uint8_t code(Coder& coder, const OctreeLevel& nodes, std::size_t n, int level,
                    std::uint8_t occupancy) {
    const NodeContext context = node_context(nodes, n, level);
    unsigned coded = 0;
    for (unsigned child = 0; child < 8; ++child) {
      if (child == 7 && coded == 0) {  // a node has a child: it must be the last
        coded = 1u << 7;
        break;
      }
      const std::uint32_t p1 = predict(context, child, coded);
      const unsigned bit = coder.bit(p1, occupancy >> child & 1u);
      update(bit);
      coded |= bit << child;
    }
    history_.store(static_cast<std::uint8_t>(coded));
    return static_cast<std::uint8_t>(coded);
  }

 private:
  static constexpr std::size_t kContexts = 11;
  static constexpr std::size_t kInputs = kContexts + 1;  // and a constant

  NodeContext node_context(const OctreeLevel& nodes, std::size_t n, int level);
  std::uint32_t predict(const NodeContext& node, unsigned child, unsigned coded);
  void update(unsigned bit);

  OccupancyHistory history_;
  std::array<int, kContexts> context_bits_;  // log2 of the number of contexts of each prediction
  std::array<std::vector<AdaptiveBit>, kContexts> contexts_;
  std::array<AdaptiveBit*, kContexts> selected_{};
  std::array<int, kInputs> inputs_{};
  Mixer<kInputs, 256 * 8> by_siblings_;
  Mixer<kInputs, 27 * 22> by_density_;
  Mixer<kInputs, 27 * 8> by_faces_;
};

}  // namespace slf
