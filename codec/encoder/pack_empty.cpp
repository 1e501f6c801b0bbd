// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <utility>

#include "bitstream/metadata.h"
#include "codec/encoder/assemble.h"
#include "codec/encoder/pack_frame.h"
#include "codec/encoder/pack_parameters.h"

namespace slf {

Result<std::vector<std::uint8_t>, InputError> pack_empty(const LightField& field,
                                                         const CodingParameters& parameters,
                                                         FrameHeader& frame) {
  SLF_TRY(SequenceParameterSet set, sequence_of_frame(field, parameters));  // 7.2
  set.features = kEmptyFrame;
  set.sps_level = 1;  // 9: no points are within every level
  std::vector<CodedUnit> units;
  if (!parameters.metadata.empty())
    units.push_back({UnitType::kMetadata, write_metadata(parameters.metadata), {}});  // 7.8
  SLF_TRY(CodedUnit unit, frame_unit_before(units, frame));                           // 7.13
  units.insert(units.begin(), std::move(unit));
  return assemble(std::move(set), units, std::nullopt);  // 7.1
}

}  // namespace slf
