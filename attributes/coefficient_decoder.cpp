#include "attributes/coefficient_decoder.h"

#include "attributes/quantiser.h"
#include "entropy/range_decoder.h"

namespace slf {

CoefficientModels::CoefficientModels(const PlaneGroups& groups, std::size_t num_points,
                                     std::size_t planes, bool vector) {
  for (const auto& functions : groups) {
    if (vector) {
      vector_.emplace_back(functions, num_points, planes);
    } else {
      independent_.emplace_back(functions);
    }
  }
}

Result<Done> decode_coefficients(std::span<const std::uint8_t> payload, CoefficientModels& models,
                                 const CoefficientRows& rows, std::size_t group, std::size_t begin,
                                 std::size_t end, bool cut) {
  RangeDecoder decoder(payload);
  if (!models.code(decoder, rows, group, begin, end))
    return Error{Errc::kOutOfRange, "cu_magnitude", 0};
  if (cut) return Done{};
  return decoder.finish("cu_coefficients");
}

Result<Done> dequantise(std::span<std::int32_t> values, std::span<const std::uint32_t> steps) {
  const std::size_t planes = steps.size();
  for (std::size_t row = 0; row < values.size(); row += planes)
    for (std::size_t j = 0; j < planes; ++j) {
      std::int32_t& value = values[row + j];
      if (value == 0) continue;
      const std::int64_t product = std::int64_t{value} * steps[j];
      if (product >= kCoefficientLimit || product <= -kCoefficientLimit)
        return Error{Errc::kOutOfRange, "cu_magnitude", 0};
      value = static_cast<std::int32_t>(product);
    }
  return Done{};
}

}  // namespace slf
