// SPDX-License-Identifier: Apache-2.0
// Coefficients in quality layers. Spec 8.7.7.
#include <algorithm>
#include <numeric>

#include "attributes/coefficient_models.h"
#include "bitstream/parameter_sets.h"
#include "bitstream/unchecked_headers.h"
#include "conformance/cases.h"
#include "conformance/edit_units.h"
#include "conformance/fields.h"
#include "entropy/range_encoder.h"

namespace slf::conformance {
namespace {

/// Three groups with a number of layers each, level ranges above and below the base.
Case layered(const char* id, const char* purpose, std::vector<int> layers, int base_levels,
             std::uint32_t slice_points) {
  Case c{id,
         purpose,
         {"7.2", "7.12", "8.7.4", "8.7.7", "8.9"},
         field(small_sphere(), 5, 9),
         with_steps(9, 20),
         {2, 4},
         {1, 2},
         0,
         false};
  c.parameters.group = {0, 1, 1, 2, 2, 2, 2, 2, 2};
  c.parameters.geometry_level_ends = {2, 5};
  c.parameters.coefficient_level_ends = {3, 4, 5};
  c.parameters.base_levels = base_levels;
  c.parameters.max_slice_points = slice_points;
  c.parameters.group_layers = std::move(layers);
  for (int layer = 1; layer <= 4; ++layer)
    if (std::any_of(c.parameters.group_layers.begin(), c.parameters.group_layers.end(),
                    [&](int most) { return most > layer; }))
      c.layers.push_back(layer);
  return c;
}

/// 4,096 points of one colour: the mean of all is 64 times that, 16 steps, and nothing else is
/// there, so that the codewords of refinements are empty.
Case even() {
  Case c = layered("layers-empty", "refinements of zeros alone", {3, 2, 4}, 0, 1u << 20);
  std::vector<Voxel> voxels;
  for (std::int32_t i = 0; i < 4096; ++i) voxels.push_back({i & 15, i >> 4 & 15, i >> 8});
  c.field = field(sorted(std::move(voxels)), 5, 9);
  for (std::size_t p = 0; p < 4096; ++p)
    for (std::size_t j = 0; j < 27; ++j) c.field.components[27 * p + j] = j % 2 == 0 ? 1000 : -1000;
  c.parameters.step = with_steps(9, 4000).step;
  return c;
}

void add_layer_cuts(std::vector<Case>& cases) {
  const auto add = [&](const char* id, const char* purpose, int levels, int groups, int layers) {
    Case c = layered(id, purpose, {3, 2, 3}, 2, 200);
    c.truncated.emplace();
    c.truncated->levels = levels;
    c.truncated->groups = groups;
    c.truncated->layers = layers;
    c.groups = {1};
    c.layers = {1};
    cases.push_back(c);
  };
  add("layers-cut", "the last layer left out", 0, 0, 2);
  add("layers-cut-to-one", "all refinements left out", 0, 0, 1);
  add("layers-cut-levels", "a layer, a level range and a group left out", 4, 2, 2);
}

/// One slice, two groups of three layers, headers of a byte.
Bytes layered_stream() {
  CodingParameters parameters = with_steps(4, 16);
  parameters.group = {0, 1, 1, 1};
  parameters.quality_layers = 3;
  parameters.base_levels = 0;
  parameters.predict = parameters.index = parameters.digest = false;
  return *pack(field(sphere(4), 4, 4), parameters);
}

/// Codeword of group 0 of that stream: the mean of all, and nothing else.
Bytes codeword_of(std::int32_t mean) {
  std::vector<std::uint64_t> codes;
  for (const Voxel& v : sphere(4)) codes.push_back(morton(v));
  const RahtTree tree = build_raht_tree(codes);
  std::vector<std::uint32_t> first(codes.size() + 1);
  std::iota(first.begin(), first.end(), 0u);
  CoefficientModels models({{0}}, tree, codes, first, true);
  std::vector<std::int32_t> values(3 * codes.size());
  values[0] = mean;
  RangeEncoder encoder;
  models.code(encoder, {tree, values, 3}, 0, 0, codes.size());
  return encoder.finish();
}

void edit_set(UnitList& units, const std::function<void(SequenceParameterSet&)>& edit) {
  auto set = *parse_sequence_parameter_set(units[0].payload);
  edit(set);
  units[0].payload = sequence_as_is(set);
}

/// A coefficient of 2^27 - 2048, 256 without three of its layers: what that stands for is more.
Case greatest() {
  LightField f = field({{1, 0, 1}}, 1, 1);
  f.components.assign(3, 2048);
  CodingParameters p = with_steps(1, 1);
  p.quality_layers = 4;
  Case c = case_of_stream(
      "layers-greatest", "a value at the limit, without its layers", {"8.7.4", "8.7.7"},
      edited(packed_bare(f, p), [](auto& units) {
        edit_set(units, [](auto& set) { set.runs[0].sps_plane_step.fill((1 << 16) - 1); });
      }));
  c.layers = {1, 2, 3};
  return c;
}

}  // namespace

std::vector<Case> layer_cases() {
  std::vector<Case> cases;
  cases.push_back(layered("layers", "two layers", {2, 2, 2}, 0, 1u << 20));
  cases.push_back(layered("layers-four", "four layers, a base", {4, 4, 4}, 2, 1u << 20));
  cases.push_back(layered("layers-by-group", "groups of 1, 3 and 2 layers", {1, 3, 2}, 2, 200));
  Case alone =
      layered("layers-alone", "slices that start from the base's states", {2, 2, 2}, 2, 200);
  alone.parameters.slice_start = SliceStart::kBase;
  cases.push_back(alone);
  cases.push_back(even());
  cases.push_back(greatest());
  Case large =
      layered("layers-large", "magnitudes beyond the contexts, step 1", {4, 4, 4}, 0, 1u << 20);
  large.field = field(sphere(5, 0, 12), 5, 9, 1000000);  // more than a reader asks for at once
  large.parameters.step = with_steps(9, 1).step;
  cases.push_back(large);
  for (const std::size_t units : {18u, 25u, 32u}) {
    Case c = layered(("layers-prefix-" + std::to_string(units)).c_str(), "layers cut short",
                     {3, 2, 3}, 2, 200);
    c.keep_units = units;
    cases.push_back(c);
  }
  Case runs = layered("layers-of-runs", "a group of three runs", {2, 3}, 0, 1u << 20);
  runs.field = field(sphere(4), 4, 12);
  for (std::size_t i = 0; i < runs.field.components.size(); ++i)
    if (i / 3 % 12 > 5) runs.field.components[i] /= 8;  // less in the last run, often nothing
  runs.parameters = with_steps(12, 30);
  runs.parameters.group = {0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  runs.parameters.base_levels = 0;
  runs.parameters.group_layers = {2, 3};
  runs.levels = {2};
  runs.groups = {1};
  cases.push_back(runs);
  add_layer_cuts(cases);
  return cases;
}

std::vector<RefusedCase> refused_layers() {
  std::vector<RefusedCase> cases;
  const Bytes stream = layered_stream();
  const auto add = [&](const char* id, const char* purpose, const char* clause,
                       const UnitEdit& edit) {
    cases.push_back({id, purpose, {clause}, edited(stream, edit)});
  };
  add("layers-out-of-order", "the second refinement before the first", "7.1", [](auto& units) {
    auto& first = first_of(units, UnitType::kRefinement);
    std::swap(first, *(&first + 2));
  });
  add("layers-missing", "an end unit before the last refinement", "7.1",
      [](auto& units) { units.erase(units.end() - 2); });
  add("layers-shorter", "a refinement without its last bytes", "8.3.1", [](auto& units) {
    auto& payload = first_of(units, UnitType::kRefinement).payload;
    payload.resize(payload.size() / 2);
  });
  add("layers-cut-more", "a cut to as many layers as there are", "7.2", [](auto& units) {
    edit_set(units, [](auto& s) {
      s.sps_cut_flag = 1, s.sps_cut_levels = s.grid_bits(), s.sps_cut_layers = 3;
    });
  });
  add("layers-of-a-texture", "a texture in layers", "7.2",
      [](auto& units) { edit_set(units, [](auto& s) { s.sps_profile = kTextureProfile; }); });
  add("layers-magnitude", "a value of 2^26 that is refined", "8.7.7", [](auto& units) {
    auto& unit = first_of(units, UnitType::kCoefficients);
    unit.payload = {0xE0};  // ids 0, 0, 0; no prediction
    const Bytes large = codeword_of(1 << 26);
    unit.payload.insert(unit.payload.end(), large.begin(), large.end());
    // Empty codewords behind their headers: others would be coded around what is there now.
    (&unit + 1)->payload.resize(1);
    first_of(units, UnitType::kRefinement).payload.resize(1);  // an empty codeword
  });
  cases.push_back({"layers-unannounced",
                   "a refinement where there are no layers",
                   {"7.1"},
                   edited([](auto& units) {
                     EditableUnit& last = units[units.size() - 1];
                     last = {UnitType::kRefinement, {0xD0}};
                     units.push_back({UnitType::kEnd, {}});
                   })});
  return cases;
}

}  // namespace slf::conformance
