#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <variant>

#include "audit/mechanics.hpp"
#include "identify/parameters.hpp"

namespace edmill::identify {

namespace {

using casefile::Quantity;
using Joints = std::vector<model::Joint<Quantity>>;

using std::numbers::pi;

void put_chain(Assumptions& a, Joints joints) {
  const auto period = casefile::period_of(a.spec.mill);
  a.spec.mill = model::Chain<Quantity>{{std::move(joints), period}};
}

/// Joints that turn the other way in time: t becomes -t in every motion.
Joints reversed(Joints joints) {
  for (auto& joint : joints) {
    joint.speed = -joint.speed;
    for (auto& swing : joint.swings) {  // sin(2 pi (-f t + p)) = -sin(2 pi (f t - p))
      swing.amplitude = -swing.amplitude;
      swing.phase = -swing.phase;
    }
  }
  return joints;
}

Parameter mistake(std::string key, std::string text, std::function<void(Assumptions&)> make) {
  return {.key = std::move(key),
          .set = [make = std::move(make)](Assumptions& a, double) { make(a); },
          .first_values = {1},
          .mistake = std::move(text)};
}

void add_motions(const Assumptions& nominal, std::vector<Parameter>& list) {
  const Joints joints = casefile::joints_of(nominal.spec.mill);
  const auto add = [&](const char* what, const char* text, const Joints& others) {
    list.push_back(
        mistake(fmt::format("mill, {}", what), text, [others](Assumptions& a) { put_chain(a, others); }));
    list.back().of_motion = true;
  };
  const bool is_spex = std::holds_alternative<model::Spex8000<Quantity>>(nominal.spec.mill);
  if (is_spex) {
    // The centre stays on its circle; the axes are turned by theta first, then by gamma about X.
    auto back = joints[0];
    back.angle = -back.angle;
    for (auto& swing : back.swings) swing.amplitude = -swing.amplitude;
    add("order of rotations",
        "R_x(gamma) R_z(theta), as (2.14) is printed, in place of R_z(theta) R_x(gamma)",
        {joints[0], joints[1], back, joints[2], joints[0]});
    auto turned = joints;
    for (auto& swing : turned[2].swings) swing.amplitude = -swing.amplitude;
    add("sign of gamma", "-gamma_max sin(phase) in place of gamma_max sin(phase)", turned);
  }
  const auto moves = [](const auto& joint) { return !joint.speed.zero() || !joint.swings.empty(); };
  if (std::any_of(joints.begin(), joints.end(), moves))
    add("direction of rotation",
        is_spex ? "the drive turns the other way" : "all joints move the other way in time",
        reversed(joints));
}

/// Factors by which a wrong unit, or a diameter in place of a radius, changes a number.
struct Factor {
  enum class Of { any, angle, angular_speed, diameter } of;
  double by;
  const char* text;

  bool changes(const Parameter& p) const {
    const bool turns = p.dimension == Dimension::angular_speed;
    return of == Of::any || (of == Of::angle && (turns || p.dimension == Dimension::angle)) ||
           (of == Of::angular_speed && turns) || (of == Of::diameter && p.is_diameter);
  }
};
constexpr Factor factors[] = {
    {Factor::Of::any, 1e3, "1000: its unit"},
    {Factor::Of::any, 1e-3, "1/1000: its unit"},
    {Factor::Of::angle, pi / 180, "pi/180: degrees taken for radians, or the reverse"},
    {Factor::Of::angle, 180 / pi, "180/pi: degrees taken for radians, or the reverse"},
    {Factor::Of::angular_speed, 60, "60: revolutions per minute taken for per second"},
    {Factor::Of::angular_speed, 1.0 / 60, "1/60: revolutions per second taken for per minute"},
    {Factor::Of::angular_speed, 2 * pi, "2 pi: revolutions taken for radians"},
    {Factor::Of::angular_speed, 0.5 / pi, "1/(2 pi): radians taken for revolutions"},
    {Factor::Of::diameter, 2, "2: the diameter taken for the radius"},
    {Factor::Of::diameter, 0.5, "1/2: the radius taken for the diameter"}};

void add_factors(const std::vector<Parameter>& numbers, std::vector<Parameter>& list) {
  for (const auto& p : numbers)
    for (const auto& factor : factors) {
      if (!p.has_unit || p.dimension == Dimension::none || !factor.changes(p)) continue;
      const double value = factor.by * p.value;
      list.push_back(mistake(p.key,
                             fmt::format("{} in place of {}, a factor of {}", value_text(p.dimension, value),
                                         value_text(p.dimension, p.value), factor.text),
                             [set = p.set, value](Assumptions& a) { set(a, value); }));
      list.back().by_factor = true;
    }
}

/// Which columns of vectors a log has, of the ball.
struct Vectors {
  bool positions, velocities, spins;

