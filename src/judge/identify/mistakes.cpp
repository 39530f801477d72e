#include <fmt/format.h>

#include <numbers>
#include <variant>

#include "identify/assumed.hpp"

namespace edmill::identify {

namespace {

using Joints = std::vector<model::Joint<Quantity>>;

using std::numbers::pi;

void put_chain(Assumed& a, Joints joints) {
  const auto period = casefile::period_of(a.spec.mill);
  a.spec.mill = model::Chain<Quantity>{{std::move(joints), period}};
}

/// Reverses the joints in time: t becomes -t in every motion.
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

void add(Assumptions& list, std::string key, std::string text, std::function<void(Assumed&)> make) {
  list.push_back({.key = std::move(key),
                  .set = [make = std::move(make)](Assumed& a, double) { make(a); },
                  .first_values = {1},
                  .mistake = std::move(text)});
}

void add_motions(const Assumed& nominal, Assumptions& list) {
  const Joints joints = casefile::joints_of(nominal.spec.mill);
  const auto add_joints = [&](const char* what, const char* text, const Joints& others) {
    add(list, fmt::format("mill, {}", what), text, [others](Assumed& a) { put_chain(a, others); });
    list.back().of_motion = true;
  };
  const bool is_spex = std::holds_alternative<model::Spex8000<Quantity>>(nominal.spec.mill);
  if (is_spex) {
    // The centre stays on its circle; the axes are turned by theta first, then by gamma about X.
    auto back = joints[0];
    back.angle = -back.angle;
    for (auto& swing : back.swings) swing.amplitude = -swing.amplitude;
    add_joints("order of rotations",
               "R_x(gamma) R_z(theta), as (2.14) is printed, in place of R_z(theta) R_x(gamma)",
               {joints[0], joints[1], back, joints[2], joints[0]});
    auto turned = joints;
    for (auto& swing : turned[2].swings) swing.amplitude = -swing.amplitude;
    add_joints("sign of gamma", "-gamma_max sin(phase) in place of gamma_max sin(phase)", turned);
  }
  const auto moves = [](const auto& joint) { return !joint.speed.zero() || !joint.swings.empty(); };
  if (std::any_of(joints.begin(), joints.end(), moves))
    add_joints("direction of rotation",
               is_spex ? "the drive turns the other way" : "all joints move the other way in time",
               reversed(joints));
}

/// Factors by which a wrong unit, or a diameter in place of a radius, changes a number.
struct Factor {
  enum class On { any, angle, angular_speed, diameter } of;
  double by;
  const char* text;

  bool changes(const Assumption& p) const {
    const bool turns = p.dimension == Dimension::angular_speed;
    return of == On::any || (of == On::angle && (turns || p.dimension == Dimension::angle)) ||
           (of == On::angular_speed && turns) || (of == On::diameter && p.is_diameter);
  }
};
constexpr Factor factors[] = {
    {Factor::On::any, 1e3, "1000: its unit"},
    {Factor::On::any, 1e-3, "1/1000: its unit"},
    {Factor::On::angle, pi / 180, "pi/180: degrees taken for radians, or the reverse"},
    {Factor::On::angle, 180 / pi, "180/pi: degrees taken for radians, or the reverse"},
    {Factor::On::angular_speed, 60, "60: revolutions per minute taken for per second"},
    {Factor::On::angular_speed, 1.0 / 60, "1/60: revolutions per second taken for per minute"},
    {Factor::On::angular_speed, 2 * pi, "2 pi: revolutions taken for radians"},
    {Factor::On::angular_speed, 0.5 / pi, "1/(2 pi): radians taken for revolutions"},
    {Factor::On::diameter, 2, "2: the diameter taken for the radius"},
    {Factor::On::diameter, 0.5, "1/2: the radius taken for the diameter"}};

void add_factors(const Assumptions& numbers, Assumptions& list) {
  for (const auto& p : numbers)
    for (const auto& factor : factors) {
      if (!p.has_unit || p.dimension == Dimension::none || !factor.changes(p)) continue;
      const double value = factor.by * p.value;
      add(list, p.key,
          fmt::format("{} in place of {}, a factor of {}", value_text(p.dimension, value),
                      value_text(p.dimension, p.value), factor.text),
          [set = p.set, value](Assumed& a) { set(a, value); });
      list.back().by_factor = true;
    }
}

void add_units(const Available& has, Assumptions& list) {
  const auto& ball = has.body[0];
  const auto add_unit = [&](const char* columns, double LogChange::*member, double by, std::string text) {
    add(list, fmt::format("the log's {}", columns), std::move(text), [=](Assumed& a) { a.log.*member = by; });
  };
  struct Columns {
    bool logged;
    const char* name;
    double LogChange::*factor;
    const char *small, *unit;
  };
  const Columns with_units[] = {
      {true, "times", &LogChange::time, "ms", "s"},
      {ball.position, "positions", &LogChange::positions, "mm", "m"},
      {ball.velocity_before || ball.velocity_after, "velocities", &LogChange::velocities, "mm/s", "m/s"},
      {has.milling_dose || has.wall_work, "energies", &LogChange::energies, "mJ", "J"},
      {has.approach_speed, "speeds", &LogChange::speeds, "mm/s", "m/s"}};
  for (const auto& c : with_units) {
    if (!c.logged) continue;
    add_unit(c.name, c.factor, 1e-3, fmt::format("in {} in place of {}", c.small, c.unit));
    add_unit(c.name, c.factor, 1e3, fmt::format("in units of 1000 {}", c.unit));
  }
  if (!ball.spin_before && !ball.spin_after) return;
  add_unit("spins", &LogChange::spins, pi / 180, "in degrees per second in place of rad/s");
  add_unit("spins", &LogChange::spins, 180 / pi, "multiplied by pi/180 once too often");
  add_unit("spins", &LogChange::spins, 2 * pi, "in revolutions per second in place of rad/s");
}

/// Adds axes in another order or direction.
void add_axes(const Available& has, Assumptions& list) {
  const auto& ball = has.body[0];
  struct Vectors {
    bool logged;
    const char* name;
    Axes LogChange::*axes;
  };
  const Vectors vectors[] = {
      {ball.position, "positions", &LogChange::axes_of_positions},
      {ball.velocity_before || ball.velocity_after, "velocities", &LogChange::axes_of_velocities},
      {ball.spin_before || ball.spin_after, "spins", &LogChange::axes_of_spins}};
  const bool all = vectors[0].logged && vectors[1].logged && vectors[2].logged;
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
      text += " of the log are x, y, z of the case";
      if (all)
        add(list, "the log's vectors", text, [=](Assumed& a) {
          for (const auto& v : vectors) a.log.*v.axes = axes;
        });
      for (const auto& v : vectors)
        if (v.logged)
          add(list, fmt::format("the log's {}", v.name), text, [=](Assumed& a) { a.log.*v.axes = axes; });
    }
  } while (std::next_permutation(from.begin(), from.end()));
}

