#include "conformance/cases.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

using Strings = std::vector<std::string>;

std::vector<Voxel> lattice(std::int32_t nx, std::int32_t ny, std::int32_t nz) {
  std::vector<Voxel> voxels;
  for (std::int32_t z = 0; z < nz; ++z)
    for (std::int32_t y = 0; y < ny; ++y)
      for (std::int32_t x = 0; x < nx; ++x) voxels.push_back({x, y, z});
  return sorted(voxels);
}

void add_geometry(std::vector<Case>& cases) {
  const auto add = [&](std::string id, std::string purpose, std::vector<Voxel> voxels, int bits) {
    cases.push_back({std::move(id),
                     std::move(purpose),
                     Strings{"7.3", "8.4"},
                     field(std::move(voxels), bits, 0),
                     {},
                     {},
                     {},
                     0,
                     false});
  };
  add("one-point", "smallest light field: no level to code", {{5, 2, 7}}, 3);
  add("two-points-21-bit", "corners of the largest grid",
      {{0, 0, 0}, {(1 << 21) - 1, (1 << 21) - 1, (1 << 21) - 1}}, 21);
  add("full-cube", "every voxel occupied: probabilities near 1", lattice(16, 16, 16), 4);
  add("line", "one row", lattice(256, 1, 1), 8);
  add("plane", "one layer", lattice(64, 64, 1), 6);
  add("scattered", "no structure", scattered(3000, 9, 3), 9);
  add("scattered-21-bit", "history tables are hashed", scattered(400, 21, 4), 21);
  add("sphere-dense", "closed surface", sphere(7), 7);
  add("sphere-thinned", "surface with holes", sphere(7, 3), 7);
}

void add_components(std::vector<Case>& cases) {
  {
    Case c{"two-points",
           "annex B: one merge",
           {"8.6", "8.7.2", "8.8"},
           field({{0, 0, 0}, {1, 1, 1}}, 1, 1),
           with_steps(1, 4),
           {},
           {},
           0,
           false};
    c.field.components = {100, -200, 300, 400, 500, -600};
    cases.push_back(c);
  }
  for (const bool vector : {true, false}) {
    Case c{vector ? "vector" : "independent",
           "three groups, three level ranges",
           {"7.6", vector ? "8.7.2" : "8.7.3", "8.8", "8.9"},
           field(sphere(5), 5, 24),
           with_steps(24, 250),
           {1, 3, 4},
           {1, 2},
           0,
           false};
    c.parameters.coefficients = vector ? CoefficientCoder::kVector : CoefficientCoder::kIndependent;
    for (int k = 0; k < 24; ++k) c.parameters.group.push_back(k == 0 ? 0 : k < 5 ? 1 : 2);
    c.parameters.coefficient_level_ends = {3, 4, 5};
    c.parameters.geometry_level_ends = {3, 5};
    cases.push_back(c);
  }
  for (const bool surface : {true, false}) {
    Case c{surface ? "prediction" : "prediction-full-cube",
           "levels predicted from coarser ones, three groups, several slices",
           {"7.6", "8.7.6", "8.8", "8.9"},
           field(surface ? sphere(5) : lattice(8, 8, 8), surface ? 5 : 3, 12),
           with_steps(12, 40),
           surface ? std::vector<int>{1, 3, 4} : std::vector<int>{1, 2},
           {1, 2},
           0,
           false};
    c.parameters.rdo = surface ? 0.3 : 0;
    for (int k = 0; k < 12; ++k) c.parameters.group.push_back(k == 0 ? 0 : k % 2 + 1);
    c.parameters.coefficient_level_ends =
        surface ? std::vector<int>{3, 4, 5} : std::vector<int>{2, 3};
    c.parameters.max_slice_points = surface ? 800 : 1u << 20;
    cases.push_back(c);
  }
  Case steps{"unequal-steps",
             "steps and shifts per function and channel",
             {"7.2", "8.7.4"},
             field(sphere(5), 5, 4),
             {},
             {},
             {},
             0,
             false};
  steps.parameters.step = {{8, 16, 17}, {9, 9, 9}, {9, 9, 9}, {100, 50, 1}};
  steps.field.header.shift = {6, 6, 5, 0};
  cases.push_back(steps);
  cases.push_back({"large-magnitudes",
                   "escapes of the magnitude code, step 1",
                   {"8.3.4", "8.6.2"},
                   field(sphere(4), 4, 2, 2000000),
                   with_steps(2, 1),
                   {},
                   {},
                   0,
                   false});
  Case zero{"all-zero",
            "components that are all zero",
            {"8.7.2"},
            field(sphere(5), 5, 16),
            with_steps(16, 1),
            {},
            {},
            0,
            false};
  std::fill(zero.field.components.begin(), zero.field.components.end(), 0);
  cases.push_back(zero);
}

