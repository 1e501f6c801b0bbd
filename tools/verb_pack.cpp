// SPDX-License-Identifier: Apache-2.0
// slf pack: given integers to bytes, without any fit. For research, golden encodes, comparisons.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <set>

#include "slf/encoder.h"
#include "tools/describe.h"
#include "tools/npy.h"
#include "tools/options.h"
#include "tools/output.h"
#include "tools/setting_options.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

/// The settings of slf encode that code given integers.
const std::set<std::string> kCoding = {"geometry",    "coefficients", "klt",
                                       "predict",     "rdo",          "quality-layers",
                                       "base-levels", "slice-points", "slice-start"};

struct PackOptions {
  std::string positions, components, output, steps, groups;
  int grid_bits = 0;
  std::uint32_t step = 1;
  GivenSettings coding;  ///< those of slf encode that code given integers
  std::vector<int> levels;
  bool index = false, no_index = false, no_digest = false;
  CommonOptions common;
};

Failure invalid(const std::string& file, const std::string& cause) {
  return {kInputInvalid, input_name(file) + ": " + cause};
}

Result<NpyArray, Failure> read_npy(const std::string& file) {
  SLF_TRY(auto bytes, from(input_name(file), read_file(file)));
  return from(input_name(file), parse_npy(std::move(bytes)));
}

/// Integers of an array whose shape is [rows], or [rows, 3] ... as `fits` says.
Result<std::vector<std::int32_t>, Failure> read_integers(const std::string& file,
                                                         std::vector<std::size_t>& shape) {
  SLF_TRY(const NpyArray array, read_npy(file));
  shape = array.shape;
  return from(input_name(file), int32_values(array));
}

Result<std::vector<Voxel>, Failure> ply_positions(const std::string& file, bool quiet) {
  std::vector<std::string> warnings;
  SLF_TRY(const PointCloud cloud, from(file, read_ply(file, &warnings)));
  warn(warnings, quiet);
  std::vector<Voxel> positions;
  positions.reserve(cloud.positions.size());
  for (const auto& p : cloud.positions) {
    Voxel v{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = cloud.origin[k] + double{p[k]};
      if (!(x >= 0 && x < 1 << 21) || x != std::floor(x))
        return invalid(file,
                       "coordinates are not whole numbers of 0 to 2^21 - 1 (slf encode voxelises)");
      v[k] = static_cast<std::int32_t>(x);
    }
    positions.push_back(v);
  }
  return positions;
}

Result<std::vector<Voxel>, Failure> read_positions(const std::string& file, bool quiet) {
  if (file.size() > 4 && file.compare(file.size() - 4, 4, ".ply") == 0)
    return ply_positions(file, quiet);
  std::vector<std::size_t> shape;
  SLF_TRY(const auto values, read_integers(file, shape));
  if (shape.size() != 2 || shape[1] != 3)
    return invalid(file, "positions are not an array [points, 3]");
  std::vector<Voxel> positions(shape[0]);
  if (!values.empty())
    std::memcpy(positions.data(), values.data(), values.size() * sizeof(std::int32_t));
  return positions;
}

Outcome read_components(const std::string& file, LightField& field) {
  std::vector<std::size_t> shape;
  SLF_TRY(field.components, read_integers(file, shape));
  if (shape.size() != 3 || shape[0] != field.num_points() || shape[2] != 3 || shape[1] > 4096)
    return invalid(file, "components are not an array [points, functions up to 4096, 3]");
  field.header.num_functions = static_cast<int>(shape[1]);
  return Done{};
}

