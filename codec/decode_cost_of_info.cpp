// What a decode takes, by the headers alone.
#include <algorithm>

#include "codec/decode_cost.h"
#include "slf/parallel.h"

namespace slf {
namespace {

DecodeShape shape_of(const StreamInfo& info) {
  DecodeShape shape;
  for (const SliceInfo& slice : info.slices) {
    shape.slices.push_back(slice.points);
    if (info.base_levels > 0) shape.cells += slice.cells;
  }
  auto functions = static_cast<std::uint64_t>(info.header.num_functions);
  for (const TransformInfo& t : info.transforms)
    functions -= static_cast<std::uint64_t>(t.functions - t.coded_functions);
  shape.planes = 3 * functions;
  shape.groups = static_cast<std::uint64_t>(info.num_groups);
  shape.levels = static_cast<std::uint64_t>(info.header.grid.bits);
  shape.base_levels = static_cast<std::uint64_t>(info.base_levels);
  const auto of_slice_0 = [&](const char* type) {
    return static_cast<std::uint64_t>(
        std::count_if(info.units.begin(), info.units.end(),
                      [&](const UnitInfo& unit) { return unit.slice == 0 && unit.type == type; }));
  };
  shape.geometry_units = of_slice_0("geometry");
  shape.coefficient_units = of_slice_0("coefficients") + of_slice_0("refinement");
  for (const int layers : info.layers)
    shape.layers = std::max(shape.layers, static_cast<std::uint64_t>(layers));
  std::uint64_t bytes = 0;
  for (const UnitInfo& unit : info.units)
    if (unit.type == "coefficients" || unit.type == "refinement") bytes += unit.bytes;
  if (info.num_points > 0)
    shape.coefficient_bits =
        8.0 * static_cast<double>(bytes) / static_cast<double>(info.num_points);
  shape.vector = info.coefficient_coder == "vector";
  shape.prediction = info.prediction;
  shape.draco = info.geometry_coder == "draco";
  shape.texture = info.texture_bits > 0;
  shape.normals = std::any_of(info.units.begin(), info.units.end(),
                              [](const UnitInfo& unit) { return unit.type == "normals"; });
  shape.shared_states = info.num_slices > 1 && info.slice_start == SliceStart::kShared;
  return shape;
}

}  // namespace

DecodeCost decode_cost(const StreamInfo& info, int threads) {
  return cost_of(shape_of(info), static_cast<std::uint64_t>(thread_count(
                                     threads, std::max<std::size_t>(info.slices.size(), 1))));
}

std::uint64_t decode_memory(const StreamInfo& info, int threads) {
  return decode_cost(info, threads).memory;
}

}  // namespace slf
