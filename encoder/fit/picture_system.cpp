// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/picture_system.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "encoder/fit/picture_sums.h"
#include "lightfield/directions.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kSystemPointsPerRange = 256;
constexpr std::size_t kRaysPerRange = 1 << 15;

/// [K] of functions of mean square 1.
std::vector<double> picture_penalties(const DirectionRows& rows,
                                      const PictureFitSettings& settings) {
  std::vector<double> penalty;
  for (const int fineness : rows.fineness())
    penalty.push_back(fineness == 0 ? settings.mean_penalty
                                    : settings.penalty * std::pow(settings.growth, fineness));
  return penalty;
}

/// Inner products of the channels.
std::array<double, 3> inner(const std::vector<Colour3>& a, const std::vector<Colour3>& b,
                            int threads) {
  std::vector<std::array<double, 3>> parts((a.size() + kRaysPerRange - 1) / kRaysPerRange);
  parallel_ranges(a.size(), kRaysPerRange, threads, [&](std::size_t begin, std::size_t end) {
    std::array<double, 3> sum{};
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t c = 0; c < 3; ++c) sum[c] += double(a[i][c]) * double(b[i][c]);
    parts[begin / kRaysPerRange] = sum;
  });
  std::array<double, 3> sum{};
  for (const auto& part : parts)
    for (std::size_t c = 0; c < 3; ++c) sum[c] += part[c];
  return sum;
}

/// a / b of each channel; 0 where nothing is left to improve.
Colour4 quotient(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  Colour4 q{};
  for (std::size_t c = 0; c < 3; ++c) q[c] = b[c] > 0 ? static_cast<float>(a[c] / b[c]) : 0.0f;
  return q;
}

}  // namespace

double PictureError::psnr() const { return 10 * std::log10(255.0 * 255 * 3 * trust / squares); }

PictureSystem::PictureSystem(const Grid& grid, std::span<const Voxel> positions,
                             const FitSettings& settings, std::array<float, 2> gamma_range,
                             PictureViews& pictures, std::vector<Vec3> eyes)
    : grid_(grid),
      positions_(positions),
      pictures_(pictures),
      eyes_(std::move(eyes)),
      gamma_range_(gamma_range),
      threads_(settings.threads),
      rows_(settings.basis),
      penalty_(picture_penalties(rows_, settings.pictures)),
      kernel_(settings.basis, rows_, penalty_),
      normals_(mirror_normals(settings.directions, positions, settings.normal_cell_log2,
                              settings.threads)),
      world_(pictures.rays.size()) {
  each_point([&](std::size_t p, std::size_t from, std::size_t to) {
    for (std::size_t r = from; r < to; ++r) {
      const Vec3 d = towards(p, r);
      world_[r] = {float(d[0]), float(d[1]), float(d[2])};
    }
  });
}

PictureSystem::Vector PictureSystem::colours(std::span<const float> coefficients) const {
  Vector colours(pictures_.rays.size());
  const std::size_t size = rows_.size();
  each_point([&](std::size_t p, std::size_t from, std::size_t to) {
    const std::vector<float> rows = rows_of(p, from, to);
    std::vector<Colour4> of_point(size);  // padded, so that a step is one operation
    for (std::size_t k = 0; k < size; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        of_point[k][c] =
            static_cast<float>(rows_.norms()[k]) * coefficients[3 * (size * p + k) + c];
    for (std::size_t r = from; r < to; ++r) {
      Colour4 sum{};
      for (std::size_t k = 0; k < size; ++k)
        add_scaled(rows[(r - from) * size + k], of_point[k], sum);
      colours[r] = {sum[0], sum[1], sum[2]};
    }
  });
  return colours;
}

void PictureSystem::add(const Vector& z, std::span<float> coefficients) const {
  const std::size_t size = rows_.size();
  each_point([&](std::size_t p, std::size_t from, std::size_t to) {
    const std::vector<float> rows = rows_of(p, from, to);
    std::vector<Colour4> sum(size);
    for (std::size_t r = from; r < to; ++r) {
      const Colour4 of_ray = widened(z[r]);
      for (std::size_t k = 0; k < size; ++k)
        add_scaled(rows[(r - from) * size + k], of_ray, sum[k]);
    }
    for (std::size_t k = 0; k < size; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        coefficients[3 * (size * p + k) + c] +=
            sum[k][c] / (pull_ * static_cast<float>(penalty_[k] * rows_.norms()[k]));
  });
}

void PictureSystem::set_trust(const Vector& colours, double outlier) {
  const auto scale = static_cast<float>(1 / (3 * outlier * outlier));
  parallel_ranges(pictures_.views.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      PictureView& view = pictures_.views[v];
      const auto local = gathered(view, colours, true);
      for (std::size_t i = 0; i < view.pixels(); ++i) {
        const float q = 1 + scale * square(error_of(view, i, local));
        view.trust[i] = 1 / (q * q);
      }
    }
  });
}

std::vector<PictureError> PictureSystem::errors(const Vector& colours) const {
  std::vector<PictureError> errors(pictures_.views.size());
  parallel_ranges(errors.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const PictureView& view = pictures_.views[v];
      const auto local = gathered(view, colours, true);
      for (std::size_t i = 0; i < view.pixels(); ++i) {
        errors[v].squares += double(view.trust[i] * square(error_of(view, i, local)));
        errors[v].trust += double(view.trust[i]);
      }
    }
  });
  return errors;
}

