// SPDX-License-Identifier: Apache-2.0
#include "attributes/coefficient_quantiser.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>

#include "attributes/kept_means.h"
#include "attributes/level_prediction.h"
#include "attributes/mode_trial.h"
#include "attributes/predicted_node.h"
#include "attributes/quantiser_step.h"
#include "attributes/raht_arithmetic.h"
#include "attributes/rate_model.h"
#include "attributes/row_quantiser.h"
#include "base/multiversion.h"
#include "base/prefetch.h"
#include "slf/parallel.h"

namespace slf {
namespace {

/// Spec 8.8.1 of one row pair.
SLF_MULTIVERSION
void inverse_pair(const Merge& m, std::int32_t* __restrict low, std::int32_t* __restrict high,
                  std::size_t lanes) {
  for (std::size_t j = 0; j < lanes; ++j) inverse_merge(m, low[j], high[j], low[j], high[j]);
}

class LevelQuantiser {
 public:
  LevelQuantiser(const QuantiserInput& input, std::span<std::int32_t> coefficients,
                 std::span<std::int32_t> values, int threads)
      : input_(input),
        coefficients_(coefficients),
        values_(values),
        planes_(input.steps.size()),
        steps_(input.steps.begin(), input.steps.end()),
        threads_(threads),
        levels_(input.morton, input.depth, input.dropped,
                input.base != nullptr ? input.base->level : 0, input.weights) {
    for (const auto& functions : input.groups)
      rows_.emplace_back(planes_of(functions), input.steps, input.rdo, input.tree.size());
    if (input.reference != nullptr) levels_.predict_from(*input.reference);
    if (input.base != nullptr) {
      adopt(*input.base);
    } else {
      code_root();
    }
  }

  int num_levels() const { return levels_.count(); }
  std::vector<RateModel> rates() const {
    std::vector<RateModel> rates;
    for (const RowQuantiser& group : rows_) rates.push_back(group.rates());
    return rates;
  }

  /// Chosen modes of the groups on the next level, which is coded with them.
  std::vector<std::uint8_t> next_level() {
    level_ = &levels_.next();
    ++level_number_;
    merges_ = std::span(input_.tree.merges)
                  .subspan(level_->nodes.size() - 1,
                           level_->child_rows.size() - 1 - level_->nodes.size());
    if (input_.predict) means_.resize(level_->num_slots * planes_);
    std::vector<std::uint8_t> modes =
        input_.predict && (level_->nodes.size() > 1 || input_.reference != nullptr)
            ? choose_modes()
            : std::vector<std::uint8_t>(input_.groups.size(), 0);
    std::vector<std::uint8_t> of_plane(planes_);
    for (std::size_t g = 0; g < modes.size(); ++g)
      for (const std::size_t j : planes_of(input_.groups[g])) of_plane[j] = modes[g];
    if (!needs_whole_rows()) {
      parallel_ranges(planes_, kPredictionLanes, threads_, [&](std::size_t begin, std::size_t end) {
        code(begin, end, of_plane, nullptr);
      });
    } else {
      code(0, planes_, of_plane, nullptr);
    }
    return modes;
  }

 private:
  static constexpr std::size_t kMergesAhead = 8;  // whose rows are asked for before they are needed
  /// Nodes on which modes are tried.
  struct Tries {
    std::size_t nodes;  // that branch, to twice as many
    std::size_t run;    // nodes that follow one another
  };
  /// A predicted frame has twice as many modes, and is to take no more time. View maps lose by it.
  Tries tries() const {
    return input_.reference != nullptr && planes_ == 3 ? Tries{2048, 256} : Tries{8192, 1024};
  }

  std::int32_t dequantised(std::size_t plane, std::int32_t quantised) const {
    return quantised * static_cast<std::int32_t>(input_.steps[plane]);
  }

  bool needs_whole_rows() const { return input_.rdo > 0; }

  void begin_with_zeros(const SliceCells& cells) {
    for (const std::uint32_t row : cells.row)
      std::fill_n(coefficients_.begin() + static_cast<std::ptrdiff_t>(row * planes_), planes_, 0);
  }

