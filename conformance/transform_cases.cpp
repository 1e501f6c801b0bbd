// SPDX-License-Identifier: Apache-2.0
// Transforms that no encoder writes: greatest entries, groups without a coded function, several at
// once.
#include <algorithm>
#include <cmath>
#include <functional>

#include "bitstream/bit_writer.h"
#include "codec/encoder/derive_transforms.h"
#include "codec/scene_units.h"
#include "codec/sequence.h"
#include "codec/transform_units.h"
#include "conformance/cases.h"
#include "conformance/edit_units.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

/// A transform with the given entries, columns of as many fractional bits as `precision` says.
ForwardTransform random_transform(const PlaneGroups& all, std::size_t first, std::size_t groups,
                                  std::size_t rank, std::size_t lanes, Random& random) {
  ForwardTransform forward;
  PlaneTransform& t = forward.inverse;
  t.first_group = first;
  t.num_groups = groups;
  t.functions = functions_of_groups(all, first, groups);
  t.rank = rank;
  t.lanes = lanes;
  if (lanes == 3) t.colour = {{{512, -512, 0}, {7, 300, -1}, {-256, 511, 12}}};
  for (std::size_t column = 0; column < t.columns(); ++column) {
    const auto bits = static_cast<std::uint8_t>(column == 0 ? 14 : random.below(15));
    forward.precision.push_back(bits);
    const std::uint32_t most = 1u << (6 + bits);
    for (std::size_t row = 0; row < t.rows(); ++row) {
      const std::uint32_t range = random.below(3) == 0 ? most : std::min(most, 40u);
      auto v = static_cast<std::int32_t>(random.below(4) == 0 ? 0 : random.below(range + 1));
      if (row == 0) v = static_cast<std::int32_t>(most);
      t.matrix.push_back((random.below(2) ? -v : v) * (1 << (14 - bits)));
    }
  }
  return forward;
}

/// Gives the coefficient units of groups, the first of each, the columns of these.
/// before: of the units as they are; set: with transforms
void add_columns(UnitList& units, const SequenceParameterSet& before,
                 const SequenceParameterSet& set, const std::vector<ForwardTransform>& transforms) {
  for (EditableUnit& unit : units) {
    if (unit.type != UnitType::kCoefficients) continue;
    const auto header = read_part_unit({unit.type, unit.payload, 0, 0}, before)->header;
    if (header.range != 0) continue;
    Bytes matrix;
    for (const ForwardTransform& transform : transforms) {
      const ColumnRange columns =
          columns_of_group(transform.inverse, plane_groups(set), header.group);
      if (!columns.empty()) matrix = write_columns(transform, columns);
    }
    set_matrix(unit, before, set, matrix);
  }
}

struct Group {
  std::uint32_t functions, coded;
};

/// Groups of which only some functions are coded, as if by transforms, which still have to be
/// added. The stream has units of no codeword for groups without a coded function.
UnitList groups_of(const std::vector<Group>& groups, std::int32_t size, std::uint32_t step) {
  CodingParameters p;
  p.base_levels = 0;
  p.index = p.digest = false;
  int functions = 0;
  std::uint32_t packed_groups = 0;
  for (const Group& g : groups) {
    for (std::uint32_t k = 0; k < g.coded; ++k, ++functions)
      p.group.push_back(static_cast<int>(packed_groups)), p.step.push_back({step, step, step});
    packed_groups += g.coded > 0;
  }
  UnitList units;
  edited(*pack(field(scattered(30, 3, 19), 3, functions, size), p),
         [&](UnitList& all) { units = all; });
  const SequenceParameterSet before = *parse_sequence_parameter_set(units[0].payload);
  edit_sequence(units, [&](SequenceParameterSet& set) {
    set.sps_num_groups_minus1 = static_cast<std::uint32_t>(groups.size() - 1);
    set.sps_num_functions = 0;
    set.runs.clear();
    for (std::uint32_t g = 0; g < groups.size(); ++g) {
      set.runs.push_back({groups[g].functions - 1, g, 0, 1, {step, step, step}});
      set.sps_num_functions += groups[g].functions;
    }
  });
  const auto coefficients = std::find_if(units.begin(), units.end(), [](const EditableUnit& u) {
    return u.type == UnitType::kCoefficients;
  });
  UnitList made(units.begin(), coefficients);
  auto next = coefficients;
  for (std::uint32_t g = 0; g < groups.size(); ++g) {
    BitWriter header;
    header.ue(0), header.ue(0), header.ue(g);
    for (int level = 0; level < 3; ++level) header.u(2, groups[g].coded > 0 ? g % 4 : 3);
    Bytes payload = header.take();
    if (groups[g].coded > 0) {
      // Behind a group without a coded function contexts are those of group 0 (8.7.2: l).
      const bool alone = g > 0 && groups[g - 1].coded == 0;
      const EditableUnit& from = alone ? *coefficients : *next;
      const auto body = read_part_unit({from.type, from.payload, 0, 0}, before)->payload;
      payload.insert(payload.end(), body.begin(), body.end());
      ++next;
    }
    made.push_back({UnitType::kCoefficients, payload});
  }
  made.insert(made.end(), next, units.end());
  return made;
}

/// The stream of units that were coded without transforms.
/// make: the transforms, by what the sequence then is
Bytes with_transforms(
    UnitList units, std::size_t count,
    const std::function<std::vector<ForwardTransform>(const SequenceParameterSet&)>& make) {
  const SequenceParameterSet before = *parse_sequence_parameter_set(units[0].payload);
  edit_sequence(units, [&](SequenceParameterSet& set) {
    set.sps_transform_flag = 1;
    set.sps_num_transforms_minus1 = static_cast<std::uint32_t>(count - 1);
  });
  const SequenceParameterSet set = *parse_sequence_parameter_set(units[0].payload);
  const std::vector<ForwardTransform> made = make(set);
  add_columns(units, before, set, made);
  for (std::size_t i = made.size(); i-- > 0;)
    units.insert(units.begin() + 1,
                 {UnitType::kTransform, *write_transform(made[i], set.num_groups())});
  return stream_of(units);
}

