// What a decode takes, by the headers alone.
#include "codec/decode_cost.h"

namespace slf {

Result<DecodeCost> decode_cost(std::span<const std::uint8_t> stream, const DecodeOptions& options) {
  if (stream.size() > options.limits.max_stream_bytes) return Error{Errc::kLimitExceeded, "stream"};
  SLF_TRY(const Units units, split_units(stream, options.max_bytes));
  SLF_TRY(const SequenceParameterSet set, find_sequence(units));
  SLF_TRY(const SceneUnits scene, collect_units(units, set));
  SLF_TRY(const Request request, request_of(units, scene, options));
  DecodeShape shape = shape_of(request);
  if (const std::uint64_t points = scene.stream.table.num_points(); points > 0)
    shape.coefficient_bits =
        8.0 * static_cast<double>(bytes_wanted(scene, request, true)) / static_cast<double>(points);
  return cost_of(shape, options);
}

}  // namespace slf
