// SPDX-License-Identifier: Apache-2.0
#include "attributes/plane_transform.h"

#include <numeric>
#include <vector>

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
inline void add_column(const std::int32_t* __restrict column, std::int32_t component,
                       std::int64_t* __restrict sums, std::size_t rows) {
  for (std::size_t i = 0; i < rows; ++i) sums[i] += std::int64_t{column[i]} * component;
}

inline std::array<std::int32_t, 3> mix_channels(const PlaneTransform& t, const std::int32_t* v) {
  std::array<std::int32_t, 3> mixed;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& m = t.colour[i];
    mixed[i] = clamped((std::int64_t{m[0]} * v[0] + std::int64_t{m[1]} * v[1] +
                        std::int64_t{m[2]} * v[2] + (1 << (PlaneTransform::kColourBits - 1))) >>
                       PlaneTransform::kColourBits);
  }
  return mixed;
}

/// The values of the transform's functions at a point, of the components there. Spec 8.7.5.
/// @param components  [R][3] all of the point
/// @param planes      [K][3] receives those of the functions
/// @param sums        room for as many
inline void expand_point(const PlaneTransform& t, const std::int32_t* components,
                         std::int32_t* planes, std::int64_t* sums) {
  const std::size_t rows = t.rows(), per_function = 3 / t.lanes;
  std::fill_n(sums, t.lanes * rows, std::int64_t{1} << (PlaneTransform::kFractionBits - 1));
  for (std::size_t r = 0; r < t.components.size(); ++r) {
    const std::int32_t* component = components + std::size_t{3} * t.components[r];
    if ((component[0] | component[1] | component[2]) == 0) continue;  // most
    const auto mixed = t.colour == PlaneTransform::kNoColour
                           ? std::array{component[0], component[1], component[2]}
                           : mix_channels(t, component);
    for (std::size_t c = 0; c < 3; ++c)
      add_column(&t.matrix[(r * per_function + (t.lanes == 3 ? 0 : c)) * rows], mixed[c],
                 sums + (t.lanes == 3 ? c * rows : 0), rows);
  }
  for (std::size_t i = 0; i < t.functions.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      planes[std::size_t{3} * t.functions[i] + c] =
          clamped(sums[t.lanes == 3 ? c * rows + i : 3 * i + c] >> PlaneTransform::kFractionBits);
}

/// Points of a light field, from coded functions to all.
struct Expansion {
  const std::vector<PlaneTransform>& transforms;
  std::vector<std::uint16_t> coded;  // [R] function of each component, where no transform has it
  std::size_t row;                   // planes of a point
};

/// sums: [row]
SLF_MULTIVERSION_LANES
void expand_points(const Expansion& of, const std::int32_t* components, std::int32_t* planes,
                   std::size_t points, std::int64_t* sums) {
  for (; points > 0; --points, components += 3 * of.coded.size(), planes += of.row) {
    for (std::size_t r = 0; r < of.coded.size(); ++r)
      std::copy_n(components + 3 * r, 3, planes + std::size_t{3} * of.coded[r]);
    // A transform writes all of its functions, those too where its components stand.
    for (const PlaneTransform& t : of.transforms) expand_point(t, components, planes, sums);
  }
}

}  // namespace

std::vector<std::int32_t> given_planes(const LightField& field, int threads) {
  const LightFieldHeader& header = field.header;
  if (header.coded.empty() && header.transforms.empty()) return field.components;
  Expansion of{header.transforms, header.coded, 3 * static_cast<std::size_t>(header.num_functions)};
  if (of.coded.empty()) {
    of.coded.resize(static_cast<std::size_t>(header.num_components()));
    std::iota(of.coded.begin(), of.coded.end(), std::uint16_t{0});
  }
  std::vector<std::int32_t> planes(field.num_points() * of.row);
  parallel_ranges(field.num_points(), kPointGrain, threads,
                  [&](std::size_t begin, std::size_t end) {
                    std::vector<std::int64_t> sums(of.row);
                    expand_points(of, field.components.data() + begin * 3 * of.coded.size(),
                                  planes.data() + begin * of.row, end - begin, sums.data());
                  });
  return planes;
}

}  // namespace slf
