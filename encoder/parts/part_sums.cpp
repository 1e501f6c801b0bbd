// SPDX-License-Identifier: Apache-2.0
#include "encoder/parts/part_sums.h"

#include "bitstream/bit_reader.h"
#include "bitstream/bit_writer.h"

namespace slf {
namespace {

constexpr std::size_t kDigestBytes = 32;
constexpr std::int64_t kMostSum = std::int64_t{1} << 30;

Error out_of_range(const char* element) { return {Errc::kOutOfRange, element}; }

}  // namespace

std::vector<std::uint8_t> write_part_sums(const PartSums& part) {
  BitWriter out;
  for (const std::uint8_t byte : part.plan) out.u(8, byte);
  out.f64(part.rdo);
  out.ue(part.slices.size());
  for (const SliceSums& slice : part.slices) {
    out.ue(slice.slice);
    out.u(1, !slice.digest.empty());
    for (const std::uint8_t byte : slice.digest) out.u(8, byte);
    for (const std::int32_t sum : slice.sums) out.se(sum);
  }
  return out.take();
}

Result<PartSums> parse_part_sums(std::span<const std::uint8_t> payload, const SliceTable& table,
                                 std::size_t planes) {
  BitReader in(payload);
  PartSums part;
  for (std::uint8_t& byte : part.plan) byte = static_cast<std::uint8_t>(in.u(8, "part_plan"));
  part.rdo = in.f64("part_rdo");
  if (!(part.rdo >= 0 && part.rdo <= 1)) return out_of_range("part_rdo");
  const std::uint64_t count = in.ue("part_num_slices");
  if (count > table.slices.size()) return out_of_range("part_num_slices");
  for (std::uint64_t i = 0; i < count; ++i) {
    SliceSums slice;
    slice.slice = static_cast<std::size_t>(in.ue("part_slice_id"));
    if (slice.slice >= table.slices.size() || (i > 0 && slice.slice <= part.slices.back().slice))
      return out_of_range("part_slice_id");
    if (in.u(1, "part_digest_flag") != 0)
      for (std::size_t b = 0; b < kDigestBytes; ++b)
        slice.digest.push_back(static_cast<std::uint8_t>(in.u(8, "part_digest")));
    const std::uint64_t sums = table.slices[slice.slice].cells() * planes;
    if (sums > in.bits_left()) return Error{Errc::kTruncated, "part_sum"};  // one bit at least each
    slice.sums.resize(static_cast<std::size_t>(sums));
    for (std::int32_t& sum : slice.sums) {
      const std::int64_t value = in.se("part_sum");
      if (value < -kMostSum || value > kMostSum) return out_of_range("part_sum");
      sum = static_cast<std::int32_t>(value);
    }
    part.slices.push_back(std::move(slice));
  }
  in.trailing_bits("part_trailing_bits");
  if (!in.ok()) return in.error();
  return part;
}

}  // namespace slf
