// A small event-driven mill with switches for mistakes, which writes its log as another code would:
// independent of the engine, with its own search, so that every impact follows from the mistaken
// ones before.
#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core.hpp"
#include "dynamics/impulse.hpp"
#include "mill_parts.hpp"
#include "output/collision_log.hpp"

namespace edmill::testing {

struct Faults {
  bool printed_rotations = false;   ///< (2.14)
  bool wall_at_rest = false;        ///< velocity 0 in the impulse
  double wall_velocity_factor = 1;  ///< in the impulse
  double restitution = -1;          ///< instead of the law's
  double least_separation = -1;     ///< instead of the law's [m/s]; 0 for none
  bool restitution_friction =
      false;  ///< sliding limited by mu (1 + e_n) |g_n| where bodies separate at v_s
  bool tangential_sign = false;     ///< (2.34)
  bool printed_compliance = false;  ///< (2.24)
  bool equal_masses = false;        ///< each of two balls takes half of the relative change
  bool exchanged_masses = false;    ///< each takes the share of the other
  bool spin_lost = false;           ///< in flight
  bool no_gravity = false;          ///< in flight
  int late_every = 0;               ///< one in this many impacts is handled 20 us late
  double step = 0;                  ///< contacts are seen at the first multiple of it [s]
  int missed_pairs_every = 0;       ///< one in this many contacts of two balls is missed
  bool lower_cap_unseen = false;    ///< (2.19): y - R - h/2 never changes its sign
  double dose_factor = 1;
  bool net_dose = false;  ///< supplied energy is subtracted from the dose
};

class FaultyMill {
 public:
  using Vec = Vec3<double>;

  FaultyMill(const model::Case<double>& the_case,
      const std::vector<model::BallState<double>>& states, const Faults& faults)
      : case_(the_case), states_(states), faults_(faults), stalls_(states.size()) {
    gravity_ = faults.no_gravity ? Vec(0, 0, 0) : the_case.mill.gravity;
  }

  /// Writes `count` impacts. @return how many were handled with a periodic fault
  int write_log(const std::filesystem::path& place, int count) {
    std::ofstream out(place);
    out << output::collision_log_header(true) << '\n';
    for (int written = 0; written < count;) {
      const Contact next = first_contact();
      advance(next.time);
      if (!next.with_wall && faults_.missed_pairs_every > 0 &&
          ++pairs_ % faults_.missed_pairs_every == 0) {
        passing_ = {next.ball, next.partner};
        ++special_;
        continue;
      }
      if (faults_.late_every > 0 && ++impacts_ % faults_.late_every == 0) {
        // Only where nothing else happens in between and two balls do not separate before.
        const double late = time_ + 20e-6;
        if (first_contact(&next).time > late && !parting_at(late, next)) {
          advance(late);
          ++special_;
        }
      }
      if (faults_.step > 0) see_at_a_step(next);
      out << written++ << collide(next) << '\n';
    }
    return special_;
  }
 private:
  struct Contact {
    double time = std::numeric_limits<double>::infinity();
    int ball = -1;
    bool with_wall = true;
    int partner = -1;
  };

  /// The vessel's axes as columns. (2.7') or (2.14)
  void axes(
      double t, Vec& x, Vec& y, Vec& z, Vec& centre, double& theta_rate, double& gamma_rate) const {
    const auto& m = spex(case_.mill);
    const double w = 2 * M_PI / m.period();
    const double theta = m.theta_max() * std::cos(w * t) + M_PI / 2,
                 gamma = m.gamma_max() * std::sin(w * t);
    const double s = std::sin(theta), c = std::cos(theta), sg = std::sin(gamma),
                 cg = std::cos(gamma);
    centre = {m.arm() * c, m.arm() * s, 0};
    theta_rate = -m.theta_max() * w * std::sin(w * t),
    gamma_rate = m.gamma_max() * w * std::cos(w * t);
    if (faults_.printed_rotations) {
      x = {c, s * cg, s * sg}, y = {-s, c * cg, c * sg}, z = {0, -sg, cg};
    } else {
      x = {c, s, 0}, y = {-s * cg, c * cg, sg}, z = {s * sg, -c * sg, cg};
    }
  }

