// SPDX-License-Identifier: Apache-2.0
#include "attributes/video/hevc_references.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdlib>
#include <utility>

namespace slf {
namespace {

// nal_unit_type, H.265 table 7-1.
constexpr int kLastLeading = 9, kFirstSkippedLeading = 8, kFirstLeading = 6;
constexpr int kLastSubLayerType = 14;  // even types up to here: no reference within a sub-layer
constexpr int kFirstIrap = 16, kLastIrap = 23, kFirstIdr = 19, kLastIdr = 20, kLastBla = 18;

constexpr std::uint64_t kMostSets = 64, kMostPictures = 16, kMostLongTerm = 33;
constexpr std::uint64_t kMostDelta = 1 << 15;
constexpr std::uint64_t kIntraSlice = 2;

bool is_idr(int type) { return type == kFirstIdr || type == kLastIdr; }
bool is_irap(int type) { return type >= kFirstIrap && type <= kLastIrap; }

std::uint64_t at_most(BitReader& in, std::uint64_t value, std::uint64_t most, const char* element) {
  if (value > most) in.fail(Errc::kOutOfRange, element);
  return value > most ? 0 : value;
}

int bits_for(std::uint64_t count) {  // Ceil(Log2(count))
  return count > 1 ? static_cast<int>(std::bit_width(count - 1)) : 0;
}

/// H.265 (7-61), (7-62): the pictures of an earlier set and its own picture, all moved.
ShortTermSet predicted_set(BitReader& in, bool in_slice, std::span<const ShortTermSet> earlier) {
  const std::uint64_t back = in_slice ? in.ue("delta_idx_minus1") + 1 : 1;
  const bool minus = in.u(1, "delta_rps_sign") != 0;
  const auto distance = static_cast<std::int64_t>(
      at_most(in, in.ue("abs_delta_rps_minus1"), kMostDelta - 1, "abs_delta_rps_minus1") + 1);
  ShortTermSet set;
  if (back > earlier.size()) in.fail(Errc::kOutOfRange, "delta_idx_minus1");
  if (!in.ok()) return set;
  const std::int64_t further = minus ? -distance : distance;
  ShortTermSet from = earlier[earlier.size() - static_cast<std::size_t>(back)];
  from.push_back({0, false});
  for (const ShortTermPicture& picture : from) {
    const bool used = in.u(1, "used_by_curr_pic_flag") != 0;
    const bool kept = used || in.u(1, "use_delta_flag") != 0;
    const std::int64_t delta = picture.delta + further;
    if (kept && delta != 0) set.push_back({delta, used});
  }
  std::sort(set.begin(), set.end(), [](const auto& a, const auto& b) {
    return std::pair(a.delta > 0, std::abs(a.delta)) < std::pair(b.delta > 0, std::abs(b.delta));
  });
  return set;
}

/// H.265 7.3.7. `earlier`: the sets that it may be predicted from.
ShortTermSet short_term_set(BitReader& in, bool in_slice, std::span<const ShortTermSet> earlier) {
  if (!earlier.empty() && in.u(1, "inter_ref_pic_set_prediction_flag") != 0) {
    ShortTermSet set = predicted_set(in, in_slice, earlier);
    if (set.size() > kMostPictures) in.fail(Errc::kOutOfRange, "use_delta_flag");
    return set;
  }
  const std::uint64_t before =
      at_most(in, in.ue("num_negative_pics"), kMostPictures, "num_negative_pics");
  const std::uint64_t after =
      at_most(in, in.ue("num_positive_pics"), kMostPictures - before, "num_positive_pics");
  ShortTermSet set;
  for (const auto& [count, sign] : {std::pair(before, -1), std::pair(after, 1)}) {
    std::int64_t delta = 0;
    for (std::uint64_t i = 0; i < count && in.ok(); ++i) {
      delta += sign *
               static_cast<std::int64_t>(
                   at_most(in, in.ue("delta_poc_minus1"), kMostDelta - 1, "delta_poc_minus1") + 1);
      set.push_back({delta, in.u(1, "used_by_curr_pic_flag") != 0});
    }
  }
  return set;
}

}  // namespace

void read_reference_sets(BitReader& in, HevcSequence& sequence) {
  constexpr const char* kCount = "num_short_term_ref_pic_sets";
  const std::uint64_t sets = at_most(in, in.ue(kCount), kMostSets, kCount);
  for (std::uint64_t i = 0; i < sets && in.ok(); ++i)
    sequence.short_term.push_back(short_term_set(in, false, sequence.short_term));
  sequence.long_term_present = in.u(1, "long_term_ref_pics_present_flag") != 0;
  if (!sequence.long_term_present) return;
  constexpr const char* kLong = "num_long_term_ref_pics_sps";
  const std::uint64_t pictures = at_most(in, in.ue(kLong), kMostLongTerm - 1, kLong);
  for (std::uint64_t i = 0; i < pictures && in.ok(); ++i) {
    const auto count =
        static_cast<std::int64_t>(in.u(sequence.count_bits, "lt_ref_pic_poc_lsb_sps"));
    sequence.long_term.push_back({count, in.u(1, "used_by_curr_pic_lt_sps_flag") != 0});
  }
}

void HevcReferences::take_sequence(std::uint64_t id, HevcSequence sequence) {
  if (id < sequences_.size()) sequences_[static_cast<std::size_t>(id)] = std::move(sequence);
}

Result<Done> HevcReferences::take_picture_parameters(std::span<const std::uint8_t> raw) {
  BitReader in(raw);
  PictureParameters read;
  const std::uint64_t id = at_most(in, in.ue("pps_pic_parameter_set_id"), parameters_.size() - 1,
                                   "pps_pic_parameter_set_id");
  read.sequence = at_most(in, in.ue("pps_seq_parameter_set_id"), sequences_.size() - 1,
                          "pps_seq_parameter_set_id");
  read.dependent_segments = in.u(1, "dependent_slice_segments_enabled_flag") != 0;
  read.output_flag = in.u(1, "output_flag_present_flag") != 0;
  read.extra_bits = static_cast<int>(in.u(3, "num_extra_slice_header_bits"));
  if (!in.ok()) return Error{in.error().code, in.error().element};
  parameters_[static_cast<std::size_t>(id)] = read;
  return Done{};
}

/// H.265 8.3.1: of the counts with these low bits the nearest to the one before.
std::int64_t HevcReferences::count_of(std::int64_t low_bits, int count_bits) const {
  if (forgets_) return low_bits;
  const std::int64_t period = std::int64_t{1} << count_bits;
  const std::int64_t low_before = count_before_ & (period - 1);
  std::int64_t high = count_before_ - low_before;
  if (low_bits < low_before && low_before - low_bits >= period / 2) high += period;
  if (low_bits > low_before && low_bits - low_before > period / 2) high -= period;
  return high + low_bits;
}

/// H.265 7.3.6.1, (7-52).
void HevcReferences::read_long_term(BitReader& in, const HevcSequence& sequence,
                                    References& references) const {
  const std::uint64_t known = sequence.long_term.size();
  const std::uint64_t of_sequence =
      known > 0 ? at_most(in, in.ue("num_long_term_sps"), known, "num_long_term_sps") : 0;
  const std::uint64_t own =
      at_most(in, in.ue("num_long_term_pics"), kMostLongTerm - of_sequence, "num_long_term_pics");
  std::int64_t cycles = 0;
  for (std::uint64_t i = 0; i < of_sequence + own && in.ok(); ++i) {
    ShortTermPicture picture;
    if (i < of_sequence) {
      const std::uint64_t idx =
          at_most(in, in.u(bits_for(known), "lt_idx_sps"), known - 1, "lt_idx_sps");
      picture = sequence.long_term[static_cast<std::size_t>(idx)];
    } else {
      picture.delta = static_cast<std::int64_t>(in.u(sequence.count_bits, "poc_lsb_lt"));
      picture.used = in.u(1, "used_by_curr_pic_lt_flag") != 0;
    }
    const bool whole = in.u(1, "delta_poc_msb_present_flag") != 0;
    if (i == of_sequence) cycles = 0;  // counted anew for those of the slice
    if (whole) cycles += static_cast<std::int64_t>(in.ue("delta_poc_msb_cycle_lt"));
    const std::int64_t period = std::int64_t{1} << sequence.count_bits;
    const std::int64_t high =
        references.count - (references.count & (period - 1)) - cycles * period;
    references.long_term.push_back({picture.delta + (whole ? high : 0), picture.used, whole});
  }
}

HevcReferences::References HevcReferences::read_references(BitReader& in, int type,
                                                           const HevcSequence& sequence) const {
  References read;
  if (is_idr(type)) return read;
  read.count =
      count_of(static_cast<std::int64_t>(in.u(sequence.count_bits, "slice_pic_order_cnt_lsb")),
               sequence.count_bits);
  const std::size_t sets = sequence.short_term.size();
  if (in.u(1, "short_term_ref_pic_set_sps_flag") == 0) {
    read.short_term = short_term_set(in, true, sequence.short_term);
  } else if (sets == 0) {
    in.fail(Errc::kOutOfRange, "short_term_ref_pic_set_sps_flag");
  } else {
    const std::uint64_t idx = at_most(in, in.u(bits_for(sets), "short_term_ref_pic_set_idx"),
                                      sets - 1, "short_term_ref_pic_set_idx");
    read.short_term = sequence.short_term[static_cast<std::size_t>(idx)];
  }
  if (sequence.long_term_present && in.ok()) read_long_term(in, sequence, read);
  return read;
}

HevcReferences::Kept* HevcReferences::find(const LongTermPicture& wanted, int count_bits) {
  const std::int64_t mask = (std::int64_t{1} << count_bits) - 1;
  for (Kept& kept : kept_)
    if (wanted.whole ? kept.count == wanted.count : (kept.count & mask) == wanted.count)
      return &kept;
  return nullptr;
}

/// H.265 8.3.2: what the picture's set does not name is forgotten; what it uses has to be there.
Result<Done> HevcReferences::begin_picture(const References& references, int type, int temporal_id,
                                           int count_bits) {
  if (forgets_) kept_.clear();
  std::vector<Kept> still;
  for (const LongTermPicture& wanted : references.long_term) {
    Kept* kept = find(wanted, count_bits);
    if (kept == nullptr && wanted.used) return Error{Errc::kOutOfRange, "poc_lsb_lt"};
    if (kept == nullptr) continue;
    kept->long_term = true;
    still.push_back(*kept);
  }
  for (const ShortTermPicture& wanted : references.short_term) {
    const auto kept = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& picture) {
      return !picture.long_term && picture.count == references.count + wanted.delta;
    });
    if (kept == kept_.end() && wanted.used)
      return Error{Errc::kOutOfRange, "short_term_ref_pic_set"};
    if (kept != kept_.end()) still.push_back(*kept);
  }
  kept_ = std::move(still);
  const auto is_current = [&](const Kept& kept) { return kept.count == references.count; };
  if (std::any_of(kept_.begin(), kept_.end(), is_current))
    return Error{Errc::kOutOfRange, "slice_pic_order_cnt_lsb"};
  kept_.push_back({references.count, false});
  const bool leading = type >= kFirstLeading && type <= kLastLeading;
  const bool for_reference = type > kLastSubLayerType || type % 2 != 0;
  if (temporal_id == 0 && !leading && for_reference) count_before_ = references.count;
  return Done{};
}

