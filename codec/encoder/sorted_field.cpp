// SPDX-License-Identifier: Apache-2.0
#include "codec/encoder/sorted_field.h"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>

#include "base/release.h"
#include "geometry/morton.h"

namespace slf {

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

Result<SortedField, InputError> take_points(LightField& field) {
  SortedField sorted;
  sorted.morton.reserve(field.num_points());
  for (const Voxel& v : field.positions) sorted.morton.push_back(morton(v));
  const bool in_order = std::adjacent_find(sorted.morton.begin(), sorted.morton.end(),
                                           std::greater_equal<>()) == sorted.morton.end();
  if (!in_order) {
    SLF_TRY(sorted, sort_points(field));
  } else {
    sorted.components = std::move(field.components);
    if (field.normals.bits > 0) sorted.normals = std::move(field.normals.octahedral);
    sorted.positions = std::move(field.positions);
  }
  release(field.positions);
  release(field.components);
  release(field.normals.octahedral);
  return sorted;
}

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

}  // namespace slf