  /// Only where nothing else happens in between and two balls do not separate before.
  void see_at_a_step(const Contact& next) {
    const double seen = std::ceil(time_ / faults_.step) * faults_.step;
    if (first_contact(&next).time > seen && !parting_at(seen, next)) advance(seen);
  }

  Vec position(int k, double t) const {
    const double dt = t - time_;
    return states_[k].position + states_[k].velocity * dt + gravity_ * (dt * dt / 2);
  }

  double gap(int k, int wall, double t) const {
    Vec x, y, z, centre;
    double a, b;
    axes(t, x, y, z, centre, a, b);
    const Vec d = position(k, t) - centre;
    const double R = case_.balls[k].radius;
    if (wall != 2)
      return testing::cylinder(case_.mill).half_height + (wall == 0 ? 1 : -1) * d.dot(y) - R;
    const double side = testing::cylinder(case_.mill).radius - R, p = d.dot(x), q = d.dot(z);
    return (side * side - p * p - q * q) / (2 * side);
  }

  /// Steps that a bound on the second derivative keeps on this side of the first root.
  double wall_time(int k, int wall, double until) const {
    constexpr double bend = 20000, h = 1e-7;
    for (double t = time_; t < until;) {
      const double f = gap(k, wall, t),
                   slope = (gap(k, wall, t + h) - gap(k, wall, t - h)) / (2 * h);
      if (f < 2e-16 && slope < 0) return t;
      const double step = f < 1e-13 && slope > 0
          ? slope / bend
          : (slope + std::sqrt(slope * slope + 2 * bend * std::max(f, 0.0))) / bend;
      if (!(t + step > t)) {
        if (slope < 0) return t;
        t = std::nextafter(t, 1.0) + 1e-12;
      }
      t += step;
    }
    return std::numeric_limits<double>::infinity();
  }

  bool parting_at(double t, const Contact& c) const {
    if (c.with_wall) return false;
    const Vec v = states_[c.ball].velocity - states_[c.partner].velocity;
    return (position(c.ball, t) - position(c.partner, t)).dot(v) >= 0;
  }

  double pair_time(int i, int j) const {
    const Vec r = states_[i].position - states_[j].position,
              v = states_[i].velocity - states_[j].velocity;
    const double sum = case_.balls[i].radius + case_.balls[j].radius;
    const double b = r.dot(v), c = r.squaredNorm() - sum * sum, d = b * b - v.squaredNorm() * c;
    if (b >= 0 || d < 0) return std::numeric_limits<double>::infinity();
    return time_ + std::max(0.0, c / (-b + std::sqrt(d)));
  }

  /// @param except  a contact that is already due and is skipped
  Contact first_contact(const Contact* except = nullptr) {
    Contact first;
    const int n = static_cast<int>(states_.size());
    double until = time_ + 0.05;
    for (int i = 0; i < n; ++i)
      for (int j = i + 1; j < n; ++j) {
        if (except && !except->with_wall && except->ball == i && except->partner == j) continue;
        if (passing_ == std::pair(i, j)) {
          const Vec r = states_[i].position - states_[j].position;
          if (r.norm() < case_.balls[i].radius + case_.balls[j].radius + 1e-12)
            continue;  // not through yet
          passing_ = {-1, -1};
        }
        const double t = pair_time(i, j);
        if (t < first.time) first = {t, i, false, j};
      }
    for (int i = 0; i < n; ++i)
      for (int wall = 0; wall < 3; ++wall) {
        if (except && except->with_wall && except->ball == i && except->partner == wall) continue;
        if (faults_.lower_cap_unseen && wall == 0) continue;
        const double t = wall_time(i, wall, std::min(until, first.time));
        if (t < first.time) first = {t, i, true, wall};
      }
    if (!(first.time < 1e9)) {  // nothing within the horizon
      advance(until);
      return first_contact(except);
    }
    return first;
  }

