// Gap functions as Taylor series with Arb's coefficients, for the oracle of the wall tests.
#pragma once

#include <arb.h>
#include <arb_poly.h>

#include <algorithm>
#include <utility>

#include "arb_oracle.hpp"

namespace edmill::testing {

inline constexpr slong exact = ARF_PREC_EXACT;
inline constexpr slong coarse = 64;  // bits for ranges and remainders

/// Owner of one Arb ball.
struct Ball {
  arb_t v;
  Ball() { arb_init(v); }
  explicit Ball(double x) : Ball() { arb_set_d(v, x); }
  Ball(const Ball& other) : Ball() { arb_set(v, other.v); }
  Ball& operator=(const Ball& other) {
    arb_set(v, other.v);
    return *this;
  }
  ~Ball() { arb_clear(v); }
};

/// Owner of Taylor coefficients.
class Series {
 public:
  explicit Series(slong size = 0) : size_(size), data_(_arb_vec_init(size)) {}
  Series(const Series& other) : Series(other.size_) { _arb_vec_set(data_, other.data_, size_); }
  Series& operator=(Series other) {
    std::swap(size_, other.size_);
    std::swap(data_, other.data_);
    return *this;
  }
  ~Series() { _arb_vec_clear(data_, size_); }
  slong size() const { return size_; }
  arb_ptr operator[](slong k) const { return data_ + k; }

  Series derivative(slong prec) const {
    if (size_ <= 1) return Series(1);
    Series result(size_ - 1);
    _arb_poly_derivative(result.data_, data_, size_, prec);
    return result;
  }
  void at(Ball& result, const Ball& s, slong prec) const {
    _arb_poly_evaluate_horner(result.v, data_, size_, s.v, prec);
  }

 private:
  slong size_;
  arb_ptr data_;
};

inline Ball middle_of(const Ball& x) {
  Ball m;
  arb_get_mid_arb(m.v, x.v);
  return m;
}

inline Ball hull(const Ball& a, const Ball& b, slong prec) {
  Ball x;
  arb_union(x.v, a.v, b.v, prec);
  return x;
}

inline bool negative(const Ball& x) { return arb_is_negative(x.v); }
inline bool positive(const Ball& x) { return arb_is_positive(x.v); }
inline bool not_positive(const Ball& x) { return arb_is_nonpositive(x.v); }
inline bool not_negative(const Ball& x) { return arb_is_nonnegative(x.v); }
inline double nearest(const Ball& x) { return arf_get_d(arb_midref(x.v), ARF_RND_NEAR); }

/// Whether most of the width of `range` comes from the uncertainty of the value at its middle.
inline bool blurred(const Ball& at_middle, const Ball& range) {
  mag_t m;
  mag_init(m);
  mag_mul_2exp_si(m, arb_radref(at_middle.v), 3);
  const bool result = mag_cmp(m, arb_radref(range.v)) > 0;
  mag_clear(m);
  return result;
}

/// One question at one precision. Time is the offset in the period of the window's begin.
class Problem {
 public:
  Problem(const OracleQuestion& question, slong prec) : q_(question), prec_(prec) {
    arb_const_pi(omega_.v, prec + 16);
    arb_mul_2exp_si(omega_.v, omega_.v, 1);
    const Ball period(q_.period);
    arb_div(omega_.v, omega_.v, period.v, prec + 16);
    // elapsed time = offset + shift
    arb_mul_si(shift_.v, period.v, q_.begin_period - q_.start_period, exact);
    const Ball start(q_.start_offset);
    arb_sub(shift_.v, shift_.v, start.v, exact);
    const Ball radius(q_.radius), height(q_.half_height), vessel(q_.vessel_radius);
    arb_sub(cap_.v, height.v, radius.v, exact);
    arb_sub(cylinder_.v, vessel.v, radius.v, exact);
  }

  slong prec() const { return prec_; }
  const OracleQuestion& question() const { return q_; }

