// SPDX-License-Identifier: Apache-2.0
#include "tools/film_timing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slf::tools {
namespace {

constexpr double kMostRate = 120;             // of pictures that are repeated: screens show no more
constexpr std::int64_t kMostShown = 1 << 20;  // of one picture: no film has room for more

struct Trial {
  FilmTiming timing;
  double error = 0;  // the greatest, in seconds
};

Trial trial(std::span<const double> times, double rate, double mean) {
  Trial out{{rate, {}}, 0};
  std::int64_t place = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double since = times[i] - times[0];
    out.error = std::max(out.error, std::abs(static_cast<double>(place) / rate - since));
    const double lasts = i + 1 < times.size() ? times[i + 1] - times[0] : since + mean;
    const double most = static_cast<double>(place + kMostShown);
    const std::int64_t next = std::llround(std::min(lasts * rate, most));
    out.timing.shown.push_back(static_cast<std::uint32_t>(std::max<std::int64_t>(next - place, 1)));
    place += out.timing.shown.back();
  }
  return out;
}

}  // namespace

FilmTiming even_timing(std::size_t pictures, std::span<const double> times) {
  FilmTiming timing;
  timing.shown.assign(pictures, 1);
  if (times.size() < 2) return timing;
  const double seconds = times.back() - times.front();
  if (seconds > 0) timing.rate = static_cast<double>(times.size() - 1) / seconds;
  return timing;
}

FilmTiming timing_of(std::size_t pictures, std::span<const double> times) {
  FilmTiming best = even_timing(pictures, times);
  if (times.size() < 3) return best;
  const double mean = 1 / best.rate;
  double least = std::numeric_limits<double>::infinity(), error = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    least = std::min(least, times[i] - times[i - 1]);
    error = std::max(error, std::abs(times[i] - times[0] - static_cast<double>(i) * mean));
  }
  for (int part = 1; part <= 4 && error > mean / 8; ++part) {
    const double rate = std::min(part / std::max(least, 1e-9), std::max(kMostRate, best.rate));
    Trial next = trial(times, rate, mean);
    if (next.error >= error) continue;
    error = next.error;
    best = std::move(next.timing);
  }
  return best;
}

}  // namespace slf::tools