  void advance(double t) {
    for (std::size_t k = 0; k < states_.size(); ++k) {
      const Vec r = position(static_cast<int>(k), t);
      states_[k].velocity += gravity_ * (t - time_);
      states_[k].position = r;
    }
    time_ = t;
  }

  /// Sets e_t of an impact whose friction ignores the least separation speed.
  static void fix_friction(
      model::ContactLaw<double>& law, const Vec& g, const Vec& normal, double compliance) {
    const double g_n = g.dot(normal), slip = (g - normal * g_n).norm();
    const double e_n = law.restitution(-g_n, {1, 1});  // of no law that asks for the bodies
    law.law = model::ConstantRestitution<double>{
        e_n, law.restitution_of_slip((1 + e_n) * std::max(0.0, -g_n), slip, compliance)};
  }

  struct FaultyImpact {
    Vec normal, wall{0, 0, 0};
    dynamics::ImpactOutcome<double> outcome;
  };

  FaultyImpact collide_with_wall(const Contact& c, model::ContactLaw<double> law, bool in_stall) {
    auto& one = states_[c.ball];
    FaultyImpact impact;
    Vec x, y, z, centre;
    double theta_rate, gamma_rate;
    axes(time_, x, y, z, centre, theta_rate, gamma_rate);
    const Vec d = one.position - centre;
    const Vec outward = x * d.dot(x) + z * d.dot(z);
    impact.normal =
        c.partner == 2 ? Vec(-outward / outward.norm()) : Vec(y * (c.partner == 0 ? 1.0 : -1.0));
    const Vec point = one.position - impact.normal * case_.balls[c.ball].radius;
    const double s = centre[1] / testing::spex(case_.mill).arm(),
                 co = centre[0] / testing::spex(case_.mill).arm();
    Vec& wall = impact.wall;
    wall = Vec(0, 0, theta_rate).cross(point) +
        Vec(Vec(co, s, 0) * gamma_rate).cross(Vec(point - centre));
    if (faults_.printed_rotations)  // the derivative of the printed position
      wall = Vec(0, 0, theta_rate).cross(centre) +
          Vec(gamma_rate, 0, 0).cross(Vec(point - centre)) +
          Vec(z * theta_rate).cross(Vec(point - centre));
    wall *= faults_.wall_at_rest ? 0 : faults_.wall_velocity_factor;
    const auto& ball = case_.balls[c.ball];
    if (faults_.restitution_friction)
      fix_friction(law, one.velocity - wall - Vec(one.spin * ball.radius).cross(impact.normal),
          impact.normal, 1 + 1 / ball.reduced_inertia);
    impact.outcome = dynamics::collide_with_wall<double>(
        impact.normal, ball, wall, one.velocity, one.spin, law, in_stall);
    return impact;
  }

  FaultyImpact collide_balls(const Contact& c, model::ContactLaw<double> law, bool in_stall) {
    auto &one = states_[c.ball], &two = states_[c.partner];
    const auto before = std::pair(one, two);
    FaultyImpact impact;
    const auto &bi = case_.balls[c.ball], &bj = case_.balls[c.partner];
    Vec& normal = impact.normal;
    normal = one.position - two.position;
    normal /= normal.norm();
    const Vec g = one.velocity - two.velocity -
        Vec(one.spin * bi.radius + two.spin * bj.radius).cross(normal);
    if (faults_.printed_compliance) {
      const double g_n = g.dot(normal), slip = (g - normal * g_n).norm();
      law.law = model::ConstantRestitution<double>{law.restitution(-g_n, {1, 1}),
          law.restitution_of_slip(
              law.separation_speed(-g_n, {1, 1}) - g_n, slip, 1 + 1 / bi.reduced_inertia)};
    }
    if (faults_.restitution_friction) {
      const double total = bi.mass + bj.mass;
      fix_friction(law, g, normal,
          1 + bj.mass / total / bi.reduced_inertia + bi.mass / total / bj.reduced_inertia);
    }
    impact.outcome = dynamics::collide_balls<double>(
        normal, bi, bj, one.velocity, one.spin, two.velocity, two.spin, law, in_stall);
    const auto scale = [](auto& state, const auto& old, double factor) {
      state.velocity = old.velocity + (state.velocity - old.velocity) * factor;
      state.spin = old.spin + (state.spin - old.spin) * factor;
    };
    if (faults_.equal_masses) {
      const double half = (bi.mass + bj.mass) / 2;
      scale(one, before.first, half / bj.mass);
      scale(two, before.second, half / bi.mass);
    }
    if (faults_.exchanged_masses) {
      scale(one, before.first, bi.mass / bj.mass);
      scale(two, before.second, bj.mass / bi.mass);
    }
    return impact;
  }

