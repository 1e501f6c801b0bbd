#include "codec/coded_unit.h"

namespace slf {

CodedUnit part_unit(UnitType type, SliceUnitHeader header, std::span<const std::uint8_t> body,
                    const SequenceParameterSet& set) {
  BitWriter out;
  WriteSyntax write{out};
  slice_unit_header(write, header, type, set);
  out.append(body);
  return {type, out.take(), std::move(header)};
}

std::vector<std::uint32_t> modes_of_range(const SequenceParameterSet& set, std::uint32_t range,
                                          const std::vector<std::uint8_t>& modes, int start) {
  std::vector<std::uint32_t> coded;
  if (set.sps_prediction_flag == 0) return coded;
  for (std::size_t level = set.coefficient_begin(range); level < set.coefficient_end(range);
       ++level) {
    const std::size_t i = level - static_cast<std::size_t>(start);
    coded.push_back(i < modes.size() ? modes[i] : 0u);
  }
  return coded;
}

}  // namespace slf
