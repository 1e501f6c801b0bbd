// What a decode takes, by the headers alone.
#include "codec/decode_cost.h"
#include "codec/scene_units.h"

namespace slf {
namespace {

/// Bits of a point in units of values that are asked for.
double coefficient_bits(const SceneUnits& scene, const SequencePlan& plan) {
  std::uint64_t bytes = 0;
  const auto add = [&](const PartUnits& part) {
    for (const PartUnit& unit : part)
      if (plan.wants_values(unit.type, unit.header)) bytes += unit.payload.size();
  };
  add(scene.base);
  for (const PartUnits& slice : scene.slices) add(slice);
  const std::uint64_t points = plan.table.num_points();
  return points > 0 ? 8.0 * static_cast<double>(bytes) / static_cast<double>(points)
                    : DecodeShape::kUnknown;
}

}  // namespace

Result<DecodeCost> decode_cost(std::span<const std::uint8_t> stream, const DecodeOptions& options) {
  if (stream.size() > options.limits.max_stream_bytes) return Error{Errc::kLimitExceeded, "stream"};
  SLF_TRY(const Units units, split_units(stream, options.max_bytes));
  SLF_TRY(const SequenceParameterSet set, find_sequence(units));
  SLF_TRY(const SceneUnits scene, collect_units(units, set));
  SLF_TRY(const SequencePlan plan, plan_sequence(units, set, scene.table, options));
  DecodeShape shape = shape_of(plan);
  shape.coefficient_bits = coefficient_bits(scene, plan);
  return cost_of(shape, options);
}

}  // namespace slf
