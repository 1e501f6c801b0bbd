#include "attributes/coefficient_decoder.h"

#include "bitstream/multiversion.h"
#include "entropy/range_decoder.h"

namespace slf {

CoefficientModels::CoefficientModels(const PlaneGroups& groups, const RahtTree& tree,
                                     std::span<const std::uint64_t> morton,
                                     std::span<const std::uint32_t> first, bool vector) {
  if (vector) neighbours_ = find_coefficient_neighbours(tree, morton, first);
  for (const auto& functions : groups) {
    empty_.push_back(functions.empty());
    if (vector) {
      vector_.emplace_back(functions, tree.size());
    } else {
      independent_.emplace_back(functions);
    }
  }
}

SLF_MULTIVERSION_ALL
Result<Done> decode_coefficients(std::span<const std::uint8_t> payload, CoefficientModels& models,
                                 const CoefficientRows& rows, std::size_t group, std::size_t begin,
                                 std::size_t end, bool cut) {
  if (payload.empty()) return Done{};  // all are zero
  RangeDecoder decoder(payload);
  if (!models.code(decoder, rows, group, begin, end))
    return decoder.exhausted() ? decoder.finish("cu_coefficients")
                               : Error{Errc::kOutOfRange, "cu_magnitude", 0};
  if (cut) return Done{};
  return decoder.finish("cu_coefficients");
}

}  // namespace slf
