// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/camera_agreement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

#include "base/error_sum.h"
#include "lightfield/directions.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kPatchPoints = 64;
constexpr std::size_t kLeastPatches = 60, kMostPatches = 120;
constexpr double kPairs = 2.5e7;            // about so many are looked at, kLeastPatches apart
constexpr double kLeastPoints = 21;         // of a patch that a camera sees
constexpr double kLeastContrast = 6;        // grey levels rms of a pattern
constexpr double kNoise = 2;                // grey levels rms that a camera's own pattern may lack
constexpr double kMostDifference = 48;      // grey levels; greater ones count as that
constexpr double kTrim = 0.8;               // share of the squared differences, the smallest
constexpr double kDark = 8, kBright = 247;  // grey levels between which ratios are taken
const double kNearest = std::pow(3 * std::numbers::pi / 180, 2);  // squared radians

/// Values of one patch, or of all, for one camera.
struct Samples {
  std::vector<std::array<double, 2>> pattern, peer_pattern;  ///< luma: own, predicted
  std::vector<float> own_loss, neighbour_loss;
  std::array<std::vector<float>, 3> log_gain;
  std::vector<float> mean_log_gain;
  std::vector<float> correlation, peer_correlation;
};

/// What the cameras see of one point.
class PointViews {
 public:
  PointViews(const Observations& seen, const std::vector<CameraState>& states, std::size_t point) {
    for (auto i = seen.first[point]; i < seen.first[point + 1]; ++i) {
      const CameraState& state = states[seen.camera[i]];
      if (state.dropped) continue;
      Vec3 colour{};
      bool clipped = false;
      for (std::size_t k = 0; k < 3; ++k) {
        clipped |= seen.colour[i][k] >= kClipped;
        colour[k] = double(seen.colour[i][k]) * double(state.gain[k]);
      }
      if (state.corrected && clipped) continue;
      camera_.push_back(seen.camera[i]);
      colour_.push_back(colour);
      directions_.push_back(vector_of(seen.direction[i]));
    }
    weigh();
  }

  std::size_t size() const { return camera_.size(); }
  std::size_t camera(std::size_t i) const { return camera_[i]; }
  const Vec3& colour(std::size_t i) const { return colour_[i]; }
  double weight(std::size_t i, std::size_t j) const { return weight_[i * size() + j]; }
  /// Share of j among all that predict i.
  double share(std::size_t i, std::size_t j) const { return weight(i, j) / sum_[i]; }

  Vec3 predicted(std::size_t i) const { return scaled(weighted_[i], 1 / sum_[i]); }
  /// Without j; nothing where nothing of weight is left.
  std::optional<Vec3> predicted_without(std::size_t i, std::size_t j) const {
    const double w = weight(i, j), left = sum_[i] - w;
    if (!(left > 1e-9 * sum_[i])) return std::nullopt;
    Vec3 sum = weighted_[i];
    for (std::size_t k = 0; k < 3; ++k) sum[k] -= w * colour_[j][k];
    return scaled(sum, 1 / left);
  }

 private:
  static Vec3 scaled(const Vec3& v, double by) { return {v[0] * by, v[1] * by, v[2] * by}; }

  void weigh() {
    const std::size_t n = size();
    weight_.assign(n * n, 0);
    sum_.assign(n, 0);
    weighted_.assign(n, Vec3{});
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        if (i == j) continue;
        const Vec3 &a = directions_[i], &b = directions_[j];
        // Squared chord, the squared angle where it is small.
        const double apart =
            std::max(0.0, 2 - 2 * (a[0] * b[0] + a[1] * b[1] + a[2] * b[2])) + kNearest;
        const double w = 1 / (apart * apart);
        weight_[i * n + j] = w;
        sum_[i] += w;
        for (std::size_t k = 0; k < 3; ++k) weighted_[i][k] += w * colour_[j][k];
      }
  }

  std::vector<std::size_t> camera_;
  std::vector<Vec3> colour_, directions_, weighted_;
  std::vector<double> weight_, sum_;
};

double loss(const Vec3& a, const Vec3& b) {
  double squares = 0;
  for (std::size_t k = 0; k < 3; ++k) squares += (a[k] - b[k]) * (a[k] - b[k]);
  return std::min(squares / 3, kMostDifference * kMostDifference);
}

void add_gain(const Vec3& own, const Vec3& predicted, Samples& samples) {
  std::array<float, 3> logs{};
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(own[k] > kDark && own[k] < kBright && predicted[k] > kDark && predicted[k] < kBright))
      return;
    logs[k] = static_cast<float>(std::log(predicted[k] / own[k]));
  }
  for (std::size_t k = 0; k < 3; ++k) samples.log_gain[k].push_back(logs[k]);
  samples.mean_log_gain.push_back((logs[0] + logs[1] + logs[2]) / 3);
}

/// Observation i of a point, to the samples of its camera.
void add_view(const PointViews& views, std::size_t i, Samples& samples) {
  const Vec3 predicted = views.predicted(i);
  double of_neighbours = 0, weights = 0;
  std::size_t peer = i == 0 ? 1 : 0;
  for (std::size_t j = 0; j < views.size(); ++j) {
    if (j == i) continue;
    if (views.weight(i, j) > views.weight(i, peer)) peer = j;
    const auto without = views.predicted_without(j, i);
    if (!without) continue;
    of_neighbours += views.share(i, j) * loss(views.colour(j), *without);
    weights += views.share(i, j);
  }
  if (!(weights > 0)) return;
  samples.own_loss.push_back(static_cast<float>(loss(views.colour(i), predicted)));
  samples.neighbour_loss.push_back(static_cast<float>(of_neighbours / weights));
  samples.pattern.push_back({luma(views.colour(i)), luma(predicted)});
  if (const auto without = views.predicted_without(peer, i))
    samples.peer_pattern.push_back({luma(views.colour(peer)), luma(*without)});
  add_gain(views.colour(i), predicted, samples);
}

