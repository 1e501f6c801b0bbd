#include "codec/component_decoder.h"

#include <algorithm>

#include "attributes/level_prediction.h"
#include "attributes/quantiser.h"
#include "attributes/raht_inverse.h"

namespace slf {

// Levels of missing units are predicted: what is known is interpolated. Spec 8.9.1.
ComponentDecoder::ComponentDecoder(const SequencePlan& plan, const ComponentRows& rows)
    : plan_(plan),
      rows_(rows),
      models_(plan.groups, rows.tree, rows.codes, rows.first, plan.set.has_vectors(), rows.weights,
              static_cast<std::size_t>(plan.layers)),
      nonzero_(rows.tree.size(), 0),
      of_unit_(rows.tree.size()),
      any_(plan.groups.size(), false),
      modes_(plan.groups.size(),
             std::vector<std::uint8_t>(static_cast<std::size_t>(plan.grid_bits() - rows.start),
                                       plan.set.sps_prediction_flag ? kWide : kUnpredicted)),
      layers_(plan.groups.size(), std::vector<std::uint32_t>(plan.set.coefficient_ranges())) {}

/// Spec 8.6.4.
void ComponentDecoder::start_from_base(const BaseComponents& base, const CodeWeights& weights,
                                       std::size_t first_cell, std::span<std::int32_t> components) {
  cells_ = find_cells(rows_.tree, rows_.first, plan_.lowest_split(rows_.start), first_cell);
  if (!base.models.empty()) models_.adopt(base.models.front(), cells_);
  models_.start_from_all(base.states);
  slf::start_from_base(cells_, base.values, weights, plan_.planes(), components);
  any_ = base.any;
  last_ = base.last;
}

void ComponentDecoder::start_apart() {
  cells_ = find_cells(rows_.tree, rows_.first, plan_.lowest_split(rows_.start), 0);
}

void ComponentDecoder::set_modes(const PartUnit& unit) {
  const std::size_t begin = plan_.set.coefficient_begin(unit.header.range);
  auto& modes = modes_[unit.header.group];
  for (std::size_t i = 0; i < unit.header.cu_prediction.size(); ++i)
    modes[begin + i - static_cast<std::size_t>(rows_.start)] =
        static_cast<std::uint8_t>(unit.header.cu_prediction[i]);
}

Result<Done> ComponentDecoder::decode(const PartUnit& unit, std::span<std::int32_t> components) {
  const std::uint32_t begin = plan_.set.coefficient_begin(unit.header.range),
                      end = plan_.set.coefficient_end(unit.header.range);
  const std::size_t group = unit.header.group;
  set_modes(unit);
  last_ = &unit;
  std::fill(of_unit_.begin(), of_unit_.end(), std::uint8_t{0});
  const CoefficientRows rows{rows_.tree, components, plan_.planes(), of_unit_};
  const bool cut = end > static_cast<std::uint32_t>(rows_.levels);
  SLF_CHECK(in_unit(unit, decode_coefficients(unit.payload, models_, rows, group, order_at(begin),
                                              order_at(end), cut, unit.header.layer)));
  layers_[group][unit.header.range] = unit.header.layer + 1;
  for (std::size_t row = 0; row < nonzero_.size(); ++row) nonzero_[row] |= of_unit_[row];
  if (std::find(of_unit_.begin(), of_unit_.end(), 1) != of_unit_.end()) any_[group] = true;
  return Done{};
}

/// Planes up to the last that is not all zero; in others there is nothing to predict.
std::size_t ComponentDecoder::used_planes() {
  std::size_t used = 0;
  for (std::size_t g = 0; g < any_.size(); ++g)
    if (any_[g]) {
      used = std::max(used, std::size_t{3} * plan_.groups[g].back() + 3);
    } else {
      modes_[g].clear();
    }
  return used;
}

bool ComponentDecoder::misses_layers() const {
  for (std::size_t g = 0; g < layers_.size(); ++g)
    for (const std::uint32_t decoded : layers_[g])
      if (decoded > 0 && decoded < plan_.set.layers_of(g)) return true;
  return false;
}

/// Spec 8.7.4, of all rows that are coded here: quantised values to coefficients.
Result<Done> ComponentDecoder::dequantise(std::span<std::int32_t> components) const {
  for (std::size_t g = 0; g < layers_.size(); ++g) {
    const std::vector<std::size_t> planes = planes_of(plan_.groups[g]);
    for (std::uint32_t range = 0; range < layers_[g].size(); ++range) {
      if (layers_[g][range] == 0) continue;
      const int missing = static_cast<int>(plan_.set.layers_of(g) - layers_[g][range]);
      const std::size_t end = order_at(plan_.set.coefficient_end(range));
      for (std::size_t i = order_at(plan_.set.coefficient_begin(range)); i < end; ++i)
        for (const std::size_t j : planes) {
          std::int32_t& value = components[rows_.tree.order[i] * plan_.planes() + j];
          if (!slf::dequantise(value, plan_.steps[j], missing))
            return Error{Errc::kOutOfRange, "cu_magnitude"};
        }
    }
  }
  return Done{};
}

Result<Done> ComponentDecoder::reconstruct(std::span<std::int32_t> components, int threads) {
  auto done = transform_back(components, threads);
  return last_ == nullptr ? done : in_unit(*last_, std::move(done));
}

/// Spec 8.7.4, 8.7.6, 8.8.
Result<Done> ComponentDecoder::transform_back(std::span<std::int32_t> components, int threads) {
  const std::size_t used = used_planes();
  if (used == 0) return Done{};
  if (!misses_layers()) return undo(plan_.steps, components, used, threads);
  SLF_CHECK(dequantise(components));
  return undo(std::vector<std::uint32_t>(plan_.steps.size(), 1), components, used, threads);
}

/// Dequantisation by `steps`, inverse transform.
Result<Done> ComponentDecoder::undo(std::span<const std::uint32_t> steps,
                                    std::span<std::int32_t> components, std::size_t used,
                                    int threads) {
  const std::size_t cells = cells_.size();
  const auto is_predicted = [](const auto& levels) {
    return std::any_of(levels.begin(), levels.end(), [](auto mode) { return mode != 0; });
  };
  if (std::none_of(modes_.begin(), modes_.end(), is_predicted))
    return raht_inverse(rows_.tree, steps, components, threads, nonzero_, used, cells);
  std::vector<std::size_t> group(plan_.coded.size());
  for (std::size_t g = 0; g < plan_.groups.size(); ++g)
    for (const std::uint16_t place : plan_.groups[g]) group[place] = g;
  std::vector<PredictedPlanes> planes;
  for (std::size_t r = 0; r < group.size(); ++r) {
    if (r == 0 || group[r] != group[r - 1]) planes.push_back({3 * r, 3 * r, modes_[group[r]]});
    planes.back().end = 3 * r + 3;
  }
  TransformLevels levels(rows_.codes, plan_.grid_bits(), plan_.grid_bits() - rows_.levels,
                         rows_.start, rows_.weights);
  return raht_inverse_predicted(rows_.tree, levels, planes, steps, components, threads, nonzero_,
                                used, cells);
}

void ComponentDecoder::to_means(std::span<std::int32_t> components) const {
  const std::size_t planes = plan_.planes();
  for (std::size_t row = 0; row < rows_.tree.size(); ++row)
    to_node_means(components.subspan(row * planes, planes),
                  rows_.weights.of(rows_.first[row], rows_.first[row + 1]));
}

void ComponentDecoder::take_rows(const ComponentDecoder& finer, std::span<const std::int32_t> from,
                                 std::span<std::int32_t> to) {
  const std::size_t planes = plan_.planes();
  for (std::size_t row = 0, there = 0; row < rows_.tree.size(); ++row) {
    while (finer.rows_.first[there] != rows_.first[row]) ++there;
    nonzero_[row] = finer.nonzero_[there];
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(there * planes), planes,
                to.begin() + static_cast<std::ptrdiff_t>(row * planes));
  }
  modes_ = finer.modes_;
  layers_ = finer.layers_;
  any_ = finer.any_;
  last_ = finer.last_;
  cells_ = find_cells(rows_.tree, rows_.first, plan_.lowest_split(rows_.start), finer.cells_.first);
}

BaseComponents ComponentDecoder::take_base(std::vector<std::int32_t> values) {
  BaseComponents base{{}, models_.all_states(), std::move(values), std::move(any_), last_};
  base.models.push_back(std::move(models_));
  return base;
}

}  // namespace slf
