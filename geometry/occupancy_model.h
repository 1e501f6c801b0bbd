// The probabilities of child occupancy. One description for decoder and encoder. Spec 8.4.2.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bitstream/prefetch.h"
#include "entropy/adaptive_bit.h"
#include "entropy/logistic.h"
#include "geometry/occupancy_history.h"
#include "geometry/occupancy_window.h"
#include "geometry/octree_levels.h"

namespace slf {

class OccupancyModel {
 public:
  /// points: of the slice; hashed contexts are as many as they can fill.
  explicit OccupancyModel(std::uint64_t points);

  void start_level(int level) {
    history_.start_level(level);
    level_ = static_cast<std::uint32_t>(level);
  }

  /// Codes the occupancy of node n. The nodes before it are known. The encoder passes the
  /// occupancy, the decoder 0; both get it back: 1 .. 255.
  template <class Coder>
  std::uint8_t code(Coder& coder, const OctreeLevel& nodes, std::size_t n, std::uint8_t occupancy) {
    const Node node = node_context(nodes, n);
    std::array<HashedContexts, 2> hashed{hashed_contexts(node, 0, 0)};
    unsigned coded = 0, bit = 0;
    for (unsigned child = 0; child < 8; ++child) {
      if (child == 7 && coded == 0) {  // a node has a child: it must be the last
        coded = 1u << 7;
        break;
      }
      const HashedContexts own = hashed[bit];
      if (child < 7)  // whatever the decision will be, the next contexts are on their way
        for (unsigned either = 0; either < 2; ++either)
          hashed[either] = hashed_contexts(node, child + 1, coded | either << child);
      Prediction prediction = predict(node, child, coded, own);
      bit = coder.bit(prediction.p1, occupancy >> child & 1u);
      prediction.update(bit);
      coded |= bit << child;
    }
    history_.store(static_cast<std::uint8_t>(coded));
    return static_cast<std::uint8_t>(coded);
  }

 private:
  static constexpr std::size_t kContexts = 11;
  static constexpr std::size_t kInputs = kContexts + 1;  // and a constant
  /// log2 of the number of contexts of each prediction; 0: hashed. Spec table 8-3.
  static constexpr std::array<int, kContexts> kContextBits = {11, 15, 0,  0,  15, 14,
                                                              0,  12, 12, 12, 0};
  static constexpr int kMostHashedBits = 18;
  static constexpr std::size_t kHashed = 4;
  using HashedContexts = std::array<std::uint32_t, kHashed>;

  // Found on the clouds of docs/rate.md, as the rate.
  static constexpr int kFirstWeight = 8000;  // of 65536
  static constexpr int kMixerRate = 32;
  static constexpr std::uint32_t kCountLimit = 255;

  /// What the decisions of one node have in common.
  struct Node {
    std::uint32_t neighbours = 0;  // bit d: the neighbour in direction d is occupied
    Window occupied = 0;           // cells known to be occupied
    Window unknown = 0;            // cells of neighbours that are not coded yet
    std::uint32_t halves = 0;      // history along x, y, z: which halves were occupied, 2 bits each
    std::array<std::uint32_t, 3> columns{};  // history of (y,z), (x,z), (x,y), 4 bits each
  };

  struct Prediction {
    std::array<AdaptiveBit*, kContexts> contexts;
    std::array<int, kInputs> inputs;
    std::array<Mixed, 3> mixed;
    std::uint32_t p1;

    void update(unsigned bit) {
      for (const Mixed& mixer : mixed) mixer.update(inputs, bit, kMixerRate);
      for (AdaptiveBit* context : contexts) context->update(bit, kCountLimit);
    }
  };

  Node node_context(const OctreeLevel& nodes, std::size_t n);

  /// Spec 8.4.4. Their tables do not fit a near cache.
  std::uint32_t hashed_context(std::size_t which, std::uint64_t a, std::uint64_t b) const {
    std::uint64_t h = a * 0x9E3779B97F4A7C15u + b * 0xC2B2AE3D27D4EB4Fu;
    h = (h ^ h >> 32) * 0x9E3779B97F4A7C15u;
    const auto context = static_cast<std::uint32_t>(h >> (64 - hashed_bits_));
    prefetch(&contexts_[which][context]);
    return context;
  }

  /// Rows 2, 3, 6 and 10 of table 8-3.
  HashedContexts hashed_contexts(const Node& node, unsigned child, unsigned coded) const {
    const auto& column = node.columns;
    const unsigned siblings = 1u << child | coded;
    const auto [occupied, unknown] =
        surroundings(node.occupied | kOwnCells[coded], node.unknown, child);
    return {hashed_context(2, node.neighbours, siblings),
            hashed_context(3, occupied & kFacesAndEdges, (unknown & kFacesAndEdges) << 3 | child),
            hashed_context(6, column[0] << 8 | column[1] << 4 | column[2], siblings),
            hashed_context(10, occupied, unknown << 3 | child)};
  }

  Prediction predict(const Node& node, unsigned child, unsigned coded,
                     const HashedContexts& hashed) {
    const unsigned siblings = 1u << child | coded;  // 1 .. 255: which child, the ones before it
    const Surroundings around = surroundings(node.occupied | kOwnCells[coded], node.unknown, child);
    const unsigned faces = faces_of(around, child);
    const auto num_occupied = static_cast<unsigned>(std::popcount(around.occupied));
    const auto num_unknown = static_cast<unsigned>(std::popcount(around.unknown));
    const auto num_siblings = std::min(static_cast<unsigned>(std::popcount(coded)), 3u);
    const auto num_neighbours = static_cast<unsigned>(std::popcount(node.neighbours));
    const std::array<std::uint32_t, kContexts> index = {
        // spec table 8-3
        faces * 8 + child,
        siblings << 7 | corner_of(node.neighbours, child),
        hashed[0],
        hashed[1],
        ((num_occupied * 27 + num_unknown) * 8 + child) * 4 + num_siblings,
        node.halves << 8 | siblings,
        hashed[2],
        node.columns[0] << 8 | siblings,
        node.columns[1] << 8 | siblings,
        node.columns[2] << 8 | siblings,
        hashed[3]};
    Prediction prediction;
    for (std::size_t i = 0; i < kContexts; ++i) {
      AdaptiveBit& context = contexts_[i][index[i]];
      prediction.contexts[i] = &context;
      prediction.inputs[i] = context.logistic();
    }
    prediction.inputs[kContexts] = 256;
    prediction.mixed = {
        by_siblings_.mix(prediction.inputs, siblings * 8 + std::min(num_neighbours / 3, 7u)),
        by_density_.mix(prediction.inputs, num_occupied * 22 + level_),
        by_faces_.mix(prediction.inputs, faces)};
    int sum = 0;
    for (const Mixed& mixed : prediction.mixed) sum += mixed.logistic;
    prediction.p1 = static_cast<std::uint32_t>(std::clamp(squash(sum / 3), 1, 65535));
    return prediction;
  }

  OccupancyHistory history_;
  std::uint32_t level_ = 0;
  int hashed_bits_;  // log2 of the number of contexts of hashed predictions
  std::array<std::vector<AdaptiveBit>, kContexts> contexts_;
  Mixer<kInputs, 256 * 8> by_siblings_{kFirstWeight};
  Mixer<kInputs, 27 * 22> by_density_{kFirstWeight};
  Mixer<kInputs, 27 * 8> by_faces_{kFirstWeight};
};

}  // namespace slf
