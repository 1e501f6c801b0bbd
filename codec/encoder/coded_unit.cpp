// SPDX-License-Identifier: Apache-2.0
#include "codec/encoder/coded_unit.h"

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

}  // namespace slf
