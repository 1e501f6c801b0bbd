// One kind of binary decision, predicted in several contexts at a time and mixed. Spec 8.3.5.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "entropy/adaptive_bit.h"
#include "entropy/logistic.h"

namespace slf {

/// kModels tables of contexts, and a mixer with kSets sets of weights over them and a constant.
template <std::size_t kModels, std::size_t kSets>
class MixedBit {
 public:
  /// sizes: number of contexts of each model.
  explicit MixedBit(const std::array<std::uint32_t, kModels>& sizes)
      : mixer_(kFirstWeights / static_cast<int>(kModels)) {
    for (std::size_t i = 0; i < kModels; ++i) models_[i].resize(sizes[i]);
  }

  /// Codes one decision in the given context of each model.
  template <class Coder>
  unsigned code(Coder& coder, const std::array<std::uint32_t, kModels>& contexts, std::size_t set,
                unsigned bit) {
    std::array<AdaptiveBit*, kModels> selected;
    std::array<int, kInputs> inputs{};
    for (std::size_t i = 0; i < kModels; ++i) {
      selected[i] = &models_[i][contexts[i]];
      inputs[i] = selected[i]->logistic();
    }
    inputs[kModels] = 256;
    const Mixed mixed = mixer_.mix(inputs, set);
    const int p1 = std::clamp(squash(mixed.logistic), 1, 65535);
    bit = coder.bit(static_cast<std::uint32_t>(p1), bit);
    mixed.update(inputs, bit, kRate);
    for (AdaptiveBit* model : selected) model->update(bit, kLimit);
    return bit;
  }

 private:
  // Found on the light fields and clouds of docs/rate.md.
  static constexpr std::size_t kInputs = kModels + 1;
  static constexpr int kFirstWeights = 85200;  // of 65536, shared between the models
  static constexpr int kRate = 40;
  static constexpr std::uint32_t kLimit = 255;

  std::array<std::vector<AdaptiveBit>, kModels> models_;
  Mixer<kInputs, kSets> mixer_;
};

}  // namespace slf
