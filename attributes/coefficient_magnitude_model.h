// SPDX-License-Identifier: Apache-2.0
// The magnitude of a value of a vector, predicted from the magnitudes around it. Written once for
// decoder and encoder. Spec 8.7.2.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "entropy/binarisation.h"
#include "entropy/context_shape.h"
#include "entropy/log_class.h"
#include "entropy/mixed_bit.h"

namespace slf {

/// What is known of a value before it is coded.
struct MagnitudeEvidence {
  std::uint32_t channel;  ///< 0 .. 2
  /// Expected magnitudes, 8 fractional bits: by the rows above and beside and the plane's own mean,
  /// of this channel and the function's earlier ones.
  std::array<std::uint32_t, 3> expected;
  std::array<std::uint32_t, 3> magnitude;  ///< of the function's earlier channels
  std::uint32_t functions_before;  ///< 0 .. 15: sizes of channel 0 of the two before, 16: none
  std::uint32_t vector_ratio;      ///< 0 .. 47: by the vector's earlier values
  bool first;                      ///< no value of the vector is other than 0 yet
  ContextBit* there;               ///< contexts by the reference; nullptr: none
};

/// Sizes of channel 0 of the two functions before function f of a vector. own: its kept values
inline std::uint32_t functions_before(std::size_t f, const std::int16_t* own) {
  const auto size = [&](std::size_t function, int most) {
    return static_cast<std::uint32_t>(std::min(std::abs(int{own[3 * function]}), most));
  };
  if (f == 0) return 16;
  return size(f - 1, 3) + 4 * (f == 1 ? 3 : size(f - 2, 2));
}

class CoefficientMagnitudeModel {
 public:
  static constexpr std::uint32_t kDamaged = 0xFFFFFFFFu;

  /// Codes a magnitude; the decoder ignores the argument and may get kDamaged. nonzero: it is known
  /// to be.
  template <class Coder>
  std::uint32_t code(Coder& coder, const MagnitudeEvidence& evidence, bool nonzero,
                     std::uint32_t magnitude) {
    const auto contexts = contexts_of(evidence);
    if (evidence.there != nullptr)
      return code_in(coder, more_.with(contexts, *evidence.there), evidence, nonzero, magnitude);
    return code_in(coder, more_.select(contexts), evidence, nonzero, magnitude);
  }

  /// Codes whether a magnitude is 2 * before or one more. Spec 8.7.7.
  template <class Coder>
  std::uint32_t refine(Coder& coder, const MagnitudeEvidence& evidence, bool nonzero,
                       std::uint32_t before, std::uint32_t magnitude) {
    const std::uint32_t least = 2 * before;
    if (nonzero && least == 0) return 1;
    const std::uint32_t reached = std::min(least, kUnary - 1);
    return least + more_.code(coder, more_.select(contexts_of(evidence)), reached,
                              Set::index(evidence.first, evidence.channel, reached),
                              magnitude > least);
  }

  /// Before the first context by a reference: what its weight begins with.
  void weigh_more(std::int16_t weight) { more_.weigh_more(weight); }

 private:
  static constexpr std::uint32_t kUnary = 15;  // decisions "more than 0" to "more than 14"
  static constexpr std::uint32_t kLimit = 255;

  template <class Coder, class Contexts>
  std::uint32_t code_in(Coder& coder, const Contexts& contexts, const MagnitudeEvidence& evidence,
                        bool nonzero, std::uint32_t magnitude) {
    for (std::uint32_t reached = nonzero ? 1 : 0; reached < kUnary; ++reached)
      if (!more_.code(coder, contexts, reached,
                      Set::index(evidence.first, evidence.channel, reached), magnitude > reached))
        return reached;
    const std::uint32_t rest = code_exp_golomb(
        coder, prefix_[std::min(log_class(evidence.expected[evidence.channel] >> 8, 47) / 4, 11u)],
        kLimit, Coder::kDecodes ? 0 : magnitude - kUnary + 1);
    return rest == 0 ? kDamaged : kUnary - 1 + rest;
  }

  static std::array<std::uint32_t, 3> contexts_of(const MagnitudeEvidence& e) {
    const std::uint32_t c = e.channel;
    const std::uint32_t other =
        c == 0   ? e.functions_before
        : c == 1 ? log_class(e.magnitude[0], 15)
                 : std::min(e.magnitude[1], 3u) * 16 + log_class(e.magnitude[0], 15);
    // What an earlier channel's magnitude is to its expectation, this one's may be to its own.
    const auto by_channel = [&](std::uint32_t b) {
      return log_class(
          std::uint64_t{e.magnitude[b] * 2 + 1} * 8 * (e.expected[c] + 16) / (e.expected[b] + 16),
          47);
    };
    std::array<std::uint32_t, 2> ratios{};
    const std::uint32_t to_first = c > 0 ? by_channel(0) : 0;
    if (c == 1) ratios = {to_first / 24, to_first % 24};  // all of its 48 classes
    if (c == 2) ratios = {by_channel(1) / 2, to_first / 2};
    const std::uint32_t size = log_class(e.expected[c] >> 4, 47);
    return {Expected::index(std::min(size / 2, Expected::kMost<0>), other, c, 0),
            Channels::index(ratios[0], ratios[1], c, 0),
            Ratio::index(e.vector_ratio / 3, size / 3, c, 0)};
  }

  // The last two: the channel, and the place in the unary code.
  using Expected = ContextShape<20, 64, 3, 16>;  // magnitude; those that are known
  using Channels = ContextShape<24, 24, 3, 16>;  // of earlier channels to their expectation
  using Ratio = ContextShape<16, 16, 3, 16>;     // of the vector so far; magnitude
  using Set = ContextShape<2, 3, 16>;            // first of the vector; as above
  MixedBit<Set::kCount, Expected, Channels, Ratio> more_;
  std::array<PrefixContexts, 12> prefix_;
};

}  // namespace slf
