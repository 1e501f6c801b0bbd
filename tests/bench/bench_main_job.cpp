// SPDX-License-Identifier: Apache-2.0
// The main job, timed by stage, and the presets beside each other: bench_main_job CAPTURE
// [GRID_BITS [SPLIT]]
//
// Times: encode once per row on all cores, decode and render as medians of five; decode on one
// thread. PSNR of pictures on held-out and input cameras, then (p.) of points.
#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>

#include "slf/decoder.h"
#include "slf/encoder.h"
#include "slf/evaluate.h"
#include "slf/render.h"
#include "tests/bench/stopwatch.h"

namespace {

using namespace slf;

struct Job {
  Capture capture;
  std::vector<int> input, held_out;
};

Result<Job, InputError> load(const char* path, const char* split) {
  Job job;
  SLF_TRY(job.capture, load_capture(path));
  SLF_TRY(job.input, split_cameras(job.capture, split));
  SLF_TRY(job.held_out, split_cameras(job.capture, "evaluation"));
  return job;
}

double peak_gib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / (1 << 20);
}

Result<Done, InputError> print_row(const Job& job, Preset preset, int bits, double q) {
  EncoderSettings settings = settings_of(preset);
  settings.grid_bits = bits;
  settings.q = q;
  SLF_TRY(const Encoded encoded, encode(job.capture, job.input, settings));
  const double decode_seconds = bench::median_seconds(5, [&] { (void)decode(encoded.stream); });
  const auto field = decode(encoded.stream);
  if (!field) return InputError{field.error().code, to_string(field.error())};
  const ViewMaps maps(*field);
  const Renderer renderer(maps);
  const double render_seconds =
      bench::median_seconds(5, [&] { (void)renderer.render(renderer.orbit(0.1, 20, 800, 800)); });
  SLF_TRY(const Quality seen, evaluate(maps, job.capture, job.input, {}));
  SLF_TRY(const Quality unseen, evaluate(maps, job.capture, job.held_out, {}));
  const double encode_seconds = encoded.seconds_voxelise + encoded.seconds_observe +
                                encoded.seconds_choose + encoded.seconds_fit +
                                encoded.seconds_pictures + encoded.seconds_code;
  std::printf(
      "%-8s %4g %9zu %7.2f %7.2f %7.2f %7.2f | %6.2f %6.2f %6.2f %6.2f %6.2f | %7.3f %7.3f | "
      "%5.2f\n",
      preset == Preset::kPaper ? "paper" : "default", q, encoded.stream.size(), unseen.image.psnr,
      seen.image.psnr, unseen.points[0].psnr, seen.points[0].psnr, encode_seconds,
      encoded.seconds_observe, encoded.seconds_fit, encoded.seconds_pictures, encoded.seconds_code,
      decode_seconds, render_seconds, peak_gib());
  std::fflush(stdout);
  return Done{};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_main_job CAPTURE [GRID_BITS [SPLIT]]\n");
    return 2;
  }
  const int bits = argc > 2 ? std::atoi(argv[2]) : 9;
  const auto job = load(argv[1], argc > 3 ? argv[3] : "");
  if (!job) {
    std::fprintf(stderr, "bench_main_job: %s\n", job.error().message.c_str());
    return 1;
  }
  std::printf("%s, %zu input and %zu held-out cameras, %d bits\n", argv[1], job->input.size(),
              job->held_out.size(), bits);
  std::printf("%-8s %4s %9s %7s %7s %7s %7s | %6s %6s %6s %6s %6s | %7s %7s | %5s\n", "preset", "Q",
              "bytes", "held", "input", "p.held", "p.input", "encode", "obs", "fit", "pics", "code",
              "decode1", "render", "GiB");
  for (const Preset preset : {Preset::kDefault, Preset::kPaper})
    for (const double q : {8.0, 16.0, 32.0})
      if (const auto done = print_row(*job, preset, bits, q); !done) {
        std::fprintf(stderr, "bench_main_job: %s\n", done.error().message.c_str());
        return 1;
      }
}
