// The coder's main path, from integers to bytes. Mirrors codec/decode.cpp.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>

#include "bitstream/index.h"
#include "bitstream/metadata.h"
#include "codec/assemble.h"
#include "codec/pack_parameters.h"
#include "codec/scene_encoder.h"
#include "codec/scene_frame.h"
#include "codec/sequence.h"
#include "codec/texture_parameters.h"
#include "codec/use_transforms.h"
#include "geometry/morton.h"
#include "slf/encoder.h"

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
  SLF_TRY(ChosenTransforms chosen,
          choose_transforms(field, {sorted.morton, sorted.components, layout.cuts}, layout,
                            parameters, set, coding, units));  // 7.11
  if (!chosen.transforms.empty()) sorted.components = std::move(chosen.components);
  units.push_back({UnitType::kSlices, write_slice_table(layout.table, set), {}});  // 7.3
  SLF_TRY(auto parts, code_scene(sorted, layout, coding, parameters.threads));     // 8.4 - 8.10
  std::move(parts.begin(), parts.end(), std::back_inserter(units));
  if (!parameters.metadata.empty())
    units.push_back({UnitType::kMetadata, write_metadata(parameters.metadata), {}});  // 7.8
  std::optional<std::vector<CellBox>> boxes;
  if (parameters.index) boxes = boxes_of(layout);
  return assemble(set, units, boxes);  // 7.1, 7.7
}

}  // namespace slf
