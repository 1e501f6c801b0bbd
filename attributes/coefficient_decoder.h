// SPDX-License-Identifier: Apache-2.0
// The quantised coefficients of a slice from its coefficient units. Spec 8.7.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "attributes/coefficient_models.h"
#include "slf/error.h"

namespace slf {

/// Decodes one unit: rows order[begin .. end) of `group` into rows.values; of a layer above 0 they
/// hold the values of the layers before. cut: the rows are fewer than the unit holds, so its end is
/// not reached.
Result<Done> decode_coefficients(std::span<const std::uint8_t> payload, CoefficientModels& models,
                                 const CoefficientRows& rows, std::size_t group, std::size_t begin,
                                 std::size_t end, bool cut, std::size_t layer = 0);

}  // namespace slf
