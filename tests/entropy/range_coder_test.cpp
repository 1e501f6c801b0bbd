// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>

#include "entropy/binarisation.h"
#include "entropy/context_bit.h"
#include "entropy/context_shape.h"
#include "entropy/eight_lanes.h"
#include "entropy/log_class.h"
#include "entropy/logistic.h"
#include "entropy/mixed_bit.h"
#include "entropy/mixer.h"
#include "entropy/range_decoder.h"
#include "entropy/range_encoder.h"

namespace slf::range_coder_test {
namespace {

TEST(Spec_8_3_1_RangeCoder, GivesBackEveryDecisionAtEveryProbability) {
  std::mt19937 random(1);
  for (const std::uint32_t p1 : {1u, 2u, 255u, 256u, 30000u, 32768u, 65279u, 65534u, 65535u}) {
    std::vector<unsigned> bits;
    RangeEncoder encoder;
    for (int i = 0; i < 5000; ++i) {
      bits.push_back((random() & 0xFFFF) < p1);
      encoder.bit(p1, bits.back());
    }
    const auto bytes = encoder.finish();
    RangeDecoder decoder(bytes);
    for (const unsigned bit : bits) ASSERT_EQ(decoder.bit(p1), bit);
    EXPECT_TRUE(decoder.finish("test"));
  }
}

TEST(Spec_8_3_1_RangeCoder, CodesTheLeastLikelySymbolManyTimesInARow) {
  for (const unsigned bit : {0u, 1u}) {  // carries and long runs of 0xFF
    RangeEncoder encoder;
    for (int i = 0; i < 3000; ++i) encoder.bit(bit ? 1 : 65535, bit);
    const auto bytes = encoder.finish();
    EXPECT_NEAR(8. * static_cast<double>(bytes.size()), 3000 * 16, 320);
    RangeDecoder decoder(bytes);
    for (int i = 0; i < 3000; ++i) ASSERT_EQ(decoder.bit(bit ? 1 : 65535), bit);
  }
}

TEST(Spec_8_3_1_RangeCoder, CodeLengthIsTheEntropyOfItsModel) {
  std::mt19937 random(2);
  double information = 0;
  RangeEncoder encoder;
  for (int i = 0; i < 100000; ++i) {
    const auto p1 = static_cast<std::uint32_t>(1 + random() % 65535);
    const unsigned bit = (random() & 0xFFFF) < p1;
    information -= std::log2((bit ? p1 : 65536 - p1) / 65536.0);
    encoder.bit(p1, bit);
  }
  const double bytes = static_cast<double>(encoder.finish().size());
  EXPECT_GE(bytes, information / 8 - 1);
  EXPECT_LE(bytes, information / 8 * 1.002 + 5);
}

TEST(Spec_8_3_1_RangeCoder, FourBytesLostOrAddedAtMostPassUnnoticed) {
  RangeEncoder encoder;
  for (int i = 0; i < 800; ++i) encoder.raw(1, static_cast<std::uint32_t>(i * i >> 3 & 1));
  const auto bytes = encoder.finish();
  const auto ends_well = [](const std::vector<std::uint8_t>& stream) {
    RangeDecoder decoder(stream);
    for (int i = 0; i < 800; ++i) decoder.raw(1);
    return static_cast<bool>(decoder.finish("test"));
  };
  ASSERT_TRUE(ends_well(bytes));
  // The register is four bytes ahead of the decisions: the end may be anywhere within them.
  std::vector<std::ptrdiff_t> unnoticed;
  for (std::ptrdiff_t change = -9; change <= 9; ++change) {
    auto changed = bytes;
    changed.resize(std::size_t(std::ptrdiff_t(bytes.size()) + change), 1);
    if (ends_well(changed)) unnoticed.push_back(change);
  }
  ASSERT_EQ(unnoticed.size(), 5u);  // with the whole codeword
  EXPECT_EQ(unnoticed.back() - unnoticed.front(), 4);
}

TEST(Spec_8_3_1_RangeCoder, OnlyNoDecisionsGiveNoBytes) {
  EXPECT_TRUE(RangeEncoder().finish().empty());
  RangeEncoder ones;  // the lower part of every interval: zeros would do
  for (int i = 0; i < 3; ++i) ones.bit(60000, 1);
  EXPECT_FALSE(ones.finish().empty());
}

TEST(Spec_8_3_1_RangeCoder, DecodesGarbageWithoutReadingOutside) {
  std::mt19937 random(3);
  for (std::size_t size = 0; size < 40; ++size) {
    std::vector<std::uint8_t> garbage(size);
    for (auto& byte : garbage) byte = static_cast<std::uint8_t>(random());
    RangeDecoder decoder(garbage);
    AdaptiveBit context;
    for (int i = 0; i < 2000; ++i) ASSERT_LE(decoder.bit(context, 255), 1u);
  }
}

TEST(Spec_8_3_2_AdaptiveBit, FollowsTheShareOfOnes) {
  std::mt19937 random(4);
  AdaptiveBit context;
  for (int i = 0; i < 20000; ++i) context.update(random() % 10 == 0, 1023);
  EXPECT_NEAR(context.p1() / 65536.0, 0.1, 0.02);
}

TEST(Spec_8_3_2_AdaptiveBit, StaysWithinItsRange) {
  AdaptiveBit zeros, ones;
  EXPECT_EQ(zeros.p1(), 32768u);
  for (int i = 0; i < 100000; ++i) {
    zeros.update(0, 1023);
    ones.update(1, 1023);
    ASSERT_GE(zeros.p1(), 1u);
    ASSERT_LE(ones.p1(), 65535u);
  }
  EXPECT_LT(zeros.p1(), 100u);
  EXPECT_GT(ones.p1(), 65436u);
}

TEST(Spec_8_3_3_Logistic, StretchInvertsSquash) {
  for (int x = -2300; x <= 2300; x += 7) {
    const double p = squash(x) / 65536.0;
    EXPECT_NEAR(p, 1 / (1 + std::exp(-x / 256.0)), 0.004) << x;  // linear between table entries
  }
  // One logistic unit is 64 of 65536 at p = 1/2, and p is known to 16.
  for (std::uint32_t p = 8; p < 65536; p += 16)
    EXPECT_NEAR(squash(stretch(p)), static_cast<int>(p), 72) << p;
}

TEST(Spec_8_3_3_Mixer, LearnsWhichPredictionToTrust) {
  std::mt19937 random(5);
  WeightSets weights(2, 2000);
  double cost = 0;
  for (int i = 0; i < 4000; ++i) {
    const unsigned bit = random() % 2;
    const auto logistic = [](bool one) { return static_cast<std::int16_t>(one ? 1000 : -1000); };
    const EightLanes inputs({logistic(bit), logistic(random() % 2)});  // truth, noise
    const Mixed<2> mixed(inputs, {&weights[0], &weights[1]});
    const double p1 = mixed.p1() / 65536.0;
    if (i >= 2000) cost -= std::log2(bit ? p1 : 1 - p1);
    mixed.update(bit, 4);
  }
  EXPECT_LT(cost / 2000, 0.02);
}

TEST(Spec_8_3_3_Lanes, AreTheIntegersOfTheText) {
  std::mt19937 random(8);
  for (int i = 0; i < 20000; ++i) {
    std::array<std::int16_t, 8> x, w;
    for (std::size_t k = 0; k < 8; ++k) {
      x[k] = static_cast<std::int16_t>(static_cast<int>(random() % 5631) - 2815);
      w[k] =
          static_cast<std::int16_t>(random() % 5 == 0 ? (random() % 2 ? 32767 : -32768)
                                                      : static_cast<int>(random() % 65536) - 32768);
    }
    const int factor = static_cast<int>(random() % 32768) - (1 << 14);
    int dot = 0;
    const auto sum = EightLanes(x).saturating_plus(EightLanes(w)).values();
    const auto step = EightLanes(w).times(factor).values();
    for (std::size_t k = 0; k < 8; ++k) {
      dot += x[k] * w[k];
      EXPECT_EQ(sum[k], std::clamp(x[k] + w[k], -32768, 32767));
      EXPECT_EQ(step[k], (w[k] * factor + (1 << 15)) >> 16);
    }
    EXPECT_EQ(EightLanes(x).dot(EightLanes(w)), dot);
  }
}

TEST(Spec_8_3_5_Context, FollowsTheShareOfOnesAndStaysWithinItsRange) {
  ContextBit unseen, zeros, ones;
  EXPECT_EQ(unseen.logistic(), 0);
  for (int i = 0; i < 1000; ++i) {
    zeros.update(0);
    ones.update(1);
  }
  EXPECT_LT(zeros.logistic(), -1000);
  EXPECT_GT(ones.logistic(), 1000);
}

TEST(Spec_8_3_5_Context, SeveralMoveTogetherAsEachAlone) {
  constexpr std::uint32_t kAll = ContextStates::kAll;
  const auto context = [](std::uint32_t state) {
    return std::bit_cast<ContextBit>(static_cast<std::uint16_t>(state));
  };
  for (std::uint32_t state = 0; state < kAll; ++state)
    for (const unsigned bit : {0u, 1u}) {
      std::array<ContextBit, 3> alone = {context(state), ContextBit(), context(kAll - 1 - state)};
      std::array<ContextBit, 6> together;
      std::copy(alone.begin(), alone.end(), together.begin() + 3);
      const std::array<ContextBit*, 3> first = {&together[0], &together[1], &together[2]};
      const SelectedContexts<3> selected(first, 3);
      const auto inputs = selected.inputs().values();
      selected.update(bit);
      for (std::size_t i = 0; i < 3; ++i) {
        ASSERT_EQ(inputs[i], alone[i].logistic());
        alone[i].update(bit);
        ASSERT_EQ(std::bit_cast<std::uint16_t>(together[i + 3]),
                  std::bit_cast<std::uint16_t>(alone[i]));
      }
      ASSERT_EQ(inputs[3], 256);
    }
}

/// code(coder, contexts, value) gives the value back on both sides.
template <class Contexts, class Code>
void expect_round_trip(const std::vector<std::uint32_t>& values, const Code& code) {
  RangeEncoder encoder;
  Contexts written, read;
  for (const std::uint32_t v : values) EXPECT_EQ(code(encoder, written, v), v);
  const auto bytes = encoder.finish();
  RangeDecoder decoder(bytes);
  for (const std::uint32_t v : values) EXPECT_EQ(code(decoder, read, 0u), v);
  EXPECT_TRUE(decoder.finish("test"));
}

TEST(Spec_8_3_4_Magnitude, RoundTripsFromOneToTheLargest) {
  expect_round_trip<MagnitudeContexts>(
      {1, 2, 3, 13, 14, 15, 16, 17, 18, 100, 65535, 1u << 20, (1u << 27) - 1},
      [](auto& coder, auto& contexts, auto v) { return code_magnitude(coder, contexts, 255, v); });
}

TEST(Spec_8_3_4_Magnitude, AnEndlessPrefixIsRefusedNotFollowed) {
  const std::vector<std::uint8_t> zeros(64, 0);  // the decoder takes every decision as 1
  RangeDecoder decoder(zeros);
  MagnitudeContexts contexts;
  EXPECT_EQ(code_magnitude(decoder, contexts, 255, 0), 0u);
}

TEST(Spec_8_3_4_ExpGolomb, RoundTripsFromOneToTheLargest) {
  expect_round_trip<PrefixContexts>(
      {1, 2, 3, 4, 7, 8, 1000, 1u << 27, (1u << 28) - 1},
      [](auto& coder, auto& contexts, auto v) { return code_exp_golomb(coder, contexts, 255, v); });
}

TEST(Spec_8_3_5_MixedDecision, IsCodedByTheModelThatKnows) {
  std::mt19937 random(6);
  std::vector<std::array<std::uint32_t, 2>> contexts;
  std::vector<unsigned> bits;
  for (int i = 0; i < 4000; ++i) {
    bits.push_back(random() % 2);
    contexts.push_back({bits.back(), static_cast<std::uint32_t>(random() % 16)});  // truth, noise
  }
  RangeEncoder encoder;
  MixedBit<1, ContextShape<2>, ContextShape<16>> written;
  for (std::size_t i = 0; i < bits.size(); ++i) written.code(encoder, contexts[i], 0, bits[i]);
  const auto bytes = encoder.finish();
  EXPECT_LT(bytes.size(), 4000 / 8 / 20);
  RangeDecoder decoder(bytes);
  MixedBit<1, ContextShape<2>, ContextShape<16>> read;
  for (std::size_t i = 0; i < bits.size(); ++i)
    ASSERT_EQ(read.code(decoder, contexts[i], 0, 0), bits[i]);
  EXPECT_TRUE(decoder.finish("test"));
}

TEST(Spec_8_3_6_Classes, AreFourAnOctaveAndAscending) {
  const std::vector<std::uint32_t> first = {0, 1, 2, 3, 4, 5, 6, 7, 8, 8, 9, 9, 10, 10, 11, 11, 12};
  for (std::uint32_t n = 0; n < first.size(); ++n) EXPECT_EQ(log_class(n, 47), first[n]) << n;
  for (int bit = 3; bit < 64; ++bit) {
    const std::uint64_t octave = std::uint64_t{1} << bit;
    EXPECT_EQ(log_class(octave, 1000), log_class(octave - 1, 1000) + 1) << bit;
    EXPECT_EQ(log_class(octave, 1000), log_class(octave >> 1, 1000) + 4) << bit;
  }
  EXPECT_EQ(log_class(~std::uint64_t{0}, 47), 47u);
  EXPECT_EQ(log_class(3, 2), 2u);
}

}  // namespace
}  // namespace slf::range_coder_test
