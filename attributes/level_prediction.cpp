// SPDX-License-Identifier: Apache-2.0
#include "attributes/level_prediction.h"

#include <algorithm>

#include "attributes/raht_arithmetic.h"
#include "attributes/weight_roots.h"
#include "base/multiversion.h"
#include "base/prefetch.h"

namespace slf {
namespace {

constexpr std::int32_t kMeanLimit = (1 << 17) - 1;

inline void accumulate(std::int32_t* __restrict sum, const std::int32_t* __restrict source,
                       const NodePrediction::Term& term, std::size_t lanes) {
  const std::int32_t weight = term.weight;
  if (term.root_q30 <= 0) {  // a mean
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

SLF_MULTIVERSION_LANES
void node_means(const std::int32_t* values, std::uint32_t weight, std::int32_t* means,
                std::size_t lanes) {
  mean_row(values, roots_of(small_roots(), weight).reciprocal_q30, means, lanes);
}

SLF_MULTIVERSION_LANES
void level_means(const TransformLevel& level, std::size_t begin, std::size_t end, Lanes values,
                 Lanes means, std::size_t lanes) {
  const SmallRoots& roots = small_roots();
  constexpr std::size_t kAhead = 8;  // rows that nothing of has been read yet
  for (std::size_t i = begin; i < end; ++i) {
    const std::uint32_t n = level.means[i], row = level.rows[n];
    if (i + kAhead < level.means.size())
      prefetch_row(values.row(level.rows[level.means[i + kAhead]]), lanes);
    mean_row(values.row(row), roots_of(roots, level.places[n].weight).reciprocal_q30,
             means.row(level.slot[n]), lanes);
  }
}

namespace {

inline void predict_lanes(const NodePrediction& plan, Lanes values, Lanes means,
                          ConstLanes reference, std::size_t lanes, Corrections& out) {
  for (std::size_t i = 0; i < plan.children; ++i) {
    const NodePrediction::Child& child = plan.child[i];
    std::int32_t* sum = out[i].data();
    subtract_own(sum, means.row(plan.slot), child.others, lanes);
    for (std::size_t t = 0; t < child.terms; ++t) {
      const NodePrediction::Term& term = child.term[t];
      const std::int32_t* from = term.root_q30 == NodePrediction::Term::kSlot
                                     ? means.row(term.index)
                                 : term.root_q30 > 0 ? values.row(term.index)
                                                     : reference.row(term.index);
      accumulate(sum, from, term, lanes);
    }
    for (std::size_t j = 0; j < lanes; ++j) sum[j] >>= 6;
  }
  finish_prediction(plan, lanes, out);
}

}  // namespace

SLF_MULTIVERSION_LANES
void predict_children(const NodePrediction& plan, Lanes values, Lanes means, ConstLanes reference,
                      std::size_t lanes, Corrections& out) {
  if (lanes == kPredictionLanes)
    return predict_lanes(plan, values, means, reference, kPredictionLanes, out);
  if (lanes == 3)  // one function: the means
    return predict_lanes(plan, values, means, reference, 3, out);
  predict_lanes(plan, values, means, reference, lanes, out);
}

SLF_MULTIVERSION_LANES
void add_corrections(const NodePrediction& plan, const Corrections& corrections, Lanes values,
                     std::size_t lanes) {
  for (std::size_t i = 0; i < plan.children; ++i)
    add_row(values.row(plan.child[i].row), corrections[i].data(), lanes);
}

}  // namespace slf