/// Correlation of pairs (own, predicted); nothing where the prediction has no pattern.
std::optional<float> correlation(const std::vector<std::array<double, 2>>& pairs) {
  const auto count = static_cast<double>(pairs.size());
  if (count < kLeastPoints) return std::nullopt;
  double mean_own = 0, mean_predicted = 0;
  for (const auto& [own, predicted] : pairs) {
    mean_own += own / count;
    mean_predicted += predicted / count;
  }
  double own_squares = 0, predicted_squares = 0, products = 0;
  for (const auto& [own, predicted] : pairs) {
    own_squares += (own - mean_own) * (own - mean_own);
    predicted_squares += (predicted - mean_predicted) * (predicted - mean_predicted);
    products += (own - mean_own) * (predicted - mean_predicted);
  }
  if (predicted_squares < count * kLeastContrast * kLeastContrast) return std::nullopt;
  return static_cast<float>(products /
                            std::sqrt((own_squares + count * kNoise * kNoise) * predicted_squares));
}

/// One patch: [cameras].
std::vector<Samples> look_at_patch(const Observations& seen, std::size_t patch,
                                   const std::vector<CameraState>& states) {
  std::vector<Samples> samples(states.size());
  const std::size_t end = std::min(seen.first.size() - 1, (patch + 1) * kPatchPoints);
  for (std::size_t p = patch * kPatchPoints; p < end; ++p) {
    const PointViews views(seen, states, p);
    if (views.size() < 3) continue;
    for (std::size_t i = 0; i < views.size(); ++i) add_view(views, i, samples[views.camera(i)]);
  }
  for (Samples& s : samples) {
    if (const auto own = correlation(s.pattern)) s.correlation.push_back(*own);
    if (const auto peer = correlation(s.peer_pattern)) s.peer_correlation.push_back(*peer);
  }
  return samples;
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

double quantile(std::vector<float> values, double at) {
  if (values.empty()) return 0;
  const auto rank = static_cast<std::ptrdiff_t>(at * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return static_cast<double>(values[static_cast<std::size_t>(rank)]);
}

double trimmed_mean(std::vector<float> values) {
  std::sort(values.begin(), values.end());
  const auto kept = static_cast<std::size_t>(kTrim * static_cast<double>(values.size()));
  double sum = 0;
  for (std::size_t i = 0; i < kept; ++i) sum += static_cast<double>(values[i]);
  return kept > 0 ? sum / static_cast<double>(kept) : 0;
}

CameraAgreement summary(const Samples& s) {
  CameraAgreement result;
  result.patches = s.correlation.size();
  result.agreement = quantile(s.correlation, 0.75);
  result.peer_agreement = quantile(s.peer_correlation, 0.75);
  // A grey level of noise: nothing is exact.
  result.colour_ratio = trimmed_mean(s.own_loss) / (trimmed_mean(s.neighbour_loss) + 1);
  for (std::size_t k = 0; k < 3; ++k) result.log_gain[k] = quantile(s.log_gain[k], 0.5);
  result.log_gain_spread = quantile(s.mean_log_gain, 0.75) - quantile(s.mean_log_gain, 0.25);
  result.gain_samples = s.mean_log_gain.size();
  return result;
}

}  // namespace

std::vector<std::size_t> choose_patches(const Observations& seen) {
  const std::size_t points = seen.first.size() - 1;
  const std::size_t patches = (points + kPatchPoints - 1) / kPatchPoints;
  double pairs = 1;
  for (std::size_t p = 0; p < points; ++p) {
    const auto views = static_cast<double>(seen.first[p + 1] - seen.first[p]);
    pairs += views * views;
  }
  const double of_patch = pairs / static_cast<double>(std::max<std::size_t>(patches, 1));
  const double wanted = std::clamp(kPairs / of_patch, double{kLeastPatches}, double{kMostPatches});
  const auto stride = std::max<std::size_t>(1, patches / static_cast<std::size_t>(wanted));
  std::vector<std::size_t> chosen;
  for (std::size_t patch = stride / 2; patch < patches; patch += stride) chosen.push_back(patch);
  return chosen;
}

std::vector<CameraAgreement> camera_agreement(const Observations& seen,
                                              const std::vector<std::size_t>& patches,
                                              const std::vector<CameraState>& states, int threads) {
  std::vector<std::vector<Samples>> of_patch(patches.size());
  parallel_ranges(patches.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) of_patch[i] = look_at_patch(seen, patches[i], states);
  });
  std::vector<CameraAgreement> result(states.size());
  for (std::size_t camera = 0; camera < states.size(); ++camera) {
    Samples all;
    for (const auto& samples : of_patch) {
      const Samples& s = samples[camera];
      append(all.own_loss, s.own_loss);
      append(all.neighbour_loss, s.neighbour_loss);
      for (std::size_t k = 0; k < 3; ++k) append(all.log_gain[k], s.log_gain[k]);
      append(all.mean_log_gain, s.mean_log_gain);
      append(all.correlation, s.correlation);
      append(all.peer_correlation, s.peer_correlation);
    }
    result[camera] = summary(all);
  }
  return result;
}

}  // namespace slf
