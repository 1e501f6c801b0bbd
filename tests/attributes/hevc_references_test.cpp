// SPDX-License-Identifier: Apache-2.0
// References of an HEVC stream, written by hand: what is there is taken, what is not is refused.
// H.265 8.3.
#include "attributes/video/hevc_references.h"

#include <gtest/gtest.h>

#include <string>

#include "bitstream/bit_writer.h"

namespace slf::hevc_references_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr int kTrailing = 1, kSkippedLeading = 9, kIdr = 20, kCra = 21;
constexpr int kP = 1, kI = 2;
constexpr unsigned kNone = 2;

/// The sets of a sequence, of 4 bits of count: the picture before; predicted from it that and the
/// one before it (inter_ref_pic_set_prediction_flag of H.265 7.3.7); none.
HevcSequence sequence(bool long_term) {
  BitWriter out;
  out.ue(3);
  for (const unsigned value : {1u, 0u}) out.ue(value);  // one before, none after
  out.ue(0);                                            // -1
  out.u(1, 1);
  out.u(1, 1);  // predicted
  out.u(1, 1);  // by -1
  out.ue(0);
  out.u(2, 3);  // both used: -1 - 1, and -1
  out.u(1, 0);
  for (const unsigned value : {0u, 0u}) out.ue(value);
  out.u(1, long_term);
  if (long_term) out.ue(0);
  out.align();
  const Bytes bytes = out.take();
  BitReader in(bytes);
  HevcSequence read;
  read_reference_sets(in, read);
  EXPECT_TRUE(in.ok());
  return read;
}

/// What a slice says: a set of its sequence, and a long-term picture by its low bits or by all.
struct Slice {
  int type = kTrailing, slice_type = kP;
  unsigned low_bits = 0, set = 0;
  int long_term_low_bits = -1, cycles = -1;
  bool first = true;
};

class Stream {
 public:
  explicit Stream(bool long_term = false) : long_term_(long_term) {
    references_.take_sequence(0, sequence(long_term));
    BitWriter out;
    out.ue(0);
    out.ue(0);
    out.u(5, 0);
    out.align();
    EXPECT_TRUE(references_.take_picture_parameters(out.take()));
  }

  /// @return element of the refusal; nothing where the slice is taken
  std::string take(const Slice& slice) {
    BitWriter out;
    out.u(1, slice.first);
    if (slice.type >= 16) out.u(1, 0);
    out.ue(0);
    out.ue(static_cast<unsigned>(slice.slice_type));
    if (slice.type != kIdr) {
      out.u(4, slice.low_bits);
      out.u(1, 1);
      out.u(2, slice.set);
      if (long_term_) write_long_term(out, slice);
    }
    out.u(1, 1);
    out.align();
    const auto taken = references_.take_slice(slice.type, 0, out.take());
    return taken ? "" : taken.error().element;
  }

 private:
  static void write_long_term(BitWriter& out, const Slice& slice) {
    out.ue(slice.long_term_low_bits < 0 ? 0 : 1);
    if (slice.long_term_low_bits < 0) return;
    out.u(4, static_cast<unsigned>(slice.long_term_low_bits));
    out.u(1, 1);
    out.u(1, slice.cycles >= 0);
    if (slice.cycles >= 0) out.ue(static_cast<unsigned>(slice.cycles));
  }

  bool long_term_;
  HevcReferences references_;
};

constexpr Slice kFirst{.type = kIdr, .slice_type = kI};

TEST(HevcReferences, PicturesThatAreThereAreTakenAcrossThePeriodOfTheirCount) {
  Stream stream;
  EXPECT_EQ(stream.take(kFirst), "");
  EXPECT_EQ(stream.take({.low_bits = 1}), "");
  for (unsigned count = 2; count < 40; ++count)
    EXPECT_EQ(stream.take({.low_bits = count % 16, .set = 1}), "") << count;
}

