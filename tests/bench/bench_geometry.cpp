// SPDX-License-Identifier: Apache-2.0
// Lossless geometry of voxel clouds, whole file counted: bench_geometry CLOUD.ply ...
//
// Prints bytes, bits per point and times beside Draco's in the same run and, for the clouds TMC13
// was measured on, its position bytes (v23.0-rc2, the better of planar off and on; research notes,
// g-pcc 3a).
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>

#include "slf/decoder.h"
#include "slf/encoder.h"
#include "tests/bench/stopwatch.h"

namespace {

using namespace slf;

const std::map<std::string, int> kTmc13Bytes = {{"can8tilt", 6593},       {"die8", 4192},
                                                {"can10sparse", 76159},   {"dragonv9", 90155},
                                                {"blender_can_8", 18634}, {"blender_can_9", 30225}};

/// Integer coordinates as they stand; duplicates merged.
Result<LightField, InputError> integer_field(const std::filesystem::path& file) {
  SLF_TRY(const PointCloud cloud, read_ply(file));
  float most = 1;
  for (const auto& p : cloud.positions) most = std::max({most, p[0], p[1], p[2]});
  const int bits = static_cast<int>(std::floor(std::log2(most))) + 1;
  // The corners fix origin and step, so that a voxel is its own coordinate.
  PointCloud cornered = cloud;
  cornered.normals.clear();
  cornered.colours.clear();
  const auto side = static_cast<float>((1 << bits) - 1);
  cornered.positions.push_back({0, 0, 0});
  cornered.positions.push_back({side, side, side});
  SLF_TRY(const VoxelCloud with_corners, voxelise(cornered, bits));
  LightField field;
  field.header.grid = {{0, 0, 0}, 1, bits};
  field.header.has_basis = false;
  for (const Voxel& v : with_corners.positions) {
    const bool corner =
        v == Voxel{0, 0, 0} || v == Voxel{(1 << bits) - 1, (1 << bits) - 1, (1 << bits) - 1};
    if (!corner) field.positions.push_back(v);
  }
  return field;
}

struct Row {
  std::size_t bytes = 0;
  double encode = 0, decode = 0;
  bool lossless = false;
};

Row measure(const LightField& field, GeometryCoder coder) {
  CodingParameters parameters;
  parameters.geometry = coder;
  parameters.index = parameters.digest = false;
  parameters.threads = 1;
  Row row;
  const auto stream = pack(field, parameters);
  if (!stream) return row;
  row.bytes = stream->size();
  row.encode = bench::median_seconds(3, [&] { (void)pack(field, parameters); });
  row.decode = bench::median_seconds(
      3, [&] { row.lossless = decode(*stream)->positions == field.positions; });
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  std::printf("%-16s %8s | %8s %6s %7s %7s | %8s %7s %7s | %8s %7s\n", "cloud", "points", "slf B",
              "bpp", "enc s", "dec s", "Draco B", "enc s", "dec s", "TMC13 B", "slf");
  double ratio = 0;
  int compared = 0;
  for (int i = 1; i < argc; ++i) {
    const std::filesystem::path file = argv[i];
    const auto field = integer_field(file);
    if (!field) {
      std::fprintf(stderr, "bench_geometry: %s\n", field.error().message.c_str());
      return 1;
    }
    const Row ours = measure(*field, GeometryCoder::kOctree),
              draco = measure(*field, GeometryCoder::kDraco);
    std::printf("%-16s %8zu | %8zu %6.3f %7.3f %7.3f | %8zu %7.3f %7.3f |", file.stem().c_str(),
                field->num_points(), ours.bytes,
                8.0 * static_cast<double>(ours.bytes) / static_cast<double>(field->num_points()),
                ours.encode, ours.decode, draco.bytes, draco.encode, draco.decode);
    if (const auto known = kTmc13Bytes.find(file.stem().string()); known != kTmc13Bytes.end()) {
      const double change = static_cast<double>(ours.bytes) / known->second - 1;
      std::printf(" %8d %+6.1f%%", known->second, 100 * change);
      ratio += change;
      ++compared;
    }
    std::printf("%s\n", ours.lossless ? "" : "  NOT LOSSLESS");
  }
  if (compared > 0) std::printf("mean against TMC13: %+.1f %%\n", 100 * ratio / compared);
}
