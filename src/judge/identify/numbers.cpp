#include <fmt/format.h>

#include <numbers>
#include <string_view>

#include "identify/assumed.hpp"

namespace edmill::identify {

namespace {

using model::Parameter, model::Range;

using std::numbers::pi;

/// A key with the name of an axis, "vessel.x" for axis 0; the key itself for axis -1.
std::string with_axis(const std::string& key, int axis) {
  return axis < 0 ? key : key + "." + std::string(1, "xyz"[axis]);
}

/// Makes an assumption about a number. Its unit in a fit is its own magnitude, or 1 if it is 0.
Assumption number(std::string key, Dimension dimension, double value, auto set) {
  const double size = std::abs(value);
  return {.key = std::move(key),
      .dimension = dimension,
      .value = value,
      .change = size > 0 ? size : 1.0,
      .set = set,
      .has_unit = size > 0};
}

/// Visits each number of a motion, vessel or law: f(parameter, number, axis), axis -1 for a scalar.
template <class Part, class F> void each_number(Part& part, F&& f) {
  struct Visit {
    F& f;
    void operator()(const Parameter& p, Quantity& q) const { f(p, q, -1); }
    void operator()(const Parameter& p, std::array<Quantity, 3>& q) const {
      for (int axis = 0; axis < 3; ++axis) f(p, q[axis], axis);
    }
  } visit{f};
  std::visit([&](auto& own) { own.parameters(own, visit); }, part);
}

void add_numbers(const std::string& of, const Assumed& nominal, auto member, Assumptions& list) {
  auto part = nominal.spec.*member;
  std::size_t place = 0;
  each_number(part, [&](const Parameter& p, Quantity& q, int axis) {
    const std::size_t own = place++;
    if (!p.key) return;
    const bool drive = p.range == Range::drive;
    const double nominal_value = drive ? 2 * pi / q.to<double>() : q.to<double>();
    // A number that is zero, such as a component of an axis, is not varied.
    if (nominal_value == 0) return;
    const auto set = [member, own, drive](Assumed& a, double value) {
      std::size_t k = 0;
      each_number(a.spec.*member, [&](const Parameter&, Quantity& target, int) {
        if (k++ == own) target = exactly(drive ? 2 * pi / value : value);
      });
    };
    list.push_back(number(of + "." + with_axis(p.key, axis), p.dimension, nominal_value, set));
    list.back().is_speed = drive;
    list.back().is_diameter = list.back().key == "vessel.diameter";
  });
}

/// Adds the numbers of the joints of a mill or a body; they are not keys of its type.
/// @param chains  the joints in an assumed case, of each copy, which has a rotation more before the
/// first
void add_joints(const std::string& section, Assumed nominal,
    const std::function<std::vector<std::vector<model::Joint<Quantity>>*>(Assumed&)>& chains,
    Assumptions& list) {
  const auto joints = *chains(nominal).front();
  const auto turn = std::find_if(joints.begin(), joints.end(), [](auto& j) { return j.rotates; });
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto& joint = joints[j];
    const bool behind = static_cast<std::ptrdiff_t>(j) >= turn - joints.begin();
    const auto add = [&](const std::string& key, Dimension dimension, auto member) {
      const Quantity& value = *member(joint);
      if (value.zero()) return;
      const bool turns = dimension == Dimension::angle || dimension == Dimension::angular_speed;
      const double unit = turns ? 2 * pi : 1;
      list.push_back(number(fmt::format("{}.joint.{}.{}", section, j, key), dimension,
          unit * value.to<double>(), [=, count = joints.size()](Assumed& a, double x) {
            for (auto* chain : chains(a))
              *member((*chain)[j + (behind ? chain->size() - count : 0)]) = exactly(x / unit);
          }));
    };
    for (int axis = 0; axis < 3; ++axis)
      add(with_axis("translate", axis), Dimension::length, [=](auto& j) { return &j.shift[axis]; });
    add("angle", Dimension::angle, [](auto& j) { return &j.angle; });
    add("speed", joint.rotates ? Dimension::angular_speed : Dimension::speed,
        [](auto& j) { return &j.speed; });
    if (joint.rotates && !joint.speed.zero()) list.back().is_speed = true;
    for (std::size_t s = 0; s < joint.swings.size(); ++s) {
      add(fmt::format("swing.{}.amplitude", s),
          joint.rotates ? Dimension::angle : Dimension::length,
          [s](auto& j) { return &j.swings[s].amplitude; });
      add(fmt::format("swing.{}.speed", s), Dimension::angular_speed,
          [s](auto& j) { return &j.swings[s].frequency; });
      list.back().is_speed = true;
    }
  }
}

/// Adds the numbers of the bodies in the vessel, of all copies of a body together.
void add_bodies(const Assumed& nominal, Assumptions& list) {
  const auto& bodies = nominal.spec.bodies;
  std::size_t first = 0;
  for (std::size_t entry = 0; first < bodies.size(); ++entry) {
    const auto is_copy = [where = bodies[first].where](auto& b) { return b.where == where; };
    const std::size_t end = first + std::count_if(bodies.begin(), bodies.end(), is_copy);
    const auto key = fmt::format("body.{}", entry);
    const auto add = [&](const std::string& name, Dimension of, const Quantity& q, auto set) {
      list.push_back(number(key + "." + name, of, q.to<double>(), [=](Assumed& a, double x) {
        for (std::size_t k = first; k < end; ++k) set(a.spec.bodies[k], exactly(x));
      }));
    };
    add_joints(
        key, nominal,
        [=](Assumed& a) {
          std::vector<std::vector<model::Joint<Quantity>>*> chains;
          for (std::size_t k = first; k < end; ++k) chains.push_back(&a.spec.bodies[k].joints);
          return chains;
        },
        list);
    for (std::size_t axis = 0; axis < (bodies[first].is_round ? 2 : 3); ++axis) {
      const auto name = bodies[first].is_round ? (axis == 0 ? "diameter" : "height")
                                               : with_axis("size", static_cast<int>(axis));
      if (bodies[first].size[axis].zero()) continue;
      add(name, Dimension::length, bodies[first].size[axis], [axis](auto& body, const Quantity& x) {
        body.size[axis] = x;
        if (body.is_round && axis == 0) body.size[2] = x;
      });
      list.back().is_diameter = bodies[first].is_round && axis == 0;
    }
    if (!bodies[first].rounding.zero())
      add("rounding", Dimension::length, bodies[first].rounding,
          [](auto& body, const Quantity& x) { body.rounding = x; });
    first = end;
  }
}

/// The axis of a joint as text: "x" for a coordinate axis, otherwise its components.
std::string axis_text(const model::Joint<Quantity>& joint) {
  std::array<double, 3> a{};
  for (std::size_t k = 0; k < 3; ++k) a[k] = joint.axis[k].to<double>();
  for (std::size_t k = 0; k < 3; ++k)
    if (a[k] != 0 && a[(k + 1) % 3] == 0 && a[(k + 2) % 3] == 0) return {"xyz"[k]};
  return fmt::format("({:g}, {:g}, {:g})", a[0], a[1], a[2]);
}

void add_phases(const Assumed& nominal, Assumptions& list) {
  const bool chain = std::holds_alternative<model::Chain<Quantity>>(nominal.spec.mill);
  const auto joints = casefile::joints_of(nominal.spec.mill);
  Assumptions phases;
  const auto add = [&](std::size_t j, std::size_t place, std::string key, const Quantity& turns) {
    const double value = chain ? 2 * pi * turns.to<double>() : 0;
    auto p = number(std::move(key), Dimension::angle, value, [=](Assumed& a, double x) {
      a.phases[{j, place}] = x - value;
    });
    p.change = 0.1;
    p.cycle = 2 * pi;
    p.has_unit = false;
    p.prior = 1;  // the phase of the drive is preferred if it fits as well
    phases.push_back(std::move(p));
  };
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto& swings = joints[j].swings;
    const auto name = [&](const std::string& in_file, const char* moves) {
      if (chain) return fmt::format("mill.joint.{}.{}", j, in_file);
      return fmt::format("mill, phase of joint {}, {} {}", j, moves, axis_text(joints[j]));
    };
    for (std::size_t s = 0; s < swings.size(); ++s)
      add(j, s,
          name(fmt::format("swing.{}.phase", s),
              joints[j].rotates ? "a swing about" : "a swing along"),
          swings[s].phase);
    const bool listed = chain && !joints[j].angle.zero();
    if (joints[j].rotates && !joints[j].speed.zero() && !listed)
      add(j, swings.size(), name("angle", "turning about"), joints[j].angle);
  }
  if (phases.size() < 2) return;  // a single phase is that of the drive
  for (auto& p : phases) list.push_back(std::move(p));
}

