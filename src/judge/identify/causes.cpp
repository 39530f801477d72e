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

void add_motions(const Assumptions& nominal, std::vector<Mistake>& list) {
  const Joints joints = casefile::joints_of(nominal.spec.mill);
  if (std::holds_alternative<model::Spex8000<Quantity>>(nominal.spec.mill)) {
    list.push_back({"mill, order of rotations",
                    "R_x(gamma) R_z(theta), as (2.14) is printed, in place of R_z(theta) R_x(gamma)",
                    [joints](Assumptions& a) {
                      // The centre stays on its circle; the axes are turned by theta first, then by gamma
                      // about X.
                      auto back = joints[0];
                      back.angle = -back.angle;
                      for (auto& swing : back.swings) swing.amplitude = -swing.amplitude;
                      put_chain(a, {joints[0], joints[1], back, joints[2], joints[0]});
                    },
                    false, true});
    list.push_back({"mill, sign of gamma", "-gamma_max sin(phase) in place of gamma_max sin(phase)",
                    [joints](Assumptions& a) {
                      auto turned = joints;
                      for (auto& swing : turned[2].swings) swing.amplitude = -swing.amplitude;
                      put_chain(a, turned);
                    },
                    false, true});
    list.push_back({"mill, direction of rotation", "the drive turns the other way",
                    [joints](Assumptions& a) { put_chain(a, reversed(joints)); }, false, true});
    return;
  }
  const auto moves = [](const auto& joint) { return !joint.speed.zero() || !joint.swings.empty(); };
  if (std::any_of(joints.begin(), joints.end(), moves))
    list.push_back({"mill, direction of rotation", "all joints move the other way in time",
                    [joints](Assumptions& a) { put_chain(a, reversed(joints)); }, false, true});
}

struct Factor {
  double by;
  const char* text;
};
constexpr Factor unit_factors[] = {
    {1e3, "a factor of 1000: its unit"},
    {1e-3, "a factor of 1/1000: its unit"},
    {pi / 180, "a factor of pi/180: degrees taken for radians, or the reverse"},
    {180 / pi, "a factor of 180/pi: degrees taken for radians, or the reverse"}};

void add_units(const std::vector<Parameter>& parameters, std::vector<Mistake>& list) {
  for (const auto& p : parameters) {
    if (!p.has_unit || p.dimension == Dimension::none) continue;
    const auto add = [&](const Factor& factor) {
      list.push_back({p.key,
                      fmt::format("{} in place of {}, {}", value_text(p.dimension, factor.by * p.value),
                                  value_text(p.dimension, p.value), factor.text),
                      [set = p.set, value = factor.by * p.value](Assumptions& a) { set(a, value); }, true});
    };
    const bool angle = p.dimension == Dimension::angle || p.dimension == Dimension::angular_speed;
    for (const auto& factor : unit_factors)
      if (angle || factor.by == 1e3 || factor.by == 1e-3) add(factor);
    if (p.dimension == Dimension::angular_speed) {
      add({60, "a factor of 60: revolutions per minute taken for per second"});
      add({1.0 / 60, "a factor of 1/60: revolutions per second taken for per minute"});
      add({2 * pi, "a factor of 2 pi: revolutions taken for radians"});
      add({0.5 / pi, "a factor of 1/(2 pi): radians taken for revolutions"});
    }
    if (p.is_diameter) add({2, "a factor of 2: the diameter taken for the radius"});
    if (p.is_diameter) add({0.5, "a factor of 1/2: the radius taken for the diameter"});
  }
}

void add_columns(const audit::Available& has, std::vector<Mistake>& list) {
  const auto add = [&](const std::string& columns, double LogChange::*member, double factor,
                       const std::string& text) {
    list.push_back({"the log's " + columns, text, [=](Assumptions& a) { a.log.*member = factor; }});
  };
  const auto thousands = [&](const std::string& columns, double LogChange::*member, const char* small,
                             const char* unit) {
    add(columns, member, 1e-3, fmt::format("in {} in place of {}", small, unit));
    add(columns, member, 1e3, fmt::format("in units of 1000 {}", unit));
  };
  thousands("times", &LogChange::time, "ms", "s");
  if (has.body[0].position) thousands("positions", &LogChange::positions, "mm", "m");
  if (has.body[0].velocity_before || has.body[0].velocity_after)
    thousands("velocities", &LogChange::velocities, "mm/s", "m/s");
  if (has.body[0].spin_before || has.body[0].spin_after) {
    add("spins", &LogChange::spins, pi / 180, "in degrees per second in place of rad/s");
    add("spins", &LogChange::spins, 180 / pi, "multiplied by pi/180 once too often");
    add("spins", &LogChange::spins, 2 * pi, "in revolutions per second in place of rad/s");
  }
  if (has.milling_dose || has.wall_work) thousands("energies", &LogChange::energies, "mJ", "J");
  if (has.approach_speed) thousands("speeds", &LogChange::speeds, "mm/s", "m/s");
  if (has.body[1].velocity_before || has.body[1].velocity_after)
    list.push_back({"the log's columns of the partner", "the states of ball and partner exchanged",
                    [](Assumptions& a) { a.log.states_exchanged = true; }});
}