Result<Done> HevcReferences::take_slice(int type, int temporal_id,
                                        std::span<const std::uint8_t> raw) {
  BitReader in(raw);
  const bool first = in.u(1, "first_slice_segment_in_pic_flag") != 0;
  if (is_irap(type)) in.u(1, "no_output_of_prior_pics_flag");
  constexpr const char* kId = "slice_pic_parameter_set_id";
  const auto id = static_cast<std::size_t>(at_most(in, in.ue(kId), parameters_.size() - 1, kId));
  const auto& parameters = parameters_[id];
  const HevcSequence* sequence = nullptr;
  if (parameters && sequences_[static_cast<std::size_t>(parameters->sequence)])
    sequence = &*sequences_[static_cast<std::size_t>(parameters->sequence)];
  if (sequence == nullptr || (!first && !begun_)) in.fail(Errc::kOutOfRange, kId);
  if (!in.ok()) return Error{in.error().code, in.error().element};
  if (!first) {
    const bool dependent =
        parameters->dependent_segments && in.u(1, "dependent_slice_segment_flag") != 0;
    in.u(sequence->address_bits, "slice_segment_address");
    if (dependent && in.ok()) return Done{};  // with the references of the segment before
  } else {
    begin_access_unit(type);
  }
  if (skipped_) return Done{};
  in.u(parameters->extra_bits, "slice_reserved_flag");
  const std::uint64_t slice_type = at_most(in, in.ue("slice_type"), kIntraSlice, "slice_type");
  if (parameters->output_flag) in.u(1, "pic_output_flag");
  const References read = read_references(in, type, *sequence);
  const auto used = [](const auto& picture) { return picture.used; };
  if (slice_type != kIntraSlice &&
      std::none_of(read.short_term.begin(), read.short_term.end(), used) &&
      std::none_of(read.long_term.begin(), read.long_term.end(), used))
    in.fail(Errc::kOutOfRange, "slice_type");
  if (!first && read != current_) in.fail(Errc::kOutOfRange, "slice_pic_order_cnt_lsb");
  if (!in.ok()) return Error{in.error().code, in.error().element};
  if (!first) return Done{};
  current_ = read;
  return begin_picture(read, type, temporal_id, sequence->count_bits);
}

/// Pictures before an IDR, a BLA and the stream's first are out of reach, and leading pictures
/// that may refer to them are not decoded: NoRaslOutputFlag of H.265 8.1.3.
void HevcReferences::begin_access_unit(int type) {
  forgets_ = is_irap(type) && (type <= kLastBla || is_idr(type) || !begun_);
  if (is_irap(type)) without_leading_ = forgets_;
  skipped_ = (type == kFirstSkippedLeading || type == kLastLeading) && without_leading_;
  begun_ = true;
}

}  // namespace slf