Vec gravity_of(const Assumed& a) {
  const auto& g = a.spec.gravity;
  return {g[0].to<double>(), g[1].to<double>(), g[2].to<double>()};
}

void add_gravity(const Assumed& nominal, Assumptions& list) {
  const Vec g = gravity_of(nominal);
  const double size = norm<double>(g);
  const auto put = [](Assumed& a, const Vec& to) {
    for (int k = 0; k < 3; ++k) a.spec.gravity[k] = exactly(to[k]);
  };
  if (size == 0) {
    for (int axis = 0; axis < 3; ++axis) {
      list.push_back(number(with_axis("run.gravity", axis), Dimension::acceleration, 0,
          [=](Assumed& a, double x) { a.spec.gravity[axis] = exactly(x); }));
      list.back().change = 10;
    }
    return;
  }
  list.push_back(number("run.gravity", Dimension::acceleration, size, [=](Assumed& a, double x) {
    Vec now = gravity_of(a);
    if (norm<double>(now) == 0) now = g;
    put(a, Vec(now * (x / norm<double>(now))));
  }));
  // Two tilts of the direction, towards the two axes that are closest to perpendicular to it.
  std::array<int, 3> axes = {0, 1, 2};
  std::sort(
      axes.begin(), axes.end(), [&](int a, int b) { return std::abs(g[a]) < std::abs(g[b]); });
  const int along = axes[2];
  for (int tilt = 0; tilt < 2; ++tilt) {
    const int axis = axes[tilt];
    auto p = number(with_axis("run.gravity, tilted towards", axis), Dimension::angle, 0,
        [=](Assumed& a, double x) {
          Vec now = gravity_of(a);
          const double c = std::cos(x), s = std::sin(x), side = g[along] < 0 ? -1 : 1;
          const double u = now[axis], v = now[along] * side;
          now[axis] = c * u + s * v;
          now[along] = (c * v - s * u) * side;
          put(a, now);
        });
    p.change = 0.1;
    list.push_back(std::move(p));
  }
}

