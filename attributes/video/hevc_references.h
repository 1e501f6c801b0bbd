// SPDX-License-Identifier: Apache-2.0
// Which pictures an HEVC stream refers to: a decoder is not given a reference to one that is not
// there.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bitstream/bit_reader.h"
#include "slf/error.h"

namespace slf {

/// A picture that a short-term set names, by the distance of its count from the current one.
struct ShortTermPicture {
  std::int64_t delta = 0;  // not 0
  bool used = false;       // by the current picture; otherwise kept for a later one
  bool operator==(const ShortTermPicture&) const = default;
};

/// H.265 7.4.8: pictures before the current one first, each side from the nearest on.
using ShortTermSet = std::vector<ShortTermPicture>;

/// Parts of a sequence parameter set that references hang on.
struct HevcSequence {
  int count_bits = 4;    // of slice_pic_order_cnt_lsb
  int address_bits = 0;  // of slice_segment_address
  std::vector<ShortTermSet> short_term;
  bool long_term_present = false;
  std::vector<ShortTermPicture> long_term;  // delta: the low bits of the count
};

/// H.265 7.3.2.2 from num_short_term_ref_pic_sets to the long-term pictures.
void read_reference_sets(BitReader& in, HevcSequence& sequence);

/// Follows the NAL units of a stream in their order, and the pictures that a decoder keeps.
class HevcReferences {
 public:
  void take_sequence(std::uint64_t id, HevcSequence sequence);

  /// H.265 7.3.2.3, the beginning. `raw`: a unit's bytes behind its header, without emulation
  /// prevention.
  Result<Done> take_picture_parameters(std::span<const std::uint8_t> raw);

  /// H.265 7.3.6.1 as far as the reference pictures; 8.3.1, 8.3.2.
  /// @param type         nal_unit_type of a slice segment
  /// @param temporal_id  of its unit
  /// @errors kOutOfRange: a parameter set or a picture that is referred to is not there, a slice
  ///         that predicts and has no reference, two counts in one picture. kTruncated.
  Result<Done> take_slice(int type, int temporal_id, std::span<const std::uint8_t> raw);

 private:
  struct PictureParameters {
    std::uint64_t sequence = 0;
    bool dependent_segments = false, output_flag = false;
    int extra_bits = 0;
  };
  struct Kept {
    std::int64_t count = 0;
    bool long_term = false;
  };
  struct LongTermPicture {
    std::int64_t count = 0;
    bool used = false, whole = false;  // whole: not only the low bits of the count
    bool operator==(const LongTermPicture&) const = default;
  };
  /// What all slice segments of a picture say alike.
  struct References {
    std::int64_t count = 0;
    ShortTermSet short_term;
    std::vector<LongTermPicture> long_term;
    bool operator==(const References&) const = default;
  };

  References read_references(BitReader& in, int type, const HevcSequence& sequence) const;
  void read_long_term(BitReader& in, const HevcSequence& sequence, References& references) const;
  std::int64_t count_of(std::int64_t low_bits, int count_bits) const;
  Result<Done> begin_picture(const References& references, int type, int temporal_id,
                             int count_bits);
  void begin_access_unit(int type);
  Kept* find(const LongTermPicture& wanted, int count_bits);

  std::array<std::optional<HevcSequence>, 16> sequences_{};
  std::array<std::optional<PictureParameters>, 64> parameters_{};
  std::vector<Kept> kept_;  // pictures that later ones may refer to
  References current_;
  std::int64_t count_before_ = 0;  // of prevTid0Pic
  bool begun_ = false;             // a picture was there
  bool forgets_ = false;           // the current picture is the first that can be decoded
  bool without_leading_ = false;   // the last picture of random access was such a one
  bool skipped_ = false;           // a leading picture that is not decoded
};

}  // namespace slf
