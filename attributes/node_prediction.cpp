// SPDX-License-Identifier: Apache-2.0
#include "attributes/node_prediction.h"

#include <bit>

#include "attributes/weight_roots.h"
#include "base/multiversion.h"

namespace slf {
namespace {

/// The three faces and three edges of a child that its parent does not share, a bit each.
constexpr auto kOutward = [] {
  std::array<std::uint32_t, 8> table{};
  for (std::size_t c = 0; c < 8; ++c) {
    const int x = (c & 1 ? 1 : -1), y = (c & 2 ? 1 : -1), z = (c & 4 ? 1 : -1);
    for (const int d :
         {direction_index(x, 0, 0), direction_index(0, y, 0), direction_index(0, 0, z),
          direction_index(x, y, 0), direction_index(x, 0, z), direction_index(0, y, z)})
      table[c] |= std::uint32_t{1} << d;
  }
  return table;
}();

/// Weight of a neighbour; 51 / 256 keeps that of coinciding centres finite. At most 2^30 / 51^2.
SLF_IN_LINE std::uint32_t closeness(const NodePlace& a, const NodePlace& b, bool wide) {
  std::uint32_t square = 51;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int32_t d = a.centre[i] - b.centre[i];  // within 64
    square += static_cast<std::uint32_t>(d * d);
  }
  return wide ? (1u << 24) / square : (1u << 30) / (square * square);
}

/// The child's terms give half of their weights to the reference, or all that it has.
/// index: of the child, of node n
void add_reference(const TransformLevel& level, std::size_t n, std::size_t index, bool half,
                   NodePrediction::Child& child) {
  const auto terms = level.reference->of(level.first_term[n] + index - level.nodes.first_child[n]);
  if (terms.empty()) return;
  if (half) {
    child.others = 0;
    for (std::uint32_t t = 0; t < child.terms; ++t) child.others += child.term[t].weight /= 2;
  } else {
    child.terms = 0;
    child.others = 0;
  }
  for (const ReferenceTerm& term : terms) {
    const std::int32_t weight = half ? term.weight / 2 : term.weight;
    child.term[child.terms++] = {term.node, weight, NodePrediction::Term::kReference};
    child.others += weight;
  }
}

}  // namespace

// Pointers and sums are kept in variables: what is stored in the plan might be a part of them else.
SLF_MULTIVERSION_ALL
void plan_node(const TransformLevel& level, std::size_t n, std::uint32_t given,
               NodePrediction& plan) {
  const std::uint32_t mode = given == kFromReference ? std::uint32_t{kSharp} : given & 3;
  const OctreeLevel& nodes = level.nodes;
  const std::uint8_t* const occupancy = nodes.occupancy.data();
  const std::uint32_t* const first_child = nodes.first_child.data();
  const std::uint32_t* const child_rows = level.child_rows.data();
  const std::uint32_t* const slot = level.slot.data();
  const NodePlace* const places = level.places.data();
  const NodePlace* const child_places = level.child_places.data();
  const std::uint32_t directions = nodes.around[n].directions;
  const std::uint32_t* const beside = nodes.neighbours.data() + nodes.around[n].first;
  const SmallRoots& roots = small_roots();
  const NodePlace own = places[n];
  NodePrediction::Child* child = plan.child.data();
  std::uint32_t index = first_child[n];
  for (unsigned left = occupancy[n]; left != 0; left &= left - 1, ++child, ++index) {
    const auto c = static_cast<std::size_t>(std::countr_zero(left));
    const NodePlace place = child_places[index];
    child->row = child_rows[index];
    child->share_q30 = static_cast<std::int32_t>((std::uint64_t{place.weight} << 30) / own.weight);
    const std::int32_t root = roots_of(roots, place.weight).root_q19;
    child->root_q19 = mode == kSharpDamped ? root - (root >> 2) : root;
    NodePrediction::Term* term = child->term.data();
    std::uint32_t sum = closeness(place, own, mode == kWide);
    for (std::uint32_t out = kOutward[c] & directions; out != 0; out &= out - 1, ++term) {
      const auto d = static_cast<std::uint32_t>(std::countr_zero(out));
      const std::uint32_t m = beside[std::popcount(directions & ((1u << d) - 1))];
      const std::uint32_t other = kChildNeighbours[c][d].child;
      const std::uint32_t children = occupancy[m];
      const NodePlace* from = &places[m];
      term->index = slot[m];
      term->root_q30 = 0;
      if (m < n && (children >> other & 1u)) {  // known already
        const std::uint32_t at =
            first_child[m] +
            static_cast<std::uint32_t>(std::popcount(children & ((1u << other) - 1)));
        from = &child_places[at];
        term->index = child_rows[at];
        term->root_q30 = roots_of(roots, from->weight).reciprocal_q30;
      }
      const std::uint32_t close = closeness(place, *from, mode == kWide);
      term->weight = static_cast<std::int32_t>(close);
      sum += close;
    }
    child->terms = static_cast<std::uint32_t>(term - child->term.data());
    std::int32_t others = 0;
    while (term != child->term.data()) {
      --term;
      term->weight =
          static_cast<std::int32_t>(static_cast<std::uint32_t>(term->weight) * 4096 / sum);
      others += term->weight;
    }
    child->others = others;
    if (given >= kFromReference) add_reference(level, n, index, given != kFromReference, *child);
  }
  plan.slot = slot[n];
  plan.children = static_cast<std::uint32_t>(child - plan.child.data());
}

}  // namespace slf