/// Adds mistakes in the contents of columns.
void add_frames(const Available& has, Assumptions& list) {
  const auto& [ball, partner] = has.body;
  if (partner.velocity_before || partner.velocity_after)
    add(list, "the log's columns of the partner", "the states of ball and partner exchanged",
        [](Assumed& a) { a.log.states_exchanged = true; });
  if (!ball.position) return;
  add(list, "the log's frame", "vectors in components along the vessel's axes",
      [](Assumed& a) { a.log.frame = LogFrame::axes_of_vessel; });
  add(list, "the log's frame", "places, velocities and spins as seen from the vessel",
      [](Assumed& a) { a.log.frame = LogFrame::vessel; });
  if (ball.velocity_before && ball.velocity_after)
    add(list, "the log's states", "before and after the impact exchanged",
        [](Assumed& a) { a.log.reversed_in_time = true; });
  for (std::size_t formula = 1; formula < audit::wall_velocities.size(); ++formula)
    add(list, "velocity of the wall (2.27)", audit::wall_velocities[formula].note,
        [formula](Assumed& a) { a.terms.wall_velocity_formula = formula; });
}

/// Adds wrong formulas for impacts: for bodies that separate at v_s, and those for equal balls.
void add_formulas(const Assumed& nominal, Assumptions& list) {
  add(list, "limit of the friction (2.24')", "mu (1 + e_n) |g_n| in place of the impulse at v_s",
      [](Assumed& a) { a.terms.friction_of_restitution = true; });
  using Form = Terms::EqualBalls;
  const auto alike = [&](const auto& ball) { return ball == nominal.balls.front(); };
  if (std::all_of(nominal.balls.begin(), nominal.balls.end(), alike)) return;
  for (const auto& [form, text] :
       {std::pair(Form::limit_of_sliding, "1 + 1/J, as (2.24) is printed, in the limit of sliding"),
        std::pair(Form::friction, "1 + 1/J, as (2.24) is printed, in the impulse too"),
        std::pair(Form::masses, "each takes half of the relative change, as for equal masses"),
        std::pair(Form::exchanged_masses, "the masses are exchanged")})
    add(list, "impacts of balls that are not alike (2.24')", text,
        [form = form](Assumed& a) { a.terms.equal_balls = form; });
}

/// Adds exchanges of the numbers of two balls of different kinds.
void add_exchanged_balls(const Assumed& nominal, Assumptions& list) {
  constexpr int most = 40;
  const int count = static_cast<int>(nominal.balls.size());
  if (count > most) return;
  for (int i = 0; i < count; ++i)
    for (int j = i + 1; j < count; ++j)
      if (!(nominal.balls[i] == nominal.balls[j]))
        add(list, "the log's numbers of balls", fmt::format("balls {} and {} taken for each other", i, j),
            [=](Assumed& a) {
              a.log.exchanged = {i, j};
            });
}

}  // namespace

Assumptions mistakes_of(const Assumed& nominal, const Assumptions& numbers, const Available& has) {
  Assumptions list;
  add_motions(nominal, list);
  add_units(has, list);
  add_axes(has, list);
  add_frames(has, list);
  add_formulas(nominal, list);
  add_exchanged_balls(nominal, list);
  add_factors(numbers, list);
  return list;
}

}  // namespace edmill::identify
