// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/match_exposure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/stopwatch.h"
#include "capture/quantile.h"
#include "encoder/fit/sampled_sight.h"

namespace slf {
namespace {

// Measured: docs/decisions/033-photograph-exposure.md.
constexpr double kLeastDifference = 0.04;  // of most pairs, log
constexpr double kMostLeft = 0.5;          // of it, with gains
constexpr std::size_t kLeastPairs = 3;     // for each photograph: of fewer, gains explain anything

constexpr double kMostCompared = 600'000;  // observations, about: bounds time and memory
constexpr double kPullToOne = 0.003;       // to gain 1, of the weight of a camera's pairs
constexpr double kDisagreeing = 0.03;      // log: residual that halves a pair's weight
constexpr int kRoundsOfWeights = 6, kSolverSteps = 400;
constexpr double kMostLog = 1.4;  // gains stay within a factor of 4

using Logs = std::vector<std::array<double, 3>>;

/// Squared mean over channels of what is left of a pair.
double left_of(const ExposurePair& pair, const Logs& logs) {
  double squares = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double left = pair.log_ratio[k] + logs[pair.b][k] - logs[pair.a][k];
    squares += left * left;
  }
  return std::sqrt(squares / 3);
}

double median_left(const std::vector<ExposurePair>& pairs, const Logs& logs) {
  std::vector<double> left;
  for (const ExposurePair& pair : pairs) left.push_back(left_of(pair, logs));
  return left.empty() ? 0 : median(std::move(left));
}

/// Conjugate gradients on the graph of cameras, Jacobi preconditioned; one channel.
class PairSystem {
 public:
  PairSystem(const std::vector<ExposurePair>& pairs, std::vector<double> weight,
             std::size_t cameras)
      : pairs_(pairs), weight_(std::move(weight)), diagonal_(cameras, 1e-9), pull_(cameras) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      pull_[pairs[i].a] += kPullToOne * pairs[i].weight;
      pull_[pairs[i].b] += kPullToOne * pairs[i].weight;
      diagonal_[pairs[i].a] += weight_[i];
      diagonal_[pairs[i].b] += weight_[i];
    }
    for (std::size_t c = 0; c < cameras; ++c) diagonal_[c] += pull_[c];
  }

  void solve(std::size_t channel, Logs& logs) const {
    const std::size_t n = diagonal_.size();
    std::vector<double> x(n), r(n), z(n), p(n), q(n);
    for (std::size_t c = 0; c < n; ++c) x[c] = logs[c][channel];
    apply(x, q);
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const double pushed = weight_[i] * pairs_[i].log_ratio[channel];
      r[pairs_[i].a] += pushed;
      r[pairs_[i].b] -= pushed;
    }
    double rz = 0;
    for (std::size_t c = 0; c < n; ++c) {
      r[c] -= q[c];
      p[c] = z[c] = r[c] / diagonal_[c];
      rz += r[c] * z[c];
    }
    for (int step = 0; step < kSolverSteps && rz > 1e-18; ++step) {
      apply(p, q);
      double pq = 0, next = 0;
      for (std::size_t c = 0; c < n; ++c) pq += p[c] * q[c];
      for (std::size_t c = 0; c < n; ++c) {
        x[c] += rz / pq * p[c];
        r[c] -= rz / pq * q[c];
        z[c] = r[c] / diagonal_[c];
        next += r[c] * z[c];
      }
      for (std::size_t c = 0; c < n; ++c) p[c] = z[c] + next / rz * p[c];
      rz = next;
    }
    for (std::size_t c = 0; c < n; ++c) logs[c][channel] = x[c];
  }

 private:
  void apply(const std::vector<double>& x, std::vector<double>& out) const {
    for (std::size_t c = 0; c < x.size(); ++c) out[c] = (pull_[c] + 1e-9) * x[c];
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      const double flow = weight_[i] * (x[pairs_[i].a] - x[pairs_[i].b]);
      out[pairs_[i].a] += flow;
      out[pairs_[i].b] -= flow;
    }
  }

  const std::vector<ExposurePair>& pairs_;
  std::vector<double> weight_, diagonal_, pull_;
};

