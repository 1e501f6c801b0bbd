// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/camera_twists.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "capture/quantile.h"

namespace slf {
namespace {

constexpr double kMeanTwistDecay = 0.9,
                 kSquareTwistDecay = 0.99;  // a view is drawn some thirty times in all

/// R, t of a rigid motion of the world.
struct Motion {
  Eigen::Matrix3d turn;
  Eigen::Vector3d move;
};

Motion motion_of(const CameraTwist& twist, const Vec3& pivot) {
  const Eigen::Vector3d by(twist[3], twist[4], twist[5]), about(pivot[0], pivot[1], pivot[2]);
  const double angle = by.norm();
  Motion m{Eigen::Matrix3d::Identity(), Eigen::Vector3d(twist[0], twist[1], twist[2])};
  if (angle > 0) m.turn = Eigen::AngleAxisd(angle, by / angle).toRotationMatrix();
  m.move += about - m.turn * about;
  return m;
}

template <class Matrix>
Eigen::Matrix3d matrix_of(const Matrix& rows) {
  Eigen::Matrix3d out;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) out(r, c) = double(rows[std::size_t(r)][std::size_t(c)]);
  return out;
}

/// Gradient by a twist about `pivot`: the virtual work of what pulls at the surfels.
CameraTwist gradient_of(const TrainedSurfels& surfels, const std::vector<TrainedSurfel>& gradients,
                        const Vec3& pivot) {
  CameraTwist sum{};
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const float *at = surfels[i].value.data(), *g = gradients[i].value.data();
    const Eigen::Vector3d arm(at[0] - pivot[0], at[1] - pivot[1], at[2] - pivot[2]);
    const Eigen::Vector3d pull(g[0], g[1], g[2]);
    // A quaternion w, v that is turned by a small angle a changes by (-a v, w a + a x v) / 2.
    const float *q = at + TrainedSurfel::kTurn, *gq = g + TrainedSurfel::kTurn;
    const Eigen::Vector3d v(q[1], q[2], q[3]), gv(gq[1], gq[2], gq[3]);
    const Eigen::Vector3d turn =
        arm.cross(pull) + 0.5 * (double(q[0]) * gv - double(gq[0]) * v + v.cross(gv));
    for (int a = 0; a < 3; ++a) {
      sum[std::size_t(a)] += pull[a];
      sum[std::size_t(3 + a)] += turn[a];
    }
  }
  return sum;
}

}  // namespace

CameraTwists::CameraTwists(std::size_t views, const TrainedSurfels& surfels, double pixel)
    : twists_(views), mean_(views), square_(views), steps_(views) {
  std::vector<double> distances;
  for (std::size_t a = 0; a < 3; ++a) {
    std::vector<double> places;
    for (const TrainedSurfel& surfel : surfels) places.push_back(double(surfel.value[a]));
    pivot_[a] = median(std::move(places));
  }
  for (const TrainedSurfel& surfel : surfels) {
    double square = 0;
    for (std::size_t a = 0; a < 3; ++a) square += std::pow(double(surfel.value[a]) - pivot_[a], 2);
    distances.push_back(std::sqrt(square));
  }
  const double reach = std::max(median(std::move(distances)), pixel);
  for (std::size_t k = 0; k < 6; ++k) unit_[k] = k < 3 ? pixel : pixel / reach;
}

TrainingCamera CameraTwists::camera(std::size_t view, const TrainingCamera& given) const {
  if (empty()) return given;
  const Motion m = motion_of(twists_[view], pivot_);
  const Eigen::Matrix3d rotation = matrix_of(given.rotation), turned = rotation * m.turn;
  const auto& t = given.translation;
  const Eigen::Vector3d moved = rotation * m.move + Eigen::Vector3d(t[0], t[1], t[2]);
  const Eigen::Vector3d centre = -turned.transpose() * moved;
  TrainingCamera out = given;
  for (std::size_t r = 0; r < 3; ++r) {
    out.translation[r] = float(moved[int(r)]);
    out.centre[r] = float(centre[int(r)]);
    for (std::size_t c = 0; c < 3; ++c) out.rotation[r][c] = float(turned(int(r), int(c)));
  }
  return out;
}

void CameraTwists::step(std::size_t view, double rate, const TrainedSurfels& surfels,
                        const std::vector<TrainedSurfel>& gradients) {
  const CameraTwist gradient = gradient_of(surfels, gradients, pivot_);
  const int steps = ++steps_[view];
  for (std::size_t k = 0; k < 6; ++k) {
    const double g = gradient[k] * unit_[k];  // by pixels
    double &mean = mean_[view][k], &square = square_[view][k];
    mean = kMeanTwistDecay * mean + (1 - kMeanTwistDecay) * g;
    square = kSquareTwistDecay * square + (1 - kSquareTwistDecay) * g * g;
    const double scale = std::sqrt(square / (1 - std::pow(kSquareTwistDecay, steps)));
    if (scale > 0)
      twists_[view][k] -= rate * unit_[k] * mean / (1 - std::pow(kMeanTwistDecay, steps)) / scale;
  }
}

void CameraTwists::centre() {
  for (std::size_t k = 0; k < 6; ++k) {
    double sum = 0;
    for (const CameraTwist& twist : twists_) sum += twist[k];
    for (CameraTwist& twist : twists_) twist[k] -= sum / double(twists_.size());
  }
}

std::vector<double> CameraTwists::state() const {
  std::vector<double> state;
  for (std::size_t view = 0; view < twists_.size(); ++view) {
    for (const auto* values : {&twists_[view], &mean_[view], &square_[view]})
      state.insert(state.end(), values->begin(), values->end());
    state.push_back(steps_[view]);
  }
  return state;
}

void CameraTwists::go_on_from(std::span<const double> state) {
  const double* from = state.data();
  for (std::size_t view = 0; view < twists_.size(); ++view) {
    for (auto* values : {&twists_[view], &mean_[view], &square_[view]})
      std::copy_n(std::exchange(from, from + values->size()), values->size(), values->begin());
    steps_[view] = static_cast<int>(*from++);
  }
}

Camera twisted(const Camera& camera, const CameraTwist& twist, const Vec3& pivot) {
  const Motion m = motion_of(twist, pivot);
  const Eigen::Matrix3d rotation = matrix_of(camera.rotation), turned = rotation * m.turn;
  const Vec3& t = camera.translation;
  const Eigen::Vector3d moved = rotation * m.move + Eigen::Vector3d(t[0], t[1], t[2]);
  Camera out = camera;
  for (std::size_t r = 0; r < 3; ++r) {
    out.translation[r] = moved[int(r)];
    for (std::size_t c = 0; c < 3; ++c) out.rotation[r][c] = turned(int(r), int(c));
  }
  return out;
}

}  // namespace slf
