// Gap functions as Taylor series with Arb's coefficients, for the oracle of the wall tests.
#pragma once

#include <algorithm>
#include <utility>

#include "arb_chain.hpp"
#include "arb_oracle.hpp"

namespace edmill::testing {

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

  /// Taylor coefficients of the gap function of `wall` about the offset `t` in units of `h`. Over a
  /// wide `t` they enclose those about every time in it.
  Series gap(int wall, const Ball& t, const Ball& h, slong count, slong prec) const {
    Series result = fixed_gap(wall, t, h, count, prec);
    for (const auto& piston : q_.pistons) {
      if (piston.wall != wall) continue;
      const OracleClock clock{q_.begin_period, Ball(q_.period)};
      Series moved = swing_series(piston.swings, clock, t, h, count, prec);
      add_constant_speed(moved, piston.speed, clock, t, h, prec);
      const Ball distance(piston.distance);
      arb_add(moved[0], moved[0], distance.v, prec);
      for (slong k = 0; k < count; ++k) arb_sub(result[k], result[k], moved[k], prec);
    }
    return result;
  }

  /// Whether a ball of this size ever touches `wall`: edges rounder than the ball are beyond its
  /// reach.
  bool within_reach(int wall) const { return !edges_unreachable() || wall >= 2; }

  /// Taylor coefficients of functions that are at least zero where `wall` is the nearest one. These
  /// regions reach a little into each other, so that a contact on their border is found with both
  /// walls.
  std::vector<Series> borders(
      int wall, const Ball& t, const Ball& h, slong count, slong prec) const {
    std::vector<Series> result;
    if (!q_.rounded || edges_unreachable()) return result;
    constexpr double overlap = 1e-10;  // [m]; the gaps differ by its square
    const auto [a, b, rounding] = *q_.rounded;
    const auto place = coordinates(t, h, count, prec);
    const auto add = [&](const Series& value, double bound, bool above) {
      result.push_back(value);
      const Ball limit(bound);
      arb_sub(result.back()[0], value[0], limit.v, prec);
      for (slong k = 0; !above && k < count; ++k) arb_neg(result.back()[k], result.back()[k]);
    };
    Series height = place[1];
    if (wall == 0 || wall == 3)
      for (slong k = 0; k < count; ++k) arb_neg(height[k], height[k]);
    if (wall == 2) {
      add(height, b + overlap, false);
      add(height, -b - overlap, true);
    } else {
      add(height, b - overlap, true);
    }
    if (a > 0 && wall != 2) {
      Series square(count);
      add_product(square, 1, place[0], place[0], prec);
      add_product(square, 1, place[2], place[2], prec);
      const double edge = wall < 3 ? a - overlap : a + overlap;
      add(square, edge * edge, wall < 3);
    }
    return result;
  }

  /// Value and rate at one offset.
  Series sample(int wall, const Ball& t, slong count = 2) const {
    return gap(wall, t, Ball(1.0), count, prec_);
  }
 private:
  /// To the wall at its place in the vessel.
  Series fixed_gap(int wall, const Ball& t, const Ball& h, slong count, slong prec) const {
    const slong n = count;
    if (q_.sphere) return gap_to_centre(t, h, n, prec);
    if (q_.rounded) return gap_to_rounded(wall, t, h, n, prec);
    if (!q_.planes.empty())
      return gap_to_plane(q_.planes[static_cast<std::size_t>(wall)], t, h, n, prec);
    if (!q_.polynomials.empty())
      return gap_of_polynomial(q_.polynomials[static_cast<std::size_t>(wall)], t, h, n, prec);
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
    const auto place = coordinates(t, h, n, prec);
    const Series &x = place[0], &z = place[2];
    Series result(n);
    for (slong k = 0; k < n; ++k) {
      arb_dot(result[k], nullptr, 1, x[0], 1, x[k], -1, k + 1, prec);
      arb_dot(result[k], result[k], 1, z[0], 1, z[k], -1, k + 1, prec);
    }
    arb_addmul(result[0], cylinder_.v, cylinder_.v, prec);
    return result;
  }

  /// size^2 - the sum of squares of the given series
  static Series beyond_squares(const Ball& size, const std::vector<Series>& parts, slong prec) {
    Series result(parts[0].size());
    for (const auto& part : parts) add_product(result, -1, part, part, prec);
    arb_addmul(result[0], size.v, size.v, prec);
    return result;
  }
  Series gap_to_centre(const Ball& t, const Ball& h, slong n, slong prec) const {
    Ball room(*q_.sphere);
    const Ball radius(q_.radius);
    arb_sub(room.v, room.v, radius.v, exact);
    const auto place = coordinates(t, h, n, prec);
    return beyond_squares(room, {place[0], place[1], place[2]}, prec);
  }
  /// 0 and 1 the edges or ends, 2 the cylinder, 3 and 4 the caps.
  Series gap_to_rounded(int wall, const Ball& t, const Ball& h, slong n, slong prec) const {
    const Ball core((*q_.rounded)[0]), half((*q_.rounded)[1]), radius(q_.radius);
    Ball room((*q_.rounded)[2]), along, around;
    arb_sub(room.v, room.v, radius.v, exact);
    arb_add(along.v, half.v, room.v, exact);
    arb_add(around.v, core.v, room.v, exact);
    auto [x, y, z] = coordinates(t, h, n, prec);
    if (wall == 2) return beyond_squares(around, {x, z}, prec);
    if (wall == 0 || wall == 3)
      for (slong k = 0; k < n; ++k) arb_neg(y[k], y[k]);
    if (wall >= 3) {
      for (slong k = 0; k < n; ++k) arb_neg(y[k], y[k]);
      arb_add(y[0], y[0], along.v, prec);
      return y;
    }
    arb_sub(y[0], y[0], half.v, prec);
    if (arb_is_zero(core.v)) return beyond_squares(room, {x, z, y}, prec);
    Series square(n), distance(n);
    add_product(square, 1, x, x, prec);
    add_product(square, 1, z, z, prec);
    _arb_poly_sqrt_series(distance[0], square[0], n, n, prec);
    arb_sub(distance[0], distance[0], core.v, prec);
    return beyond_squares(room, {distance, y}, prec);
  }