  /// The rows of a slice's cells as the base has them.
  void adopt(const QuantisedBase& base) {
    if (base.quantised == nullptr) return begin_with_zeros(base.cells);
    for (std::size_t g = 0; g < rows_.size(); ++g) rows_[g].start_from(base.quantised->rates[g]);
    start_from_base(base.cells, base.quantised->values, base.weights, planes_, values_);
    for (std::size_t i = 0; i < base.cells.size(); ++i) {
      const std::uint32_t row = base.cells.row[i];
      const auto there = base.coefficients.subspan((base.cells.first + i) * planes_, planes_);
      std::copy(there.begin(), there.end(),
                coefficients_.begin() + static_cast<std::ptrdiff_t>(row * planes_));
      for (RowQuantiser& group : rows_) group.adopt(there.data(), row);
    }
  }

  void code_root() {
    std::vector<std::int32_t> predicted(planes_);
    for (std::size_t j = 0; input_.reference != nullptr && j < planes_; ++j)
      predicted[j] = predicted_root(input_.reference->means[0][j],
                                    static_cast<std::uint32_t>(levels_.points()));
    for (std::size_t j = 0; j < planes_; ++j) coefficients_[j] -= predicted[j];
    code_whole_row(0);
    for (std::size_t j = 0; j < planes_; ++j)
      values_[j] = std::clamp(values_[j] + predicted[j], -kPredictedLimit, kPredictedLimit);
  }

  /// Means of the children in the reference, of planes from `begin` on.
  ConstLanes reference_lanes(std::size_t begin) const {
    if (input_.reference == nullptr) return {nullptr, 0};
    return {input_.reference->means[static_cast<std::size_t>(level_number_)].data() + begin,
            planes_};
  }

  std::size_t num_modes() const {
    return input_.reference != nullptr ? kModesWithReference : kPredictionModes;
  }

  /// Coefficients of all planes of a row to quantised ones, and what a decoder makes of them.
  void code_whole_row(std::uint32_t row) {
    std::int32_t* coefficients = coefficients_.data() + row * planes_;
    std::int32_t* values = values_.data() + row * planes_;
    const std::uint32_t parent = input_.tree.parent[row];
    for (RowQuantiser& group : rows_)
      group.quantise_row(coefficients, row,
                         parent != 0 ? coefficients_.data() + parent * planes_ : nullptr, parent);
    for (std::size_t j = 0; j < planes_; ++j) values[j] = dequantised(j, coefficients[j]);
  }

  /// Are modes tried on this node of the level? On all, or on runs of them some way apart.
  bool is_tried(std::size_t n) const { return n / tries().run % apart_ == 0; }

  std::vector<std::size_t> nodes_to_try() {
    std::size_t branching = 0;
    for (std::size_t n = 0; n < level_->nodes.size(); ++n) branching += level_->branches(n);
    apart_ = std::max(branching / tries().nodes, std::size_t{1});
    std::vector<std::size_t> nodes;
    for (std::size_t n = 0; n < level_->nodes.size(); ++n)
      if (is_tried(n)) nodes.push_back(n);
    return nodes;
  }

  /// Tries every mode on all planes; a group takes the one that its planes together like best.
  std::vector<std::uint8_t> choose_modes() {
    const std::vector<std::size_t> nodes = nodes_to_try();
    std::vector<std::int32_t> parents(nodes.size() * planes_);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(level_->rows[nodes[i]] * planes_),
                  planes_, parents.begin() + static_cast<std::ptrdiff_t>(i * planes_));
    std::array<std::vector<ModeTrial>, kModesWithReference> tried;
    for (std::size_t mode = 0; mode < num_modes(); ++mode) {
      tried[mode].resize(planes_);
      const std::vector<std::uint8_t> same(planes_, static_cast<std::uint8_t>(mode));
      parallel_ranges(planes_, kPredictionLanes, threads_, [&](std::size_t begin, std::size_t end) {
        code(begin, end, same, tried[mode].data());
        for (std::size_t i = 0; i < nodes.size(); ++i)
          std::copy_n(parents.begin() + static_cast<std::ptrdiff_t>(i * planes_ + begin),
                      end - begin,
                      values_.begin() +
                          static_cast<std::ptrdiff_t>(level_->rows[nodes[i]] * planes_ + begin));
      });
    }
    std::vector<std::uint8_t> modes;
    for (const auto& functions : input_.groups) {
      std::array<std::uint64_t, kModesWithReference> cost{};
      for (std::size_t mode = 0; mode < num_modes(); ++mode)
        for (const std::size_t j : planes_of(functions)) cost[mode] += tried[mode][j].cost_q8();
      // A mode takes a decoder's time: it has to save a 256th of a bit a node, and of all.
      const std::uint64_t least = nodes.size() * planes_of(functions).size();
      cost[0] -= std::min(cost[0], std::max(cost[0] / 256, least));
      modes.push_back(static_cast<std::uint8_t>(
          std::min_element(cost.begin(), cost.begin() + static_cast<std::ptrdiff_t>(num_modes())) -
          cost.begin()));
    }
    return modes;
  }

