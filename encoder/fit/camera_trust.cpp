// SPDX-License-Identifier: Apache-2.0
#include "slf/camera_trust.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <utility>

#include "capture/quantile.h"
#include "encoder/fit/camera_agreement.h"
#include "encoder/fit/local_observations.h"

namespace slf {
namespace {

// Measured on four captures, 12 to 125 cameras: those that belong have 0.88 or more of their peers'
// agreement, those turned by a degree or with another picture 0.65 or less, or colours that differ
// 16 times as much.
constexpr double kLeastShare = 0.65;         // of the peers' agreement that is enough
constexpr double kLeastPeerAgreement = 0.7;  // of peers that can be judged by
constexpr std::size_t kEnoughPatches = 24;   // that have a pattern; of fewer, chance decides
constexpr double kMostColourRatio = 16;      // 7.4 at most of cameras that belong: highlights
constexpr std::size_t kEnoughColours = 12;   // cameras: of fewer, which lie far apart, one that
                                             // belongs had more than 16
constexpr double kLeastLogGain = 0.08, kLeastGainOverSpread = 0.6;
constexpr std::size_t kLeastGainSamples = 100;
constexpr double kMostClipped = 0.5, kMostClippedOfOthers = 0.25;
constexpr std::size_t kLeastTrustedCameras = 4;
constexpr double kLeastSupport = 0.4;  // agreement of the median camera with the others

/// One of each camera that sees anything, ascending, with what of it is clipped.
std::vector<CameraTrust> cameras_that_see(const Observations& seen) {
  std::vector<double> clipped, all;
  for (std::size_t i = 0; i < seen.camera.size(); ++i) {
    const std::size_t camera = seen.camera[i];
    if (camera >= all.size()) {
      all.resize(camera + 1);
      clipped.resize(camera + 1);
    }
    const auto& c = seen.colour[i];
    clipped[camera] += std::max({c[0], c[1], c[2]}) >= kClipped ? 1 : 0;
    ++all[camera];
  }
  std::vector<CameraTrust> trust;
  for (std::size_t c = 0; c < all.size(); ++c) {
    if (all[c] == 0) continue;
    trust.emplace_back().camera = static_cast<int>(c);
    trust.back().clipped_share = clipped[c] / all[c];
  }
  return trust;
}

/// Most of what it sees is white, and not so of the median camera.
bool is_burnt_out(const CameraTrust& camera, const std::vector<CameraTrust>& all) {
  if (camera.clipped_share <= kMostClipped) return false;
  std::vector<double> shares;
  for (const CameraTrust& t : all) shares.push_back(t.clipped_share);
  return median(std::move(shares)) < kMostClippedOfOthers;
}

bool can_be_judged(const CameraAgreement& a) {
  return a.patches >= kEnoughPatches && a.peer_agreement >= kLeastPeerAgreement;
}

/// How far beyond the threshold a camera is; above 1 it is dropped.
/// @param cameras  how many there are
double excess(const CameraAgreement& a, std::size_t cameras) {
  const double of_colour = cameras < kEnoughColours ? 0 : a.colour_ratio / kMostColourRatio;
  if (!can_be_judged(a)) return of_colour;
  return std::max(of_colour, kLeastShare * a.peer_agreement / std::max(a.agreement, 0.01));
}

/// Factors that make the camera's colours those of the others, where they differ by factors.
std::optional<std::array<float, 3>> gain_of(const CameraAgreement& a) {
  if (a.gain_samples < kLeastGainSamples) return std::nullopt;
  if (can_be_judged(a) && a.agreement < kLeastShare * a.peer_agreement) return std::nullopt;
  // An exposure moves all channels the same way; a dark channel alone is moved by any reflection.
  const auto [least, most] = std::minmax_element(a.log_gain.begin(), a.log_gain.end());
  const double mean = std::abs(a.log_gain[0] + a.log_gain[1] + a.log_gain[2]) / 3;
  if (*least < kLeastLogGain / 2 && *most > -kLeastLogGain / 2) return std::nullopt;
  if (mean < kLeastLogGain || mean < kLeastGainOverSpread * a.log_gain_spread) return std::nullopt;
  std::array<float, 3> gain{};
  for (std::size_t k = 0; k < 3; ++k) gain[k] = static_cast<float>(std::exp(a.log_gain[k]));
  return gain;
}

/// What is not yet settled: the observations as they are taken so far.
struct Check {
  const Observations& seen;
  std::vector<std::size_t> patches;
  std::vector<CameraState> states;
  std::vector<CameraAgreement> agreement, when_dropped;
  std::size_t cameras = 0, dropped = 0;
  int threads = 0;

