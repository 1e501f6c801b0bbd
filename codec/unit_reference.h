// SPDX-License-Identifier: Apache-2.0
// What the reference has in the places of coefficients, for the units of a predicted frame. Spec
// 8.12.6.
#pragma once

#include <optional>
#include <span>

#include "attributes/coefficient_models.h"
#include "attributes/reference_coefficients.h"
#include "bitstream/slice_headers.h"
#include "codec/frame_state.h"

namespace slf {

class UnitReference {
 public:
  /// @param reference  nullptr: the frame is not predicted
  /// @param set        kept by reference
  UnitReference(const FrameReference* reference, const SequenceParameterSet& set,
                const ReferenceRows& rows, std::span<const std::uint32_t> steps)
      : set_(set) {
    if (reference == nullptr || !set.has_reference_contexts()) return;
    found_ = find_reference_coefficients(rows, reference->means(), steps);
  }

  /// Before a unit is coded. ids: with its modes
  void before_unit(const SliceUnitHeader& ids, CoefficientModels& models) const {
    if (found_)
      models.predict_from(
          ids.group, group_reference(*found_, ids.cu_prediction, set_.coefficient_begin(ids.range),
                                     set_.grid_bits()));
  }

 private:
  const SequenceParameterSet& set_;
  std::optional<ReferenceCoefficients> found_;
};

}  // namespace slf