TEST(HevcReferences, APictureThatWasNeverThereIsRefused) {
  Stream stream;
  EXPECT_EQ(stream.take(kFirst), "");
  EXPECT_EQ(stream.take({.low_bits = 2}), "short_term_ref_pic_set");
}

TEST(HevcReferences, APictureThatASetDidNotKeepIsRefused) {
  Stream stream;
  EXPECT_EQ(stream.take(kFirst), "");
  EXPECT_EQ(stream.take({.low_bits = 1}), "");
  EXPECT_EQ(stream.take({.low_bits = 2}), "");  // keeps 1, not 0
  EXPECT_EQ(stream.take({.low_bits = 3, .set = 1}), "");
  EXPECT_EQ(stream.take({.low_bits = 4}), "");
  EXPECT_EQ(stream.take({.low_bits = 6, .set = 1}), "short_term_ref_pic_set");
}

TEST(HevcReferences, PicturesBeforeAnIdrAreOutOfReach) {
  Stream stream;
  EXPECT_EQ(stream.take(kFirst), "");
  EXPECT_EQ(stream.take({.low_bits = 1}), "");
  EXPECT_EQ(stream.take(kFirst), "");
  EXPECT_EQ(stream.take({.low_bits = 2}), "short_term_ref_pic_set");
}

TEST(HevcReferences, ASliceThatPredictsHasAReference) {
  Stream stream;
  EXPECT_EQ(stream.take({.type = kIdr, .slice_type = kP}), "slice_type");
}

TEST(HevcReferences, SlicesOfAPictureSayTheSame) {
  Stream stream;
  EXPECT_EQ(stream.take(kFirst), "");
  EXPECT_EQ(stream.take({.low_bits = 1}), "");
  EXPECT_EQ(stream.take({.low_bits = 1, .first = false}), "");
  EXPECT_EQ(stream.take({.low_bits = 2, .first = false}), "slice_pic_order_cnt_lsb");
  EXPECT_EQ(stream.take({.low_bits = 1, .set = 1, .first = false}), "slice_pic_order_cnt_lsb");
}

TEST(HevcReferences, ALongTermPictureIsFoundByItsLowBitsOrByAll) {
  Stream stream(true);
  EXPECT_EQ(stream.take(kFirst), "");
  EXPECT_EQ(stream.take({.low_bits = 1}), "");
  EXPECT_EQ(stream.take({.low_bits = 2, .set = kNone, .long_term_low_bits = 1}), "");
  for (unsigned count = 3; count < 18; ++count)
    EXPECT_EQ(stream.take({.low_bits = count % 16, .long_term_low_bits = 1}), "") << count;
  EXPECT_EQ(stream.take({.low_bits = 2, .set = kNone, .long_term_low_bits = 1, .cycles = 1}), "");
  EXPECT_EQ(stream.take({.low_bits = 3, .set = kNone, .long_term_low_bits = 2, .cycles = 1}),
            "poc_lsb_lt");
}

TEST(HevcReferences, ALongTermPictureIsNoShortTermOne) {
  Stream stream(true);
  EXPECT_EQ(stream.take(kFirst), "");
  EXPECT_EQ(stream.take({.low_bits = 1, .set = kNone, .long_term_low_bits = 0}), "");
  EXPECT_EQ(stream.take({.low_bits = 2, .set = 1}), "short_term_ref_pic_set");
}

TEST(HevcReferences, LeadingPicturesOfTheFirstPictureAreNotDecodedAndNotChecked) {
  Stream stream;
  EXPECT_EQ(stream.take({.type = kCra, .slice_type = kI, .low_bits = 4, .set = kNone}), "");
  EXPECT_EQ(stream.take({.type = kSkippedLeading, .low_bits = 2}), "");
  EXPECT_EQ(stream.take({.low_bits = 5}), "");
  EXPECT_EQ(stream.take({.low_bits = 3}), "short_term_ref_pic_set");
}

}  // namespace
}  // namespace slf::hevc_references_test