  /// Taylor coefficients of the gap function of `wall` about the offset `t` in units of `h`. Over a wide `t`
  /// they enclose those about every time in it.
  Series gap(int wall, const Ball& t, const Ball& h, slong count, slong prec) const {
    const slong n = count;
    if (!q_.planes.empty()) return gap_to_plane(q_.planes[static_cast<std::size_t>(wall)], t, h, n, prec);
    if (q_.box || wall < 2) {
      const int axis = q_.box ? wall / 2 : 1;
      Series result = coordinate(axis, t, h, n, prec);
      if (wall % 2 == 1)
        for (slong k = 0; k < n; ++k) arb_neg(result[k], result[k]);
      Ball room = cap_;
      if (q_.box) {
        const Ball half((*q_.box)[static_cast<std::size_t>(axis)]), radius(q_.radius);
        arb_sub(room.v, half.v, radius.v, exact);
      }
      arb_add(result[0], result[0], room.v, prec);
      return result;
    }
    const Series x = coordinate(0, t, h, n, prec), z = coordinate(2, t, h, n, prec);
    Series result(n);
    for (slong k = 0; k < n; ++k) {
      arb_dot(result[k], nullptr, 1, x[0], 1, x[k], -1, k + 1, prec);
      arb_dot(result[k], result[k], 1, z[0], 1, z[k], -1, k + 1, prec);
    }
    arb_addmul(result[0], cylinder_.v, cylinder_.v, prec);
    return result;
  }

  /// Value and rate at one offset.
  Series sample(int wall, const Ball& t, slong count = 2) const {
    return gap(wall, t, Ball(1.0), count, prec_);
  }

 private:
  /// d - R - n.p
  Series gap_to_plane(const std::array<double, 4>& plane, const Ball& t, const Ball& h, slong n,
                      slong prec) const {
    Series result(n);
    const Ball distance(plane[3]), radius(q_.radius);
    arb_sub(result[0], distance.v, radius.v, exact);
    for (int axis = 0; axis < 3; ++axis) {
      const Ball normal(plane[static_cast<std::size_t>(axis)]);
      const Series x = coordinate(axis, t, h, n, prec);
      for (slong k = 0; k < n; ++k) arb_submul(result[k], x[k], normal.v, prec);
    }
    return result;
  }

  /// A coordinate of the ball in the vessel frame.
  Series coordinate(int axis, const Ball& t, const Ball& h, slong n, slong prec) const {
    return q_.shaken ? on_table(axis, t, h, n, prec) : in_nested(axis, t, h, n, prec);
  }

  /// P - A sin(phase).
  Series on_table(int axis, const Ball& t, const Ball& h, slong n, slong prec) const {
    Ball phase, wh, factor((*q_.shaken)[static_cast<std::size_t>(axis)]), s, c;
    arb_mul(phase.v, omega_.v, t.v, prec);
    arb_mul(wh.v, omega_.v, h.v, prec);
    arb_sin_cos(s.v, c.v, phase.v, prec);
    Series result(n);
    const Series r = path(static_cast<std::size_t>(axis), t, h, n, prec);
    for (slong k = 0; k < n; ++k) {
      if (k > 0) {
        arb_mul(factor.v, factor.v, wh.v, prec);
        arb_div_ui(factor.v, factor.v, static_cast<ulong>(k), prec);
      }
      arb_mul(result[k], (k % 2 == 0 ? s : c).v, factor.v, prec);
      if (k % 4 < 2) arb_neg(result[k], result[k]);  // -(sin, cos, -sin, -cos)
      if (k < 3) arb_add(result[k], result[k], r[k], prec);
    }
    return result;
  }

  Series in_nested(int axis, const Ball& t, const Ball& h, slong n, slong prec) const {
    Series sin_a(n), cos_a(n), sin_g(n), cos_g(n);
    turn_drive(t, h, prec, sin_a, cos_a, sin_g, cos_g);
    // R_z(-theta) P = (a, b, Z) with a = Y cos(alpha) - X sin(alpha), b = -X cos(alpha) - Y sin(alpha).
    const Series X = path(0, t, h, n, prec), Y = path(1, t, h, n, prec), Z = path(2, t, h, n, prec);
    Series result(n);
    if (axis == 0) {
      for (slong k = 0; k < n; ++k) {
        const slong terms = std::min<slong>(k + 1, 3);
        arb_dot(result[k], nullptr, 0, Y[0], 1, cos_a[k], -1, terms, prec);
        arb_dot(result[k], result[k], 1, X[0], 1, sin_a[k], -1, terms, prec);
      }
      const Ball arm(q_.arm);
      arb_sub(result[0], result[0], arm.v, prec);
      return result;
    }
    Series b(n);
    for (slong k = 0; k < n; ++k) {
      const slong terms = std::min<slong>(k + 1, 3);
      arb_dot(b[k], nullptr, 0, X[0], 1, cos_a[k], -1, terms, prec);
      arb_dot(b[k], b[k], 0, Y[0], 1, sin_a[k], -1, terms, prec);
      arb_neg(b[k], b[k]);
    }
    // R_x(-gamma): y = b cos(gamma) + Z sin(gamma), z = Z cos(gamma) - b sin(gamma).
    for (slong k = 0; k < n; ++k) {
      const slong terms = std::min<slong>(k + 1, 3);
      if (axis == 1) {
        arb_dot(result[k], nullptr, 0, b[0], 1, cos_g[k], -1, k + 1, prec);
        arb_dot(result[k], result[k], 0, Z[0], 1, sin_g[k], -1, terms, prec);
      } else {
        arb_dot(result[k], nullptr, 0, Z[0], 1, cos_g[k], -1, terms, prec);
        arb_dot(result[k], result[k], 1, b[0], 1, sin_g[k], -1, k + 1, prec);
      }
    }
    return result;
  }

