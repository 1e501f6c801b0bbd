#include "lightfield/harmonics.h"

#include <cmath>

namespace slf {

Harmonics::Harmonics(int degree) : degree_(degree) {
  for (int m = 0; m <= degree; ++m)
    for (int l = m; l <= degree; ++l) {
      double ratio = 1;  // (l + m)! / (l - m)!
      for (int i = l - m + 1; i <= l + m; ++i) ratio *= i;
      const double norm = std::sqrt((m == 0 ? 1 : 2) * (2 * l + 1) / ratio);
      const double next = l - m + 1;
      steps_.push_back({m % 2 == 0 ? norm : -norm, (2 * l + 1) / next, (l + m) / next});
    }
}

template <class Real>
void Harmonics::evaluate(const std::array<double, 3>& direction, Real* row) const {
  const auto [x, y, z] = direction;
  // sin^m cos(m phi) and sin^m sin(m phi); Legendre functions without their factor sin^m.
  double cosine = 1, sine = 0, diagonal = 1;
  const Step* step = steps_.data();
  for (int m = 0; m <= degree_; ++m) {
    double before = 0, legendre = diagonal;
    for (int l = m; l <= degree_; ++l, ++step) {
      Real* middle = row + l * l + l;
      middle[m] = static_cast<Real>(step->norm * legendre * cosine);
      if (m > 0) middle[-m] = static_cast<Real>(step->norm * legendre * sine);
      const double next = step->from_this * z * legendre - step->from_before * before;
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
