#include "bitstream/parameter_sets.h"

namespace slf {

Result<SequenceParameterSet> parse_sequence_parameter_set(std::span<const std::uint8_t> payload) {
  BitReader in(payload);
  ParseSyntax parse{in};
  SequenceParameterSet set;
  sequence_parameter_set(parse, set);
  in.trailing_bits("sps_trailing_bits");
  if (!in.ok()) return in.error();
  std::uint32_t used = 0;  // groups, by bit: each has a function
  for (const PlaneRun& run : set.runs) used |= 1u << run.sps_plane_group;
  if (used + 1 != 1u << set.num_groups())
    return Error{Errc::kOutOfRange, "sps_num_groups_minus1", 0};
  return set;
}

std::vector<std::uint8_t> write_sequence_parameter_set(const SequenceParameterSet& set) {
  BitWriter out;
  WriteSyntax write{out};
  sequence_parameter_set(write, set);
  return out.take();
}

Result<SliceHeader> parse_slice_header(std::span<const std::uint8_t> payload,
                                       std::uint32_t grid_bits) {
  BitReader in(payload);
  ParseSyntax parse{in};
  SliceHeader header;
  slice_header(parse, header, grid_bits);
  in.trailing_bits("slice_trailing_bits");
  if (!in.ok()) return in.error();
  return header;
}

std::vector<std::uint8_t> write_slice_header(const SliceHeader& header, std::uint32_t grid_bits) {
  BitWriter out;
  WriteSyntax write{out};
  slice_header(write, header, grid_bits);
  return out.take();
}

}  // namespace slf
