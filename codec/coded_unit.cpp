#include "codec/coded_unit.h"

#include <algorithm>

namespace slf {

CodedUnit part_unit(UnitType type, SliceUnitHeader header, std::span<const std::uint8_t> body,
                    const SequenceParameterSet& set) {
  BitWriter out;
  WriteSyntax write{out};
  slice_unit_header(write, header, type, set);
  out.append(body);
  return {type, out.take(), std::move(header)};
}

CodedUnit coefficient_unit(SliceUnitHeader header, std::vector<std::uint8_t> codeword,
                           const SliceCoding& coding) {
  if (header.range == 0 && !coding.matrices.empty()) {
    const auto& matrix = coding.matrices[header.group];
    header.cu_matrix_bytes = static_cast<std::uint32_t>(matrix.size());
    codeword.insert(codeword.begin(), matrix.begin(), matrix.end());
  }
  return part_unit(UnitType::kCoefficients, std::move(header), codeword, coding.set);
}

std::vector<std::int32_t> values_of_layer(const SliceCoding& coding, std::uint32_t layer,
                                          std::span<const std::int32_t> values) {
  std::vector<std::int32_t> divisor(coding.planes(), 1);
  for (std::size_t g = 0; g < coding.groups.size(); ++g)
    for (const std::size_t j : planes_of(coding.groups[g]))
      divisor[j] = 1 << (std::max(coding.set.layers_of(g), layer + 1) - 1 - layer);
  std::vector<std::int32_t> coarser(values.begin(), values.end());
  for (std::size_t i = 0; i < coarser.size(); ++i) coarser[i] /= divisor[i % divisor.size()];
  return coarser;
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
