// SPDX-License-Identifier: Apache-2.0
#include "codec/encoder/coded_unit.h"

#include <algorithm>

#include "bitstream/checked_syntax.h"

namespace slf {

Result<CodedUnit, InputError> part_unit(UnitType type, SliceUnitHeader header,
                                        std::span<const std::uint8_t> body,
                                        const SequenceParameterSet& set) {
  SLF_TRY(auto payload,
          checked_header([&](auto& v) { slice_unit_header(v, std::as_const(header), type, set); }));
  payload.insert(payload.end(), body.begin(), body.end());
  return CodedUnit{type, std::move(payload), std::move(header)};
}

Result<CodedUnit, InputError> coefficient_unit(SliceUnitHeader header,
                                               std::vector<std::uint8_t> codeword,
                                               const SliceCoding& coding) {
  if (header.range == 0 && !coding.matrices.empty()) {
    const auto& matrix = coding.matrices[header.group];
    header.cu_matrix_bytes = static_cast<std::uint32_t>(matrix.size());
    codeword.insert(codeword.begin(), matrix.begin(), matrix.end());
  }
  return part_unit(UnitType::kCoefficients, std::move(header), codeword, coding.set);
}

}  // namespace slf
