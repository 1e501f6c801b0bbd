// SPDX-License-Identifier: Apache-2.0
// What it costs to decode a file again and again while it arrives: bench_arrival FILE.slf [GROWTH
// [FIRST [RUNS]]]. It is pulled when FIRST bytes have come (4096), and whenever there are GROWTH
// times as many (2) as at the pull before. Of each pull: bytes, points, milliseconds of a processor
// (the least of RUNS, one thread), how many of them are geometry's, and their share of a decode of
// the whole.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>

#include "slf/frame_reader.h"

namespace {

using namespace slf;

struct Pull {
  double points = 0, seconds = 1e9, geometry = 0;
};

double processor_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

Pull pull(FrameReader& reader, int runs) {
  Pull least;
  for (int run = 0; run < runs; ++run) {
    DecodeSeconds took;
    DecodeOptions options;
    options.seconds = &took;
    if (!reader.set_options(options)) continue;
    const double begin = processor_seconds();
    const auto field = reader.decode(0);
    const double seconds = processor_seconds() - begin;
    if (field && seconds < least.seconds)
      least = {double(field->num_points()), seconds,
               seconds * took.geometry / (took.geometry + took.coefficients)};
  }
  return least;
}

void print(std::size_t bytes, const Pull& p, double whole) {
  std::printf("%9zu %9.0f %8.1f %8.1f %8.2f\n", bytes, p.points, 1e3 * p.seconds, 1e3 * p.geometry,
              p.seconds / whole);
}

}  // namespace

int main(int argc, char** argv) {
  std::ifstream in(argc > 1 ? argv[1] : "", std::ios::binary);
  const std::vector<std::uint8_t> file((std::istreambuf_iterator<char>(in)), {});
  const double growth = argc > 2 ? std::atof(argv[2]) : 2;
  const auto first = argc > 3 ? static_cast<std::size_t>(std::atoll(argv[3])) : 4096;
  const int runs = argc > 4 ? std::max(std::atoi(argv[4]), 1) : 5;
  auto all = FrameReader::open(), reader = FrameReader::open();
  if (growth <= 1 || !all->push(file) || !all->finish() || all->frames().size() != 1) {
    std::fprintf(stderr, "usage: bench_arrival FILE.slf [GROWTH [FIRST [RUNS]]], not of frames\n");
    return 2;
  }
  const Pull whole = pull(*all, runs);
  std::printf("%9s %9s %8s %8s %8s\n", "bytes", "points", "ms", "geometry", "share");
  double sum = 0, geometry = 0;
  std::size_t arrived = 0;
  for (double look = double(first); look < double(file.size()); look *= growth) {
    const auto piece = std::span(file).subspan(arrived, static_cast<std::size_t>(look) - arrived);
    if (!reader->push(piece)) return 1;
    arrived += piece.size();
    if (reader->frames().empty()) continue;
    const Pull p = pull(*reader, runs);
    print(arrived, p, whole.seconds);
    sum += p.seconds;
    geometry += p.geometry;
  }
  print(file.size(), whole, whole.seconds);
  std::printf("all pulls and the whole: %.2f decodes, geometry of pulls %.2f\n",
              1 + sum / whole.seconds, geometry / whole.seconds);
}
