// SPDX-License-Identifier: Apache-2.0
#include "encoder/frames_to_bitrate.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "encoder/rate_control.h"

namespace slf {
namespace {

constexpr double kTolerance = 0.03;     // of the rate that may be left
constexpr std::size_t kSample = 4;      // frames that tell what the others will take
constexpr double kFactorOfWhole = 1.1;  // from the step that the sample tells to the next

/// The sequence, coded with one step.
struct Run {
  EncodedFrames encoded;
  std::vector<std::vector<std::uint8_t>> frames;
  double bytes = 0;
};

Result<Run, InputError> run(const RateJob& job, double q, std::size_t first, std::size_t count) {
  Run coded;
  const auto keep = [&](std::size_t, std::span<const std::uint8_t> bytes) {
    coded.frames.emplace_back(bytes.begin(), bytes.end());
    coded.bytes += static_cast<double>(bytes.size());
    return Result<Done, InputError>(Done{});
  };
  SLF_CHECK(job.code(q, first, count, keep, coded.encoded));
  return coded;
}

/// Bytes of all frames, if those that are predicted take what those of the sample take.
double expected_bytes(const RateJob& job, const Run& sample) {
  const auto group = static_cast<std::size_t>(job.frames.group);
  double intra = 0, num_intra = 0;
  for (const EncodedFrame& frame : sample.encoded.frames) {
    if (frame.predicted) continue;
    intra += static_cast<double>(frame.bytes);
    ++num_intra;
  }
  const double predicted = sample.bytes - intra,
               num_predicted = static_cast<double>(sample.frames.size()) - num_intra;
  const std::size_t num_groups = (job.length + group - 1) / group;
  const auto groups = static_cast<double>(num_groups);
  return groups * intra / num_intra +
         (static_cast<double>(job.length) - groups) * predicted / std::max(num_predicted, 1.0);
}

/// Is a run better than another, where neither need be within the goal? Most bytes within the rate
/// come before fewest bytes beyond it.
bool is_better(const Run& a, const Run& b, double most) {
  if (b.frames.empty()) return true;
  const bool fits = a.bytes <= most;
  if (fits != (b.bytes <= most)) return fits;
  return fits ? a.bytes > b.bytes : a.bytes < b.bytes;
}

}  // namespace

Result<Done, InputError> code_to_bitrate(const RateJob& job, const TakeFrame& take,
                                         EncodedFrames& encoded) {
  const double most = job.bitrate / 8 * static_cast<double>(job.length) / job.frames.rate;
  const StepGoal goal{std::log(most * (1 - kTolerance)), std::log(most)};
  double guess = job.guess, factor = kFactorOfWhole;
  if (job.length > job.chooser + 2 * kSample) {
    const auto measure_sample = [&](double q) -> Result<double, InputError> {
      SLF_TRY(const Run sample, run(job, q, job.chooser, kSample));
      return std::log(expected_bytes(job, sample));
    };
    SLF_TRY(const StepFound found, find_step(guess, goal, measure_sample));
    guess = found.q;
  } else {
    factor = 4;
  }
  Run best;
  const auto measure = [&](double q) -> Result<double, InputError> {
    SLF_TRY(Run whole, run(job, q, 0, job.length));
    const double bytes = whole.bytes;
    if (is_better(whole, best, most)) best = std::move(whole);
    return std::log(bytes);
  };
  SLF_TRY(const StepFound found, find_step(guess, goal, measure, factor));
  for (std::size_t f = 0; f < best.frames.size(); ++f) SLF_CHECK(take(f, best.frames[f]));
  encoded = std::move(best.encoded);
  if (!found.reached)
    encoded.warnings.push_back("no step gives 97 to 100 % of " +
                               std::to_string(std::llround(job.bitrate)) + " bits a second: Q " +
                               std::to_string(encoded.q) + " gives " +
                               std::to_string(std::llround(best.bytes / most * job.bitrate)));
  return Done{};
}

}  // namespace slf
