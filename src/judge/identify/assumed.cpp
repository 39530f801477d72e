#include "identify/assumed.hpp"

#include <fmt/format.h>

#include <numbers>

namespace edmill::identify {

Vec Axes::of(const Vec& v) const {
  Vec turned;
  for (std::size_t k = 0; k < 3; ++k) turned[k] = sign[k] * v[from[k]];
  return turned;
}

namespace {

/// Transforms the vectors of an event from another frame to that of the laboratory.
void to_laboratory(LoggedEvent& event, LogFrame from, const Mill& mill) {
  const auto frame = audit::vessel_at(mill, event.time, false);
  const auto turned = [&](const Vec& v) {
    return Vec(frame.x * v[0] + frame.y * v[1] + frame.z * v[2]);
  };
  const bool moves = from == LogFrame::vessel;
  for (auto& body : event.body) {
    body.position = turned(body.position);
    if (moves) body.position += frame.centre;
    const Vec of_vessel = moves
        ? audit::wall_velocities[0].at({frame, frame, body.position, body.position})
        : Vec(0, 0, 0);
    for (auto* v : {&body.velocity_before, &body.velocity_after}) *v = turned(*v) + of_vessel;
    for (auto* w : {&body.spin_before, &body.spin_after}) {
      *w = turned(*w);
      if (moves) *w += frame.angular_velocity;
    }
  }
}

/// True if a ball with a number in [first, end) takes part in an impact.
bool takes_part(const LoggedEvent& event, std::size_t first, std::size_t end) {
  const auto is_one = [&](int ball) {
    return ball >= static_cast<int>(first) && ball < static_cast<int>(end);
  };
  return is_one(event.ball) || (!event.with_wall && is_one(event.partner));
}

}  // namespace

void LogChange::apply(LoggedEvent& event, const Mill& mill) const {
  event.time = event.time * time + delay;
  event.milling_dose *= energies;
  event.wall_work *= energies;
  event.approach_speed *= speeds;
  event.slip_speed *= speeds;
  for (auto& body : event.body) {
    body.position = axes_of_positions.of(body.position * positions);
    for (auto* v : {&body.velocity_before, &body.velocity_after})
      *v = axes_of_velocities.of(*v * velocities);
    for (auto* w : {&body.spin_before, &body.spin_after}) *w = axes_of_spins.of(*w * spins);
    if (reversed_in_time) {
      std::swap(body.velocity_before, body.velocity_after);
      std::swap(body.spin_before, body.spin_after);
    }
  }
  if (frame != LogFrame::laboratory) to_laboratory(event, frame, mill);
  if (states_exchanged && !event.with_wall) std::swap(event.body[0], event.body[1]);
  if (exchanged[0] < 0) return;
  const auto renamed = [&](int& ball) {
    if (ball == exchanged[0])
      ball = exchanged[1];
    else if (ball == exchanged[1])
      ball = exchanged[0];
  };
  renamed(event.ball);
  if (!event.with_wall) renamed(event.partner);
}

CaseSpec Assumed::case_file() const {
  if (phases.empty() || !casefile::problems_of(spec).empty()) return spec;
  auto joints = casefile::joints_of(spec.mill);
  if (joints.size() != this->joints) return spec;  // a mistake has replaced the mill
  for (const auto& [place, more] : phases) {
    auto& joint = joints.at(place[0]);
    auto& angle = place[1] < joint.swings.size() ? joint.swings[place[1]].phase : joint.angle;
    angle = exactly(angle.to<double>() + more / (2 * std::numbers::pi));
  }
  CaseSpec changed = spec;
  changed.mill = model::Chain<Quantity>{{std::move(joints), casefile::period_of(spec.mill)}};
  return changed;
}

std::optional<Case> Assumed::built() const {
  const auto file = case_file();
  if (!casefile::problems_of(file).empty()) return std::nullopt;
  Case result;
  result.mill = casefile::build_mill<double>(file);
  result.balls = balls;
  const auto& vessel = result.mill.vessel;
  const bool room = std::none_of(balls.begin(), balls.end(),
      [&](const auto& ball) { return vessel.inset(ball.radius).is_empty(); });
  if (!room || result.mill.wall_count() != walls) return std::nullopt;
  return result;
}

Assumed assumed_of(const CaseSpec& spec) {
  const auto built = casefile::build_case<double>(spec).the_case;
  return {spec, built.balls, {}, built.mill.wall_count(), casefile::joints_of(spec.mill).size()};
}

Quantity exactly(double value) {
  // A case cannot contain nan or infinity. 0 is used instead: it is refused or fits as badly.
  return Quantity::exactly(std::isfinite(value) ? value : 0.0);
}

std::vector<BallGroup> ball_groups(const CaseSpec& spec) {
  std::vector<BallGroup> groups;
  std::size_t next = 0;
  for (std::size_t k = 0; k < spec.balls.size(); ++k, ++next)
    groups.push_back({"ball." + std::to_string(k), next, next + 1, &spec.balls[k]});
  for (std::size_t k = 0; k < spec.batches.size(); ++k) {
    const std::size_t count = spec.batches[k].count;
    groups.push_back({"balls." + std::to_string(k), next, next + count, &spec.batches[k]});
    next += count;
  }
  return groups;
}

std::vector<SharedSubset> subsets_of(const CaseSpec& spec, const Case& the_case,
    const std::vector<LoggedEvent>& events, const std::vector<Branches>& branches) {
  std::vector<SharedSubset> list;
  const auto add = [&](std::string name, bool of_flights, auto contains) {
    list.push_back(std::make_shared<Subset>(Subset{std::move(name), contains, of_flights}));
  };
  const auto of_impacts = [&](std::string name, auto holds) {
    add(std::move(name), false, [&events, holds](const RowPlace& at) {
      return !at.of_flight && holds(events[at.event], at.event);
    });
  };
  of_impacts("with walls", [](auto& e, auto) { return e.with_wall; });
  of_impacts("between balls", [](auto& e, auto) { return !e.with_wall; });
  const auto walls = the_case.mill.walls();
  for (int wall = 0; wall < static_cast<int>(walls.size()); ++wall)
    of_impacts("at " + walls[wall].meaning,
        [=](auto& e, auto) { return e.with_wall && e.partner == wall; });
  /// Adds the impacts at the walls that satisfy `is_one`, if these are several but not all.
  const auto at_walls = [&](const std::string& name, const auto& is_one) {
    std::vector<bool> at;
    for (int wall = 0; wall < static_cast<int>(walls.size()); ++wall) at.push_back(is_one(wall));
    const std::size_t number = std::count(at.begin(), at.end(), true);
    if (number > 1 && number < at.size())
      of_impacts("at " + name, [at](auto& e, auto) { return e.with_wall && at[e.partner]; });
  };
  const auto& mill = the_case.mill;
  at_walls("flat walls", [&](int k) { return !mill.body_of(k) && mill.vessel.is_flat(k); });
  at_walls("round walls", [&](int k) { return !mill.body_of(k) && !mill.vessel.is_flat(k); });
  at_walls("bodies in the vessel", [&](int k) { return mill.body_of(k) != nullptr; });
  for (std::size_t k = 0; k < spec.materials.size() && !spec.wall_materials.empty(); ++k)
    at_walls("walls of " + spec.materials[k].name,
        [&](int wall) { return spec.wall_materials[wall] == static_cast<int>(k) + 1; });
  const auto groups = ball_groups(spec);
  for (const auto& group : groups)
    if (groups.size() > 1 && group.last - group.first > 1)
      of_impacts("in impacts of " + group.key,
          [group](auto& e, auto) { return takes_part(e, group.first, group.last); });
  const auto of_branch = [&](const char* name, bool Branches::*member, bool value) {
    of_impacts(name, [=, &branches](const LoggedEvent&, std::size_t k) {
      return branches[k].known && branches[k].*member == value;
    });
  };
  of_branch("where contacts stick", &Branches::sticks, true);
  of_branch("where contacts slide", &Branches::sticks, false);
  of_branch("where the least separation speed applies", &Branches::at_least_separation, true);
  of_branch("where the restitution applies", &Branches::at_least_separation, false);
  const auto& balls = the_case.balls;
  of_impacts("between balls that are not alike",
      [&balls](auto& e, auto) { return !e.with_wall && !(balls[e.ball] == balls[e.partner]); });
  // Rows of both bodies, those of the energy, are affected by a change of either body.
  add("on the partner", false, [&events](const RowPlace& at) {
    return !at.of_flight && at.body != 0 && !events[at.event].with_wall;
  });
  add("on the ball, not its partner", false, [&events](const RowPlace& at) {
    return !at.of_flight && at.body != 1 && !events[at.event].with_wall;
  });
  constexpr int most_balls = 40;
  const int count = static_cast<int>(balls.size());
  for (int ball = 0; ball < count && count <= most_balls && count > 1; ++ball) {
    of_impacts(fmt::format("in impacts of ball {}", ball),
        [ball](auto& e, auto) { return takes_part(e, ball, ball + 1); });
    add(fmt::format("on ball {}", ball), true, [&events, ball](const RowPlace& at) {
      const auto& event = events[at.event];
      return at.body < 0 ? takes_part(event, ball, ball + 1) : event.ball_at(at.body) == ball;
    });
  }
  return list;
}

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
constexpr Factor factors[] = {{Factor::On::any, 1e3, "1000: its unit"},
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
  const auto add_unit = [&](const std::string& of, double LogChange::*unit, double by, auto text) {
    add(list, "the log's " + of, text, [=](Assumed& a) { a.log.*unit = by; });
  };
  struct Columns {
    bool logged;
    const char* name;
    double LogChange::*factor;
    const char *small, *unit;
  };
  const Columns with_units[] = {{true, "times", &LogChange::time, "ms", "s"},
      {ball.position, "positions", &LogChange::positions, "mm", "m"},
      {ball.velocity_before || ball.velocity_after, "velocities", &LogChange::velocities, "mm/s",
          "m/s"},
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

void add_axes(const Available& has, Assumptions& list) {
  const auto& ball = has.body[0];
  struct Vectors {
    bool logged;
    const char* name;
    Axes LogChange::*axes;
  };
  const Vectors vectors[] = {{ball.position, "positions", &LogChange::axes_of_positions},
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
        text += fmt::format(
            "{}{}{}", k > 0 ? ", " : "", axes.sign[k] < 0 ? "-" : "", "xyz"[axes.from[k]]);
      }
      if (axes == Axes{}) continue;
      text += " of the log are x, y, z of the case";
      if (all)
        add(list, "the log's vectors", text, [=](Assumed& a) {
          for (const auto& v : vectors) a.log.*v.axes = axes;
        });
      for (const auto& v : vectors)
        if (v.logged)
          add(list, std::string("the log's ") + v.name, text,
              [=](Assumed& a) { a.log.*v.axes = axes; });
    }
  } while (std::next_permutation(from.begin(), from.end()));
}

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
        add(list, "the log's numbers of balls",
            fmt::format("balls {} and {} taken for each other", i, j), [=](Assumed& a) {
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
