#include "attributes/coefficient_decoder.h"

#include "bitstream/multiversion.h"
#include "entropy/range_decoder.h"

namespace slf {

CoefficientModels::CoefficientModels(const PlaneGroups& groups, const RahtTree& tree,
                                     std::span<const std::uint64_t> morton,
                                     std::span<const std::uint32_t> first, bool vector,
                                     std::uint32_t weight) {
  if (vector) neighbours_ = find_coefficient_neighbours(tree, morton, first, weight);
  for (const auto& functions : groups) {
    empty_.push_back(functions.empty());
    if (vector) {
      vector_.emplace_back(functions, tree.size());
    } else {
      independent_.emplace_back(functions);
    }
  }
}

/// Spec 8.2.1. Row 0 of a slice stays without: it counts as none around other rows.
void CoefficientModels::adopt(const CoefficientModels& base, const SliceCells& cells) {
  if (vector_.empty()) return;
  for (std::size_t i = 1; i < cells.size(); ++i) {
    const std::uint32_t there = base.neighbours_.place[cells.first + i];
    const std::uint32_t here = neighbours_.place[cells.row[i]];
    neighbours_.rows[here].scale = base.neighbours_.rows[there].scale;
    for (std::size_t g = 0; g < vector_.size(); ++g) vector_[g].adopt(base.vector_[g], there, here);
  }
}

CoefficientStates CoefficientModels::states(std::size_t group) {
  if (!vector_.empty()) return {vector_[group].states().share(), nullptr};
  return {nullptr, independent_[group].states().share()};
}

void CoefficientModels::start_from(std::size_t group, const CoefficientStates& states) {
  if (!vector_.empty()) return vector_[group].states().start_from(states.vector);
  independent_[group].states().start_from(states.independent);
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