void add_transforms(std::vector<Case>& cases) {
  for (const bool joint : {false, true}) {
    Case c{joint ? "transform-joint" : "transform-functions",
           "transforms across planes, of lower rank, over three groups",
           {"7.11", "8.7.5", "8.9"},
           field(sphere(5), 5, 24),
           with_steps(24, 250),
           {3, 4},
           {1, 2},
           0,
           false};
    c.parameters.transform = joint ? TransformMode::kJoint : TransformMode::kFunctions;
    for (int k = 0; k < 24; ++k) c.parameters.group.push_back(k == 0 ? 0 : k < 5 ? 1 : 2);
    c.parameters.coefficient_level_ends = {3, 4, 5};
    c.parameters.max_slice_points = 1500;
    cases.push_back(c);
  }
}

void add_structure(std::vector<Case>& cases) {
  Case slices{"slices",
              "several slices",
              {"7.3", "8.2"},
              field(sphere(6), 6, 3),
              with_steps(3, 32),
              {},
              {},
              0,
              false};
  slices.parameters.max_slice_points = 1500;
  cases.push_back(slices);
  std::vector<Voxel> uneven = sphere(5);
  for (const Voxel& stray :
       {Voxel{100, 3, 90}, Voxel{127, 127, 127}, Voxel{64, 64, 64}, Voxel{65, 64, 64}})
    uneven.push_back(stray);
  Case depths{"slices-of-one-cell",
              "every cell is a slice, those of lone points among them",
              {"7.3", "8.9"},
              field(sorted(uneven), 7, 3),
              with_steps(3, 32),
              {1, 3, 6},
              {},
              0,
              false};
  depths.parameters.base_levels = 3;
  depths.parameters.max_slice_points = 1;
  depths.field.normals.bits = 4;
  for (std::size_t p = 0; p < depths.field.num_points(); ++p)
    depths.field.normals.octahedral.push_back(
        {static_cast<std::uint16_t>(p % 16), static_cast<std::uint16_t>(p / 7 % 16)});
  cases.push_back(depths);
  Case normals{"normals",
               "coded normals, whole and of coarser nodes",
               {"7.5", "8.9", "8.10"},
               field(sphere(5), 5, 1),
               with_steps(1, 16),
               {3},
               {},
               0,
               false};
  normals.field.normals.bits = 7;
  Random random(9);
  std::uint32_t a = 0, b = 0;
  for (std::size_t p = 0; p < normals.field.num_points(); ++p) {
    a = (a + random.below(5)) % 128;
    b = (b + 127 + random.below(3)) % 128;
    normals.field.normals.octahedral.push_back(
        {static_cast<std::uint16_t>(a), static_cast<std::uint16_t>(b)});
  }
  cases.push_back(normals);
  Case basis{"basis",
             "a B-spline light field with every header element in use",
             {"6.3", "7.2"},
             field(sphere(5), 5, 8),
             with_steps(8, 16),
             {},
             {},
             0,
             false};
  basis.field.header.has_basis = true;
  basis.field.header.basis = {BasisId::kBspline, 3, 2, 1};
  basis.field.header.colour = ColourTransform::kOpponent;
  basis.field.header.transfer = Transfer::kLinear;
  basis.field.header.grid = {{-1.5, 2.25, 1e5}, 0.03125, 5};
  basis.field.header.up = UpAxis::kMinusY;
  basis.field.header.right_handed = false;
  basis.field.header.metres_per_unit = 0.01;
  basis.field.header.gamma_min_q7 = -100;
  basis.field.header.gamma_max_q7 = 90;
  basis.parameters.metadata = {{"source", "generated"}, {"note", "größer"}};
  cases.push_back(basis);
  Case harmonics{"harmonics",
                 "spherical harmonics in the reflected frame, a group per degree",
                 {"6.3", "6.4", "7.2"},
                 field(sphere(5), 5, 9),
                 with_steps(9, 16),
                 {},
                 {},
                 0,
                 false};
  harmonics.field.header.has_basis = true;
  harmonics.field.header.basis = {BasisId::kHarmonics, 2, 0, 0, 2};
  harmonics.field.header.frame = FrameId::kReflected;
  harmonics.field.header.normal_cell_log2 = 1;
  harmonics.field.header.colour = ColourTransform::kOpponent;
  harmonics.parameters.group = {0, 1, 1, 1, 2, 2, 2, 2, 2};
  cases.push_back(harmonics);
  Case bare{"no-index-no-digest",
            "only what must be there",
            {"7.1"},
            field(sphere(4), 4, 1),
            with_steps(1, 8),
            {},
            {},
            0,
            false};
  bare.parameters.index = bare.parameters.digest = false;
  cases.push_back(bare);
  bare.id = "unknown-unit";
  bare.purpose = "a unit of a type to come is skipped";
  bare.unknown_unit = true;
  cases.push_back(bare);
  Case draco{"draco", "profile 1", {"8.5"}, field(sphere(6), 6, 1), with_steps(1, 16), {},
             {},      0,           false};
  draco.parameters.geometry = GeometryCoder::kDraco;
  cases.push_back(draco);
}

