// Every variable of tables D.3 to D.5 again, from states before and after an impact that the test
// follows itself, by other formulas, in long double.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <map>

#include "output/impact_facts.hpp"
#include "spex_case.hpp"

namespace edmill::output {
namespace {

using Number = long double;
using Vector = Vec3<Number>;

/// P = R_z(theta) [(l, 0, 0) + R_x(gamma) p] as in the thesis's figure 2.4.
struct Vessel {
  Number arm = 0.1L, amplitude = acosl(-1) / 12, speed = 1054 * acosl(-1) / 30;

  Vector place(const Vector& p, Number time) const {
    const Number theta = acosl(-1) / 2 + amplitude * cosl(speed * time),
                 gamma = amplitude * sinl(speed * time);
    const Vector nested{arm + p[0], p[1] * cosl(gamma) - p[2] * sinl(gamma),
        p[1] * sinl(gamma) + p[2] * cosl(gamma)};
    return {nested[0] * cosl(theta) - nested[1] * sinl(theta),
        nested[0] * sinl(theta) + nested[1] * cosl(theta), nested[2]};
  }
  /// The vessel's own point at an inertial place: its axes are orthonormal, so dot products invert
  /// `place`.
  Vector own_point(const Vector& place_now, Number time) const {
    const Vector centre = place({0, 0, 0}, time), from_centre = place_now - centre;
    Vector p;
    for (int k = 0; k < 3; ++k) {
      Vector unit{0, 0, 0};
      unit[k] = 1;
      p[k] = from_centre.dot(place(unit, time) - centre);
    }
    return p;
  }
  /// By differences of fourth order.
  Vector velocity(const Vector& p, Number time) const {
    const Number h = 1e-5L;
    return (8 * (place(p, time + h) - place(p, time - h)) -
               (place(p, time + 2 * h) - place(p, time - 2 * h))) /
        (12 * h);
  }
};

struct State {
  Vector position, velocity, spin;
  Number time;
};

/// One impact as the test sees it.
struct Recomputed {
  State before[2], after[2];
  Number flight_time[2], mass[2] = {0, 0}, radius[2] = {0, 0}, inertia[2] = {0, 0};
  bool balls;
  Vector normal, contact, gravity;
  Number time, previous;

