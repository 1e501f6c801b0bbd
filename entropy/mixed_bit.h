// One kind of binary decision, predicted in several contexts at a time and mixed. Spec 8.3.5.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "entropy/context_bit.h"
#include "entropy/mixer.h"

namespace slf {

/// kModels tables of contexts, and a mixer with kSets sets of weights over them and a constant.
template <std::size_t kModels, std::size_t kSets>
class MixedBit {
 public:
  static_assert(kModels < EightLanes::kCount);

  /// sizes: number of contexts of each model.
  explicit MixedBit(const std::array<std::uint32_t, kModels>& sizes)
      : weights_(kSets, kFirstWeights / static_cast<int>(kModels)) {
    for (std::size_t i = 0; i < kModels; ++i) models_[i].resize(sizes[i]);
  }

  /// Codes one decision in the given context of each model.
  template <class Coder>
  unsigned code(Coder& coder, const std::array<std::uint32_t, kModels>& contexts, std::size_t set,
                unsigned bit) {
    std::array<ContextBit*, kModels> selected;
    std::array<std::int16_t, EightLanes::kCount> inputs{};
    for (std::size_t i = 0; i < kModels; ++i) {
      selected[i] = &models_[i][contexts[i]];
      inputs[i] = selected[i]->logistic();
    }
    inputs[kModels] = 256;
    const Mixed<1> mixed(EightLanes(inputs), {&weights_[set]});
    bit = coder.bit(mixed.p1(), bit);
    mixed.update(bit, kRate);
    for (ContextBit* context : selected) context->update(bit);
    return bit;
  }

 private:
  // Found on the light fields and clouds of docs/rate.md.
  static constexpr int kFirstWeights = 10650;  // of 8192, shared between the models
  static constexpr std::int32_t kRate = 8;

  std::array<std::vector<ContextBit>, kModels> models_;
  WeightSets weights_;
};

}  // namespace slf