/// Geometric sequence of values, dense enough for the fit from the best one to converge.
std::vector<double> decades(double from, double to) {
  std::vector<double> values;
  for (double value = from; value < to; value *= 1.3) values.push_back(value);
  return values;
}

/// A contact law that a code may use instead of the case's, with its fitted number.
struct OtherLaw {
  std::string_view model, number;
  Dimension dimension;
  double change;
  std::vector<double> first_values;  ///< from which fits begin
};
const OtherLaw other_laws[] = {{"constant", "restitution_tangential", Dimension::none, 0.1,
                                   {-0.9, -0.6, -0.3, 0, 0.3, 0.6, 0.9}},
    {"walton-braun", "friction", Dimension::none, 0.1, {0.03, 0.1, 0.2, 0.4, 0.8}},
    {"walton-braun", "restitution", Dimension::none, 0.1,
        {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}},
    {"viscoelastic", "dissipative_time", Dimension::time, 1e-7, decades(1e-8, 1e-4)},
    {"elastic-plastic", "yield_pressure", Dimension::pressure, 1e9, decades(1e8, 1e11)}};

/// Default for a number of another law that the case does not give; E* is that of steel.
std::optional<double> otherwise(std::string_view key) {
  if (key == "min_tangential") return -1;
  if (key == "effective_modulus") return 113e9;
  return std::nullopt;
}