  Number normal_part(const Vector& v) const { return v.dot(normal); }
  Number tangential_size(const Vector& v) const { return v.cross(normal).norm(); }
  Number angle(const Vector& v) const {
    return v.norm() == 0 ? 0 : acosl(std::clamp<Number>(normal_part(v) / v.norm(), -1, 1));
  }
  Number translational(const State& s, int k) const {
    return mass[k] * s.velocity.dot(s.velocity) / 2;
  }
  Number rotational(const State& s, int k) const { return inertia[k] * s.spin.dot(s.spin) / 2; }
  Vector relative(const State* s) const { return s[0].velocity - s[1].velocity; }
  /// Velocities of the surfaces at the contact point: v + spin x (contact - centre).
  Vector at_contact(const State* s) const {
    Vector v = s[0].velocity + s[0].spin.cross(-radius[0] * normal);
    v -= balls ? Vector(s[1].velocity + s[1].spin.cross(radius[1] * normal)) : s[1].velocity;
    return v;
  }
  Number wall_work() const {
    return balls ? 0 : mass[0] * before[1].velocity.dot(after[0].velocity - before[0].velocity);
  }
  Number energy(const State* s) const {
    return translational(s[0], 0) + rotational(s[0], 0) + translational(s[1], 1) +
        rotational(s[1], 1);
  }
  Number dose() const { return wall_work() - (energy(after) - energy(before)) + supplied(); }
  Number dose_normal() const { return std::max<Number>(0, normal_loss()); }
  Number supplied() const { return std::max<Number>(0, -normal_loss()); }
  Number effective_mass() const {
    return balls ? mass[0] * mass[1] / (mass[0] + mass[1]) : mass[0];
  }
  Number normal_loss() const {
    return effective_mass() / 2 *
        (powl(normal_part(relative(before)), 2) - powl(normal_part(relative(after)), 2));
  }
  Vector tangential(const Vector& v) const { return v - normal * normal_part(v); }
  /// Simpson's rule on the speed.
  Number path(int k) const {
    if (mass[k] == 0) return 0;
    const int steps = 2000;
    const Number h = flight_time[k] / steps;
    Number sum = 0;
    for (int i = 0; i <= steps; ++i) {
      const Number back = flight_time[k] - i * h;
      sum += (i == 0 || i == steps ? 1
                     : i % 2       ? 4
                                   : 2) *
          (before[k].velocity - gravity * back).norm();
    }
    return sum * h / 3;
  }
};

using Formulas = std::map<std::string, std::function<Number(const Recomputed&)>>;

/// name_before, name_after and name_change of what `of` gives for the states before or after.
void add_three(Formulas& all, const std::string& name,
    std::function<Number(const Recomputed&, const State*)> of) {
  all[name + "_before"] = [of](const Recomputed& r) { return of(r, r.before); };
  all[name + "_after"] = [of](const Recomputed& r) { return of(r, r.after); };
  all[name + "_change"] = [of](const Recomputed& r) { return of(r, r.after) - of(r, r.before); };
}

void add_body(Formulas& all, const std::string& who, int k) {
  add_three(all, who + "_speed", [k](const auto&, const State* s) { return s[k].velocity.norm(); });
  add_three(all, who + "_normal_speed",
      [k](const auto& r, const State* s) { return fabsl(r.normal_part(s[k].velocity)); });
  add_three(all, who + "_tangential_speed",
      [k](const auto& r, const State* s) { return r.tangential_size(s[k].velocity); });
  add_three(
      all, who + "_angle", [k](const auto& r, const State* s) { return r.angle(s[k].velocity); });
  add_three(all, who + "_spin", [k](const auto&, const State* s) { return s[k].spin.norm(); });
  add_three(all, who + "_translational_energy",
      [k](const auto& r, const State* s) { return r.translational(s[k], k); });
  add_three(all, who + "_spin_energy",
      [k](const auto& r, const State* s) { return r.rotational(s[k], k); });
  add_three(all, who + "_energy", [k](const auto& r, const State* s) {
    return r.translational(s[k], k) + r.rotational(s[k], k);
  });
  all[who + "_free_path"] = [k](const Recomputed& r) { return r.path(k); };
}

Formulas formulas() {
  Formulas all;
  add_body(all, "ball", 0);
  add_body(all, "partner", 1);
  add_three(all, "translational_energy", [](const auto& r, const State* s) {
    return r.translational(s[0], 0) + r.translational(s[1], 1);
  });
  add_three(all, "spin_energy",
      [](const auto& r, const State* s) { return r.rotational(s[0], 0) + r.rotational(s[1], 1); });
  add_three(all, "energy", [](const auto& r, const State* s) { return r.energy(s); });
  const auto add_velocity = [&](const std::string& name,
                                std::function<Vector(const Recomputed&, const State*)> of) {
    add_three(
        all, name + "_speed", [of](const auto& r, const State* s) { return of(r, s).norm(); });
    add_three(all, name + "_normal_speed",
        [of](const auto& r, const State* s) { return fabsl(r.normal_part(of(r, s))); });
    add_three(all, name + "_tangential_speed",
        [of](const auto& r, const State* s) { return r.tangential_size(of(r, s)); });
    add_three(
        all, name + "_angle", [of](const auto& r, const State* s) { return r.angle(of(r, s)); });
  };
  add_velocity("relative", [](const Recomputed& r, const State* s) { return r.relative(s); });
  add_velocity("contact", [](const Recomputed& r, const State* s) { return r.at_contact(s); });
  all["mean_free_path"] = [](const Recomputed& r) { return (r.path(0) + r.path(1)) / 2; };
  all["time"] = [](const Recomputed& r) { return r.time; };
  all["time_previous"] = [](const Recomputed& r) { return r.previous; };
  all["time_since_previous"] = [](const Recomputed& r) { return r.time - r.previous; };
  all["impact_energy"] = [](const Recomputed& r) {
    return r.effective_mass() / 2 *
        powl(std::max<Number>(0, -r.normal_part(r.relative(r.before))), 2);
  };
  all["milling_dose"] = [](const Recomputed& r) { return r.dose(); };
  all["dose_normal"] = [](const Recomputed& r) { return r.dose_normal(); };
  all["dose_tangential"] = [](const Recomputed& r) { return r.dose() - r.dose_normal(); };
  all["supplied_energy"] = [](const Recomputed& r) { return r.supplied(); };
  all["wall_work"] = [](const Recomputed& r) { return r.wall_work(); };
  all["energy_balance"] = [](const Recomputed& r) {
    return r.energy(r.after) - r.energy(r.before);
  };
  const auto pushed = [](const Recomputed& r) {
    return Vector(r.mass[0] * (r.after[0].velocity - r.before[0].velocity));
  };
  all["normal_impulse"] = [pushed](const Recomputed& r) { return r.normal_part(pushed(r)); };
  all["tangential_impulse"] = [pushed](
                                  const Recomputed& r) { return r.tangential_size(pushed(r)); };
  all["restitution_normal"] = [](const Recomputed& r) {
    return -r.normal_part(r.relative(r.after)) / r.normal_part(r.relative(r.before));
  };
  all["restitution_tangential"] = [](const Recomputed& r) {
    const Vector slip = r.tangential(r.at_contact(r.before));
    return r.at_contact(r.after).dot(slip) / slip.dot(slip);
  };
  for (int k = 0; k < 3; ++k)
    all[std::string("contact_") + "xyz"[k]] = [k](const Recomputed& r) { return r.contact[k]; };
  return all;
}

/// Follows the balls by their states after each impact, and compares.
class Follower : public engine::Observer<double> {
 public:
  static constexpr Number restitution = 0.8L;