void add_prefixes(std::vector<Case>& cases) {
  for (const std::size_t units : {2u, 4u, 5u, 7u, 8u}) {
    Case c{"prefix-" + std::to_string(units),
           "a stream cut after " + std::to_string(units) + " units",
           {"7.1", "8.9"},
           field(sphere(5), 5, 4),
           with_steps(4, 16),
           {},
           {},
           units,
           false};
    c.parameters.group = {0, 1, 1, 1};
    c.parameters.geometry_level_ends = {3, 5};
    c.parameters.coefficient_level_ends = {4, 5};
    cases.push_back(c);
  }
}

/// Small components: pictures of random samples are large.
Case texture(const char* id, const char* purpose, std::vector<Voxel> voxels, int bits,
             int functions, std::uint32_t step, int texture_bits) {
  Case c{id,
         purpose,
         {"7.6", "8.11"},
         field(std::move(voxels), bits, functions, 600),
         with_steps(functions, step),
         {},
         {},
         0,
         false};
  c.parameters.coefficients = CoefficientCoder::kTexture;
  c.parameters.texture.bits = texture_bits;
  c.parameters.texture.qp = 30;
  for (int k = 0; k < functions; ++k) c.parameters.group.push_back(std::min(k, 1));
  return c;
}

/// x265 3.5 decides the bytes of all but the last.
void add_textures(std::vector<Case>& cases) {
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
  // Charts beyond the limit of extent, upright and lying, sparse, and too small.
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
  Case constant = texture("texture-constant", "planes without pictures: no HEVC to decode",
                          sphere(4), 4, 2, 1, 8);
  for (std::size_t i = 0; i < constant.field.components.size(); ++i)
    constant.field.components[i] = 1000 - 700 * static_cast<std::int32_t>(i % 6);
  constant.levels = {2};
  cases.push_back(constant);
}

}  // namespace

std::vector<Case> valid_cases() {
  std::vector<Case> cases;
  add_geometry(cases);
  add_components(cases);
  add_transforms(cases);
  add_structure(cases);
  for (Case& scene : scene_cases()) cases.push_back(std::move(scene));
  add_prefixes(cases);
  add_textures(cases);
  return cases;
}

}  // namespace slf::conformance
