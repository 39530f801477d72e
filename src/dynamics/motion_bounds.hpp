// Bounds on the derivatives of a ball's gap functions while it flies inside the moving vessel.
// They are what makes an exclusion a proof. Derivation: docs/theory.md, section 3.
#pragma once

#include <array>
#include <vector>

#include "model/case.hpp"

namespace edmill::dynamics {

/// Suprema over a window of the 2nd, 3rd and 4th time derivatives of the gaps, by kind of wall.
template <class Real>
using DerivativeBounds = std::array<std::array<Real, 3>, model::CylinderVessel<Real>::wall_kinds>;

namespace detail {

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

}  // namespace detail

/// Bounds for a ball of any size whose speed stays below `speed` [m/s] over a window of `length` [s] that it
/// enters inside the vessel.
template <class Real>
DerivativeBounds<Real> derivative_bounds(const model::Mill<Real>& mill, const Real& speed,
                                         const Real& length) {
  using detail::Majorant;
  using detail::product_bound;
  const auto& motion = mill.motion;
  const Real w = motion.angular_speed();
  Majorant<Real> alpha, gamma, sine, cosine;
  Real power{1};
  for (int k = 0; k < 5; ++k, power *= w) {
    alpha[k] = motion.theta_max * power;
    gamma[k] = motion.gamma_max * power;
  }
  detail::fill_sin_cos(gamma, sine, cosine);

  // How far outside the vessel the path may get within the window: |p'| <= U.
  const Real reach = mill.vessel.reach();
  const Real shrink = 1 - (alpha[1] + gamma[1]) * length;
  const Real frame_speed = (speed + alpha[1] * (motion.arm + reach) + gamma[1] * reach) / shrink;
  const Real excursion = frame_speed * length;

  // Gravity and velocity in the frame that turns with theta: G' = alpha' G, V' = G + alpha' V.
  Majorant<Real> g, v, v_z, a, b, x, y, z;
  g[0] = norm<Real>(mill.gravity);
  v[0] = speed;
  v_z = {speed, g[0], Real(0), Real(0), Real(0)};
  const Vec3<Real> sizes = mill.vessel.half_sizes();
  x[0] = sizes[0] + excursion;
  y[0] = sizes[1] + excursion;
  z[0] = sizes[2] + excursion;
  a[0] = motion.arm + x[0];
  b[0] = y[0] + sine[0] * z[0];
  for (int k = 0; k < 4; ++k) {
    g[k + 1] = product_bound(alpha, 1, g, k);
    v[k + 1] = g[k] + product_bound(alpha, 1, v, k);
    a[k + 1] = v[k] + product_bound(alpha, 1, b, k);
    b[k + 1] = v[k] + product_bound(alpha, 1, a, k);
    x[k + 1] = a[k + 1];
    // The bounds on b' enter through b shifted by one derivative.
    Real y_next = product_bound(v_z, 0, sine, k) + product_bound(gamma, 1, z, k);
    Real z_next = product_bound(v_z, 0, cosine, k) + product_bound(gamma, 1, y, k);
    for (int j = 0; j <= k; ++j) {
      y_next += detail::binomial[k][j] * b[j + 1] * cosine[k - j];
      z_next += detail::binomial[k][j] * b[j + 1] * sine[k - j];
    }
    y[k + 1] = y_next;
    z[k + 1] = z_next;
  }
  const Real margin = Real(1) + Real(1) / 65536;  // over the rounding of this function itself
  const auto square = [&](const Majorant<Real>& c, int k) { return product_bound(c, 0, c, k); };
  DerivativeBounds<Real> bounds;
  for (int k = 2; k <= 4; ++k) {
    const auto of_kinds =
        mill.vessel.derivative_bounds(margin * y[k], margin * (square(x, k) + square(z, k)));
    for (std::size_t kind = 0; kind < of_kinds.size(); ++kind) bounds[kind][k - 2] = of_kinds[kind];
  }
  return bounds;
}

/// The bounds tabulated over speed and window length, rounded up.
template <class Real>
class BoundsTable {
 public:
  explicit BoundsTable(const model::Mill<Real>& mill) : mill_(mill) {
    const Real w = mill.motion.angular_speed();
    const Real turning = (mill.motion.theta_max + mill.motion.gamma_max) * w;
    const Real quarter = turning > 0 ? Real(1 / (4 * turning)) : mill.motion.period;
    longest_ = mill.motion.period / 8 < quarter ? Real(mill.motion.period / 8) : quarter;
    const Real wall_speed = turning * (mill.motion.arm + mill.vessel.extent());
    speed_step_ = wall_speed > 0 ? Real(wall_speed / 16) : Real(1) / 4;
    per_speed_ = 1 / speed_step_;
    rows_.reserve(speeds * lengths);
    for (int i = 0; i < speeds; ++i)
      for (int j = 0; j < lengths; ++j)
        rows_.push_back(derivative_bounds<Real>(mill_, (i + 1) * speed_step_, longest_ / (1 << j)));
  }

  /// Longest window [s] that the bounds serve.
  const Real& longest_window() const { return longest_; }

  DerivativeBounds<Real> at(const Real& speed, const Real& length) const {
    const Real place = speed * per_speed_;
    if (!(place < speeds - 1)) return derivative_bounds<Real>(mill_, speed, length);
    const int row = static_cast<int>(place);
    int column = 0;  // counted without branches: windows are of any length
    for (int j = 1; j < lengths; ++j) column += length <= longest_ / (1 << j);
    return rows_[row * lengths + column];
  }

 private:
  static constexpr int speeds = 64;
  static constexpr int lengths = 5;
  model::Mill<Real> mill_;
  Real longest_, speed_step_, per_speed_;
  std::vector<DerivativeBounds<Real>> rows_;
};

}  // namespace edmill::dynamics