  explicit Follower(const engine::Simulation<double>& simulation) {
    for (int i = 0; i < simulation.ball_count(); ++i) states_.push_back(seen(simulation, i, 0));
    for (const auto& v : model::impact_variables)
      EXPECT_TRUE(v.kind != model::VariableKind::number || formulas_.count(std::string(v.name)))
          << v.name;
  }

  void on_impact(
      const engine::Impact<double>& impact, engine::Simulation<double>& simulation) override {
    const ImpactFacts<double> facts{impact, simulation, static_cast<double>(previous_), 3};
    const Recomputed r = recompute(impact, simulation);
    for (int k = 0; k < static_cast<int>(model::impact_variables.size()); ++k) {
      const auto& v = model::impact_variables[k];
      if (v.kind != model::VariableKind::number) continue;
      const std::string name(v.name);
      const Number ours = variable_formula<double>(k)(facts), theirs = formulas_.at(name)(r);
      // Coefficients and angles of very slow motion amplify the rounding of the states.
      const bool slow = fabsl(r.normal_part(r.relative(r.before))) < 1e-3L ||
          r.tangential(r.at_contact(r.before)).norm() < 1e-3L ||
          r.at_contact(r.after).norm() < 1e-3L;
      if (slow && (v.unit == "rad" || v.unit == "1")) continue;
      const Number size = v.unit == "J" ? 1e-3L
          : v.unit == "m"               ? 0.1L
          : v.unit == "N s"             ? 1e-2L
          : v.unit == "s"               ? 1
                                        : 10;
      worst_ = std::max(worst_, fabsl(ours - theirs) / size);
      EXPECT_NEAR(
          static_cast<double>(ours), static_cast<double>(theirs), static_cast<double>(size) * 1e-9)
          << name << " at impact " << impact.index;
    }
    EXPECT_EQ(variable_formula<double>(*model::find_variable("ball_ball"))(facts),
        impact.with_wall ? 0 : 1);
    const Number rebound = -restitution * r.normal_part(r.relative(r.before)), least = 0.01L;
    if (fabsl(rebound - least) > 1e-9L) {
      EXPECT_EQ(facts.outcome.least_separation, rebound < least);
    }
    touched_ += facts.outcome.least_separation;
    previous_ = r.time;
    for (const int ball : {impact.ball, impact.with_wall ? impact.ball : impact.partner})
      states_[ball] = seen(simulation, ball, r.time);
    ++impacts_[impact.with_wall ? impact.partner : 3];
  }

  Number worst() const { return worst_; }
  int touched() const { return touched_; }
  const std::array<int, 4>& impacts() const { return impacts_; }
 private:
  static State seen(const engine::Simulation<double>& simulation, int i, Number time) {
    const auto& f = simulation.flight(i);
    return {vector_cast<Number>(f.position), vector_cast<Number>(f.velocity),
        vector_cast<Number>(simulation.spin(i)), time};
  }

