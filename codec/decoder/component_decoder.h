// SPDX-License-Identifier: Apache-2.0
// Coefficient units of the base or of a slice to components. Spec 8.6 - 8.9.
#pragma once

#include <cstdint>
#include <span>

#include "codec/decoder/decoder_state.h"

namespace slf {

/// Entropy decoding of a unit. components: [rows][planes], coefficients after.
Result<Done> decode_values_unit(const PartUnit& unit, const Request& request,
                                const ComponentRows& rows, ValueState& state,
                                std::span<std::int32_t> components);

/// Dequantisation and inverse transform, when all units are decoded. An error is of the last.
/// keep: request.kept receives means
Result<Done> reconstruct(const Request& request, const ComponentRows& rows, CodedCoefficients coded,
                         std::span<std::int32_t> components, int threads, bool keep = true);

/// The mean of each node, of what reconstruct() left.
void to_means(const ComponentRows& rows, std::size_t planes, std::span<std::int32_t> components);

/// What was decoded of finer rows, for the rows among them that are kept.
/// @param from  [finer rows][planes]
CodedCoefficients keep_rows(const Request& request, const ComponentRows& finer,
                            CodedCoefficients coded, std::span<const std::int32_t> from,
                            const ComponentRows& rows, std::span<std::int32_t> to);

}  // namespace slf
