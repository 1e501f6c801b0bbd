#include "attributes/level_prediction.h"

#include <algorithm>
#include <bit>

#include "attributes/raht_arithmetic.h"
#include "attributes/raht_tree.h"
#include "base/multiversion.h"
#include "base/prefetch.h"

namespace slf {
namespace {

constexpr std::int32_t kMeanLimit = (1 << 17) - 1;

/// The three faces and three edges of a child that its parent does not share.
constexpr auto kOutward = [] {
  std::array<std::array<std::uint8_t, 6>, 8> table{};
  for (int c = 0; c < 8; ++c) {
    const int x = (c & 1) * 2 - 1, y = (c >> 1 & 1) * 2 - 1, z = (c >> 2 & 1) * 2 - 1;
    const std::array<int, 6> d = {direction_index(x, 0, 0), direction_index(0, y, 0),
                                  direction_index(0, 0, z), direction_index(x, y, 0),
                                  direction_index(x, 0, z), direction_index(0, y, z)};
    for (std::size_t i = 0; i < 6; ++i)
      table[static_cast<std::size_t>(c)][i] = static_cast<std::uint8_t>(d[i]);
  }
  return table;
}();

/// Most nodes have few points: their roots are worked out once.
struct Roots {
  std::int32_t reciprocal_q30;
  std::int32_t root_q19;  // of a child: it weighs less than 2^24
};
Roots compute_roots(std::uint32_t weight) {
  return {static_cast<std::int32_t>(isqrt((std::uint64_t{1} << 60) / weight)),
          static_cast<std::int32_t>(isqrt(std::uint64_t{weight} << 38))};
}
const std::array<Roots, 512>& small_roots() {
  static const auto table = [] {
    std::array<Roots, 512> roots{};
    for (std::uint32_t w = 1; w < roots.size(); ++w) roots[w] = compute_roots(w);
    return roots;
  }();
  return table;
}
Roots roots_of(std::uint32_t weight) {
  const auto& table = small_roots();
  return weight < table.size() ? table[weight] : compute_roots(weight);
}

/// Weight of a neighbour; 51 / 256 keeps that of coinciding centres finite.
std::uint32_t closeness(const NodePlace& a, const NodePlace& b, std::uint32_t mode) {
  std::uint32_t square = 51;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int32_t d = a.centre[i] - b.centre[i];  // within 64
    square += static_cast<std::uint32_t>(d * d);
  }
  return mode == kWide ? (1u << 24) / square : (1u << 30) / (square * square);
}

inline void accumulate(std::int32_t* __restrict sum, const std::int32_t* __restrict source,
                       const NodePrediction::Term& term, std::size_t lanes) {
  const std::int32_t weight = term.weight;
  if (term.root_q30 == 0) {
    for (std::size_t j = 0; j < lanes; ++j) sum[j] += weight * source[j];
  } else if (term.root_q30 == 1 << 30) {
    for (std::size_t j = 0; j < lanes; ++j) sum[j] += weight * limited(source[j], kMeanLimit);
  } else {
    for_values(lanes, [=, root = term.root_q30](auto at) {
      const auto mean = limited(rounded<30>(product(value_at(source, at), root)), kMeanLimit);
      set_value(sum, at, value_at(sum, at) + mean * weight);
    });
  }
}

/// Means of the corrections over the children, weighted with their shares.
inline void mean_correction(const NodePrediction& plan, const Corrections& out, std::size_t lanes,
                            std::array<std::int32_t, kPredictionLanes>& mean) {
  bool alike = true;
  for (std::size_t i = 1; i < plan.children; ++i)
    alike = alike && plan.child[i].share_q30 == plan.child[0].share_q30;
  if (alike) {  // the same sum, which fits: corrections are at most 2^24
    for (std::size_t j = 0; j < lanes; ++j) mean[j] = out[0][j];
    for (std::size_t i = 1; i < plan.children; ++i)
      for (std::size_t j = 0; j < lanes; ++j) mean[j] += out[i][j];
    for_values(lanes, [of = mean.data(), share = plan.child[0].share_q30](auto at) {
      set_value(of, at, rounded<30>(product(value_at(of, at), share)));
    });
    return;
  }
  std::array<std::int64_t, kPredictionLanes> total;
  for (std::size_t j = 0; j < lanes; ++j)
    total[j] = std::int64_t{plan.child[0].share_q30} * out[0][j];
  for (std::size_t i = 1; i < plan.children; ++i)
    for (std::size_t j = 0; j < lanes; ++j)
      total[j] += std::int64_t{plan.child[i].share_q30} * out[i][j];
  for (std::size_t j = 0; j < lanes; ++j) mean[j] = rounded<30>(total[j]);
}

inline void finish_prediction(const NodePrediction& plan, std::size_t lanes, Corrections& out) {
  std::array<std::int32_t, kPredictionLanes> mean;
  mean_correction(plan, out, lanes, mean);
  for (std::size_t i = 0; i < plan.children; ++i) {
    const std::int32_t root = plan.child[i].root_q19;
    if (root % (1 << 17) == 0 && root <= 1 << 22) {  // as for one point: rounded<25> in 32 bits
      const std::int32_t root_q2 = root >> 17;
      for (std::size_t j = 0; j < lanes; ++j) {
        const std::int32_t difference = out[i][j] - mean[j];  // at most 2^25
        out[i][j] = (difference * root_q2 + 128 - (difference < 0)) >> 8;
      }
    } else {
      for_values(lanes, [to = out[i].data(), from = mean.data(), root](auto at) {
        set_value(to, at, rounded<25>(product(value_at(to, at) - value_at(from, at), root)));
      });
    }
  }
}

inline void mean_row(const std::int32_t* __restrict value, std::int32_t root_q30,
                     std::int32_t* __restrict mean, std::size_t lanes) {
  for_values(lanes, [=](auto at) {
    set_value(mean, at, limited(rounded<30>(product(value_at(value, at), root_q30)), kMeanLimit));
  });
}

/// Where a sum begins: its terms are differences from the node's own mean.
inline void subtract_own(std::int32_t* __restrict sum, const std::int32_t* __restrict own,
                         std::int32_t others, std::size_t lanes) {
  for (std::size_t j = 0; j < lanes; ++j) sum[j] = -others * own[j];
}

inline void add_row(std::int32_t* __restrict value, const std::int32_t* __restrict correction,
                    std::size_t lanes) {
  for (std::size_t j = 0; j < lanes; ++j)
    value[j] = std::clamp(value[j] + correction[j], -kPredictedLimit, kPredictedLimit);
}

}  // namespace

