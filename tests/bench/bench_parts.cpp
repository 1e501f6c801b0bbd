// SPDX-License-Identifier: Apache-2.0
// What parts of a file cost beside the whole: bench_parts FILE.slf [RUNS]
//
// For every number of levels, some of groups, and two regions (cubes around a point on the object,
// half and a tenth as wide as it): points and bytes that come out, user seconds (the least of RUNS,
// one thread) and their share of the whole's, and the peak memory of a process that
// decodes once beside 1.5 times the output and 64 MiB.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "slf/decoder.h"
#include "slf/encoder.h"
#include "tests/bench/stopwatch.h"

namespace {

using namespace slf;

/// What a child process says of its decodes.
struct Cost {
  double points = 0, bytes = 0, seconds = 1e9, peak = 0;
};

double user_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_utime.tv_sec) + double(usage.ru_utime.tv_usec) * 1e-6;
}

double output_bytes(const LightField& field) {
  return double(field.positions.size() * sizeof(Voxel) +
                field.components.size() * sizeof(std::int32_t) +
                field.normals.octahedral.size() * sizeof(field.normals.octahedral[0]));
}

/// A process of its own, so that its peak is that of this decode.
Cost measure(const std::vector<std::uint8_t>& stream, const DecodeOptions& options, int runs) {
  int ends[2];
  Cost cost;
  if (pipe(ends) != 0) return cost;
  const pid_t child = fork();
  if (child == 0) {
    for (int i = 0; i < runs; ++i) {
      const double start = user_seconds();
      const auto field = decode(stream, options);
      cost.seconds = std::min(cost.seconds, user_seconds() - start);
      if (!field) continue;
      cost.points = double(field->num_points());
      cost.bytes = output_bytes(*field);
    }
    _exit(write(ends[1], &cost, sizeof cost) == sizeof cost ? 0 : 1);
  }
  close(ends[1]);
  const bool told = child > 0 && read(ends[0], &cost, sizeof cost) == sizeof cost;
  close(ends[0]);
  rusage usage{};
  if (child > 0) wait4(child, nullptr, 0, &usage);
  cost.peak = told ? double(usage.ru_maxrss) * 1024 : 0;
  return cost;
}

void print_row(const std::string& part, const Cost& cost, double whole) {
  constexpr double kMiB = 1 << 20;
  std::printf("%-18s %9.0f %9.1f %8.3f %6.1f %% %9.1f %9.1f\n", part.c_str(), cost.points,
              cost.bytes / kMiB, cost.seconds, 100 * cost.seconds / whole, cost.peak / kMiB,
              1.5 * cost.bytes / kMiB + 64);
}

/// The positions alone, as a file of their own.
Cost geometry_alone(const std::vector<std::uint8_t>& stream, int runs) {
  auto field = decode(stream);
  if (!field) return {};
  field->header.num_functions = 0;
  field->header.has_basis = false;
  field->header.coded.clear();
  field->header.transforms.clear();
  field->header.shift.clear();
  field->components.clear();
  field->normals = {};
  const auto packed = pack(*field, {});
  *field = {};
  return packed ? measure(*packed, {}, runs) : Cost{};
}

/// The point in the middle of the coding order, and the longest side of the points' box, to a 256th
/// of the grid: what a decode of all of them leaves on the heap would count for the children.
struct Middle {
  Voxel point{};
  double side = 0;
};

Middle middle_of(const std::vector<std::uint8_t>& stream, int bits) {
  DecodeOptions options;
  options.levels = std::min(bits, 8);
  const auto field = decode(stream, options);
  if (!field || field->positions.empty()) return {};
  const std::int32_t cells = 1 << (bits - options.levels);
  Middle middle;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto along = [axis](const Voxel& a, const Voxel& b) { return a[axis] < b[axis]; };
    const auto [low, high] =
        std::minmax_element(field->positions.begin(), field->positions.end(), along);
    middle.side = std::max(middle.side, double((*high)[axis] - (*low)[axis] + 1) * cells);
    middle.point[axis] = field->positions[field->positions.size() / 2][axis] * cells;
  }
  return middle;
}

VoxelBox cube_around(const Middle& middle, double share) {
  const auto half = std::int32_t(std::lround(middle.side * share / 2));
  VoxelBox cube{middle.point, middle.point};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cube.low[axis] -= half;
    cube.high[axis] += half;
  }
  return cube;
}

}  // namespace

int main(int argc, char** argv) {
  const auto bytes =
      argc > 1
          ? read_file(argv[1])
          : Result<std::vector<std::uint8_t>, InputError>(InputError{Errc::kInvalidArgument, ""});
  const int runs = argc > 2 ? std::max(std::atoi(argv[2]), 1) : 5;
  if (!bytes) {
    std::fprintf(stderr, "usage: bench_parts FILE.slf [RUNS]\n");
    return 2;
  }
  const auto info = read_info(*bytes);
  if (!info) return 1;
  std::printf("%-18s %9s %9s %8s %8s %9s %9s\n", "part", "points", "out MiB", "user s", "share",
              "peak MiB", "limit MiB");
  const Cost whole = measure(*bytes, {}, runs);
  print_row("whole", whole, whole.seconds);
  print_row("geometry alone", geometry_alone(*bytes, runs), whole.seconds);
  DecodeOptions options;
  for (options.groups = 1; options.groups < info->num_groups; ++options.groups)
    print_row("groups " + std::to_string(options.groups), measure(*bytes, options, runs),
              whole.seconds);
  options.groups = 0;
  const int bits = info->header.grid.bits;
  for (options.levels = bits - 1; options.levels >= 1 && options.levels > bits - 6;
       --options.levels)
    print_row("levels " + std::to_string(options.levels), measure(*bytes, options, runs),
              whole.seconds);
  options.levels = bits - 1;
  options.groups = info->num_groups > 0 ? 1 : 0;
  print_row("levels -1, group 0", measure(*bytes, options, runs), whole.seconds);
  options = {};
  for (const int share : {50, 25, 10}) {
    options.max_bytes = bytes->size() * static_cast<std::uint64_t>(share) / 100;
    print_row("first " + std::to_string(share) + " %", measure(*bytes, options, runs),
              whole.seconds);
  }
  options = {};
  const Middle middle = middle_of(*bytes, bits);
  for (const double share : {0.5, 0.1}) {
    options.region = cube_around(middle, share);
    print_row("cube of " + std::string(share == 0.5 ? "half" : "a tenth"),
              measure(*bytes, options, runs), whole.seconds);
  }
}
