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
  if (used + 1 != 1u << set.num_groups()) return Error{Errc::kOutOfRange, "sps_num_groups_minus1"};
  if (set.sps_cut_groups > set.num_groups()) return Error{Errc::kOutOfRange, "sps_cut_groups"};
  return set;
}

std::vector<std::uint8_t> write_sequence_parameter_set(const SequenceParameterSet& set) {
  BitWriter out;
  WriteSyntax write{out};
  sequence_parameter_set(write, set);
  return out.take();
}

}  // namespace slf