std::vector<PictureError> PictureSystem::changes(const Vector& from, const Vector& to) const {
  std::vector<PictureError> errors(pictures_.views.size());
  parallel_ranges(errors.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const PictureView& view = pictures_.views[v];
      const auto before = gathered(view, from, true), after = gathered(view, to, true);
      for (std::size_t i = 0; i < view.pixels(); ++i) {
        Colour4 change = mixed(view, i, after);
        add_scaled(-1, mixed(view, i, before), change);
        errors[v].squares += double(view.trust[i] * square(change));
        errors[v].trust += double(view.trust[i]);
      }
    }
  });
  return errors;
}

void PictureSystem::improve(const std::function<bool(std::size_t)>& used, int steps,
                            Vector& colours, Vector* z) const {
  std::vector<bool> uses;
  for (std::size_t v = 0; v < pictures_.views.size(); ++v) uses.push_back(used(v));
  const std::size_t n = colours.size();
  // g_: G times the vector. `product` is first what the search is of the system, then g_left.
  Vector left = residual(uses, colours), product(n);
  apply_kernel(left, product);
  Vector search = left, g_search = product;
  auto rho = inner(left, product, threads_);
  for (int step = 0; step < steps; ++step) {
    product = search;
    add_pictures(uses, g_search, product);
    const Colour4 length = quotient(rho, inner(g_search, product, threads_));
    parallel_ranges(n, kRaysPerRange, threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        for (std::size_t c = 0; c < 3; ++c) {
          if (z != nullptr) (*z)[i][c] += length[c] * search[i][c];
          colours[i][c] += length[c] * g_search[i][c];
          left[i][c] -= length[c] * product[i][c];
        }
    });
    if (step + 1 == steps) return;
    apply_kernel(left, product);
    const auto before = std::exchange(rho, inner(left, product, threads_));
    const Colour4 keep = quotient(rho, before);
    parallel_ranges(n, kRaysPerRange, threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        for (std::size_t c = 0; c < 3; ++c) {
          search[i][c] = left[i][c] + keep[c] * search[i][c];
          g_search[i][c] = product[i][c] + keep[c] * g_search[i][c];
        }
    });
  }
}

PictureSystem::Vector PictureSystem::residual(const std::vector<bool>& used,
                                              const Vector& colours) const {
  Vector out(colours.size());
  parallel_ranges(used.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (!used[v]) continue;
      const PictureView& view = pictures_.views[v];
      const auto local = gathered(view, colours, true);
      spread(
          view, [&](std::size_t i) { return error_of(view, i, local); }, out);
    }
  });
  return out;
}

/// out += W^T T W x.
void PictureSystem::add_pictures(const std::vector<bool>& used, const Vector& x,
                                 Vector& out) const {
  parallel_ranges(used.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (!used[v]) continue;
      const PictureView& view = pictures_.views[v];
      const auto local = gathered(view, x, false);
      spread(
          view, [&](std::size_t i) { return mixed(view, i, local); }, out);
    }
  });
}

/// out = G x.
void PictureSystem::apply_kernel(const Vector& x, Vector& out) const {
  each_point([&](std::size_t p, std::size_t from, std::size_t to) {
    std::vector<Vec3> in_local;
    std::vector<Colour4> given, result(to - from);
    for (std::size_t r = from; r < to; ++r) {
      if (kernel_.needs_local()) in_local.push_back(direction(p, r));
      given.push_back(widened(x[r]));
    }
    kernel_.apply(std::span(world_).subspan(from, to - from), in_local, given, result);
    for (std::size_t r = from; r < to; ++r)
      for (std::size_t c = 0; c < 3; ++c) out[r][c] = result[r - from][c] / pull_;
  });
}

/// Unit, from a point to the eye.
Vec3 PictureSystem::towards(std::size_t point, std::size_t ray) const {
  const Vec3 at = grid_.world(positions_[point]);
  const Vec3& eye = eyes_[pictures_.rays.view[ray]];
  Vec3 d{eye[0] - at[0], eye[1] - at[1], eye[2] - at[2]};
  const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  for (double& x : d) x /= std::max(length, 1e-300);
  return d;
}

/// Unit, local to the point, gamma in range.
Vec3 PictureSystem::direction(std::size_t point, std::size_t ray) const {
  Vec3 d = towards(point, ray);
  if (!normals_.empty()) d = mirrored(normals_[point], d);
  const double low = double(gamma_range_[0]), high = double(gamma_range_[1]);
  if (d[2] >= low && d[2] <= high) return d;
  const double z = std::clamp(d[2], low, high), from = std::hypot(d[0], d[1]);
  const double scale = from > 0 ? std::sqrt(1 - z * z) / from : 0;
  return {scale * d[0], scale * d[1], z};
}

/// [rays][K] of rays from .. to of a point.
std::vector<float> PictureSystem::rows_of(std::size_t point, std::size_t from,
                                          std::size_t to) const {
  std::vector<Vec3> directions;
  for (std::size_t r = from; r < to; ++r) directions.push_back(direction(point, r));
  std::vector<float> rows(directions.size() * rows_.size());
  rows_.evaluate(directions, rows.data());
  return rows;
}

/// body(point, first ray, last ray) of every point that is seen.
template <class Body>
void PictureSystem::each_point(const Body& body) const {
  parallel_ranges(positions_.size(), kSystemPointsPerRange, threads_,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t p = begin; p < end; ++p) {
                      const auto from = static_cast<std::size_t>(pictures_.rays.first[p]),
                                 to = static_cast<std::size_t>(pictures_.rays.first[p + 1]);
                      if (from < to) body(p, from, to);
                    }
                  });
}

}  // namespace slf
