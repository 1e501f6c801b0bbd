// SPDX-License-Identifier: Apache-2.0
// What coding Gaussian splats takes: bench_splats FILE [RUNS]. FILE: splats as any program writes
// them. Microseconds a splat of one thread's processor time, the least of RUNS.
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "slf/decoder.h"
#include "slf/encode_gaussians.h"
#include "slf/gaussian_files.h"
#include "slf/settings.h"

namespace {

using namespace slf;

double user_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_utime.tv_sec) + double(usage.ru_utime.tv_usec) * 1e-6;
}

template <class Work>
void keep_least(double& least, Work work) {
  const double start = user_seconds();
  work();
  least = std::min(least, user_seconds() - start);
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 2 ? std::max(std::atoi(argv[2]), 1) : 20;
  const auto given = read_gaussians(argc > 1 ? argv[1] : "");
  if (!given) {
    std::fprintf(stderr, "usage: bench_splats FILE [RUNS]\n");
    return 2;
  }
  EncoderSettings settings;
  settings.threads = 1;
  DecodeOptions options;
  options.threads = 1;
  double encoded = 1e9, decoded = 1e9, shown = 1e9;
  EncodedGaussians coded;
  for (int i = 0; i < runs; ++i) {
    Gaussians splats = given->gaussians;
    keep_least(encoded, [&] {
      if (auto made = encode_gaussians(std::move(splats), settings)) coded = std::move(*made);
    });
    if (coded.splats == 0) return 1;
    keep_least(decoded, [&] { (void)decode(coded.stream, options); });
    const auto field = decode(coded.stream, options);
    if (!field) return 1;
    keep_least(shown, [&] { (void)gaussians_of(*field, 1); });
  }
  const double each = 1e6 / double(coded.splats);
  std::printf("%zu splats of degree %d, %zu bytes: encode %.2f us, decode %.2f, to floats %.2f\n",
              coded.splats, given->gaussians.degree, coded.stream.size(), encoded * each,
              decoded * each, shown * each);
}
