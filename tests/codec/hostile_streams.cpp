// SPDX-License-Identifier: Apache-2.0
// Streams made to hurt: few bytes that ask for much memory, or time, or for the reader's terminal.
// hostile_streams DIRECTORY writes them; those to be refused are in DIRECTORY/refused. Made anew
// for every version of the format, so that they get as far as they can.
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>

#include "bitstream/bit_writer.h"
#include "bitstream/slice_headers.h"
#include "bitstream/unchecked_headers.h"
#include "conformance/edit_units.h"
#include "conformance/fields.h"
#include "slf/capture.h"
#include "slf/encoder.h"

namespace slf {
namespace {

using conformance::Bytes;
using conformance::EditableUnit;
using Units = std::vector<EditableUnit>;

/// side^3 points, `spacing` voxels apart.
std::vector<Voxel> lattice(std::int32_t side, std::int32_t spacing) {
  std::vector<Voxel> voxels;
  for (std::int32_t z = 0; z < side; ++z)
    for (std::int32_t y = 0; y < side; ++y)
      for (std::int32_t x = 0; x < side; ++x)
        voxels.push_back({x * spacing, y * spacing, z * spacing});
  return voxels;
}

LightField field_of(std::vector<Voxel> voxels, int bits, int functions) {
  LightField field;
  field.header.grid = {{0, 0, 0}, 1, bits};
  field.header.has_basis = false;
  field.header.num_functions = functions;
  field.positions = std::move(voxels);
  field.components.assign(field.num_points() * 3 * static_cast<std::size_t>(functions), 7);
  return field;
}

CodingParameters plain(int functions) {
  CodingParameters parameters;
  parameters.step.assign(static_cast<std::size_t>(functions), {1, 1, 1});
  parameters.index = parameters.digest = false;
  parameters.base_levels = 0;
  parameters.max_slice_points = kMostSlicePoints;
  return parameters;
}

Bytes cube(std::int32_t side, int bits, int functions, std::int32_t spacing = 1) {
  return *pack(field_of(lattice(side, spacing), bits, functions), plain(functions));
}

void set_points(Units& units, std::uint32_t points) {
  conformance::edit_sequence(units, [](auto& s) { s.sps_level = 0; });  // which has no limit
  const auto set = *parse_sequence_parameter_set(units[0].payload);
  auto& payload = conformance::first_of(units, UnitType::kSlices).payload;
  SliceTable table = *parse_slice_table(payload, set);
  table.slices[0].slice_num_points_minus1 = points - 1;
  payload = slice_table_as_is(table, set);
}

/// The header byte of a part, and nothing behind it.
void empty_geometry(Units& units) {
  conformance::first_of(units, UnitType::kGeometry).payload.resize(1);
}

/// A stream that ends behind the first unit of a type.
Bytes ends_with(const Bytes& stream, UnitType type) {
  const auto units = *split_units(stream);
  for (const Unit& unit : units.units)
    if (unit.type == type)
      return {stream.begin(),
              stream.begin() + static_cast<std::ptrdiff_t>(unit.offset + unit.bytes)};
  return stream;
}

/// Many functions of a cube, of which no unit says anything.
Bytes many_values(int bits, std::uint32_t functions) {
  return conformance::edited(cube(1 << bits, bits, 1), [&](Units& units) {
    auto set = *parse_sequence_parameter_set(units[0].payload);
    set.sps_num_functions = functions;
    set.runs[0].sps_run_length_minus1 = functions - 1;
    units[0].payload = sequence_as_is(set);
    std::erase_if(units, [](const EditableUnit& u) { return u.type == UnitType::kFiller; });
    auto& coefficients = conformance::first_of(units, UnitType::kCoefficients).payload;
    coefficients.resize(std::size_t{set.sps_prediction_flag ? 1u : 0u} + 1);
  });
}

Bytes late_damage() {
  return conformance::edited(cube(32, 5, 8), [](Units& units) {
    auto& coefficients = conformance::first_of(units, UnitType::kCoefficients).payload;
    coefficients.insert(coefficients.end(), 40, 0x55);
  });
}

/// Draco's header with other attributes: Draco takes memory by them before it looks for points.
Bytes draco_attributes(std::uint8_t components, std::uint8_t type) {
  CodingParameters parameters = plain(0);
  parameters.geometry = GeometryCoder::kDraco;
  const auto packed = pack(field_of(lattice(4, 1), 6, 0), parameters);
  if (!packed) return {};
  return conformance::edited(*packed, [&](Units& units) {
    set_points(units, kMaxSlicePoints);
    auto& payload = conformance::first_of(units, UnitType::kGeometry).payload;
    constexpr std::size_t kDraco = 1;  // behind level_range and slice_id
    for (std::size_t i = 0; i < 4; ++i)
      payload[kDraco + 11 + i] = static_cast<std::uint8_t>(kMaxSlicePoints >> (8 * i));
    payload[kDraco + 18] = type;
    payload[kDraco + 19] = components;
  });
}

/// Metadata that steers a terminal: ESC sequences, C1 in UTF-8 and as a byte, a right-to-left turn.
Bytes steering_metadata() {
  CodingParameters parameters = plain(0);
  parameters.metadata = {{"\x1b]0;owned\x07", "\x1b[2J\x1b[31m"},
                         {"c1\xc2\x9b",
                          "\xc2\x9b"
                          "31mred"},
                         {"turn\xe2\x80\xae", "\xe2\x80\xaetxt.exe"}};
  return *pack(field_of(lattice(2, 1), 1, 0), parameters);
}

/// A dense cube beside points that are far apart, with a colour: one cell size does not do.
Bytes cluster(std::int32_t side, std::int32_t far, std::int32_t spacing, int bits) {
  std::vector<Voxel> voxels = lattice(side, 1);
  for (const Voxel& v : lattice(far, spacing))
    if (v[0] >= side || v[1] >= side || v[2] >= side) voxels.push_back(v);
  LightField field = field_of(std::move(voxels), bits, 1);
  field.header.has_basis = true;
  field.header.basis.id = BasisId::kHarmonics;
  field.header.basis.degree = 0;
  return *pack(field, plain(1));
}

Bytes normals_of_nothing() {
  LightField field = field_of(lattice(2, 1), 1, 0);
  field.normals.bits = 5;
  field.normals.octahedral.assign(field.num_points(), {3, 3});
  return ends_with(*pack(field, plain(0)), UnitType::kSequence);
}

/// A few points with a colour, on a grid of which floats hold nothing, or too much.
Bytes far_grid(double origin, double step, Transfer transfer) {
  LightField field = field_of(lattice(4, 1), 3, 4);
  field.header.grid = {{origin, origin, 0}, step, 3};
  field.header.has_basis = true;
  field.header.basis.scales_theta = field.header.basis.scales_gamma = 1;
  field.header.transfer = transfer;
  field.header.shift.assign(4, 0);
  return *pack(field, plain(4));
}

/// Filler units of 6 bytes before the end.
Bytes many_units(std::size_t count) {
  return conformance::edited(cube(2, 1, 1), [&](Units& units) {
    units.insert(units.end() - 1, count, {UnitType::kFiller, {}});
  });
}

/// An index of filler units that are not there: the stream was cut behind it.
Bytes many_entries(std::size_t count) {
  BitWriter out;
  out.ue(count);
  for (std::size_t i = 0; i < count; ++i) {
    out.u(8, static_cast<std::uint64_t>(UnitType::kFiller));
    out.ue(6);
  }
  out.u(1, 0);
  Bytes stream = ends_with(cube(2, 1, 1), UnitType::kSequence);
  append_unit(stream, UnitType::kIndex, out.take());
  return stream;
}

struct Hostile {
  const char* name;
  bool refused;
  std::function<Bytes()> make;
};

const std::vector<Hostile> kStreams = {
    {"points-4M-empty-geometry", true,
     [] {
       return conformance::edited(cube(2, 1, 0), [](Units& units) {
         set_points(units, kMaxSlicePoints);
         empty_geometry(units);
       });
     }},
    {"points-4M-empty-geometry-cut", true,
     [] {
       return ends_with(conformance::edited(cube(2, 21, 1),
                                            [](Units& units) {
                                              set_points(units, kMaxSlicePoints);
                                              empty_geometry(units);
                                            }),
                        UnitType::kGeometry);
     }},
    {"values-1024-functions", true, [] { return many_values(5, 1024); }},
    {"values-1024-functions-cut", true,
     [] { return ends_with(many_values(5, 1024), UnitType::kCoefficients); }},
    {"values-late-damage", true, [] { return late_damage(); }},
    {"draco-255-doubles", true, [] { return draco_attributes(255, 10); }},
    {"draco-4M-points", true, [] { return draco_attributes(3, 6); }},
    {"points-4M-no-geometry", false,
     [] {
       return ends_with(
           conformance::edited(cube(2, 1, 1),
                               [](Units& units) { set_points(units, kMaxSlicePoints); }),
           UnitType::kSlices);
     }},
    {"octree-deep", false, [] { return cube(32, 21, 0, 1 << 16); }},
    {"steering-metadata", false, [] { return steering_metadata(); }},
    {"normals-of-nothing", false, [] { return normals_of_nothing(); }},
    {"units-300k", false, [] { return many_units(300000); }},
    {"index-300k", false, [] { return many_entries(300000); }},
    {"cluster", false, [] { return cluster(32, 32, 1 << 10, 15); }},
};

struct FarGrid {
  const char* name;
  double origin, step;
};

constexpr FarGrid kFarGrids[] = {
    {"origin-1e38", 1e38, 1e38},      {"step-1e20", 0, 1e20},        {"step-1e150", 0, 1e150},
    {"origin-1e39", 1e39, 1e37},      {"step-1e-150", 0, 1e-150},    {"origin-1e300", 1e300, 1},
    {"origin-1e308", 1.7e308, 1e307}, {"step-most", 1e12, 1e12 / 8}, {"step-least", 0, 1e-12},
    {"origin-most", -1e12, 1e-12},    {"step-1e-300", 1, 1e-300}};

int write_grids(const std::filesystem::path& directory) {
  std::filesystem::create_directories(directory);
  for (const FarGrid& grid : kFarGrids)
    for (const Transfer transfer : {Transfer::kDisplay, Transfer::kLinear}) {
      const Bytes stream = far_grid(grid.origin, grid.step, transfer);
      const char* suffix = transfer == Transfer::kLinear ? "-linear.slf" : ".slf";
      if (!write_file(directory / (grid.name + std::string(suffix)), stream.data(), stream.size()))
        return 1;
    }
  return 0;
}

int write_all(const std::filesystem::path& directory) {
  std::filesystem::create_directories(directory / "refused");
  for (const Hostile& hostile : kStreams) {
    const Bytes stream = hostile.make();
    if (stream.empty()) continue;  // this build has no Draco
    const auto file = (hostile.refused ? directory / "refused" : directory) /
                      (std::string(hostile.name) + ".slf");
    if (!write_file(file, stream.data(), stream.size())) return 1;
    std::printf("%s: %zu bytes\n", hostile.name, stream.size());
  }
  return write_grids(directory / "grids");
}

}  // namespace
}  // namespace slf

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  return slf::write_all(argv[1]);
}
