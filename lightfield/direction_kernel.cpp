#include "lightfield/direction_kernel.h"

#include <algorithm>
#include <cmath>

namespace slf {
namespace {

/// sum_l (2 l + 1) P_l(x) / penalty of degree l.
double zonal(double x, int degree, std::span<const double> penalty) {
  double sum = 0, before = 0, legendre = 1;
  for (int l = 0; l <= degree; ++l) {
    sum += (2 * l + 1) * legendre / penalty[static_cast<std::size_t>(l * l)];
    const double next = ((2 * l + 1) * x * legendre - l * before) / (l + 1);
    before = legendre;
    legendre = next;
  }
  return sum;
}

}  // namespace

DirectionKernel::DirectionKernel(const Basis& basis, const DirectionRows& rows,
                                 std::span<const double> penalty)
    : rows_(rows) {
  for (const double p : penalty) inverse_root_.push_back(static_cast<float>(1 / std::sqrt(p)));
  if (basis.id != BasisId::kHarmonics) return;
  for (std::size_t i = 0; i < kSteps + 2; ++i)
    table_.push_back(static_cast<float>(
        zonal(std::min(2.0 * double(i) / kSteps - 1, 1.0), basis.degree, penalty)));
}

void DirectionKernel::matrix(std::span<const std::array<float, 3>> world,
                             std::span<const std::array<float, 2>> in_frame,
                             std::vector<float>& kernel) const {
  const std::size_t m = needs_frame() ? in_frame.size() : world.size();
  kernel.resize(m * m);
  if (!needs_frame()) {
    for (std::size_t i = 0; i < m; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        const float x =
            world[i][0] * world[j][0] + world[i][1] * world[j][1] + world[i][2] * world[j][2];
        const float at = (std::clamp(x, -1.0f, 1.0f) + 1) * (kSteps / 2);
        const auto low = static_cast<std::size_t>(at);
        const float part = at - static_cast<float>(low);
        kernel[i * m + j] = kernel[j * m + i] =
            table_[low] + part * (table_[low + 1] - table_[low]);
      }
    return;
  }
  const std::size_t size = rows_.size();
  std::vector<float> rows(m * size);
  for (std::size_t i = 0; i < m; ++i) {
    rows_.evaluate(in_frame[i], rows.data() + i * size);
    for (std::size_t k = 0; k < size; ++k) rows[i * size + k] *= inverse_root_[k];
    for (std::size_t j = 0; j <= i; ++j) {
      float sum = 0;
      for (std::size_t k = 0; k < size; ++k) sum += rows[i * size + k] * rows[j * size + k];
      kernel[i * m + j] = kernel[j * m + i] = sum;
    }
  }
}

}  // namespace slf
