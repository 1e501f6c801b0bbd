// SPDX-License-Identifier: Apache-2.0
// Mirror of codec/decoder/component_decoder.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "attributes/encoder/coefficient_quantiser.h"
#include "codec/encoder/coded_unit.h"

namespace slf {

/// The quantised coefficients of the base, or of a slice, to units. Spec 8.7.
class ComponentEncoder {
 public:
  /// @param start   octree level that the part begins with
  /// @param values  [rows][planes] quantised, of the last layer
  /// All but `start` are kept by reference.
  ComponentEncoder(const SliceCoding& coding, const RahtTree& tree, int start,
                   const Quantised& quantised, std::span<std::int32_t> values,
                   CoefficientModels& models)
      : coding_(coding),
        tree_(tree),
        start_(start),
        quantised_(quantised),
        values_(values),
        models_(models) {}

  /// The unit with these ids. A model goes on from the unit before: they come in their order.
  Result<CodedUnit, InputError> encode(SliceUnitHeader ids);

  /// cu_prediction of the levels of a range.
  std::vector<std::uint32_t> modes_of(const SliceUnitHeader& ids) const;

 private:
  std::span<std::int32_t> values_of(std::uint32_t layer);

  const SliceCoding& coding_;
  const RahtTree& tree_;
  int start_;
  const Quantised& quantised_;
  std::span<std::int32_t> values_;
  CoefficientModels& models_;
  std::vector<std::int32_t> of_layer_;  // where there are several
  std::uint32_t layer_ = ~0u;           // that these are of
};

}  // namespace slf
