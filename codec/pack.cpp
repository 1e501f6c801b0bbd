// The coder's main path, from integers to bytes. Mirrors codec/decode.cpp.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>

#include "attributes/forward_transform.h"
#include "bitstream/index.h"
#include "bitstream/metadata.h"
#include "codec/assemble.h"
#include "codec/decode_cost.h"
#include "codec/derive_transforms.h"
#include "codec/pack_parameters.h"
#include "codec/scene_encoder.h"
#include "codec/sequence.h"
#include "codec/texture_parameters.h"
#include "codec/transform_units.h"
#include "geometry/cell_box.h"
#include "geometry/morton.h"
#include "slf/encoder.h"
#include "slf/parallel.h"
#include "slf/view_map.h"

namespace slf {
namespace {

/// The light field in Morton order, with the codes.
struct SortedField {
  std::vector<std::uint64_t> morton;
  std::vector<Voxel> positions;
  std::vector<std::int32_t> components;
  std::vector<std::array<std::uint16_t, 2>> normals;
};

Result<SortedField, InputError> sort_points(const LightField& field) {
  const std::size_t count = field.num_points(),
                    planes = static_cast<std::size_t>(field.num_planes());
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order(count);
  for (std::size_t i = 0; i < count; ++i)
    order[i] = {morton(field.positions[i]), static_cast<std::uint32_t>(i)};
  std::sort(order.begin(), order.end());
  SortedField sorted;
  sorted.morton.reserve(count);
  sorted.positions.reserve(count);
  sorted.components.reserve(count * planes);
  for (const auto& [code, i] : order) {
    if (!sorted.morton.empty() && sorted.morton.back() == code)
      return InputError{Errc::kInvalidArgument,
                        "positions: point " + std::to_string(i) + " stands where another does"};
    sorted.morton.push_back(code);
    sorted.positions.push_back(field.positions[i]);
    const auto row = field.components.begin() + static_cast<std::ptrdiff_t>(i * planes);
    sorted.components.insert(sorted.components.end(), row,
                             row + static_cast<std::ptrdiff_t>(planes));
    if (field.normals.bits > 0) sorted.normals.push_back(field.normals.octahedral[i]);
  }
  return sorted;
}

/// Base and slices.
Result<std::vector<CodedUnit>, InputError> code_scene(SortedField& sorted,
                                                      const SceneLayout& layout,
                                                      const SliceCoding& coding, int threads) {
  const std::size_t planes = coding.planes();
  std::vector<SliceInput> slices;
  for (const SliceCut& cut : layout.cuts) {
    const std::size_t begin = cut.begin, points = cut.end - begin;
    slices.push_back(
        {std::span(sorted.morton).subspan(begin, points),
         std::span(sorted.positions).subspan(begin, points),
         std::span(sorted.components).subspan(begin * planes, points * planes),
         std::span(sorted.normals)
             .subspan(sorted.normals.empty() ? 0 : begin, sorted.normals.empty() ? 0 : points)});
  }
  return encode_scene(coding, layout, slices, threads);
}

/// What a texture is coded with beside the steps, which have to fit its samples.
Result<Done, InputError> choose_texture(const SortedField& sorted, int bits,
                                        SequenceParameterSet& set) {
  const auto steps = plane_steps(set);
  const auto least = least_texture_steps(sorted.components, steps.size(), bits);
  for (std::size_t j = 0; j < steps.size(); ++j)
    if (steps[j] < least[j])
      return InputError{Errc::kInvalidArgument,
                        "steps: plane " + std::to_string(j) + " of the texture needs at least " +
                            std::to_string(least[j]) + " with " + std::to_string(bits) + " bits"};
  set.sps_texture_cell_log2 = static_cast<std::uint32_t>(
      texture_cell_log2(sorted.morton, static_cast<int>(set.grid_bits())));
  return Done{};
}

/// The given planes [P][3 K] to components [P][3 R].
void find_components(const std::vector<ForwardTransform>& transforms,
                     const std::vector<std::uint16_t>& coded, std::size_t row, int threads,
                     std::vector<std::int32_t>& values) {
  constexpr std::size_t kPointGrain = 256;
  const std::size_t points = values.size() / row, width = 3 * coded.size();
  std::vector<std::int32_t> components(points * width);
  parallel_ranges(points, kPointGrain, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<ComponentFinder> finders(transforms.begin(), transforms.end());
    for (std::size_t p = begin; p < end; ++p) {
      const std::int32_t* planes = &values[p * row];
      for (std::size_t r = 0; r < coded.size(); ++r)  // those of no transform stay
        std::copy_n(planes + std::size_t{3} * coded[r], 3, &components[p * width + 3 * r]);
      for (ComponentFinder& finder : finders) finder.find(planes, &components[p * width]);
    }
  });
  values = std::move(components);
}

/// Transforms across planes where they pay, with their units. Components have the steps of the
/// transform's first function, in whose units they are.
Result<Done, InputError> choose_transforms(const LightField& field, SortedField& sorted,
                                           const SceneLayout& layout, CodingParameters parameters,
                                           SequenceParameterSet& set, SliceCoding& coding,
                                           std::vector<CodedUnit>& units) {
  const LightFieldHeader& header = field.header;
  std::vector<double> weights(set.sps_num_functions, 1);
  if (header.has_basis) weights = basis_norms(header.basis);
  for (std::size_t k = 0; k < weights.size(); ++k)
    weights[k] = std::pow(std::ldexp(weights[k], header.shift.empty() ? 0 : -header.shift[k]), 2);
  auto transforms =
      derive_transforms({sorted.morton, sorted.components, layout.cuts}, coding.groups, weights,
                        coding.steps, parameters.transform, parameters.threads);
  if (transforms.empty()) return Done{};
  parameters.step = function_steps(set);
  std::vector<PlaneTransform> inverse;
  for (const ForwardTransform& transform : transforms) {
    inverse.push_back(transform.inverse);
    for (const std::uint16_t k : transform.inverse.functions)
      parameters.step[k] = parameters.step[transform.inverse.functions[0]];
  }
  SLF_TRY(set, sequence_of(field, parameters));
  set_base(layout, set);
  set.sps_transform_flag = 1;
  set.sps_num_transforms_minus1 = static_cast<std::uint32_t>(transforms.size() - 1);
  for (const ForwardTransform& transform : transforms)
    units.push_back({UnitType::kTransform, write_transform(transform, set.num_groups()), {}});
  coding.matrices.resize(coding.groups.size());
  for (const ForwardTransform& transform : transforms)
    for (std::size_t g = 0; g < coding.groups.size(); ++g)
      if (const auto columns = columns_of_group(transform.inverse, coding.groups, g);
          !columns.empty())
        coding.matrices[g] = write_columns(transform, columns);
  CodedFunctions coded = code_functions(std::move(coding.groups), inverse);
  for (std::size_t i = 0; i < transforms.size(); ++i)
    transforms[i].inverse.components = inverse[i].components;
  find_components(transforms, coded.functions, 3 * weights.size(), parameters.threads,
                  sorted.components);
  coding.groups = std::move(coded.groups);
  const std::vector<std::uint32_t> steps = plane_steps(set);
  coding.steps.clear();
  for (const std::size_t j : planes_of(coded.functions)) coding.steps.push_back(steps[j]);
  return Done{};
}

/// Boxes of the slices' cells.
std::vector<CellBox> boxes_of(const SceneLayout& layout) {
  std::vector<CellBox> boxes;
  if (layout.base_levels == 0) return boxes;
  std::size_t end = 0;
  for (const SliceEntry& slice : layout.table.slices) {
    const std::size_t begin = end;
    end += slice.cells();
    boxes.push_back(box_of_cells(std::span(layout.cells).subspan(begin, end - begin)));
  }
  return boxes;
}

/// Spec 9: zeros before the parts of the scene, where these have more values than bytes allow.
/// Their geometry is enough by itself, or that of the base: what follows may be missing.
void add_filler(std::vector<CodedUnit>& units, const std::vector<CodedUnit>& parts,
                std::uint64_t cells, std::uint64_t points, std::uint64_t planes) {
  std::uint64_t bytes = 0, of_base = 0, all = 0;
  for (const CodedUnit& unit : units) bytes += unit_bytes(unit.payload.size());
  for (const CodedUnit& unit : parts) {
    if (unit.type != UnitType::kGeometry) continue;
    (unit.ids.of_base() ? of_base : all) += unit_bytes(unit.payload.size());
  }
  all += of_base;
  const auto lacking = [&](std::uint64_t rows, std::uint64_t there) {
    const std::uint64_t values = rows * std::max<std::uint64_t>(planes, 1);
    const std::uint64_t least = values / kLevelValuesOfByte + 1 - kLevelValues / kLevelValuesOfByte;
    return values <= kLevelValues || least <= bytes + there ? 0 : least - bytes - there;
  };
  const std::uint64_t filler = std::max(lacking(points + cells, all), lacking(cells, of_base));
  if (filler > 0)
    units.push_back({UnitType::kFiller, std::vector<std::uint8_t>(std::size_t{filler}), {}});
}

}  // namespace