  /// Every fault leaves the rule on stalls as it is.
  bool friction_rests(const Contact& c, double least_separation) {
    bool rests = false;
    for (const auto k : {c.ball, c.with_wall ? c.ball : c.partner}) {
      auto& [time, unmoved] = stalls_[static_cast<std::size_t>(k)];
      unmoved = case_.mill.stall.has_moved(time_ - time, least_separation) ? 0 : unmoved + 1;
      rests = rests || unmoved > case_.mill.stall.impacts;
      time = time_;
      if (c.with_wall) break;
    }
    return rests;
  }

  std::string collide(const Contact& c) {
    auto law = c.with_wall ? case_.mill.ball_wall : case_.mill.ball_ball;
    const bool in_stall = friction_rests(c, law.least_separation);
    auto& one = states_[c.ball];
    auto& two = states_[c.with_wall ? c.ball : c.partner];
    if (faults_.spin_lost) one.spin = two.spin = Vec(0, 0, 0);
    const auto before = std::pair(one, two);
    if (faults_.restitution >= 0)
      std::get<model::WaltonBraun<double>>(law.law).normal = faults_.restitution;
    if (faults_.least_separation >= 0) law.least_separation = faults_.least_separation;
    auto [normal, wall, o] =
        c.with_wall ? collide_with_wall(c, law, in_stall) : collide_balls(c, law, in_stall);
    if (faults_.tangential_sign) {
      const auto turn = [&](auto& state, const auto& old) {
        const Vec change = state.velocity - old.velocity, along = normal * change.dot(normal);
        state.velocity = old.velocity + along - (change - along);
      };
      turn(one, before.first);
      if (!c.with_wall) turn(two, before.second);
      o.wall_work = case_.balls[c.ball].mass * wall.dot(one.velocity - before.first.velocity);
    }
    if (faults_.net_dose) o.milling_dose -= o.supplied_energy;
    std::string line = fmt::format(",{},{},{},{},{},{},{},{}", time_, c.ball,
        c.with_wall ? "wall" : "ball", c.partner, o.approach_speed, o.slip_speed,
        o.milling_dose * faults_.dose_factor, o.wall_work);
    const auto add = [&](const auto& old, const auto& now) {
      for (const Vec* v : {&old.position, &old.velocity, &old.spin, &now.velocity, &now.spin})
        line += fmt::format(",{},{},{}", (*v)[0], (*v)[1], (*v)[2]);
    };
    add(before.first, one);
    if (c.with_wall)
      line += std::string(15, ',');
    else
      add(before.second, two);
    return line;
  }

  const model::Case<double>& case_;
  std::vector<model::BallState<double>> states_;
  Faults faults_;
  Vec gravity_;
  double time_ = 0;
  std::vector<std::pair<double, int>>
      stalls_;  ///< by ball: when its flight began, impacts without time to move
  std::pair<int, int> passing_{-1, -1};
  int special_ = 0, impacts_ = 0, pairs_ = 0;
};

}  // namespace edmill::testing