using Law = casefile::ContactSpec;

struct Entry {
  std::string key;
  Dimension dimension;
  double value;
};

/// Visits each number of a law: f(key, dimension, number).
template <class F> void each_number_of(Law& law, F&& f) {
  each_number(law.law, [&](const Parameter& p, Quantity& q, int) { f(p.key, p.dimension, q); });
  f("least_separation", Dimension::speed, law.least_separation);
}

std::vector<Entry> entries(Law law) {
  std::vector<Entry> list;
  each_number_of(law, [&](const char* key, Dimension dimension, Quantity& q) {
    list.push_back({key, dimension, q.to<double>()});
  });
  return list;
}

/// Replaces a law, but for numbers of the same name. @return true if all of the new one are known
bool replace(Law& law, const OtherLaw& other, double value) {
  const auto own = entries(law);
  bool complete = true;
  casefile::for_each_kind<model::NamedLaws<Quantity>>([&](const auto& kind) {
    if (kind.name == other.model) law.law = kind;
  });
  each_number_of(law, [&](const char* key, Dimension, Quantity& q) {
    const auto same = std::find_if(own.begin(), own.end(), [&](auto& e) { return e.key == key; });
    const auto value_there = key == other.number ? value
        : same != own.end()                      ? same->value
                                                 : otherwise(key);
    complete = complete && value_there;
    q = exactly(value_there.value_or(0));
  });
  return complete;
}

/// A section of a case that defines a contact law, or two laws of the same kind.
struct Section {
  std::string key;  ///< "contact.ball_wall"
  std::function<std::vector<Law*>(Assumed&)> laws;
};

/// Adds the numbers of a section that are equal in all of its laws.
void add_numbers_of(const Section& section, Assumed nominal, Assumptions& list) {
  const auto laws = section.laws(nominal);
  const auto own = entries(*laws.front()), others = entries(*laws.back());
  if (own.size() != others.size()) return;  // tables with other points
  std::map<std::string, std::size_t> seen;
  for (std::size_t k = 0; k < own.size(); ++k) {
    const auto& [key, dimension, value] = own[k];
    // Another law may not have a number of this name; points of tables have one name.
    const auto set = [laws = section.laws, key = key, which = seen[key]++](Assumed& a, double x) {
      for (Law* law : laws(a)) {
        std::size_t same = 0;
        each_number_of(*law, [&](const char* there, Dimension, Quantity& q) {
          if (there == key && same++ == which) q = exactly(x);
        });
      }
    };
    if (value != others[k].value) continue;
    list.push_back(number(section.key + "." + key, dimension, value, set));
    if (value == 0) list.back().change = dimension == Dimension::speed ? 0.01 : 0.1;
  }
}

void add_other_laws(const Section& section, Assumed nominal, Assumptions& list) {
  const Law& law = *section.laws(nominal).front();
  for (const auto& other : other_laws) {
    Law tried = law;
    if (law.name() == other.model || !replace(tried, other, other.first_values.front())) continue;
    list.push_back(
        {.key = fmt::format("{}, law \"{}\": {}", section.key, other.model, other.number),
            .dimension = other.dimension,
            .value = std::numeric_limits<double>::quiet_NaN(),
            .change = other.change,
            .set =
                [laws = section.laws, &other](Assumed& a, double x) {
                  for (Law* own : laws(a)) replace(*own, other, x);
                },
            .prior = 1,  // a number of the case's law is preferred if it fits as well
            .in_place_of = fmt::format("the law \"{}\"", law.name()),
            .first_values = other.first_values});
  }
}