  /// Sine and cosine of alpha = theta - pi/2 and of gamma.
  void turn_drive(const Ball& t, const Ball& h, slong prec, Series& sin_a, Series& cos_a, Series& sin_g,
                  Series& cos_g) const {
    const slong n = sin_a.size();
    Ball phase, wh, factor(1.0), s, c;
    arb_mul(phase.v, omega_.v, t.v, prec);
    arb_mul(wh.v, omega_.v, h.v, prec);
    arb_sin_cos(s.v, c.v, phase.v, prec);
    Series alpha(n), gamma(n);
    for (slong k = 0; k < n; ++k) {
      if (k > 0) {
        arb_mul(factor.v, factor.v, wh.v, prec);
        arb_div_ui(factor.v, factor.v, static_cast<ulong>(k), prec);
      }
      arb_mul(alpha[k], (k % 2 == 0 ? c : s).v, factor.v, prec);
      arb_mul(gamma[k], (k % 2 == 0 ? s : c).v, factor.v, prec);
      if (k % 4 == 1 || k % 4 == 2) arb_neg(alpha[k], alpha[k]);  // cos, -sin, -cos, sin
      if (k % 4 >= 2) arb_neg(gamma[k], gamma[k]);                // sin, cos, -sin, -cos
    }
    const Ball theta_max(q_.theta_max), gamma_max(q_.gamma_max);
    for (slong k = 0; k < n; ++k) {
      arb_mul(alpha[k], alpha[k], theta_max.v, prec);
      arb_mul(gamma[k], gamma[k], gamma_max.v, prec);
    }
    sin_cos(alpha, sin_a, cos_a, prec);
    sin_cos(gamma, sin_g, cos_g, prec);
  }

  static void sin_cos(const Series& angle, Series& sine, Series& cosine, slong prec) {
    const slong n = angle.size();
    Series rate(n);  // k a_k
    for (slong k = 1; k < n; ++k) arb_mul_ui(rate[k], angle[k], static_cast<ulong>(k), prec);
    arb_sin_cos(sine[0], cosine[0], angle[0], prec);
    for (slong k = 1; k < n; ++k) {
      arb_dot(sine[k], nullptr, 0, rate[1], 1, cosine[k - 1], -1, k, prec);
      arb_dot(cosine[k], nullptr, 1, rate[1], 1, sine[k - 1], -1, k, prec);
      arb_div_ui(sine[k], sine[k], static_cast<ulong>(k), prec);
      arb_div_ui(cosine[k], cosine[k], static_cast<ulong>(k), prec);
    }
  }

  /// r0 + v0 dt + g dt^2 / 2 along one inertial axis.
  Series path(std::size_t axis, const Ball& t, const Ball& h, slong n, slong prec) const {
    Series r(std::max<slong>(n, 3));
    Ball dt;
    arb_add(dt.v, t.v, shift_.v, prec);
    const Ball g(q_.gravity[axis]), v0(q_.velocity[axis]), r0(q_.position[axis]);
    arb_mul(r[2], g.v, dt.v, prec);
    arb_add(r[1], v0.v, r[2], prec);  // v
    arb_mul_2exp_si(r[2], r[2], -1);
    arb_add(r[2], r[2], v0.v, prec);
    arb_mul(r[0], r[2], dt.v, prec);
    arb_add(r[0], r[0], r0.v, prec);
    arb_mul(r[1], r[1], h.v, prec);
    arb_mul(r[2], h.v, h.v, prec);
    arb_mul(r[2], r[2], g.v, prec);
    arb_mul_2exp_si(r[2], r[2], -1);
    return r;
  }

  OracleQuestion q_;
  slong prec_;
  Ball omega_, shift_, cap_, cylinder_;
};

}  // namespace edmill::testing
