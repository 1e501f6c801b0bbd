// SPDX-License-Identifier: Apache-2.0
// Planes as pictures.
#include "conformance/cases.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

/// Small components: pictures of random samples are large.
Case texture(const char* id, const char* purpose, std::vector<Voxel> voxels, int bits,
             int functions, std::uint32_t step, int texture_bits) {
  Case c = case_of(id, purpose, {"7.6", "8.11"}, field(std::move(voxels), bits, functions, 600),
                   with_steps(functions, step));
  c.parameters.coefficients = CoefficientCoder::kTexture;
  c.parameters.texture.bits = texture_bits;
  c.parameters.texture.qp = 30;
  for (int k = 0; k < functions; ++k) c.parameters.group.push_back(std::min(k, 1));
  return c;
}

void add_pictures(std::vector<Case>& cases) {
  Case intra =
      texture("texture-intra-8", "every plane by itself; cells of two voxels; coarser levels",
              sphere(5), 5, 2, 8, 8);
  for (Voxel& v : intra.field.positions)
    for (auto& c : v) c *= 2;
  intra.field.header.grid.bits = 6;
  intra.parameters.texture.mode = TextureSettings::kIntra;
  intra.levels = {3, 5};
  intra.groups = {1};
  cases.push_back(intra);
  cases.push_back(texture("texture-low-delay-10", "planes predicted from others; loose points",
                          sphere(5, 3), 5, 3, 2, 10));
  Case slices = texture("texture-12", "12 bits; a lone point", sphere(6), 6, 2, 1, 12);
  slices.field = field(sorted([] {
                         auto voxels = sphere(5);
                         voxels.push_back({63, 63, 63});
                         return voxels;
                       }()),
                       6, 2, 600);
  cases.push_back(slices);
}

/// Charts beyond the limit of extent, upright and lying, sparse, and too small.
void add_charts(std::vector<Case>& cases) {
  std::vector<Voxel> shapes;
  for (std::int32_t a = 0; a < 700; ++a)
    for (std::int32_t b = 0; b < 10; ++b) shapes.push_back({3, b, a});
  for (std::int32_t a = 0; a < 61; ++a)
    for (std::int32_t b = 0; b < 7 + a % 5; ++b) shapes.push_back({100 + b, 100 + a, 9});
  for (std::int32_t a = 0; a < 90; ++a) shapes.push_back({300 + a, 300 + a, 400});
  for (std::int32_t a = 0; a < 15; ++a) shapes.push_back({500 + a % 4, 500 + a / 4, 800});
  Case charts = texture("texture-charts", "limits of extent, of cells and of fill; boxes turned",
                        sorted(std::move(shapes)), 10, 1, 4, 8);
  for (std::size_t p = 0; p < charts.field.num_points(); ++p)
    for (std::size_t c = 0; c < 3; ++c)
      charts.field.components[3 * p + c] =
          charts.field.positions[p][c] / 2 + static_cast<std::int32_t>(40 * c);
  cases.push_back(charts);
}

void add_constant(std::vector<Case>& cases) {
  Case constant = texture("texture-constant", "planes without pictures: no HEVC to decode",
                          sphere(4), 4, 2, 1, 8);
  for (std::size_t i = 0; i < constant.field.components.size(); ++i)
    constant.field.components[i] = 1000 - 700 * static_cast<std::int32_t>(i % 6);
  constant.levels = {2};
  cases.push_back(constant);
}

}  // namespace

/// x265 3.5 decides the bytes of all but the last.
std::vector<Case> texture_cases() {
  std::vector<Case> cases;
  add_pictures(cases);
  add_charts(cases);
  add_constant(cases);
  return cases;
}

}  // namespace slf::conformance
