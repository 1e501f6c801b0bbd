// SPDX-License-Identifier: Apache-2.0
// The paper's one-dimensional periodic B-spline wavelets, by their definition. Spec 6.3.
#pragma once

#include <array>

namespace slf {

inline constexpr int kMaxSplineOrder = 4;

/// Cardinal B-spline N_o: degree o - 1, support [0, o], integer knots, sum over shifts 1.
/// @param order  >= 1
double cardinal_bspline(int order, double x);

/// q_n, n = 0 .. 3o - 2, of the paper's eq. (splinepsi), zero beyond. The printed binom(m, j) is
/// read as binom(o, j), which gives the published wavelets (o = 2: 1/12 [1, -6, 10, -6, 1]).
/// @param order  1 .. 4
std::array<double, 3 * kMaxSplineOrder - 1> wavelet_taps(int order);

/// Scale of function i >= 1: the k with 2^k <= i < 2^(k+1).
int wavelet_scale(int i);

/// w_i(x) with period 1: the constant 1 for i = 0, else the wavelet of scale k at offset i - 2^k.
/// The printed eq. (splinew) has one scale and no mean, so it cannot be meant; see spec 6.3.
double wavelet_value(int order, int i, double x);

/// Axis coordinates in [0, 1): theta / 2 pi and gamma / 2, modulo 1. gamma = -1 and 1 coincide.
double axis_of_theta(double theta);
double axis_of_gamma(double gamma);

}  // namespace slf
