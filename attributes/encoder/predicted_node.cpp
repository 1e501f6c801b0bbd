// SPDX-License-Identifier: Apache-2.0
#include "attributes/encoder/predicted_node.h"

#include <algorithm>

#include "attributes/raht_arithmetic.h"
#include "base/multiversion.h"

namespace slf {
namespace {

SLF_MULTIVERSION
void forward_rows(const Merge& m, std::int32_t* __restrict low, std::int32_t* __restrict high,
                  std::size_t lanes) {
  for (std::size_t j = 0; j < lanes; ++j) forward_merge(m, low[j], high[j]);
}

}  // namespace

PredictedNode::PredictedNode(std::span<const std::uint8_t> modes)
    : modes_(modes),
      used_(modes.begin(), modes.end()),
      corrections_((modes.size() + kPredictionLanes - 1) / kPredictionLanes),
      transformed_(8 * modes.size()) {
  std::sort(used_.begin(), used_.end());
  used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
  plan_ = &plans_[used_.back()];
}

void PredictedNode::predict(const TransformLevel& level, std::size_t n, std::span<const Merge> own,
                            Lanes values, Lanes means, ConstLanes reference) {
  if (!is_predicted()) return;
  for (const std::uint8_t mode : used_)
    if (mode != kUnpredicted) plan_node(level, n, mode, plans_[mode]);
  for (std::size_t block = 0; block < corrections_.size(); ++block)
    predict_block(block, values, means, reference);
  const std::size_t lanes = modes_.size();
  for (std::size_t i = 0; i < plan_->children; ++i)
    for (std::size_t j = 0; j < lanes; j += kPredictionLanes)
      std::copy_n(corrections_[j / kPredictionLanes][i].begin(),
                  std::min(kPredictionLanes, lanes - j), &transformed_[i * lanes + j]);
  for (std::size_t m = own.size(); m-- > 0;)
    forward_rows(own[m], &transformed_[child_of(own[m].left) * lanes],
                 &transformed_[child_of(own[m].right) * lanes], lanes);
}

void PredictedNode::predict_block(std::size_t block, Lanes values, Lanes means,
                                  ConstLanes reference) {
  const std::size_t begin = block * kPredictionLanes,
                    end = std::min(modes_.size(), begin + kPredictionLanes);
  if (used_.size() == 1)  // all lanes of one mode, as where modes are tried
    return predict_children(*plan_, {values.first + begin, values.stride},
                            {means.first + begin, means.stride}, reference.from(begin), end - begin,
                            corrections_[block]);
  for (auto& child : corrections_[block]) child.fill(0);
  for (std::size_t j = begin; j < end;) {  // lanes of one mode
    const std::size_t first = j;
    while (j < end && modes_[j] == modes_[first]) ++j;
    if (modes_[first] == kUnpredicted) continue;
    Corrections some;
    predict_children(plans_[modes_[first]], {values.first + first, values.stride},
                     {means.first + first, means.stride}, reference.from(first), j - first, some);
    for (std::size_t i = 0; i < plan_->children; ++i)
      std::copy_n(some[i].begin(), j - first,
                  corrections_[block][i].begin() + static_cast<std::ptrdiff_t>(first - begin));
  }
}

const std::int32_t* PredictedNode::coefficients(std::uint32_t right) const {
  return is_predicted() ? &transformed_[child_of(right) * modes_.size()] : nullptr;
}

void PredictedNode::correct(Lanes values) const {
  if (!is_predicted()) return;
  for (std::size_t j = 0; j < modes_.size(); j += kPredictionLanes)
    add_corrections(*plan_, corrections_[j / kPredictionLanes], {values.first + j, values.stride},
                    std::min(kPredictionLanes, modes_.size() - j));
}

std::size_t PredictedNode::child_of(std::uint32_t row) const {
  std::size_t i = 0;
  while (plan_->child[i].row != row) ++i;
  return i;
}

}  // namespace slf
