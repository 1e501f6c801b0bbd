// SPDX-License-Identifier: Apache-2.0
// What writers of splats ask for: the same of discs and of Gaussians. Values before and after their
// activations are both asked for, so that what a source has is written to the last bit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lightfield/splats/gaussian_collector.h"
#include "lightfield/splats/splat_axes.h"
#include "slf/gaussians.h"
#include "slf/splats.h"

namespace slf {

class SplatRows {
 public:
  virtual ~SplatRows() = default;

  virtual std::size_t size() const = 0;
  virtual int degree() const = 0;
  virtual std::array<float, 3> position(std::size_t p) const = 0;
  /// 0: not known.
  virtual std::array<float, 3> normal(std::size_t p) const = 0;
  virtual std::array<float, 3> deviations(std::size_t p) const = 0;
  virtual std::array<float, 3> log_deviations(std::size_t p) const = 0;
  virtual std::array<float, 4> rotation(std::size_t p) const = 0;  ///< w, x, y, z
  virtual float opacity(std::size_t p) const = 0;
  virtual float logit(std::size_t p) const = 0;
  /// [(degree + 1)^2][3]
  virtual const float* harmonics(std::size_t p) const = 0;
  /// Opacity for programs that draw points alone.
  virtual float point_opacity(std::size_t p) const = 0;
  /// Where a scene puts coordinate 0, axes of the file.
  virtual Vec3 origin() const { return {0, 0, 0}; }
  /// World units that coordinates and sizes have to resolve; 0: none is known.
  virtual double step() const { return 0; }
};

/// Discs of a light field, kept by reference.
class DiscRows final : public SplatRows {
 public:
  explicit DiscRows(const SplatCloud& splats) : splats_(splats) {}

  std::size_t size() const override { return splats_.size(); }
  int degree() const override { return splats_.degree; }
  std::array<float, 3> position(std::size_t p) const override { return splats_.positions[p]; }
  std::array<float, 3> normal(std::size_t p) const override { return splats_.normals[p]; }
  std::array<float, 3> deviations(std::size_t p) const override {
    const float across = splats_.deviations[p];
    return {across, across, across * kSplatFlatness};
  }
  std::array<float, 3> log_deviations(std::size_t p) const override {
    const float across = std::log(splats_.deviations[p]);
    return {across, across, across + std::log(kSplatFlatness)};
  }
  std::array<float, 4> rotation(std::size_t p) const override {
    return disc_rotation(splats_.normals[p]);
  }
  float opacity(std::size_t) const override { return kSplatOpacity; }
  float logit(std::size_t) const override { return std::log(kSplatOpacity / (1 - kSplatOpacity)); }
  const float* harmonics(std::size_t p) const override {
    return &splats_.harmonics[p * 3 * splats_.num_harmonics()];
  }
  float point_opacity(std::size_t) const override { return 1; }
  Vec3 origin() const override { return turned(splats_.axes, splats_.origin); }
  double step() const override { return splats_.step; }

 private:
  const SplatCloud& splats_;
};

/// Gaussians, kept by reference.
class GaussianRows final : public SplatRows {
 public:
  explicit GaussianRows(const Gaussians& splats) : splats_(splats) {}

  std::size_t size() const override { return splats_.size(); }
  int degree() const override { return splats_.degree; }
  std::array<float, 3> position(std::size_t p) const override { return splats_.positions[p]; }
  std::array<float, 3> normal(std::size_t) const override { return {0, 0, 0}; }
  std::array<float, 3> deviations(std::size_t p) const override {
    const auto& log = splats_.log_deviations[p];
    return {std::exp(log[0]), std::exp(log[1]), std::exp(log[2])};
  }
  std::array<float, 3> log_deviations(std::size_t p) const override {
    return splats_.log_deviations[p];
  }
  std::array<float, 4> rotation(std::size_t p) const override { return splats_.rotations[p]; }
  float opacity(std::size_t p) const override { return 1 / (1 + std::exp(-splats_.logits[p])); }
  float logit(std::size_t p) const override { return splats_.logits[p]; }
  const float* harmonics(std::size_t p) const override {
    return &splats_.harmonics[p * 3 * splats_.num_harmonics()];
  }
  float point_opacity(std::size_t p) const override { return opacity(p); }
  Vec3 origin() const override { return splats_.origin; }

 private:
  const Gaussians& splats_;
};

/// How many harmonics a degree has.
inline std::size_t functions_of(int degree) {
  return std::size_t(degree + 1) * std::size_t(degree + 1);
}

}  // namespace slf