  Recomputed recompute(
      const engine::Impact<double>& impact, const engine::Simulation<double>& simulation) const {
    Recomputed r;
    r.time = static_cast<Number>(impact.time.period) * (60 / Number(1054)) + impact.time.offset;
    r.previous = previous_;
    r.gravity = {0, -9.8L, 0};
    r.balls = !impact.with_wall;
    const int ids[2] = {impact.ball, impact.partner};
    for (int k = 0; k < (r.balls ? 2 : 1); ++k) {
      const State& old = states_[ids[k]];
      const Number dt = r.time - old.time;
      r.flight_time[k] = dt;
      r.before[k] = {old.position + old.velocity * dt + r.gravity * (dt * dt / 2),
          old.velocity + r.gravity * dt, old.spin, r.time};
      r.after[k] = seen(simulation, ids[k], r.time);
      const auto& ball = simulation.properties(ids[k]);
      r.radius[k] = ball.radius;
      r.mass[k] = 8000 * 4 * acosl(-1) / 3 * powl(ball.radius, 3);
      r.inertia[k] = 0.4L * r.mass[k] * r.radius[k] * r.radius[k];
    }
    if (r.balls) {
      r.normal = (r.before[0].position - r.before[1].position).normalized();
    } else {
      // From the nearest point of the wall to the ball, in the vessel's frame.
      const Vector own = vessel_.own_point(r.before[0].position, r.time),
                   centre = vessel_.place({0, 0, 0}, r.time);
      const Vector inward = ids[1] == 0 ? Vector{0, 1, 0}
          : ids[1] == 1
          ? Vector{0, -1, 0}
          : Vector{-own[0] / hypotl(own[0], own[2]), 0, -own[2] / hypotl(own[0], own[2])};
      r.normal = vessel_.place(inward, r.time) - centre;
    }
    r.contact = r.before[0].position - r.radius[0] * r.normal;
    if (!r.balls) {
      const Vector velocity = vessel_.velocity(vessel_.own_point(r.contact, r.time), r.time);
      const Vector none{0, 0, 0};
      r.before[1] = r.after[1] = {r.contact, velocity, none, r.time};
      r.flight_time[1] = 0;
    }
    return r;
  }

  Vessel vessel_;
  Formulas formulas_ = formulas();
  std::vector<State> states_;
  Number previous_ = 0, worst_ = 0;
  std::array<int, 4> impacts_{};
  int touched_ = 0;
};

TEST(Variables, AreWhatOtherFormulasGive) {
  const auto spec =
      casefile::parse_case(testing::spex_text("max_collisions = 2000", "restitution = 0.8",
                               testing::batch(6, "9.52 mm", "diameter_spread = \"3 mm\"\n")),
          "variables.toml");
  const auto built = casefile::build_case<double>(spec);
  engine::Simulation<double> simulation(built.the_case, built.states, built.start);
  Follower follower(simulation);
  struct Stop : engine::Observer<double> {
    void on_impact(
        const engine::Impact<double>& impact, engine::Simulation<double>& simulation) override {
      if (impact.index + 1 == 2000) simulation.request_stop(engine::EndReason::stopped);
    }
  } stop;
  simulation.attach(follower);
  simulation.attach(stop);
  simulation.run_until(simulation.clock().at(60));
  for (int partner = 0; partner < 4; ++partner)
    EXPECT_GT(follower.impacts()[partner], 50) << partner;
  EXPECT_GT(follower.touched(), 50);
  std::cout << "worst difference of any variable, of its size: " << follower.worst() << "\n";
}

TEST(Variables, HaveNamesOfTheirOwnAndAllOfTheThesis) {
  std::map<std::string_view, int> names, thesis;
  for (const auto& v : model::impact_variables) {
    ++names[v.name];
    if (!v.thesis.empty()) ++thesis[v.thesis];
  }
  EXPECT_EQ(names.size(), model::impact_variables.size());
  for (const auto& [name, count] : thesis) EXPECT_EQ(count, 1) << name;
  EXPECT_EQ(thesis.size(), 3u + 5u + 82u);  // tables D.3, D.4 and D.5
}

/// A body thrown up, at its top, falling straight, with and without gravity: against Simpson's
/// rule.
TEST(PathLength, OfParabolas) {
  const Vec3<double> gravity{0, -9.8, 0};
  for (const Vec3<double>& v :
      {Vec3<double>{1, 2, 3}, Vec3<double>{0, -3, 0}, Vec3<double>{0, 3, 0},
          Vec3<double>{1e-9, -0.5, 0}, Vec3<double>{2, 0, 0}, Vec3<double>{0, 0, 0}})
    for (const double time : {0.0, 1e-9, 1e-3, 0.3}) {
      Recomputed r;
      r.mass[0] = 1, r.gravity = vector_cast<Number>(gravity), r.flight_time[0] = time;
      r.before[0].velocity = vector_cast<Number>(v);
      const auto expected = static_cast<double>(r.path(0));
      // A kink of the speed, where the ball stops for an instant, costs Simpson's rule digits.
      EXPECT_NEAR(path_length<double>(v, gravity, time), expected, 1e-6 * expected + 1e-18)
          << v << "\n"
          << time;
      EXPECT_NEAR(path_length<double>(v, Vec3<double>{0, 0, 0}, time), v.norm() * time, 1e-15);
    }
  // Straight up 3 m/s, back after 0.6 s with 2.88 m/s: two legs v^2 / 2g.
  EXPECT_NEAR(
      path_length<double>({0, -2.88, 0}, gravity, 0.6), (3 * 3 + 2.88 * 2.88) / 19.6, 1e-15);
}

}  // namespace
}  // namespace edmill::output