SLF_MULTIVERSION_ALL
void plan_node(const TransformLevel& level, std::size_t n, std::uint32_t mode,
               NodePrediction& plan) {
  const OctreeLevel& nodes = level.nodes;
  const NodePlace& own = level.places[n];
  plan.slot = level.slot[n];
  plan.children = 0;
  for (std::uint32_t c = 0, index = nodes.first_child[n]; c < 8; ++c) {
    if (!(nodes.occupancy[n] >> c & 1u)) continue;
    NodePrediction::Child& child = plan.child[plan.children++];
    const NodePlace& place = level.child_places[index];
    child.row = level.child_rows[index++];
    child.share_q30 = static_cast<std::int32_t>((std::uint64_t{place.weight} << 30) / own.weight);
    child.root_q19 = roots_of(place.weight).root_q19;
    if (mode == kSharpDamped) child.root_q19 -= child.root_q19 >> 2;
    child.terms = 0;
    std::uint32_t sum = closeness(place, own, mode);
    for (const std::uint8_t d : kOutward[c]) {
      if (!(nodes.around[n].directions >> d & 1u)) continue;
      const std::size_t m = nodes.neighbour(n, d);
      NodePrediction::Term& term = child.term[child.terms++];
      const std::uint32_t other = kChildNeighbours[c][d].child;
      const NodePlace* there = &level.places[m];
      if (m < n && (nodes.occupancy[m] >> other & 1u)) {  // known already
        const auto before = static_cast<unsigned>(nodes.occupancy[m]) & ((1u << other) - 1);
        const std::uint32_t at =
            nodes.first_child[m] + static_cast<std::uint32_t>(std::popcount(before));
        there = &level.child_places[at];
        term.index = level.child_rows[at];
        term.root_q30 = roots_of(there->weight).reciprocal_q30;
      } else {
        term.index = level.slot[m];
        term.root_q30 = 0;
      }
      const std::uint32_t close = closeness(place, *there, mode);
      term.weight = static_cast<std::int32_t>(close);
      sum += close;
    }
    child.others = 0;
    for (std::size_t t = 0; t < child.terms; ++t) {
      std::int32_t& weight = child.term[t].weight;
      weight = static_cast<std::int32_t>(static_cast<std::uint32_t>(weight) * 4096 / sum);
      child.others += weight;
    }
  }
}

SLF_MULTIVERSION_LANES
void level_means(const TransformLevel& level, std::size_t begin, std::size_t end, Lanes values,
                 Lanes means, std::size_t lanes) {
  constexpr std::size_t kAhead = 8;  // rows that nothing of has been read yet
  for (std::size_t i = begin; i < end; ++i) {
    const std::uint32_t n = level.means[i], row = level.rows[n];
    if (i + kAhead < level.means.size())
      prefetch_row(values.row(level.rows[level.means[i + kAhead]]), lanes);
    mean_row(values.row(row), roots_of(level.places[n].weight).reciprocal_q30,
             means.row(level.slot[n]), lanes);
  }
}

namespace {

inline void predict_lanes(const NodePrediction& plan, Lanes values, Lanes means, std::size_t lanes,
                          Corrections& out) {
  for (std::size_t i = 0; i < plan.children; ++i) {
    const NodePrediction::Child& child = plan.child[i];
    std::int32_t* sum = out[i].data();
    subtract_own(sum, means.row(plan.slot), child.others, lanes);
    for (std::size_t t = 0; t < child.terms; ++t) {
      const NodePrediction::Term& term = child.term[t];
      const Lanes& from = term.root_q30 == 0 ? means : values;
      accumulate(sum, from.row(term.index), term, lanes);
    }
    for (std::size_t j = 0; j < lanes; ++j) sum[j] >>= 6;
  }
  finish_prediction(plan, lanes, out);
}

}  // namespace

SLF_MULTIVERSION_LANES
void predict_children(const NodePrediction& plan, Lanes values, Lanes means, std::size_t lanes,
                      Corrections& out) {
  if (lanes == kPredictionLanes) return predict_lanes(plan, values, means, kPredictionLanes, out);
  predict_lanes(plan, values, means, lanes, out);
}

SLF_MULTIVERSION_LANES
void add_corrections(const NodePrediction& plan, const Corrections& corrections, Lanes values,
                     std::size_t lanes) {
  for (std::size_t i = 0; i < plan.children; ++i)
    add_row(values.row(plan.child[i].row), corrections[i].data(), lanes);
}

std::int32_t reciprocal_root_q30(std::uint32_t weight) { return roots_of(weight).reciprocal_q30; }

}  // namespace slf
