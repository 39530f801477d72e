// Flights in the moving vessel, and their contacts with its walls: docs/theory.md, sections 1
// and 2.
#pragma once

#include <algorithm>
#include <array>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "vectors.hpp"

template <class S> struct Mill {
  S turns_per_second, arm, theta_max, gamma_max, radius, half_height, gravity, ball_radius;
  // Of a faulty code: gaps at which bodies meet, and gamma's phase.
  std::array<S, 3> wall_gap{};
  S pair_gap{}, gamma_phase{};
};
template <class T> Mill<double> in_double(const Mill<T>& m) {
  auto d = [](const T& s) { return static_cast<double>(s); };
  return {d(m.turns_per_second), d(m.arm), d(m.theta_max), d(m.gamma_max), d(m.radius),
      d(m.half_height), d(m.gravity), d(m.ball_radius),
      {d(m.wall_gap[0]), d(m.wall_gap[1]), d(m.wall_gap[2])}, d(m.pair_gap), d(m.gamma_phase)};
}

// Section 1: P = R_z(theta) [ (l, 0, 0) + R_x(gamma) p ].
template <class S> struct Pose {
  S arm, ct, st, cg, sg, theta_rate, gamma_rate;

  Pose(const Mill<S>& m, S turns) : arm(m.arm) {
    using std::cos, std::sin, std::floor;
    const S pi = boost::math::constants::pi<S>();
    turns -= floor(turns);
    const S c = cos(2 * pi * turns), s = sin(2 * pi * turns), w = 2 * pi * m.turns_per_second;
    const S late = 2 * pi * turns + m.gamma_phase;
    const S theta = m.theta_max * c + pi / 2, gamma = m.gamma_max * sin(late);
    theta_rate = -m.theta_max * w * s;
    gamma_rate = m.gamma_max * w * cos(late);
    ct = cos(theta), st = sin(theta), cg = cos(gamma), sg = sin(gamma);
  }
  // A direction of the vessel in the inertial frame, and back.
  Vec<S> outward(const Vec<S>& p) const {
    const S y = cg * p.y - sg * p.z, z = sg * p.y + cg * p.z;
    return {ct * p.x - st * y, st * p.x + ct * y, z};
  }
  Vec<S> inward(const Vec<S>& d) const {
    const S x = ct * d.x + st * d.y, y = ct * d.y - st * d.x;
    return {x, cg * y + sg * d.z, cg * d.z - sg * y};
  }
  Vec<S> centre() const { return {arm * ct, arm * st, S(0)}; }
  // Velocity of the vessel's point that is at P.
  Vec<S> velocity(const Vec<S>& P) const {
    const Vec<S> about_z{S(0), S(0), theta_rate}, about_x{ct * gamma_rate, st * gamma_rate, S(0)};
    return cross(about_z, P) + cross(about_x, P - centre());
  }
};

// The parabola of a ball, by the time tau since its start.
template <class S> struct Flight {
  Vec<S> r, v;
  S turns;                     // of the drive at the start
  S in_place{1}, in_speed{1};  // gravity's share, other than 1 in a faulty code

  Vec<S> position(const Mill<S>& m, const S& tau) const {
    return r + v * tau - Vec<S>{S(0), in_place * m.gravity * tau * tau / 2, S(0)};
  }
  Vec<S> velocity(const Mill<S>& m, const S& tau) const {
    return v - Vec<S>{S(0), in_speed * m.gravity * tau, S(0)};
  }
  // Of the place: another than the velocity where gravity has other shares.
  Vec<S> rate(const Mill<S>& m, const S& tau) const {
    return v - Vec<S>{S(0), in_place * m.gravity * tau, S(0)};
  }
  Pose<S> pose(const Mill<S>& m, const S& tau) const {
    return {m, turns + tau * m.turns_per_second};
  }
};

template <class S> struct Gap { S value, rate; };

