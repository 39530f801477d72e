#include "identify/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace edmill::identify {

namespace {

using casefile::Quantity;
using model::Range;

using std::numbers::pi;

/// Visits each number of a motion or a vessel: f(parameter, number, axis), axis -1 for a scalar.
template <class Part, class F>
void each_number(Part& part, F&& f) {
  struct Visit {
    F& f;
    void operator()(const model::Parameter& p, Quantity& q) const { f(p, q, -1); }
    void operator()(const model::Parameter& p, std::array<Quantity, 3>& q) const {
      for (int axis = 0; axis < 3; ++axis) f(p, q[axis], axis);
    }
  } visit{f};
  std::visit([&](auto& own) { own.parameters(own, visit); }, part);
}

template <class Member>
void add_numbers(const std::string& section, const Assumptions& nominal, Member member,
                 std::vector<Parameter>& list) {
  auto part = nominal.spec.*member;
  std::size_t place = 0;
  each_number(part, [&](const model::Parameter& p, Quantity& q, int axis) {
    const std::size_t own = place++;
    if (!p.key) return;
    const bool drive = p.range == Range::drive;
    const double nominal_value = drive ? 2 * pi / q.to<double>() : q.to<double>();
    // What does not move, and directions of axes, are not numbers that a code takes for another.
    if (nominal_value == 0) return;
    const auto set = [member, own, drive](Assumptions& a, double value) {
      std::size_t k = 0;
      each_number(a.spec.*member, [&](const model::Parameter&, Quantity& target, int) {
        if (k++ == own) target = exactly(drive ? 2 * pi / value : value);
      });
    };
    auto parameter =
        number(section + "." + with_axis(p.key, axis), p.meaning, p.dimension, nominal_value, set);
    parameter.is_speed = drive;
    parameter.is_diameter = parameter.key == "vessel.diameter";
    list.push_back(std::move(parameter));
  });
}

Vec3<double> gravity_of(const Assumptions& a) {
  const auto& g = a.spec.gravity;
  return {g[0].to<double>(), g[1].to<double>(), g[2].to<double>()};
}

void add_gravity(const Assumptions& nominal, std::vector<Parameter>& list) {
  const Vec3<double> g = gravity_of(nominal);
  const double size = norm<double>(g);
  const auto put = [](Assumptions& a, const Vec3<double>& to) {
    for (int k = 0; k < 3; ++k) a.spec.gravity[k] = exactly(to[k]);
  };
  if (size == 0) {
    for (int axis = 0; axis < 3; ++axis) {
      auto p =
          number(with_axis("run.gravity", axis), "gravity, which the case has not", Dimension::acceleration,
                 0, [=](Assumptions& a, double x) { a.spec.gravity[axis] = exactly(x); });
      p.change = 10;
      list.push_back(std::move(p));
    }
    return;
  }
  list.push_back(number("run.gravity", "size", Dimension::acceleration, size, [=](Assumptions& a, double x) {
    Vec3<double> now = gravity_of(a);
    if (norm<double>(now) == 0) now = g;
    put(a, Vec3<double>(now * (x / norm<double>(now))));
  }));
  // Two tilts of the direction: towards the axes that are most across it.
  std::array<int, 3> axes = {0, 1, 2};
  std::sort(axes.begin(), axes.end(), [&](int i, int j) { return std::abs(g[i]) < std::abs(g[j]); });
  const int along = axes[2];
  for (int tilt = 0; tilt < 2; ++tilt) {
    const int axis = axes[tilt];
    auto p = number(with_axis("run.gravity, tilted towards", axis), "direction", Dimension::angle, 0,
                    [=](Assumptions& a, double x) {
                      Vec3<double> now = gravity_of(a);
                      const double c = std::cos(x), s = std::sin(x), side = g[along] < 0 ? -1 : 1;
                      const double u = now[axis], v = now[along] * side;
                      now[axis] = c * u + s * v, now[along] = (c * v - s * u) * side;
                      put(a, now);
                    });
    p.change = 0.1;
    list.push_back(std::move(p));
  }
}

/// Adds the parameters of the balls [first, last), whose numbers are all scaled alike.
void add_balls(const std::string& key, std::size_t first, std::size_t last, const casefile::BallSpec& spec,
               std::vector<Parameter>& list) {
  using Spec = casefile::BallSpec;
  // In the balls themselves, whose diameters may differ, and in the entries of the case.
  const auto each = [first, last](Assumptions& a, Quantity Spec::*member, double x, auto&& change) {
    for (std::size_t k = first; k < last; ++k) change(a.balls[k]);
    const std::size_t explicit_ones = a.spec.balls.size();
    for (std::size_t k = first; k < std::min(last, explicit_ones); ++k) a.spec.balls[k].*member = exactly(x);
    std::size_t next = explicit_ones;
    for (auto& batch : a.spec.batches) {
      if (next >= first && next < last) batch.*member = exactly(x);
      next += static_cast<std::size_t>(batch.count);
    }
  };
  const double diameter = spec.diameter.to<double>(), density = spec.density.to<double>();
  list.push_back(number(key + ".diameter", "", Dimension::length, diameter, [=](Assumptions& a, double x) {
    const double by = x / diameter;
    each(a, &Spec::diameter, x, [&](auto& ball) { ball.radius *= by, ball.mass *= by * by * by; });
  }));
  list.back().is_diameter = true;
  list.push_back(number(key + ".density", "", Dimension::density, density, [=](Assumptions& a, double x) {
    each(a, &Spec::density, x, [&](auto& ball) { ball.mass *= x / density; });
  }));
  list.push_back(number(key + ".reduced_inertia", "J", Dimension::none, spec.reduced_inertia.to<double>(),
                        [=](Assumptions& a, double x) {
                          each(a, &Spec::reduced_inertia, x, [&](auto& ball) { ball.reduced_inertia = x; });
                        }));
}

void add_all_balls(const Assumptions& nominal, std::vector<Parameter>& list) {
  const auto groups = ball_groups(nominal.spec);
  if (groups.empty()) return;
  constexpr std::size_t most_groups = 8;
  const auto same = [&](auto member) {
    return std::all_of(groups.begin(), groups.end(), [&](const BallGroup& g) {
      return (g.spec->*member).text() == (groups[0].spec->*member).text();
    });
  };
  using Spec = casefile::BallSpec;
  if (groups.size() == 1) return add_balls(groups[0].key, 0, nominal.balls.size(), *groups[0].spec, list);
  if (same(&Spec::diameter) && same(&Spec::density) && same(&Spec::reduced_inertia))
    add_balls("all balls", 0, nominal.balls.size(), *groups[0].spec, list);
  if (groups.size() <= most_groups)
    for (const auto& g : groups) add_balls(g.key, g.first, g.last, *g.spec, list);
}

}  // namespace