/// Values of points with the Morton codes 0, 1, 2, 4, 8, .., whose coefficients are as great as
/// these and have signs that make the first as great as can be.
std::vector<double> chain(int points, double mean, double detail) {
  std::vector<double> values(static_cast<std::size_t>(points));
  double low = mean;
  for (int before = points - 1; before > 0; --before) {
    const double c = std::sqrt(before / (before + 1.0)), s = std::sqrt(1 / (before + 1.0));
    values[static_cast<std::size_t>(before)] = s * low - c * detail;
    low = c * low + s * detail;
  }
  values[0] = low;
  return values;
}

/// Components of 6.1 times what a coefficient can be: half from a base whose cells weigh 1, half
/// from within a cell. Three of them are more than 32 bits hold, a quarter of that is not.
Case colours_clamped() {
  constexpr int kLevels = 6, kChain = 3 * kLevels + 1;
  constexpr std::uint32_t kStep = 1 << 13;  // 1 for the encoder, which takes no such components
  constexpr double kGreatest = 0.99 * (1 << 27) / kStep;
  const std::vector<double> cells = chain(kChain, kGreatest, kGreatest);
  const std::vector<double> within = chain(kChain, 0, kGreatest);
  LightField f = field({}, 2 * kLevels, 1);
  CodingParameters p = with_steps(1, 1);
  p.base_levels = kLevels;
  p.base_weight = 1;
  p.slice_start = SliceStart::kApart;
  p.max_slice_points = kChain;  // two slices: one alone is not apart
  p.geometry_level_ends = p.coefficient_level_ends = {kLevels, 2 * kLevels};
  p.predict = false;
  for (int i = 0; i < 2 * kChain - 1; ++i) {
    const int place = i < kChain ? i : i - kChain + 1;  // in its chain
    const std::int32_t far = i < kChain ? 1 : 1 << kLevels;
    Voxel v{0, 0, 0};
    if (place > 0) v[static_cast<std::size_t>((place - 1) % 3)] = far << (place - 1) / 3;
    f.positions.push_back(v);
    const auto at = static_cast<std::size_t>(place);
    const double value = i < kChain ? cells[0] + within[at] : cells[at];
    f.components.insert(f.components.end(), 3, static_cast<std::int32_t>(std::lround(value)));
  }
  UnitList units;
  edited(packed_bare(f, p), [&](UnitList& all) { units = all; });
  edit_sequence(units, [&](auto& set) { set.runs[0].sps_plane_step.fill(kStep); });
  return case_of_stream("transform-of-greatest", "colours beyond 32 bits before the matrix",
                        {"8.7.5", "8.8.3"},
                        with_transforms(units, 1, [](const SequenceParameterSet& set) {
                          ForwardTransform t;
                          t.inverse.num_groups = t.inverse.rank = 1;
                          t.inverse.functions = functions_of_groups(plane_groups(set), 0, 1);
                          t.inverse.lanes = 3;
                          t.inverse.colour = {{{512, 512, 512}, {512, 512, -512}, {0, 512, 0}}};
                          t.inverse.matrix = {1 << 12};
                          t.precision = {14};
                          return std::vector<ForwardTransform>{t};
                        }));
}

}  // namespace

std::vector<Case> transform_cases() {
  std::vector<Case> cases;
  const auto add = [&](const char* id, const char* purpose, const std::vector<Group>& groups,
                       std::int32_t size,
                       const std::vector<std::array<std::size_t, 4>>& transforms) {
    const Bytes stream = with_transforms(
        groups_of(groups, size, 3), transforms.size(), [&](const SequenceParameterSet& set) {
          Random random(99);
          std::vector<ForwardTransform> made;
          for (const auto& [first, count, rank, lanes] : transforms)
            made.push_back(random_transform(plane_groups(set), first, count, rank, lanes, random));
          return made;
        });
    Case c = case_of_stream(id, purpose, {"7.11", "8.7.1", "8.7.5"}, stream);
    for (int g = 1; g <= static_cast<int>(groups.size()); ++g) c.groups.push_back(g);
    c.levels = {2};
    cases.push_back(c);
  };
  add("transform-of-all", "a matrix of full rank with the greatest entries; values clamped",
      {{4, 4}}, 22000000, {{0, 1, 4, 3}});
  add("transform-empty-group", "a group without a coded function, between two that have some",
      {{2, 2}, {3, 0}, {2, 2}}, 3000, {{0, 2, 2, 3}});
  add("transforms-apart", "two transforms, one of them joint, with a group in none between them",
      {{3, 2}, {2, 2}, {2, 2}, {4, 1}}, 3000, {{0, 1, 2, 1}, {2, 2, 3, 3}});
  add("transform-joint-aligned", "a joint transform whose header ends with a byte", {{5, 4}}, 3000,
      {{0, 1, 4, 1}});
  add("transform-of-several-groups", "columns of three groups, the contexts of each its own",
      {{3, 3}, {2, 2}, {2, 2}}, 3000, {{0, 3, 7, 3}});
  add("transform-one-function", "a transform of one function, joint", {{1, 1}, {2, 2}}, 9000000,
      {{0, 1, 1, 1}});
  cases.push_back(colours_clamped());
  return cases;
}

}  // namespace slf::conformance