Outcome read_steps(const PackOptions& given, std::size_t functions, CodingParameters& parameters) {
  parameters.step.assign(functions, {given.step, given.step, given.step});
  if (given.steps.empty()) return Done{};
  std::vector<std::size_t> shape;
  SLF_TRY(const auto values, read_integers(given.steps, shape));
  const bool one = shape == std::vector<std::size_t>{functions};
  if (!one && shape != std::vector<std::size_t>{functions, 3})
    return invalid(given.steps, "steps are not an array [functions] or [functions, 3]");
  for (std::size_t k = 0; k < functions; ++k)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::int32_t step = values[one ? k : 3 * k + c];
      if (step < 1 || step > CodingParameters::kMostStep)
        return invalid(given.steps, "a step is not in the range 1 to 2^27 - 1");
      parameters.step[k][c] = static_cast<std::uint32_t>(step);
    }
  return Done{};
}

Outcome read_groups(const PackOptions& given, std::size_t functions, CodingParameters& parameters) {
  if (given.groups.empty()) return Done{};
  std::vector<std::size_t> shape;
  SLF_TRY(parameters.group, read_integers(given.groups, shape));
  if (shape != std::vector<std::size_t>{functions})
    return invalid(given.groups, "groups are not an array [functions]");
  return Done{};
}

/// What the largest coordinate needs, at least 1.
int bits_of(const std::vector<Voxel>& positions) {
  std::int32_t largest = 1;
  for (const Voxel& v : positions)
    largest = std::max(largest, *std::max_element(v.begin(), v.end()));
  return static_cast<int>(std::bit_width(static_cast<std::uint32_t>(largest)));
}

/// Without a transform, unless one is asked for.
Result<EncoderSettings, Failure> coding_settings(const PackOptions& given) {
  GivenSettings all = given.coding;
  if (std::none_of(all.begin(), all.end(), [](const auto& s) { return s.first == "klt"; }))
    all.emplace_back("klt", "off");
  auto settings = settings_from(all);
  if (!settings) return Failure{kUsage, "pack: " + settings.error().message};
  return *std::move(settings);
}

Result<CodingParameters, Failure> coding_parameters(const PackOptions& given,
                                                    const LightField& field) {
  const auto functions = static_cast<std::size_t>(field.header.num_functions);
  SLF_TRY(const EncoderSettings coding, coding_settings(given));
  CodingParameters parameters = coding_parameters(coding);
  SLF_CHECK(read_steps(given, functions, parameters));
  SLF_CHECK(read_groups(given, functions, parameters));
  const auto ends = given.levels.empty() ? level_ends(field.header.grid.bits) : given.levels;
  if (coding.coefficients != CoefficientCoder::kTexture) parameters.coefficient_level_ends = ends;
  if (coding.geometry == GeometryCoder::kOctree) parameters.geometry_level_ends = ends;
  parameters.digest = !given.no_digest;
  parameters.index = given.index || (functions > 0 && !given.no_index);
  parameters.threads = given.common.threads;
  return parameters;
}

/// The options have passed their ranges, but not whether they go with the data. What is refused
/// begins with its name.
Failure refused(const PackOptions& given, const InputError& error) {
  if (error.code != Errc::kInvalidArgument) return failure_of(error, input_name(given.positions));
  const std::string& cause = error.message;
  if (cause.starts_with("positions")) return invalid(given.positions, cause);
  if (cause.starts_with("components")) return invalid(given.components, cause);
  if (cause.starts_with("groups") || cause.starts_with("sps_plane_group"))
    return invalid(given.groups, cause);
  const bool steps = cause.starts_with("steps") || cause.starts_with("sps_plane_step");
  if (steps && !given.steps.empty()) return invalid(given.steps, cause);
  const bool levels = cause.find("level ends: ") != std::string::npos ||
                      cause.find("_range_end: ") != std::string::npos;
  return {kUsage, (levels ? "pack: --levels: " : "pack: ") + cause};
}

nlohmann::ordered_json packed_json(const LightField& field, std::uint64_t bytes, double seconds) {
  return {{"bytes", bytes},
          {"points", field.num_points()},
          {"functions", field.header.num_functions},
          {"grid_bits", field.header.grid.bits},
          {"bits_per_point", bits_per_point(bytes, field.num_points())},
          {"seconds", seconds}};
}

