// SPDX-License-Identifier: Apache-2.0
#include "bitstream/slice_headers.h"

#include "bitstream/checked_syntax.h"
#include "bitstream/unchecked_headers.h"

namespace slf {
namespace {

bool cells_fit(const SliceTable& table, std::uint32_t base_levels) {
  return base_levels == 0 || table.num_cells() <= kMaxCells;
}

}  // namespace

Result<SliceTable> parse_slice_table(std::span<const std::uint8_t> payload,
                                     const SequenceParameterSet& set) {
  BitReader in(payload);
  ParseSyntax parse{in};
  SliceTable table;
  slice_table(parse, table, set.sps_base_levels);
  in.trailing_bits("slices_trailing_bits");
  if (!in.ok()) return in.error();
  if (!cells_fit(table, set.sps_base_levels))
    return Error{Errc::kOutOfRange, "slice_num_cells_minus1"};
  return table;
}

Result<std::vector<std::uint8_t>, InputError> write_slice_table(const SliceTable& table,
                                                                const SequenceParameterSet& set) {
  return checked_header([&](auto& v) {
    slice_table(v, table, set.sps_base_levels);
    v.require(cells_fit(table, set.sps_base_levels), Errc::kOutOfRange, "slice_num_cells_minus1");
  });
}

std::vector<std::uint8_t> slice_table_as_is(const SliceTable& table,
                                            const SequenceParameterSet& set) {
  return header_as_is([&](auto& v) { slice_table(v, table, set.sps_base_levels); });
}

}  // namespace slf