/// Adds the numbers of the contact laws, and one number of each law that a code may use instead.
void add_laws(const Assumed& nominal, Assumptions& list) {
  using Laws = std::vector<Law*>;
  const auto& spec = nominal.spec;
  std::vector<Section> sections;
  if (!spec.pairs_only) {
    if (spec.ball_ball.law.index() == spec.ball_wall.law.index())
      sections.push_back({"contact", [](Assumed& a) {
                            return Laws{&a.spec.ball_ball, &a.spec.ball_wall};
                          }});
    sections.push_back({"contact.ball_ball", [](Assumed& a) { return Laws{&a.spec.ball_ball}; }});
    sections.push_back({"contact.ball_wall", [](Assumed& a) { return Laws{&a.spec.ball_wall}; }});
  }
  for (const auto& section : sections) add_numbers_of(section, nominal, list);
  for (const auto& section : sections) add_other_laws(section, nominal, list);
  for (std::size_t k = 0; k < spec.pairs.size(); ++k)
    add_numbers_of(
        {fmt::format("contact.pair.{}", k), [k](Assumed& a) { return Laws{&a.spec.pairs[k].law}; }},
        nominal, list);
}

/// Adds the parameters of the balls [first, last), each scaled by one factor for all of them.
void add_balls(const std::string& key, std::size_t first, std::size_t last,
    const casefile::BallSpec& spec, Assumptions& list) {
  using Spec = casefile::BallSpec;
  // Changes the balls themselves, whose diameters may differ, and their entries in the case.
  const auto each = [first, last](Assumed& a, Quantity Spec::*member, double x, auto&& change) {
    for (std::size_t k = first; k < last; ++k) change(a.balls[k]);
    const std::size_t explicit_ones = a.spec.balls.size();
    for (std::size_t k = first; k < std::min(last, explicit_ones); ++k)
      a.spec.balls[k].*member = exactly(x);
    std::size_t next = explicit_ones;
    for (auto& batch : a.spec.batches) {
      if (next >= first && next < last) batch.*member = exactly(x);
      next += batch.count;
    }
  };
  const double diameter = spec.diameter.to<double>(), density = spec.density.to<double>();
  list.push_back(number(key + ".diameter", Dimension::length, diameter, [=](Assumed& a, double x) {
    const double by = x / diameter;
    each(a, &Spec::diameter, x, [&](auto& ball) {
      ball.radius *= by;
      ball.mass *= by * by * by;
    });
  }));
  list.back().is_diameter = true;
  list.push_back(number(key + ".density", Dimension::density, density, [=](Assumed& a, double x) {
    each(a, &Spec::density, x, [&](auto& ball) { ball.mass *= x / density; });
  }));
  list.push_back(number(key + ".reduced_inertia", Dimension::none,
      spec.reduced_inertia.to<double>(), [=](Assumed& a, double x) {
        each(a, &Spec::reduced_inertia, x, [&](auto& ball) { ball.reduced_inertia = x; });
      }));
}

void add_all_balls(const Assumed& nominal, Assumptions& list) {
  const auto groups = ball_groups(nominal.spec);
  if (groups.empty()) return;
  constexpr std::size_t most_groups = 8;
  const auto same = [&](auto member) {
    return std::all_of(groups.begin(), groups.end(), [&](const BallGroup& g) {
      return (g.spec->*member).text() == (groups[0].spec->*member).text();
    });
  };
  using Spec = casefile::BallSpec;
  if (groups.size() == 1)
    return add_balls(groups[0].key, 0, nominal.balls.size(), *groups[0].spec, list);
  if (same(&Spec::diameter) && same(&Spec::density) && same(&Spec::reduced_inertia))
    add_balls("all balls", 0, nominal.balls.size(), *groups[0].spec, list);
  if (groups.size() <= most_groups)
    for (const auto& g : groups) add_balls(g.key, g.first, g.last, *g.spec, list);
}

