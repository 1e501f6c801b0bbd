// Coefficients of one plane group, a vector per node: significance of the node, of blocks of eight
// functions, of values, then magnitudes. Written once for decoder and encoder. Spec 8.7.2.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "attributes/coefficient_layout.h"
#include "entropy/adaptive_bit.h"
#include "entropy/binarisation.h"

namespace slf {

class VectorCoefficients {
 public:
  /// functions: the group's, ascending.
  VectorCoefficients(std::vector<std::uint16_t> functions, std::size_t num_points,
                     std::size_t planes)
      : functions_(std::move(functions)),
        zeros_(planes, 0),
        nonzeros_(num_points, 0),
        activity_(planes, 4096),
        node_(kLevelClasses * 27),
        block_(16 * 2 * 2 * 3),
        value_(2 * kLevelClasses * kActivities * 5 * 4 * 4),
        magnitude_(kActivities * 3) {}

  /// Codes rows order[begin .. end). `lower`: the group before this one, or nullptr.
  /// Returns false where the decoder met a value no encoder writes.
  template <class Coder>
  bool code(Coder& coder, const CoefficientRows& rows, const VectorCoefficients* lower,
            std::size_t begin, std::size_t end) {
    const RahtTree& tree = rows.tree;
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t row = tree.order[i];
      const std::uint32_t parent = tree.parent[row];
      const std::uint32_t previous = i > 1 ? tree.order[i - 1] : 0;
      const bool beside = previous != 0 && tree.split[previous] == tree.split[row];
      const Around around{parent != 0 ? rows.row(parent) : zeros_.data(),
                          beside ? rows.row(previous) : zeros_.data(), level_class(tree, row)};
      const std::uint32_t context =
          ((around.level * 3 + few(parent != 0 ? nonzeros_[parent] : 0u)) * 3 +
           few(beside ? nonzeros_[previous] : 0u)) *
              3 +
          few(lower != nullptr ? lower->nonzeros_[row] : 0u);
      const bool any = !Coder::kDecodes && has_any(rows.row(row), 0, functions_.size());
      if (!coder.bit(node_[context], kLimit, any)) continue;
      if (!code_node(coder, around, rows.row(row), row)) return false;
    }
    return true;
  }

 private:
  static constexpr std::uint32_t kLimit = 255;
  static constexpr std::size_t kBlock = 8;  // functions
  static constexpr std::uint32_t kActivities = 12;

  /// Where a node stands: coefficients of its parent and of the node before it, zeros where none.
  struct Around {
    const std::int32_t* parent;
    const std::int32_t* previous;
    std::uint32_t level;
  };

  static std::uint32_t few(std::uint32_t count) { return count == 0 ? 0 : count < 3 ? 1 : 2; }
  static std::uint32_t size_class(std::int32_t value) {
    return value == 0 ? 0 : value == 1 || value == -1 ? 1 : 2;
  }

  bool has_any(const std::int32_t* row, std::size_t first, std::size_t last) const {
    for (std::size_t f = first; f < last; ++f) {
      const std::int32_t* v = row + 3u * functions_[f];
      if ((v[0] | v[1] | v[2]) != 0) return true;
    }
    return false;
  }

  template <class Coder>
  bool code_node(Coder& coder, const Around& around, std::int32_t* values, std::uint32_t row) {
    std::uint32_t count = 0;  // non-zero values of the node so far
    for (std::size_t first = 0; first < functions_.size(); first += kBlock) {
      const std::size_t last = std::min(first + kBlock, functions_.size());
      const bool implied = count == 0 && last == functions_.size();  // the node is not all zero
      if (!implied) {
        const std::uint32_t context =
            ((static_cast<std::uint32_t>(std::min<std::size_t>(first / kBlock, 15)) * 2 +
              has_any(around.parent, first, last)) *
                 2 +
             has_any(around.previous, first, last)) *
                3 +
            few(count);
        const bool any = !Coder::kDecodes && has_any(values, first, last);
        if (!coder.bit(block_[context], kLimit, any)) continue;
      }
      if (!code_block(coder, around, values, first, last, count)) return false;
    }
    nonzeros_[row] = static_cast<std::uint8_t>(std::min(count, 255u));
    return true;
  }

  template <class Coder>
  bool code_block(Coder& coder, const Around& around, std::int32_t* values, std::size_t first,
                  std::size_t last, std::uint32_t& count) {
    for (std::size_t f = first; f < last; ++f) {
      const std::size_t plane0 = 3u * functions_[f];
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t j = plane0 + c;
        const std::uint32_t beside = size_class(around.parent[j]) + size_class(around.previous[j]);
        // The same function's earlier channels; for the first, the function before.
        const std::uint32_t sibling =
            c == 0
                ? (f > first ? size_class(values[3u * functions_[f - 1]]) : 3u)
                : std::min(size_class(values[plane0]) + (c == 2 ? size_class(values[j - 1]) : 0u),
                           3u);
        if (!code_value(coder, values[j], j, around.level, beside, c == 0, sibling, count))
          return false;
      }
    }
    return true;
  }

  template <class Coder>
  bool code_value(Coder& coder, std::int32_t& value, std::size_t plane, std::uint32_t level,
                  std::uint32_t beside, bool first_channel, std::uint32_t sibling,
                  std::uint32_t& count) {
    const std::uint32_t activity = activity_class(plane);
    const std::uint32_t so_far = count < 2 ? count : count < 5 ? 2 : 3;
    const std::uint32_t context =
        ((((first_channel * kLevelClasses + level) * kActivities + activity) * 5 + beside) * 4 +
         sibling) *
            4 +
        so_far;
    const unsigned nonzero = coder.bit(value_[context], kLimit, !Coder::kDecodes && value != 0);
    // Moves 1/32 of the way: the share of non-zeros among the values coded.
    activity_[plane] += ((nonzero ? 65535 : 0) - activity_[plane]) >> 5;
    if (!nonzero) return true;
    const std::uint32_t magnitude =
        code_magnitude(coder, magnitude_[activity * 3 + std::min(beside, 2u)], kLimit,
                       static_cast<std::uint32_t>(value < 0 ? -value : value));
    const bool negative = coder.raw(1, value < 0);
    if (magnitude == 0) return false;
    if (Coder::kDecodes)
      value =
          negative ? -static_cast<std::int32_t>(magnitude) : static_cast<std::int32_t>(magnitude);
    ++count;
    return true;
  }

  std::uint32_t activity_class(std::size_t plane) const {
    const auto width =  // 0 .. 16
        static_cast<int>(std::bit_width(static_cast<std::uint32_t>(activity_[plane])));
    return static_cast<std::uint32_t>(std::clamp(width - 5, 0, static_cast<int>(kActivities) - 1));
  }

  std::vector<std::uint16_t> functions_;
  std::vector<std::int32_t> zeros_;  // [planes] stands for a parent or neighbour that is not there
  std::vector<std::uint8_t> nonzeros_;  // [P] non-zero values of the group, 255 for more
  std::vector<std::int32_t> activity_;  // [planes] of 65536
  std::vector<AdaptiveBit> node_, block_, value_;
  std::vector<MagnitudeContexts> magnitude_;
};

}  // namespace slf
