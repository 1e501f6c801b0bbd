// SPDX-License-Identifier: Apache-2.0
#include "attributes/plane_transform.h"

#include "base/multiversion.h"
#include "slf/given_planes.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kPointGrain = 1024;

/// The nearest that 32 bits hold; no encoder makes one that they do not.
std::int32_t clamped(std::int64_t value) {
  constexpr std::int64_t kMost = 0x7FFFFFFF;
  return static_cast<std::int32_t>(std::clamp(value, -kMost, kMost));
}

/// sums[i] += component * column[i]. |component| < 2^31, |column[i]| <= 2^20, at most 2^10 columns
/// (their product with as many rows or more is at most 2^20): below 2^61.
SLF_MULTIVERSION
void add_column(const std::int32_t* column, std::int32_t component, std::int64_t* sums,
                std::size_t rows) {
  for (std::size_t i = 0; i < rows; ++i) sums[i] += std::int64_t{column[i]} * component;
}

std::array<std::int32_t, 3> mix_channels(const PlaneTransform& t, const std::int32_t* v) {
  std::array<std::int32_t, 3> mixed;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& m = t.colour[i];
    mixed[i] = clamped((std::int64_t{m[0]} * v[0] + std::int64_t{m[1]} * v[1] +
                        std::int64_t{m[2]} * v[2] + (1 << (PlaneTransform::kColourBits - 1))) >>
                       PlaneTransform::kColourBits);
  }
  return mixed;
}

}  // namespace

void expand_point(const PlaneTransform& t, const std::int32_t* components, std::int32_t* planes,
                  ExpansionScratch& scratch) {
  const std::size_t rows = t.rows(), per_function = 3 / t.lanes;
  auto& sums = scratch.sums;
  sums.assign(t.lanes * rows, 1 << (PlaneTransform::kFractionBits - 1));
  for (std::size_t r = 0; r < t.components.size(); ++r) {
    const std::int32_t* component = components + std::size_t{3} * t.components[r];
    if ((component[0] | component[1] | component[2]) == 0) continue;  // most
    const auto mixed = t.colour == PlaneTransform::kNoColour
                           ? std::array{component[0], component[1], component[2]}
                           : mix_channels(t, component);
    for (std::size_t c = 0; c < 3; ++c)
      add_column(&t.matrix[(r * per_function + (t.lanes == 3 ? 0 : c)) * rows], mixed[c],
                 &sums[t.lanes == 3 ? c * rows : 0], rows);
  }
  for (std::size_t i = 0; i < t.functions.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      planes[std::size_t{3} * t.functions[i] + c] =
          clamped(sums[t.lanes == 3 ? c * rows + i : 3 * i + c] >> PlaneTransform::kFractionBits);
}

std::vector<std::int32_t> given_planes(const LightField& field, int threads) {
  const LightFieldHeader& header = field.header;
  if (header.coded.empty() && header.transforms.empty()) return field.components;
  const std::size_t row = 3 * static_cast<std::size_t>(header.num_functions),
                    coded = 3 * static_cast<std::size_t>(header.num_components());
  std::vector<std::uint16_t> alone(static_cast<std::size_t>(header.num_components()));
  for (std::size_t r = 0; r < alone.size(); ++r)
    alone[r] = header.coded.empty() ? static_cast<std::uint16_t>(r) : header.coded[r];
  std::vector<std::int32_t> planes(field.num_points() * row);
  parallel_ranges(field.num_points(), kPointGrain, threads,
                  [&](std::size_t begin, std::size_t end) {
                    ExpansionScratch scratch;
                    for (std::size_t p = begin; p < end; ++p) {
                      const std::int32_t* from = &field.components[p * coded];
                      std::int32_t* to = &planes[p * row];
                      for (std::size_t r = 0; r < alone.size(); ++r)
                        std::copy_n(from + 3 * r, 3, to + std::size_t{3} * alone[r]);
                      // A transform writes all of its functions, those too where its components
                      // stand.
                      for (const PlaneTransform& t : header.transforms)
                        expand_point(t, from, to, scratch);
                    }
                  });
  return planes;
}

}  // namespace slf