  Lanes lanes_of(std::span<std::int32_t> rows, std::size_t begin) const {
    return {rows.empty() ? nullptr : rows.data() + begin, planes_};
  }

  /// Codes planes begin .. end - 1 of the level, or tries to: then coefficients stay as they are.
  void code(std::size_t begin, std::size_t end, const std::vector<std::uint8_t>& modes,
            ModeTrial* tried) {
    const std::size_t lanes = end - begin;
    const Lanes values = lanes_of(values_, begin), means = lanes_of(means_, begin);
    PredictedNode node(std::span<const std::uint8_t>(modes).subspan(begin, lanes));
    for (std::size_t n = 0, merge = 0, mean = 0; n < level_->nodes.size(); ++n) {
      if (!level_->branches(n)) continue;
      if (node.is_predicted())
        level_means(*level_, mean, level_->means_end[n], values, means, lanes);
      mean = level_->means_end[n];
      const auto children = static_cast<std::size_t>(std::popcount(level_->nodes.occupancy[n]));
      const std::span<const Merge> own = merges_.subspan(merge, children - 1);
      merge += own.size();
      if (tried != nullptr && !is_tried(n)) continue;
      for (std::size_t i = merge + kMergesAhead;
           i < std::min(merge + kMergesAhead + own.size(), merges_.size()); ++i) {
        prefetch_row(coefficients_.data() + merges_[i].right * planes_ + begin, lanes);
        prefetch_row(values.row(merges_[i].right), lanes);
      }
      node.predict(*level_, n, own, values, means, reference_lanes(begin));
      for (const Merge& m : own) code_row(m.right, begin, lanes, node.coefficients(m.right), tried);
      for (const Merge& m : own) inverse_pair(m, values.row(m.left), values.row(m.right), lanes);
      node.correct(values);
    }
  }

  void code_row(std::uint32_t row, std::size_t begin, std::size_t lanes,
                const std::int32_t* predicted, ModeTrial* tried) {
    std::int32_t* coefficient = coefficients_.data() + row * planes_ + begin;
    std::int32_t* value = values_.data() + row * planes_ + begin;
    if (tried != nullptr) {
      for (std::size_t j = 0; j < lanes; ++j) {
        const std::int32_t residual = coefficient[j] - (predicted != nullptr ? predicted[j] : 0);
        const QuantiserStep& step = steps_[begin + j];
        const std::int32_t quantised = step.quantise(residual);
        value[j] = dequantised(begin + j, quantised);
        tried[begin + j].add(static_cast<std::uint32_t>(std::abs(residual - value[j])),
                             static_cast<std::uint32_t>(std::abs(quantised)), step);
      }
      return;
    }
    if (predicted != nullptr)
      for (std::size_t j = 0; j < lanes; ++j) coefficient[j] -= predicted[j];
    if (needs_whole_rows()) return code_whole_row(row);
    for (std::size_t j = 0; j < lanes; ++j) {
      coefficient[j] = steps_[begin + j].quantise(coefficient[j]);
      value[j] = dequantised(begin + j, coefficient[j]);
    }
  }

  const QuantiserInput& input_;
  std::span<std::int32_t> coefficients_, values_;
  std::size_t planes_;
  std::vector<QuantiserStep> steps_;  // [planes]
  int threads_;
  TransformLevels levels_;
  const TransformLevel* level_ = nullptr;
  int level_number_ = 0;   // of its children: 1 .. depth
  std::size_t apart_ = 1;  // every apart_-th run of nodes is tried
  std::span<const Merge> merges_;
  std::vector<RowQuantiser> rows_;
  std::vector<std::int32_t> means_;
};

}  // namespace

Quantised quantise_coefficients(const QuantiserInput& input, std::span<std::int32_t> coefficients,
                                int threads) {
  Quantised out;
  out.values.resize(coefficients.size());
  out.modes.resize(input.groups.size());
  LevelQuantiser quantiser(input, coefficients, out.values, threads);
  for (int level = 0; level < quantiser.num_levels(); ++level) {
    const auto modes = quantiser.next_level();
    for (std::size_t g = 0; g < modes.size(); ++g) out.modes[g].push_back(modes[g]);
  }
  out.rates = quantiser.rates();
  return out;
}

}  // namespace slf
