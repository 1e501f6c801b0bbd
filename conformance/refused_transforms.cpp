// SPDX-License-Identifier: Apache-2.0
// What is wrong with transforms and their matrices.
#include <functional>

#include "attributes/plane_transform.h"
#include "bitstream/bit_writer.h"
#include "bitstream/parameter_sets.h"
#include "bitstream/transform_header.h"
#include "bitstream/unchecked_headers.h"
#include "codec/scene_units.h"
#include "conformance/cases.h"
#include "conformance/edit_units.h"
#include "conformance/fields.h"
#include "entropy/range_encoder.h"

namespace slf::conformance {
namespace {

constexpr std::uint32_t kFunctions = 8;

/// A transform each of two groups of four functions.
Bytes transformed_stream() {
  CodingParameters parameters = with_steps(kFunctions, 100);
  parameters.group = {0, 0, 0, 0, 1, 1, 1, 1};
  parameters.transform = TransformMode::kFunctions;
  parameters.base_levels = 0;
  return packed_bare(field(scattered(40, 4, 3), 4, kFunctions), parameters);
}

void add_transforms(std::vector<RefusedCase>& cases) {
  const Bytes base = transformed_stream();
  const auto add = [&](const char* id, const char* purpose, const char* clause,
                       const UnitEdit& edit) {
    cases.push_back({id, purpose, {clause}, edited(base, edit)});
  };
  add("transform-missing", "fewer transform units than stated", "7.11",
      [](auto& units) { units.erase(units.begin() + 1); });
  add("transform-late", "a transform unit after the slices", "7.1", [](auto& units) {
    const EditableUnit transform = units[1];
    units.insert(units.end() - 1, transform);
  });
  const auto add_header = [&](const char* id, const char* purpose,
                              const std::function<void(TransformHeader&)>& edit) {
    add(id, purpose, "7.11", [&](auto& units) {
      const auto groups = parse_sequence_parameter_set(units[0].payload)->num_groups();
      BitReader in(units[1].payload);
      ParseSyntax parse{in};
      TransformHeader header;
      transform_header(parse, header, groups);
      edit(header);
      BitWriter out;
      WriteSyntax write{out};
      transform_header(write, header, groups);
      units[1].payload = out.take();
    });
  };
  add_header("transform-first-group", "a transform of a group that there is not",
             [](auto& header) { header.tr_first_group = 2; });
  add_header("transform-groups", "a transform of more groups than there are",
             [](auto& header) { header.tr_num_groups_minus1 = 2; });
  add_header("transform-rank", "more components than functions",
             [](auto& header) { header.tr_rank_minus1 = kFunctions; });
  add_header("transform-colour", "an entry of a matrix of colours of 513 / 512",
             [](auto& header) { header.tr_colour_flag = 1, header.tr_colour[2][2] = 513; });
  add("matrix-of-no-columns", "a matrix for a group of no transform", "7.11", [](auto& units) {
    edit_sequence(units, [](auto& set) { set.sps_num_transforms_minus1 = 0; });
    units.erase(units.begin() + 2);
  });
  add("transform-and-texture", "a texture with a transform", "7.2", [](auto& units) {
    auto set = *parse_sequence_parameter_set(units[0].payload);
    set.sps_profile = kTextureProfile;
    set.sps_coefficient_coder = kTextureCoder;
    units[0].payload = sequence_as_is(set);
  });
}

/// The columns of a group, all of them 0 but for the last entry.
Bytes matrix_of(std::uint8_t fractional_bits, std::int32_t entry) {
  PlaneTransform t;
  t.functions = {0, 1, 2, 3};
  t.rank = 4;
  t.lanes = 3;
  t.matrix.assign(t.rows() * t.columns(), 0);
  t.matrix.back() = entry;
  const std::vector<std::uint8_t> precision(t.columns(), fractional_bits);
  RangeEncoder encoder;
  // Stops at what it does not let pass, before the sign.
  if (!code_columns(encoder, t, {0, t.columns()}, precision)) encoder.raw(1, 0);
  return encoder.finish();
}

void add_matrices(std::vector<RefusedCase>& cases) {
  const Bytes base = transformed_stream();
  const auto add = [&](const char* id, const char* purpose, const char* clause,
                       const UnitEdit& edit) {
    cases.push_back({id, purpose, {clause}, edited(base, edit)});
  };
  const auto with_matrix = [&](const char* id, const char* purpose, const char* clause,
                               const std::function<void(Bytes&, std::uint32_t&)>& edit) {
    add(id, purpose, clause, [&](auto& units) {
      const SequenceParameterSet set = *parse_sequence_parameter_set(units[0].payload);
      EditableUnit& unit = first_of(units, UnitType::kCoefficients);
      const PartUnit part = *read_part_unit({unit.type, unit.payload, 0, 0}, set);
      Bytes matrix(part.matrix.begin(), part.matrix.end());
      auto bytes = static_cast<std::uint32_t>(matrix.size());
      edit(matrix, bytes);
      set_matrix(unit, set, set, matrix, bytes);
    });
  };
  with_matrix("matrix-shorter", "a matrix without its last bytes", "8.3.1",
              [](Bytes& matrix, std::uint32_t& bytes) { matrix.resize(bytes /= 2); });
  with_matrix("matrix-longer", "five bytes more behind a matrix", "8.3.1",
              [](Bytes& matrix, std::uint32_t& bytes) { matrix.resize(bytes += 5); });
  with_matrix("matrix-bytes", "a matrix longer than its unit", "7.6",
              [](Bytes&, std::uint32_t& bytes) { bytes = 1 << 20; });
  with_matrix("matrix-missing", "no matrix where the group has columns", "7.11",
              [](Bytes& matrix, std::uint32_t& bytes) { matrix.clear(), bytes = 0; });
  with_matrix("matrix-precision", "a column of 15 fractional bits", "7.11",
              [](Bytes& matrix, std::uint32_t& bytes) {
                matrix = matrix_of(15, 0), bytes = static_cast<std::uint32_t>(matrix.size());
              });
  with_matrix("matrix-entry", "an entry above 64", "7.11", [](Bytes& matrix, std::uint32_t& bytes) {
    matrix = matrix_of(14, PlaneTransform::kEntryLimit + 1);
    bytes = static_cast<std::uint32_t>(matrix.size());
  });
}

}  // namespace

std::vector<RefusedCase> refused_transforms() {
  std::vector<RefusedCase> cases;
  add_transforms(cases);
  add_matrices(cases);
  return cases;
}

}  // namespace slf::conformance