  /// d - R - n.p
  Series gap_to_plane(
      const std::array<double, 4>& plane, const Ball& t, const Ball& h, slong n, slong prec) const {
    Series result(n);
    const Ball distance(plane[3]), radius(q_.radius);
    arb_sub(result[0], distance.v, radius.v, exact);
    const auto place = coordinates(t, h, n, prec);
    for (int axis = 0; axis < 3; ++axis) {
      const Ball normal(plane[static_cast<std::size_t>(axis)]);
      const Series& x = place[static_cast<std::size_t>(axis)];
      for (slong k = 0; k < n; ++k) arb_submul(result[k], x[k], normal.v, prec);
    }
    return result;
  }

  Series gap_of_polynomial(const std::vector<OracleTerm>& terms, const Ball& t, const Ball& h,
      slong n, slong prec) const {
    const auto place = coordinates(t, h, n, prec);
    Series sum(n);
    for (const auto& term : terms) {
      const Ball radius(q_.radius);
      Series product(n);
      arb_set_d(product[0], term.factor);
      for (int k = 0; k < term.powers[3]; ++k) arb_mul(product[0], product[0], radius.v, prec);
      for (std::size_t axis = 0; axis < 3; ++axis)
        for (int k = 0; k < term.powers[axis]; ++k) {
          Series next(n);
          add_product(next, 1, product, place[axis], prec);
          product = next;
        }
      for (slong k = 0; k < n; ++k) arb_add(sum[k], sum[k], product[k], prec);
    }
    return sum;
  }

  bool edges_unreachable() const { return q_.rounded && q_.radius > (*q_.rounded)[2]; }

  /// The ball in the vessel frame.
  std::array<Series, 3> coordinates(const Ball& t, const Ball& h, slong n, slong prec) const {
    if (!q_.chain) return in_nested(t, h, n, prec);
    std::array<Series, 3> place;
    for (std::size_t k = 0; k < 3; ++k) place[k] = cut(path(k, t, h, n, prec), n);
    return through_chain(*q_.chain, {q_.begin_period, Ball(q_.period)}, place, t, h, prec);
  }
  Series coordinate(int axis, const Ball& t, const Ball& h, slong n, slong prec) const {
    return coordinates(t, h, n, prec)[static_cast<std::size_t>(axis)];
  }

  std::array<Series, 3> in_nested(const Ball& t, const Ball& h, slong n, slong prec) const {
    Series sin_a(n), cos_a(n), sin_g(n), cos_g(n);
    turn_drive(t, h, prec, sin_a, cos_a, sin_g, cos_g);
    // R_z(-theta) P = (x, b, Z) with x = Y cos(alpha) - X sin(alpha), b = -X cos(alpha) - Y
    // sin(alpha), R_x(-gamma): y = b cos(gamma) + Z sin(gamma), z = Z cos(gamma) - b sin(gamma).
    const Series X = path(0, t, h, n, prec), Y = path(1, t, h, n, prec), Z = path(2, t, h, n, prec);
    Series x(n), y(n), z(n), b(n);
    for (slong k = 0; k < n; ++k) {
      const slong terms = std::min<slong>(k + 1, 3);  // of a path
      arb_dot(x[k], nullptr, 0, Y[0], 1, cos_a[k], -1, terms, prec);
      arb_dot(x[k], x[k], 1, X[0], 1, sin_a[k], -1, terms, prec);
      arb_dot(b[k], nullptr, 0, X[0], 1, cos_a[k], -1, terms, prec);
      arb_dot(b[k], b[k], 0, Y[0], 1, sin_a[k], -1, terms, prec);
      arb_neg(b[k], b[k]);
    }
    const Ball arm(q_.arm);
    arb_sub(x[0], x[0], arm.v, prec);
    for (slong k = 0; k < n; ++k) {
      const slong terms = std::min<slong>(k + 1, 3);
      arb_dot(y[k], nullptr, 0, b[0], 1, cos_g[k], -1, k + 1, prec);
      arb_dot(y[k], y[k], 0, Z[0], 1, sin_g[k], -1, terms, prec);
      arb_dot(z[k], nullptr, 0, Z[0], 1, cos_g[k], -1, terms, prec);
      arb_dot(z[k], z[k], 1, b[0], 1, sin_g[k], -1, k + 1, prec);
    }
    return {x, y, z};
  }

  /// Sine and cosine of alpha = theta - pi/2 and of gamma.
  void turn_drive(const Ball& t, const Ball& h, slong prec, Series& sin_a, Series& cos_a,
      Series& sin_g, Series& cos_g) const {
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
