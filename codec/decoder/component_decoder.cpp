// SPDX-License-Identifier: Apache-2.0
#include "codec/decoder/component_decoder.h"

#include <algorithm>
#include <optional>

#include "attributes/coefficient_decoder.h"
#include "attributes/level_prediction.h"
#include "attributes/quantiser.h"
#include "attributes/raht_inverse.h"

namespace slf {
namespace {

std::size_t order_at(const ComponentRows& rows, const StreamHeader& stream, std::uint32_t level) {
  return slf::order_at(rows.tree, stream.grid_bits(), level);
}

void set_modes(const PartUnit& unit, std::size_t begin, std::vector<std::uint8_t>& modes) {
  for (std::size_t i = 0; i < unit.header.cu_prediction.size(); ++i)
    modes[begin + i] = static_cast<std::uint8_t>(unit.header.cu_prediction[i]);
}

/// Planes up to the last that is not all zero; in others there is nothing to predict.
std::size_t used_planes(const Request& request, CodedCoefficients& coded) {
  if (request.reference != nullptr) return request.planes();
  const PlaneGroups& groups = request.groups;
  std::size_t used = 0;
  for (std::size_t g = 0; g < coded.any.size(); ++g)
    if (coded.any[g]) {
      used = std::max(used, std::size_t{3} * groups[g].back() + 3);
    } else {
      coded.modes[g].clear();
    }
  return used;
}

bool misses_layers(const SequenceParameterSet& set, const CodedCoefficients& coded) {
  for (std::size_t g = 0; g < coded.layers.size(); ++g)
    for (const std::uint32_t decoded : coded.layers[g])
      if (decoded > 0 && decoded < set.layers_of(g)) return true;
  return false;
}

/// Spec 8.7.4, of all rows that are coded here: quantised values to coefficients.
Result<Done> dequantise_rows(const Request& request, const ComponentRows& rows,
                             const CodedCoefficients& coded, std::span<std::int32_t> components) {
  const StreamHeader& stream = request.stream;
  for (std::size_t g = 0; g < coded.layers.size(); ++g) {
    const std::vector<std::size_t> planes = planes_of(request.groups[g]);
    for (std::uint32_t range = 0; range < coded.layers[g].size(); ++range) {
      if (coded.layers[g][range] == 0) continue;
      const int missing = static_cast<int>(stream.set.layers_of(g) - coded.layers[g][range]);
      const std::size_t end = order_at(rows, stream, stream.set.coefficient_end(range));
      for (std::size_t i = order_at(rows, stream, stream.set.coefficient_begin(range)); i < end;
           ++i)
        for (const std::size_t j : planes) {
          std::int32_t& value = components[rows.tree.order[i] * request.planes() + j];
          if (!dequantise(value, request.steps[j], missing))
            return Error{Errc::kOutOfRange, "cu_magnitude"};
        }
    }
  }
  return Done{};
}

/// Planes that follow one another in a group are predicted alike.
std::vector<PredictedPlanes> predicted_planes(const Request& request,
                                              const CodedCoefficients& coded) {
  std::vector<std::size_t> group(request.coded.size());
  for (std::size_t g = 0; g < request.groups.size(); ++g)
    for (const std::uint16_t place : request.groups[g]) group[place] = g;
  std::vector<PredictedPlanes> planes;
  for (std::size_t r = 0; r < group.size(); ++r) {
    if (r == 0 || group[r] != group[r - 1]) planes.push_back({3 * r, 3 * r, coded.modes[group[r]]});
    planes.back().end = 3 * r + 3;
  }
  return planes;
}

/// Dequantisation by `steps`, inverse transform.
Result<Done> undo(const Request& request, const ComponentRows& rows, const CodedCoefficients& coded,
                  std::span<const std::uint32_t> steps, std::span<std::int32_t> components,
                  std::size_t used, int threads, bool keep) {
  const auto is_predicted = [](const auto& levels) {
    return std::any_of(levels.begin(), levels.end(), [](auto mode) { return mode != 0; });
  };
  const FrameReference* reference = request.reference;
  keep = keep && request.kept != nullptr;
  if (reference == nullptr && !keep &&
      std::none_of(coded.modes.begin(), coded.modes.end(), is_predicted))
    return raht_inverse(rows.tree, steps, components, threads, coded.nonzero, used,
                        coded.cells.size());
  const int grid_bits = request.stream.grid_bits();
  TransformLevels levels(rows.codes, grid_bits, grid_bits - rows.levels, rows.start, rows.weights);
  std::optional<ReferenceMeans> means;
  if (reference != nullptr) means.emplace(reference->means());
  return raht_inverse_predicted(rows.tree, levels, predicted_planes(request, coded), steps,
                                components, threads, coded.nonzero, used, coded.cells.size(),
                                means ? &*means : nullptr, keep ? &request.kept->means : nullptr);
}

/// Spec 8.7.4, 8.7.6, 8.8.
Result<Done> transform_back(const Request& request, const ComponentRows& rows,
                            CodedCoefficients& coded, std::span<std::int32_t> components,
                            int threads, bool keep) {
  const std::size_t used = used_planes(request, coded);
  if (used == 0) return Done{};
  if (!misses_layers(request.stream.set, coded))
    return undo(request, rows, coded, request.steps, components, used, threads, keep);
  SLF_CHECK(dequantise_rows(request, rows, coded, components));
  const std::vector<std::uint32_t> ones(request.steps.size(), 1);
  return undo(request, rows, coded, ones, components, used, threads, keep);
}

}  // namespace

Result<Done> decode_values_unit(const PartUnit& unit, const Request& request,
                                const ComponentRows& rows, ValueState& state,
                                std::span<std::int32_t> components) {
  const SliceUnitHeader& ids = unit.header;
  const StreamHeader& stream = request.stream;
  const std::uint32_t begin = stream.set.coefficient_begin(ids.range),
                      end = stream.set.coefficient_end(ids.range);
  CodedCoefficients& coded = state.coded;
  set_modes(unit, begin - static_cast<std::uint32_t>(rows.start), coded.modes[ids.group]);
  coded.last = &unit;
  std::fill(state.of_unit.begin(), state.of_unit.end(), std::uint8_t{0});
  const CoefficientRows values{rows.tree, components, request.planes(), state.of_unit};
  const bool cut = end > static_cast<std::uint32_t>(rows.levels);
  SLF_CHECK(in_unit(unit, decode_coefficients(unit.payload, state.models, values, ids.group,
                                              order_at(rows, stream, begin),
                                              order_at(rows, stream, end), cut, ids.layer)));
  coded.layers[ids.group][ids.range] = ids.layer + 1;
  for (std::size_t row = 0; row < coded.nonzero.size(); ++row)
    coded.nonzero[row] |= state.of_unit[row];
  if (std::find(state.of_unit.begin(), state.of_unit.end(), 1) != state.of_unit.end())
    coded.any[ids.group] = true;
  return Done{};
}

Result<Done> reconstruct(const Request& request, const ComponentRows& rows, CodedCoefficients coded,
                         std::span<std::int32_t> components, int threads, bool keep) {
  auto done = transform_back(request, rows, coded, components, threads, keep);
  return coded.last == nullptr ? done : in_unit(*coded.last, done);
}

void to_means(const ComponentRows& rows, std::size_t planes, std::span<std::int32_t> components) {
  for (std::size_t row = 0; row < rows.tree.size(); ++row)
    to_node_means(components.subspan(row * planes, planes),
                  rows.weights.of(rows.first[row], rows.first[row + 1]));
}

CodedCoefficients keep_rows(const Request& request, const ComponentRows& finer,
                            CodedCoefficients coded, std::span<const std::int32_t> from,
                            const ComponentRows& rows, std::span<std::int32_t> to) {
  const std::size_t planes = request.planes();
  for (std::size_t row = 0, there = 0; row < rows.tree.size(); ++row) {
    while (finer.first[there] != rows.first[row]) ++there;
    coded.nonzero[row] = coded.nonzero[there];  // row <= there
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(there * planes), planes,
                to.begin() + static_cast<std::ptrdiff_t>(row * planes));
  }
  coded.nonzero.resize(rows.tree.size());
  if (coded.cells.size() > 0)  // without a base row 0 has a coefficient
    coded.cells = find_cells(rows.tree, rows.first, request.stream.lowest_split(rows.start),
                             coded.cells.first);
  return coded;
}

}  // namespace slf
