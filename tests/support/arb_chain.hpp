// A place seen from the end of a chain of joints, as Taylor series.
#pragma once

#include <array>
#include <vector>

#include "arb_oracle.hpp"
#include "arb_values.hpp"

namespace edmill::testing {

/// The first n coefficients.
inline Series cut(const Series& series, slong n) {
  Series result(n);
  for (slong k = 0; k < std::min(n, series.size()); ++k) arb_set(result[k], series[k]);
  return result;
}
/// a += sign * b c
inline void add_product(Series& a, int sign, const Series& b, const Series& c, slong prec) {
  Ball term;
  for (slong k = 0; k < a.size(); ++k) {
    arb_dot(term.v, nullptr, sign < 0, b[0], 1, c[k], -1, k + 1, prec);
    arb_add(a[k], a[k], term.v, prec);
  }
}

inline Ball fraction_of(const OracleTurns& turns) {
  Ball fraction;
  for (std::size_t k = turns.fraction.size(); k-- > 0;) {
    arb_add_ui(fraction.v, fraction.v, turns.fraction[k], exact);
    arb_mul_2exp_si(fraction.v, fraction.v, -64);
  }
  return fraction;
}

/// The clock of a mill: the drive period in which offsets count, and its length.
struct OracleClock {
  std::int64_t count;
  Ball length;  ///< [s]
};

/// 2 pi (phase + turns of whole periods + turns at the offset) about the offset t in units of h.
inline Series phase_series(const OracleTurns& per_period, const OracleClock& clock, double phase,
    const Ball& t, const Ball& h, slong n, slong prec) {
  Series result(std::max<slong>(n, 2));
  Ball turn, rate = fraction_of(per_period), turns = rate, whole;
  // Whole turns of whole periods drop out.
  arb_mul_si(turns.v, turns.v, clock.count, exact);
  arb_floor(whole.v, turns.v, 4096);
  arb_sub(turns.v, turns.v, whole.v, exact);
  arb_add_si(rate.v, rate.v, per_period.whole, exact);
  arb_div(rate.v, rate.v, clock.length.v, prec + 16);
  arb_const_pi(turn.v, prec + 16);
  arb_mul_2exp_si(turn.v, turn.v, 1);
  const Ball begin(phase);
  arb_add(turns.v, turns.v, begin.v, exact);
  arb_mul(result[0], rate.v, t.v, prec);
  arb_add(result[0], result[0], turns.v, prec);
  arb_mul(result[0], result[0], turn.v, prec);
  arb_mul(result[1], rate.v, h.v, prec);
  arb_mul(result[1], result[1], turn.v, prec);
  return cut(result, n);
}

/// The sum of swings: [m] or [turns].
inline Series swing_series(const std::vector<OracleSwing>& swings, const OracleClock& clock,
    const Ball& t, const Ball& h, slong n, slong prec) {
  Series sum(n);
  for (const auto& swing : swings) {
    Series sine(n), cosine(n);
    sin_cos(phase_series(swing.per_period, clock, swing.phase, t, h, n, prec), sine, cosine, prec);
    const Ball amplitude(swing.amplitude);
    for (slong k = 0; k < n; ++k) arb_addmul(sum[k], sine[k], amplitude.v, prec);
  }
  return sum;
}

/// speed times the clock [m].
inline void add_constant_speed(
    Series& sum, double speed, const OracleClock& clock, const Ball& t, const Ball& h, slong prec) {
  const Ball rate(speed);
  Ball seconds;
  arb_mul_si(seconds.v, clock.length.v, clock.count, exact);
  arb_add(seconds.v, seconds.v, t.v, exact);
  arb_addmul(sum[0], rate.v, seconds.v, prec);
  if (sum.size() > 1) arb_addmul(sum[1], rate.v, h.v, prec);
}

inline std::array<Ball, 3> unit_vector(const std::array<double, 3>& v, slong prec) {
  Ball size;
  std::array<Ball, 3> unit;
  for (std::size_t k = 0; k < 3; ++k) {
    unit[k] = Ball(v[k]);
    arb_addmul(size.v, unit[k].v, unit[k].v, exact);
  }
  if (arb_is_zero(size.v)) return unit;
  arb_sqrt(size.v, size.v, prec);
  for (auto& x : unit) arb_div(x.v, x.v, size.v, prec);
  return unit;
}

/// Turned about the axis a by -angle: p cos - a x p sin + a (a.p) (1 - cos). (Rodrigues)
inline std::array<Series, 3> turned_back(const std::array<Series, 3>& p,
    const std::array<Ball, 3>& a, const Series& sine, const Series& cosine, slong prec) {
  const slong n = sine.size();
  Series along(n), rest(n);
  for (slong k = 0; k < n; ++k) {
    arb_neg(rest[k], cosine[k]);
    for (std::size_t i = 0; i < 3; ++i) arb_addmul(along[k], p[i][k], a[i].v, prec);
  }
  arb_add_ui(rest[0], rest[0], 1, prec);
  Series lifted(n);
  add_product(lifted, 1, along, rest, prec);
  std::array<Series, 3> result;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, l = (i + 2) % 3;
    Series crossed(n);
    for (slong k = 0; k < n; ++k) {
      arb_mul(crossed[k], p[l][k], a[j].v, prec);
      arb_submul(crossed[k], p[j][k], a[l].v, prec);
    }
    Series sum(n);
    for (slong k = 0; k < n; ++k) arb_mul(sum[k], lifted[k], a[i].v, prec);
    add_product(sum, 1, p[i], cosine, prec);
    add_product(sum, -1, crossed, sine, prec);
    result[i] = sum;
  }
  return result;
}

/// An inertial place about the offset t of this period, seen from behind the last joint.
inline std::array<Series, 3> through_chain(const std::vector<OracleJoint>& chain,
    const OracleClock& clock, std::array<Series, 3> p, const Ball& t, const Ball& h, slong prec) {
  const slong n = p[0].size();
  for (const auto& joint : chain) {
    const auto axis = unit_vector(joint.axis, prec);
    Series swing = swing_series(joint.swings, clock, t, h, n, prec);
    if (!joint.rotates) {
      add_constant_speed(swing, joint.speed, clock, t, h, prec);
      for (std::size_t i = 0; i < 3; ++i) {
        const Ball shift(joint.shift[i]);
        arb_sub(p[i][0], p[i][0], shift.v, prec);
        for (slong k = 0; k < n; ++k) arb_submul(p[i][k], swing[k], axis[i].v, prec);
      }
      continue;
    }
    Series angle = phase_series(joint.per_period, clock, joint.angle, t, h, n, prec);
    Ball turn;
    arb_const_pi(turn.v, prec + 16);
    arb_mul_2exp_si(turn.v, turn.v, 1);
    for (slong k = 0; k < n; ++k) arb_addmul(angle[k], swing[k], turn.v, prec);
    Series sine(n), cosine(n);
    sin_cos(angle, sine, cosine, prec);
    p = turned_back(p, axis, sine, cosine, prec);
  }
  return p;
}

}  // namespace edmill::testing
