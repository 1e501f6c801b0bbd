// SPDX-License-Identifier: Apache-2.0
#include "lightfield/splats/gaussian_collector.h"

namespace slf {
namespace {

constexpr float kMostLogit = 16;  // 1 - opacity of 1e-7
constexpr float kMostHarmonic = 1e4f;

bool is_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

/// False where a value means nothing.
bool is_usable(const RawGaussian& raw, std::span<const float> harmonics) {
  if (!is_finite(raw.position) || !is_finite(raw.rotation) || std::isnan(raw.logit)) return false;
  for (const float x : raw.log_deviations)
    if (!(x <= kMostLogDeviation)) return false;
  return std::all_of(harmonics.begin(), harmonics.end(),
                     [](float h) { return std::abs(h) <= kMostHarmonic; });  // false of NaN
}

/// Makes its length 1; a quaternion of 0 becomes no turn.
std::array<float, 4> unit_quaternion(const std::array<float, 4>& q, bool& mended) {
  double square = 0;
  for (const float x : q) square += double{x} * double{x};
  if (!(square > 0)) {
    mended = true;
    return {1, 0, 0, 0};
  }
  std::array<float, 4> unit;
  for (std::size_t k = 0; k < 4; ++k)
    unit[k] = static_cast<float>(double{q[k]} / std::sqrt(square));
  return unit;
}

/// Into a range; `mended` where it was outside.
float limited(float value, float most, bool& mended) {
  if (std::abs(value) > most) mended = true;
  return std::clamp(value, -most, most);
}

}  // namespace

GaussianCollector::GaussianCollector(int degree, UpAxis up, std::size_t count) {
  Gaussians& to = file_.gaussians;
  to.degree = degree;
  to.up = up;
  to.positions.reserve(count);
  to.log_deviations.reserve(count);
  to.rotations.reserve(count);
  to.logits.reserve(count);
  to.harmonics.reserve(count * 3 * to.num_harmonics());
}

void GaussianCollector::add(const RawGaussian& raw, std::span<const float> harmonics) {
  if (!is_usable(raw, harmonics)) {
    ++file_.left_out;
    return;
  }
  bool mended = false;
  Gaussians& to = file_.gaussians;
  to.positions.push_back(raw.position);
  std::array<float, 3> sizes = raw.log_deviations;
  for (float& x : sizes) x = limited(x, kMostLogDeviation, mended);
  to.log_deviations.push_back(sizes);
  to.rotations.push_back(unit_quaternion(raw.rotation, mended));
  to.logits.push_back(limited(raw.logit, kMostLogit, mended));
  to.harmonics.insert(to.harmonics.end(), harmonics.begin(), harmonics.end());
  file_.mended += mended;
}

Result<GaussianFile, InputError> GaussianCollector::take(const std::string& name,
                                                         std::string format) && {
  if (file_.gaussians.size() == 0)
    return InputError{Errc::kInvalidInput,
                      name + ": " +
                          (file_.left_out == 0
                               ? "has no splats"
                               : "none of its " + std::to_string(file_.left_out) +
                                     " splats has a place, a size and a colour within its range")};
  file_.format = std::move(format);
  return std::move(file_);
}

}  // namespace slf
