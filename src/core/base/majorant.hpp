// Bounds on a function of time and on its derivatives.
#pragma once

#include <array>

namespace edmill::numerics {

/// Bounds on a function and its first four derivatives.
template <class Real>
using Majorant = std::array<Real, 5>;

inline constexpr int binomial[5][5] = {
    {1, 0, 0, 0, 0}, {1, 1, 0, 0, 0}, {1, 2, 1, 0, 0}, {1, 3, 3, 1, 0}, {1, 4, 6, 4, 1}};

/// k-th derivative of a product a^(shift) * b, from bounds on a and b. (Leibniz)
template <class Real>
Real product_bound(const Majorant<Real>& a, int shift, const Majorant<Real>& b, int k) {
  Real sum{0};
  for (int j = 0; j <= k; ++j) sum += binomial[k][j] * a[j + shift] * b[k - j];
  return sum;
}

/// Bounds for sin or cos of an angle of amplitude `m` and angular speed `w`, whose derivatives are at most
/// m w^k: the derivative of one is the other times the angle's rate.
template <class Real>
void fill_sin_cos(const Majorant<Real>& angle, Majorant<Real>& sine, Majorant<Real>& cosine) {
  sine[0] = angle[0] < 1 ? angle[0] : Real(1);
  cosine[0] = Real(1);
  for (int k = 0; k < 4; ++k) {
    sine[k + 1] = product_bound(angle, 1, cosine, k);
    cosine[k + 1] = product_bound(angle, 1, sine, k);
  }
}

}  // namespace edmill::numerics