// Section 2. The rates: the ball's velocity less that of the vessel's point it is at, in the
// vessel's axes.
template <class S>
std::array<Gap<S>, 3> gaps(const Mill<S>& m, const Flight<S>& flight, const S& tau) {
  const Pose<S> pose = flight.pose(m, tau);
  const Vec<S> P = flight.position(m, tau);
  const Vec<S> p = pose.inward(P - pose.centre());
  const Vec<S> u = pose.inward(flight.rate(m, tau) - pose.velocity(P));
  const S free_height = m.half_height - m.ball_radius,
          free_radius = m.radius - m.ball_radius - m.wall_gap[2];
  return {{{free_height - m.wall_gap[0] + p.y, u.y}, {free_height - m.wall_gap[1] - p.y, -u.y},
      {free_radius * free_radius - p.x * p.x - p.z * p.z, -2 * (p.x * u.x + p.z * u.z)}}};
}

// The contact in [a, b], at whose end the gap is negative: bisection to an open gap, then Newton.
template <class T>
T closing_time(const Mill<T>& m, const Flight<T>& flight, unsigned wall, T a, T b) {
  const T least = 8 * std::numeric_limits<T>::epsilon() * b;
  for (Gap<T> g = gaps(m, flight, a)[wall]; !(g.value > 0);) {  // a ball that has just left
    if (b - a <= least) return b;
    const T middle = (a + b) / 2;
    g = gaps(m, flight, middle)[wall];
    (g.value > 0 || g.rate > 0 ? a : b) = middle;
  }
  T x = (a + b) / 2;
  while (b - a > least) {
    const Gap<T> g = gaps(m, flight, x)[wall];
    (g.value > 0 ? a : b) = x;
    const T next = x - g.value / g.rate;
    if (abs(next - x) <= least) return x;
    x = next > a && next < b ? next : T((a + b) / 2);
  }
  return x;
}

// The least gap in [a, b], where the rate changes sign; the place if the ball is at or behind the
// wall there.
template <class T>
std::optional<T> graze(const Mill<T>& m, const Flight<T>& flight, unsigned wall, T a, T b) {
  for (int i = 0; i < 400 && b - a > std::numeric_limits<T>::epsilon() * b; ++i) {
    const T middle = (a + b) / 2;
    const Gap<T> g = gaps(m, flight, middle)[wall];
    if (g.value <= 0) return middle;
    if (g.value > abs(g.rate) * (b - a)) return {};  // the gap is convex here: it stays open
    (g.rate < 0 ? a : b) = middle;
  }
  return {};
}

// The first contact with a wall: samples in double, roots in the wide scalar.
template <class T> std::pair<T, unsigned> first_wall(const Mill<T>& m, const Flight<T>& flight) {
  const Mill<double> near_mill = in_double(m);
  auto d = [](const Vec<T>& v) {
    return Vec<double>{
        static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
  };
  const Flight<double> near_flight{d(flight.r), d(flight.v), static_cast<double>(flight.turns),
      static_cast<double>(flight.in_place), static_cast<double>(flight.in_speed)};
  // A sign that double cannot decide is computed in the wide scalar.
  auto sample = [&](double tau, bool wide) {
    std::array<Gap<double>, 3> near = gaps(near_mill, near_flight, tau);
    for (const Gap<double>& g : near)
      wide = wide || std::fabs(g.value) < 1e-12 || std::fabs(g.rate) < 1e-12;
    if (!wide) return near;
    const std::array<Gap<T>, 3> sharp = gaps(m, flight, T(tau));
    for (unsigned k = 0; k < 3; ++k)
      near[k] = {static_cast<double>(sharp[k].value), static_cast<double>(sharp[k].rate)};
    return near;
  };
  double a = 0, step = 1e-9;
  std::array<Gap<double>, 3> old = sample(a, true);
  for (unsigned k = 0; k < 3; ++k)
    if (old[k].value <= 0 && old[k].rate < 0) return {T(0), k};
  while (a < 10) {
    const double b = a + step;
    const std::array<Gap<double>, 3> now = sample(b, false);
    std::optional<std::pair<T, unsigned>> first;
    for (unsigned k = 0; k < 3; ++k) {
      std::optional<T> behind;
      if (now[k].value <= 0 && now[k].rate < 0)
        behind = T(b);
      else if (old[k].rate < 0 && now[k].rate >= 0)
        behind = graze(m, flight, k, T(a), T(b));
      if (!behind) continue;
      const T tau = closing_time(m, flight, k, T(a), *behind);
      if (!first || tau < first->first) first = {tau, k};
    }
    if (first) return *first;
    a = b;
    old = now;
    step = std::min(1.5 * step, 1e-5);
  }
  throw std::runtime_error("a ball meets no wall within 10 s");
}