  explicit Vectors(const audit::Available::Body& has)
      : positions(has.position),
        velocities(has.velocity_before || has.velocity_after),
        spins(has.spin_before || has.spin_after) {}
};

void add_units(const audit::Available& has, std::vector<Parameter>& list) {
  const Vectors ball(has.body[0]);
  const bool energies = has.milling_dose || has.wall_work;
  struct Unit {
    bool logged;
    const char* columns;
    double LogChange::*factor;
    double value;
    const char* text;
  };
  const Unit units[] = {
      {true, "times", &LogChange::time, 1e-3, "in ms in place of s"},
      {true, "times", &LogChange::time, 1e3, "in units of 1000 s"},
      {ball.positions, "positions", &LogChange::positions, 1e-3, "in mm in place of m"},
      {ball.positions, "positions", &LogChange::positions, 1e3, "in units of 1000 m"},
      {ball.velocities, "velocities", &LogChange::velocities, 1e-3, "in mm/s in place of m/s"},
      {ball.velocities, "velocities", &LogChange::velocities, 1e3, "in units of 1000 m/s"},
      {ball.spins, "spins", &LogChange::spins, pi / 180, "in degrees per second in place of rad/s"},
      {ball.spins, "spins", &LogChange::spins, 180 / pi, "multiplied by pi/180 once too often"},
      {ball.spins, "spins", &LogChange::spins, 2 * pi, "in revolutions per second in place of rad/s"},
      {energies, "energies", &LogChange::energies, 1e-3, "in mJ in place of J"},
      {energies, "energies", &LogChange::energies, 1e3, "in units of 1000 J"},
      {has.approach_speed, "speeds", &LogChange::speeds, 1e-3, "in mm/s in place of m/s"},
      {has.approach_speed, "speeds", &LogChange::speeds, 1e3, "in units of 1000 m/s"}};
  for (const auto& unit : units)
    if (unit.logged)
      list.push_back(
          mistake(fmt::format("the log's {}", unit.columns), unit.text,
                  [factor = unit.factor, value = unit.value](Assumptions& a) { a.log.*factor = value; }));
}

/// Axes that a code has in another order or direction.
void add_axes(const audit::Available& has, std::vector<Parameter>& list) {
  const Vectors ball(has.body[0]);
  using Changed = std::vector<Axes LogChange::*>;
  struct Group {
    bool logged;
    const char* name;
    Changed changed;
  };
  const Group groups[] = {
      {ball.positions && ball.velocities && ball.spins,
       "vectors",
       {&LogChange::axes_of_positions, &LogChange::axes_of_velocities, &LogChange::axes_of_spins}},
      {ball.positions, "positions", {&LogChange::axes_of_positions}},
      {ball.velocities, "velocities", {&LogChange::axes_of_velocities}},
      {ball.spins, "spins", {&LogChange::axes_of_spins}}};
  std::array<int, 3> from{0, 1, 2};
  do {
    for (unsigned signs = 0; signs < 8; ++signs) {
      Axes axes{from, {}};
      std::string text;
      for (std::size_t k = 0; k < 3; ++k) {
        axes.sign[k] = signs >> k & 1 ? -1 : 1;
        text += fmt::format("{}{}{}", k > 0 ? ", " : "", axes.sign[k] < 0 ? "-" : "", "xyz"[axes.from[k]]);
      }
      if (axes == Axes{}) continue;
      for (const auto& group : groups)
        if (group.logged)
          list.push_back(mistake(fmt::format("the log's {}", group.name),
                                 fmt::format("{} of the log are x, y, z of the case", text),
                                 [axes, changed = group.changed](Assumptions& a) {
                                   for (const auto member : changed) a.log.*member = axes;
                                 }));
    }
  } while (std::next_permutation(from.begin(), from.end()));
}

/// What columns stand for, and formulas.
void add_conventions(const audit::Available& has, const Assumptions& nominal, std::vector<Parameter>& list) {
  const auto add = [&](bool can_be, const char* key, const char* text, auto make) {
    if (can_be) list.push_back(mistake(key, text, make));
  };
  const auto& [ball, partner] = has.body;
  add(Vectors(partner).velocities, "the log's columns of the partner",
      "the states of ball and partner exchanged", [](Assumptions& a) { a.log.states_exchanged = true; });
  add(ball.position, "the log's frame", "vectors in components along the vessel's axes",
      [](Assumptions& a) { a.log.frame = LogFrame::axes_of_vessel; });
  add(ball.position, "the log's frame", "places, velocities and spins as seen from the vessel",
      [](Assumptions& a) { a.log.frame = LogFrame::vessel; });
  add(ball.position && ball.velocity_before && ball.velocity_after, "the log's states",
      "before and after the impact exchanged", [](Assumptions& a) { a.log.reversed_in_time = true; });
  for (std::size_t formula = 1; formula < audit::wall_velocities.size(); ++formula)
    add(ball.position, "velocity of the wall (2.27)", audit::wall_velocities[formula].note,
        [formula](Assumptions& a) { a.terms.wall_velocity_formula = formula; });
  using Form = Terms::EqualBalls;
  const auto alike = [&](const auto& own) { return own == nominal.balls.front(); };
  const bool some_differ = !std::all_of(nominal.balls.begin(), nominal.balls.end(), alike);
  for (const auto& [form, text] :
       {std::pair(Form::limit_of_sliding, "1 + 1/J, as (2.24) is printed, in the limit of sliding"),
        std::pair(Form::friction, "1 + 1/J, as (2.24) is printed, in the impulse too"),
        std::pair(Form::masses, "each takes half of the relative change, as for equal masses")})
    add(some_differ, "impacts of balls that are not alike (2.24')", text,
        [form = form](Assumptions& a) { a.terms.equal_balls = form; });
}

/// Numbers of balls of different kinds that a log has exchanged. Balls alike cannot be told apart.
void add_exchanged_balls(const Assumptions& nominal, std::vector<Parameter>& list) {
  constexpr int most = 40;
  const int count = static_cast<int>(nominal.balls.size());
  if (count > most) return;
  for (int i = 0; i < count; ++i)
    for (int j = i + 1; j < count; ++j)
      if (!(nominal.balls[i] == nominal.balls[j]))
        list.push_back(mistake("the log's numbers of balls",
                               fmt::format("balls {} and {} taken for each other", i, j),
                               [=](Assumptions& a) {
                                 a.log.exchanged = {i, j};
                               }));
}

}  // namespace

std::vector<Parameter> mistakes_of(const Assumptions& nominal, const std::vector<Parameter>& parameters,
                                   const audit::Available& has) {
  std::vector<Parameter> list;
  add_motions(nominal, list);
  add_units(has, list);
  add_axes(has, list);
  add_conventions(has, nominal, list);
  add_exchanged_balls(nominal, list);
  add_factors(parameters, list);
  return list;
}

}  // namespace edmill::identify
