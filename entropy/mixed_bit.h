// SPDX-License-Identifier: Apache-2.0
// One kind of binary decision, predicted in several contexts at a time and mixed. Spec 8.3.5.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "base/multiversion.h"
#include "entropy/context_bit.h"
#include "entropy/mixer.h"

namespace slf {

/// Codes one decision in the contexts `next` places after those selected.
template <std::size_t kBehind = 0, class Coder, std::size_t kModels>
SLF_OWN_CALL unsigned code_mixed(Coder& coder, const std::array<ContextBit*, kModels>& selected,
                                 std::size_t next, EightLanes& weights, unsigned bit) {
  constexpr std::int32_t kRate = 8;  // found on the light fields and clouds of docs/decisions/001
  const SelectedContexts<kModels, kBehind> states(selected, next);
  const Mixed<1> mixed(states.inputs(), {&weights});
  bit = coder.bit(mixed.p1(), bit);
  mixed.update(bit, kRate);
  states.update(bit);
  return bit;
}

/// A model for each shape of contexts, and a mixer with kSets sets of weights over them and a
/// constant. Too large for a stack where the shapes are.
template <std::size_t kSets, class... Shapes>
class MixedBit {
 public:
  static constexpr std::size_t kModels = sizeof...(Shapes);
  static_assert(kModels < EightLanes::kCount, "a lane is the constant's");

  MixedBit() {
    // The constant's is 0: neither decision is the likelier before anything is known.
    std::array<std::int16_t, EightLanes::kCount> first{};
    std::fill_n(first.begin(), kModels, kFirstWeights / static_cast<int>(kModels));
    weights_.fill(EightLanes(first));
  }

  /// A context of each model.
  using Contexts = std::array<ContextBit*, kModels>;
  Contexts select(const std::array<std::uint32_t, kModels>& contexts) {
    Contexts selected;
    for (std::size_t i = 0; i < kModels; ++i) selected[i] = &contexts_[kFirst[i] + contexts[i]];
    return selected;
  }

  /// Codes one decision in the given context of each model.
  template <class Coder>
  unsigned code(Coder& coder, const std::array<std::uint32_t, kModels>& contexts, std::size_t set,
                unsigned bit) {
    return code(coder, select(contexts), 0, set, bit);
  }

  /// The same in the contexts that are `next` places after those selected.
  template <class Coder>
  unsigned code(Coder& coder, const Contexts& selected, std::size_t next, std::size_t set,
                unsigned bit) {
    return code_mixed(coder, selected, next, weights_[set], bit);
  }

  /// The same with one context more, of a table elsewhere.
  using MoreContexts = std::array<ContextBit*, kModels + 1>;
  MoreContexts with(const std::array<std::uint32_t, kModels>& contexts, ContextBit& more) {
    const Contexts selected = select(contexts);
    MoreContexts all;
    std::copy(selected.begin(), selected.end(), all.begin());
    all.back() = &more;
    return all;
  }
  template <class Coder>
  unsigned code(Coder& coder, const MoreContexts& selected, std::size_t next, std::size_t set,
                unsigned bit) {
    return code_mixed<1>(coder, selected, next, weights_[set], bit);
  }
  /// Before the first of them: what its weight begins with.
  void weigh_more(std::int16_t weight) {
    static_assert(kModels + 1 < EightLanes::kCount);
    for (EightLanes& weights : weights_) {
      auto values = weights.values();
      values[kModels + 1] = weight;
      weights = EightLanes(values);
    }
  }

 private:
  // In 1/8192, shared between the models; found on synthetic scenes (docs/decisions/010).
  static constexpr int kFirstWeights = 8500;

  /// Where each model's contexts begin.
  static constexpr std::array<std::size_t, kModels> kFirst = [] {
    std::array<std::size_t, kModels> first{Shapes::kCount...};
    std::exclusive_scan(first.begin(), first.end(), first.begin(), std::size_t{0});
    return first;
  }();

  std::array<ContextBit, (Shapes::kCount + ...)> contexts_;  // model by model
  std::array<EightLanes, kSets> weights_;
};

}  // namespace slf
