#include "lightfield/harmonics.h"

#include <cmath>
#include <cstddef>
#include <cstdlib>

namespace slf {

Harmonics::Harmonics(int degree) : degree_(degree) {
  for (int l = 0; l <= degree; ++l)
    for (int m = -l; m <= l; ++m) {
      double ratio = 1;  // (l + |m|)! / (l - |m|)!
      for (int i = l - std::abs(m) + 1; i <= l + std::abs(m); ++i) ratio *= i;
      const double norm = std::sqrt((m == 0 ? 1 : 2) * (2 * l + 1) / ratio);
      norm_.push_back(m % 2 == 0 ? norm : -norm);
    }
}

template <class Real>
void Harmonics::evaluate(const std::array<double, 3>& direction, Real* row) const {
  const auto [x, y, z] = direction;
  const auto put = [&](int l, int m, double value) {
    const auto at = static_cast<std::size_t>(l * l + l + m);
    row[at] = static_cast<Real>(norm_[at] * value);
  };
  // sin^m cos(m phi) and sin^m sin(m phi); Legendre functions without their factor sin^m.
  double cosine = 1, sine = 0, diagonal = 1;
  for (int m = 0; m <= degree_; ++m) {
    double before = 0, legendre = diagonal;
    for (int l = m; l <= degree_; ++l) {
      put(l, m, legendre * cosine);
      if (m > 0) put(l, -m, legendre * sine);
      const double next = ((2 * l + 1) * z * legendre - (l + m) * before) / (l - m + 1);
      before = legendre;
      legendre = next;
    }
    diagonal *= 2 * m + 1;
    const double turned = cosine * x - sine * y;
    sine = sine * x + cosine * y;
    cosine = turned;
  }
}

template void Harmonics::evaluate(const std::array<double, 3>&, float*) const;
template void Harmonics::evaluate(const std::array<double, 3>&, double*) const;

}  // namespace slf
