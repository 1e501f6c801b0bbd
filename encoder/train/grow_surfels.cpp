// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/grow_surfels.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace slf {
namespace {

constexpr float kApart = 0.3f;  // radii: of the centres of the two from the middle
constexpr float kLonger = 0.62f, kShorter = 0.9f;  // of the radius before

bool is_finite(const TrainedSurfel& surfel) {
  return std::all_of(surfel.value.begin(), surfel.value.end(),
                     [](float value) { return std::isfinite(value); });
}

/// Without those that show nothing.
void prune(const GrowSettings& settings, SurfelUse& use, AdamState& state,
           TrainedSurfels& surfels) {
  std::vector<std::uint8_t> keep(surfels.size());
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const bool idle = surfels[i].opacity() < settings.least_opacity ||
                      (settings.all_seen && !(use.drawn[i] > 0)) || !is_finite(surfels[i]);
    const bool stays = !settings.moving.empty() && !settings.moving[i];
    keep[i] = !idle || stays;
  }
  keep_surfels(keep, use, state, surfels);
}

/// Room for others where there is none: without those that say the least.
void make_room(const GrowSettings& settings, SurfelUse& use, AdamState& state,
               TrainedSurfels& surfels) {
  const auto room = std::size_t(settings.replaced * double(settings.most));
  if (surfels.size() + room <= settings.most || room == 0 || !settings.moving.empty()) return;
  const std::size_t count = std::min(surfels.size() + room - settings.most, surfels.size());
  std::vector<std::uint32_t> order(surfels.size());
  std::iota(order.begin(), order.end(), 0u);
  std::partial_sort(order.begin(), order.begin() + std::ptrdiff_t(count), order.end(),
                    [&](std::uint32_t a, std::uint32_t b) {
                      return use.pull[a] != use.pull[b] ? use.pull[a] < use.pull[b] : a < b;
                    });
  std::vector<std::uint8_t> keep(surfels.size(), 1);
  for (std::size_t i = 0; i < count; ++i) keep[order[i]] = 0;
  keep_surfels(keep, use, state, surfels);
}

std::size_t longest_axis(const TrainedSurfel& surfel, std::size_t axes) {
  const float* radius = &surfel.value[TrainedSurfel::kLogRadius];
  return std::size_t(std::max_element(radius, radius + axes) - radius);
}

/// Two for one: it, and the one that is returned.
TrainedSurfel split(TrainedSurfel& surfel, std::size_t count) {
  const SurfelAxes axes = axes_of(surfel);
  const std::size_t longest = longest_axis(surfel, count);
  const Float3& axis = axes.axis(longest);
  const float step = kApart * surfel.radius(longest);
  for (std::size_t k = 0; k < count; ++k)
    surfel.value[TrainedSurfel::kLogRadius + k] += std::log(k == longest ? kLonger : kShorter);
  TrainedSurfel other = surfel;
  for (std::size_t a = 0; a < 3; ++a) {
    surfel.value[TrainedSurfel::kPosition + a] += step * axis[a];
    other.value[TrainedSurfel::kPosition + a] -= step * axis[a];
  }
  return other;
}

}  // namespace

void SurfelUse::resize(std::size_t surfels) {
  drawn.resize(surfels, 0);
  pull.resize(surfels, 0);
}

void SurfelUse::clear() {
  std::fill(drawn.begin(), drawn.end(), 0.0f);
  std::fill(pull.begin(), pull.end(), 0.0f);
}

void SurfelUse::add(const SurfelTiles& tiles, const std::vector<ProjectedGradient>& gradients) {
  for (std::size_t i = 0; i < gradients.size(); ++i) {
    drawn[tiles.projected[i].surfel] += gradients[i].drawn;
    pull[tiles.projected[i].surfel] += gradients[i].pull;
  }
}

void keep_surfels(std::span<const std::uint8_t> keep, SurfelUse& use, AdamState& state,
                  TrainedSurfels& surfels) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    if (!keep[i]) continue;
    surfels[kept] = surfels[i];
    state.mean[kept] = state.mean[i];
    state.square[kept] = state.square[i];
    use.drawn[kept] = use.drawn[i];
    use.pull[kept++] = use.pull[i];
  }
  surfels.resize(kept);
  state.resize(kept);
  use.drawn.resize(kept);
  use.pull.resize(kept);
}

void grow_surfels(const GrowSettings& settings, SurfelUse& use, AdamState& state,
                  TrainedSurfels& surfels) {
  prune(settings, use, state, surfels);
  make_room(settings, use, state, surfels);
  const std::size_t room = settings.most > surfels.size() ? settings.most - surfels.size() : 0;
  std::size_t count = std::min(room, std::size_t(settings.share * double(surfels.size())));
  std::vector<std::uint32_t> order;
  for (std::size_t i = 0; i < surfels.size(); ++i)
    if (use.pull[i] > 0 && surfels[i].radius(longest_axis(surfels[i], settings.axes)) >
                               settings.smallest * settings.space.pixels_at(surfels[i].position()))
      order.push_back(std::uint32_t(i));
  count = std::min(count, order.size());
  const auto end = order.begin() + std::ptrdiff_t(count);
  std::partial_sort(order.begin(), end, order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return use.pull[a] != use.pull[b] ? use.pull[a] > use.pull[b] : a < b;
  });
  order.resize(count);
  for (const std::uint32_t i : order) {
    surfels.push_back(split(surfels[i], settings.axes));
    state.mean[i] = state.square[i] = {};
  }
  state.resize(surfels.size());
  use.resize(surfels.size());
  use.clear();
}

}  // namespace slf