std::vector<double> Parameter::values_from_afar() const {
  if (!is_of_case()) return first_values;
  if (is_speed || cycle > 0) return {};  // of a periodic motion: Candidates::starts
  if (value == 0) return {0.1 * change, change, 10 * change, -change};
  std::vector<double> values;
  for (const double factor : {-1.0, 0.0, 0.1, 0.5, 0.75, 1.3, 2.0, 10.0}) values.push_back(factor * value);
  return values;
}

Parameter number(std::string key, std::string meaning, Dimension dimension, double value,
                 std::function<void(Assumptions&, double)> set) {
  const double size = std::abs(value);
  return {std::move(key),        std::move(meaning), dimension, value,
          size > 0 ? size : 1.0, std::move(set),     size > 0};
}

std::vector<Parameter> parameters_of(const Assumptions& nominal) {
  std::vector<Parameter> list;
  if (std::holds_alternative<model::Chain<Quantity>>(nominal.spec.mill))
    add_joints(nominal, list);
  else
    add_numbers("mill", nominal, &casefile::CaseSpec::mill, list);
  if (!std::holds_alternative<model::StillMill<Quantity>>(nominal.spec.mill)) {
    const double period = casefile::period_of(nominal.spec.mill).to<double>();
    auto phase = number("phase of the drive", "as a time that the log's clock is behind", Dimension::time, 0,
                        [](Assumptions& a, double x) { a.log.delay = x; });
    phase.change = period / 10;
    phase.cycle = period;
    list.push_back(std::move(phase));
    add_phases(nominal, list);
  }
  if (!std::holds_alternative<model::Polyhedron<Quantity>>(nominal.spec.vessel))
    add_numbers("vessel", nominal, &casefile::CaseSpec::vessel, list);
  add_gravity(nominal, list);
  add_laws(nominal, list);
  add_all_balls(nominal, list);
  for (auto& term : term_parameters()) list.push_back(std::move(term));
  return list;
}

namespace {

struct Unit {
  const char* name;
  double size;
};
Unit unit_of(Dimension dimension, double value) {
  switch (dimension) {
    case Dimension::length:
      return {" mm", 1e-3};
    case Dimension::time:
      return {" ms", 1e-3};
    case Dimension::angle:
      return {" deg", pi / 180};
    case Dimension::speed:
      return {" m/s", 1};
    case Dimension::angular_speed:
      return {" rpm", 2 * pi / 60};
    case Dimension::acceleration:
      return {" m/s2", 1};
    case Dimension::density:
      return {" kg/m3", 1};
    case Dimension::pressure:
      return std::abs(value) < 1e9 ? Unit{" MPa", 1e6} : Unit{" GPa", 1e9};
    default:
      return {"", 1};
  }
}

}  // namespace

std::string value_text(Dimension dimension, double value) {
  const Unit unit = unit_of(dimension, value);
  return fmt::format("{:.9g}{}", value / unit.size, unit.name);
}

std::string value_text(Dimension dimension, double value, double half_width) {
  const Unit unit = unit_of(dimension, value);
  const double h = half_width / unit.size,
               v = std::abs(value) <= half_width && h < 1e-6 ? 0 : value / unit.size;
  if (!(h > 0) || !std::isfinite(h)) return fmt::format("{:.9g}{}", v, unit.name);
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(h))) + 1, 0, 15);
  if (h < 1e-6 * std::max(std::abs(v), 1e-3)) return fmt::format("{:.9g} ± {:.1e}{}", v, h, unit.name);
  return fmt::format("{:.{}f} ± {:.{}f}{}", v, decimals, h, decimals, unit.name);
}

}  // namespace edmill::identify