/// Logs of gains, mean 0 over the cameras that have pairs.
Logs solved(const std::vector<ExposurePair>& pairs, std::size_t cameras) {
  Logs logs(cameras);
  for (int round = 0; round < kRoundsOfWeights; ++round) {
    std::vector<double> weight;
    for (const ExposurePair& pair : pairs) {
      const double left = round == 0 ? 0 : left_of(pair, logs) / kDisagreeing;
      weight.push_back(pair.weight / (1 + left * left));
    }
    const PairSystem system(pairs, std::move(weight), cameras);
    for (std::size_t k = 0; k < 3; ++k) system.solve(k, logs);
  }
  std::vector<char> used(cameras);
  for (const ExposurePair& pair : pairs) used[pair.a] = used[pair.b] = 1;
  const auto count = double(std::count(used.begin(), used.end(), 1));
  for (std::size_t k = 0; k < 3 && count > 0; ++k) {
    double mean = 0;
    for (std::size_t c = 0; c < cameras; ++c) mean += used[c] ? logs[c][k] / count : 0;
    for (std::size_t c = 0; c < cameras; ++c)
      logs[c][k] = used[c] ? std::clamp(logs[c][k] - mean, -kMostLog, kMostLog) : 0;
  }
  return logs;
}

/// Some of the points of observations, so that there are kMostCompared at most.
Observations thinned(Observations seen) {
  const auto every = std::size_t(std::ceil(double(seen.camera.size()) / kMostCompared));
  if (every < 2) return seen;
  Observations some;
  some.first.push_back(0);
  for (std::size_t p = 0; p + 1 < seen.first.size(); p += every) {
    for (auto i = seen.first[p]; i < seen.first[p + 1]; ++i) {
      some.direction.push_back(seen.direction[i]);
      some.colour.push_back(seen.colour[i]);
      some.camera.push_back(seen.camera[i]);
    }
    some.first.push_back(some.camera.size());
  }
  return some;
}

}  // namespace

ExposureReport exposure_gains(const std::vector<ExposurePair>& pairs, std::size_t cameras) {
  ExposureReport report;
  report.pairs = pairs.size();
  if (pairs.empty()) return report;
  const Logs logs = solved(pairs, cameras);
  report.differ = median_left(pairs, Logs(cameras));
  report.differ_matched = median_left(pairs, logs);
  for (const auto& log : logs)
    report.gains.push_back(
        {float(std::exp(log[0])), float(std::exp(log[1])), float(std::exp(log[2]))});
  return report;
}

bool gains_pay(const ExposureReport& report) {
  const auto compared =
      std::count_if(report.gains.begin(), report.gains.end(), [](const std::array<float, 3>& g) {
        return g != std::array<float, 3>{1, 1, 1};
      });
  return report.pairs >= kLeastPairs * std::size_t(compared) && report.differ > kLeastDifference &&
         report.differ_matched < kMostLeft * report.differ;
}

Result<ExposureReport, InputError> match_exposure(const Capture& capture,
                                                  std::span<const int> cameras, MatchExposure mode,
                                                  int threads) {
  ExposureReport report;
  if (mode == MatchExposure::kOff || cameras.size() < 2 || capture.cloud.positions.empty())
    return report;
  Stopwatch watch;
  SLF_TRY(Observations seen, sampled_sight(capture, capture.cloud, cameras, threads));
  if (seen.first.size() < 2) return report;
  const auto pairs = exposure_pairs(thinned(std::move(seen)));
  report = exposure_gains(pairs, capture.cameras.size());
  if (mode == MatchExposure::kAuto && !gains_pay(report)) report.gains.clear();
  report.seconds = watch.lap();
  return report;
}

}  // namespace slf
