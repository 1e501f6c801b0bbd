// The magnitude of a value of a vector, predicted from the magnitudes around it. Written once for
// decoder and encoder. Spec 8.7.2.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "entropy/binarisation.h"
#include "entropy/log_class.h"
#include "entropy/mixed_bit.h"

namespace slf {

/// What is known of a value before it is coded.
struct MagnitudeEvidence {
  std::uint32_t split;        ///< 0 .. 24
  std::uint32_t scale_class;  ///< 0 .. 23
  std::uint32_t channel;      ///< 0 .. 2
  /// Expected magnitudes, 8 fractional bits: by the rows above, by those beside; by both and the
  /// plane's own mean, of this channel and the function's earlier ones.
  std::uint32_t parents, beside;
  std::array<std::uint32_t, 3> expected;
  std::array<std::uint32_t, 3> magnitude;  ///< of the function's earlier channels
  std::uint32_t functions_before;  ///< 0 .. 15: sizes of channel 0 of the two before, 16: none
  std::uint32_t vector_ratio;      ///< 0 .. 47: by the vector's earlier values
  bool first;                      ///< no value of the vector is other than 0 yet
};

class CoefficientMagnitudeModel {
 public:
  static constexpr std::uint32_t kDamaged = 0xFFFFFFFFu;

  /// Codes a magnitude; the decoder ignores the argument and may get kDamaged. nonzero: it is known
  /// to be.
  template <class Coder>
  std::uint32_t code(Coder& coder, const MagnitudeEvidence& evidence, bool nonzero,
                     std::uint32_t magnitude) {
    const auto contexts = more_.select(contexts_of(evidence));
    const std::size_t set = (evidence.first ? 3 : 0) + evidence.channel;
    for (std::uint32_t reached = nonzero ? 1 : 0; reached < kUnary; ++reached)
      if (!more_.code(coder, contexts, reached, set * 16 + reached, magnitude > reached))
        return reached;
    const std::uint32_t rest = code_exp_golomb(
        coder, prefix_[std::min(log_class(evidence.expected[evidence.channel] >> 8, 47) / 4, 11u)],
        kLimit, Coder::kDecodes ? 0 : magnitude - kUnary + 1);
    return rest == 0 ? kDamaged : kUnary - 1 + rest;
  }

 private:
  static constexpr std::uint32_t kUnary = 15;  // decisions "more than 0" to "more than 14"
  static constexpr std::uint32_t kLimit = 255;
  static constexpr std::size_t kModels = 6;

  static std::array<std::uint32_t, kModels> contexts_of(const MagnitudeEvidence& e) {
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
    const std::uint32_t channels = c == 0   ? 0
                                   : c == 1 ? by_channel(0)
                                            : by_channel(1) / 2 * 24 + by_channel(0) / 2;
    const std::uint32_t size = log_class(e.expected[c] >> 4, 47);
    std::array<std::uint32_t, kModels> contexts = {
        e.split * 24 + e.scale_class,
        other,
        log_class(e.parents >> 4, 39) / 2 * 20 + log_class(e.beside >> 4, 39) / 2,
        std::min(size / 2, 19u) * 64 + other,
        channels,
        e.vector_ratio / 3 * 16 + size / 3};
    for (std::uint32_t& context : contexts) context = (context * 3 + c) * 16;
    return contexts;
  }

  static constexpr std::uint32_t kDecisions = 3 * 16;  // of a channel, of a place in the unary code
  MixedBit<kModels, 2 * kDecisions> more_{{25 * 24 * kDecisions, 64 * kDecisions,
                                           20 * 20 * kDecisions, 20 * 64 * kDecisions,
                                           24 * 24 * kDecisions, 16 * 16 * kDecisions}};
  std::array<PrefixContexts, 12> prefix_;
};

}  // namespace slf