/// To add a term, add a member to Terms, a factor in its equation in audit, and a row here.
struct TermRow {
  const char* name;      ///< "torque of the friction"
  const char* equation;  ///< of docs/theory.md
  double Terms::*member;
  Dimension shift = Dimension::none;  ///< of a shift, 0 if correct; none: a factor, 1 if correct
  bool of_flights = false;            ///< else of impacts
};
constexpr TermRow term_rows[] = {{"impulse of the friction", "(2.28')", &Terms::friction},
    {"change of the velocity by the friction", "(2.34')", &Terms::friction_on_velocity},
    {"torque of the friction", "(2.35)", &Terms::torque},
    {"share M/m of the impulse", "(2.28')", &Terms::share},
    {"c - 1 in the limit of sliding", "(2.24')", &Terms::compliance_in_limit},
    {"c - 1 in the impulse of the friction", "(2.28')", &Terms::compliance_in_impulse},
    {"lever arm R in the velocity of the contact point", "(2.27)", &Terms::arm},
    {"velocity of the wall", "(2.27)", &Terms::wall_velocity},
    {"delay of the wall's velocity", "(2.27)", &Terms::wall_velocity_delay, Dimension::time},
    {"work of the wall, column wall_work", "(A.82)", &Terms::wall_work},
    {"dose, column milling_dose", "(2.36')", &Terms::dose},
    {"energy of the spin in the dose", "(2.36')", &Terms::spin_in_dose},
    {"work of the wall in the dose", "(2.36')", &Terms::work_in_dose},
    {"supplied energy in the dose", "(2.36')", &Terms::supply_in_dose},
    {"column approach_speed", "(2.27)", &Terms::approach_speed},
    {"column slip_speed", "(2.27)", &Terms::slip_speed},
    {"gap at which bodies meet", "(2.17')", &Terms::contact_gap, Dimension::length},
    {"gravity in flights", "(2.1)", &Terms::gravity, Dimension::none, true},
    {"gravity in the places of flights", "(2.1)", &Terms::gravity_in_places, Dimension::none, true},
    {"gravity in the velocities of flights", "(2.1)", &Terms::gravity_in_velocities,
        Dimension::none, true},
    {"spin in flights", "(2.1)", &Terms::spin_in_flight, Dimension::none, true},
    {"time of flight, too long by", "(2.1)", &Terms::time_of_flight, Dimension::time, true},
    {"age of the velocities before impacts", "(2.1)", &Terms::age_of_velocities, Dimension::time,
        true}};

void add_terms(Assumptions& list) {
  for (const auto& row : term_rows) {
    const bool is_factor = row.shift == Dimension::none;
    const double change = is_factor ? 1.0 : row.shift == Dimension::time ? 1e-5 : 1e-4;
    list.push_back({.key = row.name,
        .dimension = row.shift,
        .value = is_factor ? 1.0 : 0.0,
        .change = change,
        .set = [member = row.member](Assumed& a, double x) { a.terms.*member = x; },
        .equation = row.equation,
        .of_impacts = !row.of_flights,
        .prior = 1});  // a number of the case is preferred if it fits as well
  }
}

struct Unit {
  Dimension dimension;
  const char* name;
  double size;
};
constexpr Unit units[] = {{Dimension::length, " mm", 1e-3}, {Dimension::time, " ms", 1e-3},
    {Dimension::angle, " deg", pi / 180}, {Dimension::speed, " m/s", 1},
    {Dimension::angular_speed, " rpm", 2 * pi / 60}, {Dimension::acceleration, " m/s2", 1},
    {Dimension::density, " kg/m3", 1}};
Unit unit_of(Dimension dimension, double value) {
  if (dimension == Dimension::pressure)
    return std::abs(value) < 1e9 ? Unit{dimension, " MPa", 1e6} : Unit{dimension, " GPa", 1e9};
  for (const auto& unit : units)
    if (unit.dimension == dimension) return unit;
  return {dimension, "", 1};
}

}  // namespace