Result<std::vector<std::uint8_t>, InputError> pack(const LightField& field,
                                                   const CodingParameters& parameters) {
  SLF_TRY(SequenceParameterSet set, sequence_of(field, parameters));  // 7.2
  SLF_TRY(SortedField sorted, sort_points(field));                    // 6.2
  SLF_TRY(const SceneLayout layout,
          lay_out(sorted.morton, field.header.grid.bits, parameters));  // 7.3
  set_base(layout, set);
  if (set.has_texture()) SLF_CHECK(choose_texture(sorted, parameters.texture.bits, set));
  SliceCoding coding{
      set,           plane_groups(set), plane_steps(set), parameters.digest, parameters.texture,
      parameters.rdo};
  std::vector<CodedUnit> units;
  if (parameters.transform != TransformMode::kNone && field.header.num_functions > 0)
    SLF_CHECK(choose_transforms(field, sorted, layout, parameters, set, coding, units));  // 7.11
  units.push_back({UnitType::kSlices, write_slice_table(layout.table, set), {}});         // 7.3
  SLF_TRY(auto parts, code_scene(sorted, layout, coding, parameters.threads));  // 8.4 - 8.10
  add_filler(units, parts, layout.base_levels > 0 ? layout.cells.size() : 0, sorted.morton.size(),
             coding.planes());  // 9
  std::move(parts.begin(), parts.end(), std::back_inserter(units));
  if (!parameters.metadata.empty())
    units.push_back({UnitType::kMetadata, write_metadata(parameters.metadata), {}});  // 7.8
  std::optional<std::vector<CellBox>> boxes;
  if (parameters.index) boxes = boxes_of(layout);
  return assemble(set, units, boxes);  // 7.1, 7.7
}

}  // namespace slf
