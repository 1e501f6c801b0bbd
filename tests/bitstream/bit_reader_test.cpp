// SPDX-License-Identifier: Apache-2.0
// Codes of headers. Spec 3.3.
#include "bitstream/bit_reader.h"

#include <gtest/gtest.h>

#include "bitstream/bit_writer.h"

namespace slf::bit_reader_test {
namespace {

TEST(Spec_3_3_BitReader, ExpGolombCodesAreThoseOfTheTable) {
  // 1, 010, 011, 00100, 00101: 0 .. 4
  const std::vector<std::uint8_t> bytes = {0b10100110, 0b01000010, 0b10000000};
  BitReader in(bytes);
  for (std::uint64_t expected = 0; expected <= 4; ++expected) EXPECT_EQ(in.ue("test"), expected);
  in.trailing_bits("test");
  EXPECT_TRUE(in.ok());
}

TEST(Spec_3_3_BitReader, SignedCodesComeBackAndAlternate) {
  BitWriter out;
  const std::vector<std::int64_t> values = {0, 1, -1, 2, -2, (1 << 30) - 1, 1 - (1 << 30)};
  for (const std::int64_t value : values) out.se(value);
  const auto bytes = out.take();
  EXPECT_EQ(bytes[0], 0b10100110);  // 1, 010, 011, 0...: the codes of 0, 1, 2
  BitReader in(bytes);
  for (const std::int64_t value : values) EXPECT_EQ(in.se("test"), value);
  EXPECT_TRUE(in.ok());
}

TEST(Spec_3_3_BitReader, ARunOfZerosFailsAndDoesNotSpin) {
  const std::vector<std::uint8_t> zeros(100, 0);
  BitReader in(zeros);
  in.ue("test");
  EXPECT_EQ(in.error().code, Errc::kOutOfRange);
  EXPECT_LE(in.bit_position(), 33u);
}

TEST(Spec_3_3_BitReader, TheFirstErrorSticks) {
  const std::vector<std::uint8_t> one = {0xFF};
  BitReader in(one);
  in.u(9, "first");
  in.u(1, "second");
  EXPECT_STREQ(in.error().element, "first");
}

TEST(Spec_3_3_BitReader, WhatFollowsAHeaderIsRefused) {
  const std::vector<std::uint8_t> zeros = {0, 0};
  BitReader longer(zeros);
  longer.u(4, "a");
  longer.trailing_bits("tail");
  EXPECT_EQ(longer.error().code, Errc::kOutOfRange);
  const std::vector<std::uint8_t> set = {0x01};
  BitReader nonzero(set);
  nonzero.u(4, "a");
  nonzero.trailing_bits("tail");
  EXPECT_EQ(nonzero.error().code, Errc::kReserved);
}

}  // namespace
}  // namespace slf::bit_reader_test