/// Axes that a code has in another order or direction.
void add_axes(const audit::Available& has, std::vector<Mistake>& list) {
  struct Group {
    const char* name;
    bool positions, velocities, spins;
  };
  const bool velocities = has.body[0].velocity_before || has.body[0].velocity_after,
             spins = has.body[0].spin_before || has.body[0].spin_after;
  constexpr Group groups[] = {{"vectors", true, true, true},
                              {"positions", true, false, false},
                              {"velocities", false, true, false},
                              {"spins", false, false, true}};
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
      for (const auto& group : groups) {
        if ((group.positions && !has.body[0].position) || (group.velocities && !velocities) ||
            (group.spins && !spins))
          continue;
        list.push_back({fmt::format("the log's {}", group.name),
                        fmt::format("{} of the log are x, y, z of the case", text), [=](Assumptions& a) {
                          if (group.positions) a.log.axes_of_positions = axes;
                          if (group.velocities) a.log.axes_of_velocities = axes;
                          if (group.spins) a.log.axes_of_spins = axes;
                        }});
      }
    }
  } while (std::next_permutation(from.begin(), from.end()));
}

void add_frames(const audit::Available& has, std::vector<Mistake>& list) {
  if (!has.body[0].position) return;
  list.push_back({"the log's frame", "vectors in components along the vessel's axes",
                  [](Assumptions& a) { a.log.frame = LogFrame::axes_of_vessel; }});
  list.push_back({"the log's frame", "places, velocities and spins as seen from the vessel",
                  [](Assumptions& a) { a.log.frame = LogFrame::vessel; }});
  if (has.body[0].velocity_before && has.body[0].velocity_after)
    list.push_back({"the log's states", "before and after the impact exchanged",
                    [](Assumptions& a) { a.log.reversed_in_time = true; }});
  for (std::size_t formula = 1; formula < audit::wall_velocities.size(); ++formula)
    list.push_back({"velocity of the wall (2.27)", audit::wall_velocities[formula].note,
                    [formula](Assumptions& a) { a.terms.wall_velocity_formula = formula; }});
}

/// Formulas that hold for balls that are alike, for those that are not.
void add_equal_balls(const Assumptions& nominal, std::vector<Mistake>& list) {
  using Form = Terms::EqualBalls;
  const auto alike = [&](const auto& ball) { return ball == nominal.balls.front(); };
  if (std::all_of(nominal.balls.begin(), nominal.balls.end(), alike)) return;
  const auto add = [&](const char* text, Form form) {
    list.push_back({"impacts of balls that are not alike (2.24')", text,
                    [form](Assumptions& a) { a.terms.equal_balls = form; }});
  };
  add("1 + 1/J, as (2.24) is printed, in the limit of sliding", Form::limit_of_sliding);
  add("1 + 1/J, as (2.24) is printed, in the impulse too", Form::friction);
  add("each takes half of the relative change, as for equal masses", Form::masses);
}

/// Numbers of balls of different kinds that a log has exchanged. Balls alike cannot be told apart.
void add_exchanged_balls(const Assumptions& nominal, std::vector<Mistake>& list) {
  constexpr int most = 40;
  const int count = static_cast<int>(nominal.balls.size());
  if (count > most) return;
  for (int i = 0; i < count; ++i)
    for (int j = i + 1; j < count; ++j)
      if (!(nominal.balls[i] == nominal.balls[j]))
        list.push_back({"the log's numbers of balls",
                        fmt::format("balls {} and {} taken for each other", i, j), [=](Assumptions& a) {
                          a.log.exchanged = {i, j};
                        }});
}

}  // namespace

std::vector<Mistake> mistakes_of(const Assumptions& nominal, const std::vector<Parameter>& parameters,
                                 const audit::Available& has) {
  std::vector<Mistake> list;
  add_motions(nominal, list);
  add_columns(has, list);
  add_axes(has, list);
  add_frames(has, list);
  add_equal_balls(nominal, list);
  add_exchanged_balls(nominal, list);
  add_units(parameters, list);
  return list;
}

}  // namespace edmill::identify
