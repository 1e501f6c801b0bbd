// SPDX-License-Identifier: Apache-2.0
#include "bitstream/slice_headers.h"

namespace slf {

Result<SliceTable> parse_slice_table(std::span<const std::uint8_t> payload,
                                     const SequenceParameterSet& set) {
  BitReader in(payload);
  ParseSyntax parse{in};
  SliceTable table;
  slice_table(parse, table, set.sps_base_levels);
  in.trailing_bits("slices_trailing_bits");
  if (!in.ok()) return in.error();
  if (set.sps_base_levels > 0 && table.num_cells() > kMaxCells)
    return Error{Errc::kOutOfRange, "slice_num_cells_minus1"};
  return table;
}

std::vector<std::uint8_t> write_slice_table(const SliceTable& table,
                                            const SequenceParameterSet& set) {
  BitWriter out;
  WriteSyntax write{out};
  slice_table(write, table, set.sps_base_levels);
  return out.take();
}

}  // namespace slf