  void look() { agreement = camera_agreement(seen, patches, states, threads); }
  /// @return false where a third of the cameras would be exceeded
  bool drop(std::size_t camera) {
    if (3 * (dropped + 1) > cameras) return false;
    ++dropped;
    states[camera].dropped = true;
    when_dropped[camera] = agreement[camera];
    return true;
  }
};

/// The camera whose gain, not yet corrected, is the furthest from 1.
std::optional<std::size_t> most_exposed(const Check& check) {
  std::optional<std::size_t> found;
  double most = 0;
  for (std::size_t c = 0; c < check.states.size(); ++c) {
    if (check.states[c].dropped || check.states[c].corrected) continue;
    const auto gain = gain_of(check.agreement[c]);
    if (!gain) continue;
    double log = 0;
    for (const float g : *gain) log += std::abs(std::log(double(g)));
    if (log > most) {
      most = log;
      found = c;
    }
  }
  return found;
}

/// The camera that agrees least with the others, where that is too little and no gain explains it.
std::optional<std::size_t> most_foreign(const Check& check) {
  std::optional<std::size_t> found;
  double most = 1;
  for (std::size_t c = 0; c < check.states.size(); ++c) {
    const CameraAgreement& a = check.agreement[c];
    const double beyond = excess(a, check.cameras);
    if (check.states[c].dropped || !(beyond > most)) continue;
    if (!check.states[c].corrected && gain_of(a)) continue;
    most = beyond;
    found = c;
  }
  return found;
}

/// The median, over cameras that see patterns, of their agreement with the others.
std::optional<double> support(const std::vector<CameraAgreement>& agreement) {
  std::vector<double> values;
  for (const CameraAgreement& a : agreement)
    if (a.patches >= kEnoughPatches) values.push_back(a.agreement);
  if (values.size() < kLeastTrustedCameras) return std::nullopt;
  return median(std::move(values));
}

/// Drops and corrects until what is left agrees. One at a time, the worst first: it spoils the
/// predictions of its neighbours.
void settle(Check& check, const std::vector<CameraTrust>& trust) {
  for (const CameraTrust& t : trust)
    if (is_burnt_out(t, trust)) check.drop(std::size_t(t.camera));
  if (check.dropped > 0) check.look();
  while (true) {
    if (const auto foreign = most_foreign(check)) {
      if (!check.drop(*foreign)) return;
    } else if (const auto exposed = most_exposed(check)) {
      check.states[*exposed] = {false, true, *gain_of(check.agreement[*exposed])};
    } else {
      return;
    }
    check.look();
  }
}

std::string text(const char* format, double a, double b = 0, double c = 0) {
  char buffer[128];
  std::snprintf(buffer, sizeof buffer, format, a, b, c);
  return buffer;
}

}  // namespace

Result<std::vector<CameraTrust>, InputError> check_cameras(const Observations& seen, int threads) {
  std::vector<CameraTrust> trust = cameras_that_see(seen);
  if (trust.size() < kLeastTrustedCameras) return trust;
  const auto count = static_cast<std::size_t>(trust.back().camera) + 1;
  Check check{seen,
              choose_patches(seen),
              std::vector<CameraState>(count),
              {},
              std::vector<CameraAgreement>(count),
              trust.size(),
              0,
              threads};
  check.look();
  if (const auto agreement = support(check.agreement); agreement && *agreement < kLeastSupport)
    return InputError{Errc::kInvalidInput,
                      "no photograph supports the cloud: what the cameras see of the same points "
                      "has nothing in common (agreement " +
                          text("%.2f", *agreement) +
                          " of 1). Do cloud, poses and photographs belong together? Without the "
                          "check of cameras it is encoded all the same"};
  settle(check, trust);
  for (CameraTrust& t : trust) {
    const auto c = static_cast<std::size_t>(t.camera);
    const CameraState& state = check.states[c];
    const CameraAgreement& a = state.dropped ? check.when_dropped[c] : check.agreement[c];
    if (can_be_judged(a)) {
      t.agreement = a.agreement;
      t.peer_agreement = a.peer_agreement;
    }
    if (state.corrected) t.gain = state.gain;
    t.verdict = state.dropped     ? CameraVerdict::kDropped
                : state.corrected ? CameraVerdict::kGainCorrected
                                  : CameraVerdict::kKept;
  }
  return trust;
}

Observations trusted_observations(Observations seen, const std::vector<CameraTrust>& trust) {
  std::vector<const CameraTrust*> of_camera;
  for (const CameraTrust& t : trust) {
    if (t.verdict == CameraVerdict::kKept) continue;
    of_camera.resize(std::max(of_camera.size(), std::size_t(t.camera) + 1));
    of_camera[std::size_t(t.camera)] = &t;
  }
  if (of_camera.empty()) return seen;
  std::size_t to = 0;
  for (std::size_t p = 0; p + 1 < seen.first.size(); ++p) {
    const auto begin = static_cast<std::size_t>(seen.first[p]);
    const auto end = static_cast<std::size_t>(seen.first[p + 1]);
    seen.first[p] = to;
    for (std::size_t i = begin; i < end; ++i) {
      const CameraTrust* t =
          seen.camera[i] < of_camera.size() ? of_camera[seen.camera[i]] : nullptr;
      auto colour = seen.colour[i];
      if (t) {
        if (t->verdict == CameraVerdict::kDropped) continue;
        if (std::max({colour[0], colour[1], colour[2]}) >= kClipped) continue;
        for (std::size_t k = 0; k < 3; ++k) colour[k] = std::min(colour[k] * t->gain[k], 255.0f);
      }
      seen.colour[to] = colour;
      seen.direction[to] = seen.direction[i];
      seen.camera[to] = seen.camera[i];
      ++to;
    }
  }
  seen.first.back() = to;
  seen.colour.resize(to);
  seen.direction.resize(to);
  seen.camera.resize(to);
  set_gamma_range(seen);
  return seen;
}

std::vector<int> trusted_cameras(const std::vector<CameraTrust>& trust) {
  std::vector<int> cameras;
  for (const CameraTrust& t : trust)
    if (t.verdict != CameraVerdict::kDropped) cameras.push_back(t.camera);
  return cameras;
}

std::string reason_of(const CameraTrust& t) {
  switch (t.verdict) {
    case CameraVerdict::kKept:
      return {};
    case CameraVerdict::kGainCorrected:
      return "another exposure: its R, G, B count times" +
             text(" %.2f, %.2f, %.2f", double(t.gain[0]), double(t.gain[1]), double(t.gain[2]));
    case CameraVerdict::kDropped:
      break;
  }
  if (t.clipped_share > kMostClipped)
    return text("dropped: overexposed, %.0f %% of what it sees", 100 * t.clipped_share);
  if (t.agreement < kLeastShare * t.peer_agreement)
    return text(
        "dropped: its patterns agree with the others' by %.2f, theirs by %.2f: another "
        "object or a wrong pose",
        t.agreement, t.peer_agreement);
  return "dropped: its colours have nothing to do with the others'";
}

}  // namespace slf