Outcome run_pack(const PackOptions& given) {
  if (given.common.json && given.output == "-")
    return Failure{kUsage, "pack: --json and --output - both want standard output"};
  SLF_CHECK(check_output(given.output, "pack", std::array{".slf"}));
  LightField field;
  field.header.has_basis = false;
  field.header.up = UpAxis::kUnknown;
  SLF_TRY(field.positions, read_positions(given.positions, given.common.quiet));
  if (!given.components.empty()) SLF_CHECK(read_components(given.components, field));
  if (bits_of(field.positions) > 21)
    return invalid(given.positions, "positions: a coordinate is not in the range 0 to 2^21 - 1");
  field.header.grid.bits = given.grid_bits > 0 ? given.grid_bits : bits_of(field.positions);
  SLF_TRY(const CodingParameters parameters, coding_parameters(given, field));
  Stopwatch watch;
  const auto packed = pack(field, parameters);
  const double seconds = watch.lap();
  if (!packed) return refused(given, packed.error());
  SLF_CHECK(save(given.output, packed->data(), packed->size()));
  if (given.common.json) return print(packed_json(field, packed->size(), seconds));
  if (!given.common.quiet)
    std::fprintf(stderr, "%s points, %d functions: %s bytes, %.3f bits per point, %.3f s\n",
                 grouped(field.num_points()).c_str(), field.header.num_functions,
                 grouped(packed->size()).c_str(),
                 bits_per_point(packed->size(), field.num_points()), seconds);
  return Done{};
}

}  // namespace

void add_pack(CLI::App& program, Run& run) {
  auto* verb =
      program.add_subcommand("pack", "Code given integers (.npy), without cameras or a fit");
  auto o = std::make_shared<PackOptions>();
  verb->add_option(
          "POSITIONS", o->positions,
          "positions.npy, integers [P,3], each 0 to 2^21 - 1, no duplicates; or a .ply with "
          "such coordinates; - is standard input (.npy)")
      ->type_name("")
      ->required();
  verb->add_option(
      "COMPONENTS", o->components,
      "components.npy, integers [P,K,3], in the order of POSITIONS. None: geometry alone");
  verb->add_option("-o,--output", o->output, "The .slf file; - is standard output")
      ->type_name("FILE")
      ->required();
  verb->add_option("--grid-bits", o->grid_bits,
                   "Bits per axis, 1 to 21; 0: what the largest coordinate needs")
      ->capture_default_str()
      ->check(whole_range(0, 21));
  auto* step =
      verb->add_option(
              "--step", o->step,
              "Quantiser step of every plane, component units; 1 is lossless up to rounding")
          ->capture_default_str()
          ->check(whole_range(1, CodingParameters::kMostStep));
  verb->add_option("--steps", o->steps,
                   "Steps of each function, .npy [K] or [K,3], each 1 to 2^27 - 1")
      ->type_name("FILE")
      ->excludes(step);
  verb->add_option("--groups", o->groups,
                   "Plane group of each function, .npy [K], 0 to 15, none empty")
      ->type_name("FILE");
  add_settings(*verb, o->coding, [](const SettingInfo& setting) {
    return setting.group.starts_with("Texture") || kCoding.contains(setting.name);
  });
  verb->get_option("--klt")->default_str("off");
  verb->add_option("--levels", o->levels,
                   "Octree levels at which units end, ascending, the last the grid's bits; "
                   "default: the last "
                   "three, e.g. 6,7,8")
      ->delimiter(',')
      ->check(whole_range(1, 21));
  auto* index =
      verb->add_flag("--index", o->index, "Write the index unit (default with COMPONENTS)");
  verb->add_flag("--no-index", o->no_index, "Leave out the index unit")->excludes(index);
  verb->add_flag("--no-digest", o->no_digest, "Leave out the digest units (SHA-256)");
  add_threads(*verb, o->common);
  add_quiet(*verb, o->common);
  add_json(*verb, o->common);
  verb->callback([&run, o] { run = [o] { return run_pack(*o); }; });
}

}  // namespace slf::tools