std::vector<double> Assumption::trial_values(double end) const {
  if (!is_of_case()) return first_values;
  std::vector<double> values;
  if (cycle > 0) {
    for (int k = -7; k <= 8; ++k)
      if (k != 0) values.push_back(value + cycle * k / 16);
  } else if (is_speed) {
    // Steps of a tenth of a turn; a wide range only if the log begins early, so that they are few.
    constexpr double most_turns = 15, near = 0.12, far = 2.5;
    const double turns = std::abs(end * value) / (2 * pi);
    const auto steps = [&](double most) { return static_cast<int>(std::ceil(most * turns * 10)); };
    const int few = std::clamp(steps(near), 1, 400), all = turns < most_turns ? steps(far) : 0;
    for (int k = -few; k <= few; ++k)
      if (k != 0) values.push_back(value * (1 + near * k / few));
    for (const double factor : {-1.0, 0.5, 2.0}) values.push_back(factor * value);
    for (int k = -all; k <= all; ++k)
      if (k != 0) values.push_back(value * far * k / all);
  } else if (value == 0) {
    values = {0.1 * change, change, 10 * change, -change};
  } else {
    for (const double factor : {-1.0, 0.0, 0.1, 0.5, 0.75, 1.3, 2.0, 10.0})
      values.push_back(factor * value);
  }
  return values;
}

Assumptions numbers_of(const Assumed& nominal) {
  Assumptions list;
  if (std::holds_alternative<model::Chain<Quantity>>(nominal.spec.mill))
    add_joints(
        "mill", nominal,
        [](Assumed& a) {
          return std::vector{&std::get<model::Chain<Quantity>>(a.spec.mill).given.list};
        },
        list);
  else
    add_numbers("mill", nominal, &CaseSpec::mill, list);
  if (!std::holds_alternative<model::StillMill<Quantity>>(nominal.spec.mill)) {
    const double period = casefile::period_of(nominal.spec.mill).to<double>();
    list.push_back(number(
        "phase of the drive", Dimension::time, 0, [](Assumed& a, double x) { a.log.delay = x; }));
    list.back().change = period / 10;
    list.back().cycle = period;
    add_phases(nominal, list);
  }
  if (!std::holds_alternative<model::Polyhedron<Quantity>>(nominal.spec.vessel))
    add_numbers("vessel", nominal, &CaseSpec::vessel, list);
  add_bodies(nominal, list);
  add_gravity(nominal, list);
  add_laws(nominal, list);
  add_all_balls(nominal, list);
  add_terms(list);
  return list;
}

Assumption restricted_to(const SharedSubset& part, const Assumption& what, std::size_t choices) {
  Assumption p = what;
  p.key += ", " + part->name;
  p.set = [part, set = what.set](Assumed& a, double x) {
    a.restricted.push_back({part, [set, x](Assumed& here) { set(here, x); }});
  };
  p.prior = what.prior + 2 * std::log(static_cast<double>(choices));
  return p;
}

std::string word_for(double factor, double half_width) {
  constexpr std::pair<double, const char*> words[] = {
      {-1, "reversed"}, {0, "left out"}, {2, "doubled"}, {0.5, "halved"}};
  for (const auto& [of, text] : words)
    if (std::abs(factor - of) <= half_width && half_width < 0.1) return text;
  return "";
}

std::string value_text(Dimension dimension, double value, double half_width) {
  const Unit unit = unit_of(dimension, value);
  const double h = half_width / unit.size,
               v = std::abs(value) <= half_width && h < 1e-6 ? 0 : value / unit.size;
  if (!(h > 0) || !std::isfinite(h)) return fmt::format("{:.9g}{}", v, unit.name);
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(h))) + 1, 0, 15);
  if (h < 1e-6 * std::max(std::abs(v), 1e-3))
    return fmt::format("{:.9g} ± {:.1e}{}", v, h, unit.name);
  return fmt::format("{:.{}f} ± {:.{}f}{}", v, decimals, h, decimals, unit.name);
}

}  // namespace edmill::identify
