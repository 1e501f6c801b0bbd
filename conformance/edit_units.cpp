// SPDX-License-Identifier: Apache-2.0
#include "conformance/edit_units.h"

#include <algorithm>
#include <cstdio>

#include "bitstream/bit_writer.h"
#include "bitstream/checked_syntax.h"
#include "bitstream/unchecked_headers.h"
#include "codec/scene_units.h"
#include "conformance/fields.h"

namespace slf::conformance {

Bytes base_stream(bool index) {
  LightField f = field(sphere(4), 4, 4);
  f.header.has_basis = true;
  f.header.basis = {BasisId::kBspline, 2, 1, 1};
  CodingParameters parameters;
  for (int k = 0; k < 4; ++k) parameters.step.push_back({16, 16, 16});
  parameters.group = {0, 1, 1, 1};
  parameters.geometry_level_ends = {1, 2, 4};
  parameters.base_levels = 2;
  parameters.max_slice_points = 150;
  parameters.index = index;
  parameters.metadata = {{"source", "generated"}};
  return *pack(f, parameters);
}

Bytes edited(const Bytes& base, const UnitEdit& edit) {
  if (base.empty()) return base;
  UnitList units;
  const Units split = *split_units(base);
  for (const Unit& unit : split.units)
    units.push_back({unit.type, Bytes(unit.payload.begin(), unit.payload.end())});
  edit(units);
  Bytes stream(kSignature.begin(), kSignature.end());
  std::uint64_t count = 0;
  for (const EditableUnit& unit : units) {
    if (unit.type == UnitType::kEnd) {
      BitWriter end;
      end.ue(count);
      append_unit(stream, unit.type, end.take());
    } else {
      append_unit(stream, unit.type, unit.payload);
    }
    ++count;
  }
  return stream;
}

Bytes edited(const UnitEdit& edit) { return edited(base_stream(false), edit); }

void set_matrix(EditableUnit& unit, const SequenceParameterSet& before,
                const SequenceParameterSet& after, const Bytes& matrix,
                std::optional<std::uint32_t> bytes) {
  PartUnit part = *read_part_unit({unit.type, unit.payload, 0, 0}, before);
  part.header.cu_matrix_bytes = bytes.value_or(static_cast<std::uint32_t>(matrix.size()));
  Bytes payload =
      header_as_is([&](auto& v) { slice_unit_header(v, part.header, unit.type, after); });
  payload.insert(payload.end(), matrix.begin(), matrix.end());
  payload.insert(payload.end(), part.payload.begin(), part.payload.end());
  unit.payload = std::move(payload);
}

void set_modes(EditableUnit& unit, const SequenceParameterSet& set,
               const std::vector<std::uint32_t>& modes) {
  PartUnit part = *read_part_unit({unit.type, unit.payload, 0, 0}, set);
  if (part.header.cu_prediction.size() != modes.size()) return;
  part.header.cu_prediction.assign(modes.begin(), modes.end());
  Bytes payload = header_as_is([&](auto& v) { slice_unit_header(v, part.header, unit.type, set); });
  payload.insert(payload.end(), part.payload.begin(), part.payload.end());
  unit.payload = std::move(payload);
}

Bytes packed_bare(const LightField& field, CodingParameters parameters) {
  parameters.index = parameters.digest = false;
  auto stream = pack(field, parameters);
  if (!stream) std::fprintf(stderr, "%s\n", stream.error().message.c_str());
  return *std::move(stream);
}

Bytes stream_of(const UnitList& units) {
  return edited(base_stream(false), [&](UnitList& all) { all = units; });
}

void edit_sequence(UnitList& units, const std::function<void(SequenceParameterSet&)>& edit) {
  SequenceParameterSet set = *parse_sequence_parameter_set(units[0].payload);
  edit(set);
  units[0].payload = sequence_as_is(set);
}

EditableUnit& first_of(UnitList& units, UnitType type) {
  return *std::find_if(units.begin(), units.end(),
                       [type](const EditableUnit& u) { return u.type == type; });
}

}  // namespace slf::conformance
