#include <algorithm>
#include <cmath>
#include <set>

#include "base/errors.hpp"
#include "identify/fit.hpp"

namespace edmill::identify {

using audit::LoggedEvent;
using audit::LoggedImpact;
using audit::Vec;

namespace {

constexpr double out_of_range = 1e15;

/// The outcome of an impact with other terms.
audit::Formula formula_of(const Terms& terms, const LoggedImpact& impact) {
  audit::Formula formula;
  formula.velocity_sign = terms.friction * terms.friction_on_velocity;
  formula.spin_sign = terms.friction * terms.torque;
  formula.friction_of_restitution = terms.friction_of_restitution;
  const double less = impact.compliance - 1;
  if (terms.compliance_in_limit != 1)
    formula.compliance_in_e_t = std::max(1e-3, 1 + less * terms.compliance_in_limit);
  if (terms.compliance_in_impulse != 1)
    formula.compliance_in_impulse = std::max(1e-3, 1 + less * terms.compliance_in_impulse);
  if (!impact.with_wall() && terms.equal_balls != Terms::EqualBalls::no) {
    const auto& [one, two] = impact.ball;
    const double alone = 1 + 1 / one.reduced_inertia;
    if (terms.equal_balls == Terms::EqualBalls::masses)
      formula.share = {0.5, 0.5};
    else if (terms.equal_balls == Terms::EqualBalls::exchanged_masses)
      formula.share = {impact.effective_mass / two.mass, impact.effective_mass / one.mass};
    else
      formula.compliance_in_e_t = alone;
    if (terms.equal_balls == Terms::EqualBalls::friction) formula.compliance_in_impulse = alone;
  }
  if (terms.share != 1)
    for (std::size_t b = 0; b < impact.count(); ++b)
      formula.share[b] = std::max(0.0, terms.share * impact.effective_mass / impact.ball[b].mass);
  return formula;
}

/// The wall's velocity becomes that of a code with other terms.
void assume_wall_velocity(const model::Mill<double>& mill, const Terms& terms, LoggedImpact& impact) {
  if (terms.wall_velocity_delay != 0 || terms.wall_velocity_formula != 0) {
    const double time = impact.event->time - terms.wall_velocity_delay;
    impact.set_wall_velocity(audit::wall_velocities[terms.wall_velocity_formula],
                             audit::vessel_at(mill, time, false), audit::vessel_at(mill, time, true));
  }
  impact.wall_velocity *= terms.wall_velocity;
}

}  // namespace

/// Writes the rows of events: what a log differs by from a case, if it is written so and with these terms.
struct LogResiduals::Writer {
  const LogResiduals& of;
  const model::Case<double>& model;
  const LogChange& change;
  const Terms& terms;
  bool with_tolerances;  ///< otherwise the differences alone
  std::vector<Row> rows = {};
  RowPlace at = {};
  bool is_changed = !(change == LogChange{});

  void add(RowKind kind, double off, double allow) {
    rows.push_back({off, allow > 0 && std::isfinite(allow) ? allow : 1.0, kind, at});
  }
  void add(RowKind kind, const Vec& off, double allow) {
    for (int k = 0; k < 3; ++k) add(kind, off[k], allow);
  }

  /// @param copy  holds the event where the log is written otherwise
  const LoggedEvent& event_at(std::size_t k, LoggedEvent& copy) const {
    if (!is_changed) return of.log_.events[k];
    copy = of.log_.events[k];
    change.apply(copy, model.mill);
    return copy;
  }

  void event_rows(std::size_t k) {
    LoggedEvent copy;
    const LoggedEvent& event = event_at(k, copy);
    const bool placed = of.log_.available.positions(event.with_wall);
    const auto frame =
        event.with_wall && placed ? audit::vessel_at(model.mill, event.time, false) : audit::VesselFrame{};
    auto impact = audit::impact_of(event, model, frame, placed);
    if (with_tolerances && placed) impact.bend = audit::bend_of(event, model, frame);
    impact.in_stall = of.in_stall_[k];
    if (event.with_wall && placed) assume_wall_velocity(model.mill, terms, impact);
    at = {k, -1, false};
    if (placed)
      add(RowKind::touch, audit::gap_of(event, model, frame) - terms.contact_gap,
          of.tolerances_.touch(event.time, event.with_wall));
    if (placed && of.log_.available.velocities_before(event.with_wall))
      impact_rows(impact);
    else
      speed_rows(impact);
    for (std::size_t body = 0; body < impact.count(); ++body) flight_rows(k, body, event);
  }

  void impact_rows(const LoggedImpact& impact) {
    const auto& has = of.log_.available;
    const LoggedEvent& event = *impact.event;
    const bool after = has.velocities_after(event.with_wall), spins = has.spins(event.with_wall);
    const double scale = with_tolerances ? audit::velocity_scale(impact, spins) : 0;
    const double by_wall = with_tolerances && event.with_wall
                               ? of.tolerances_.of_wall(event.time, scale, impact.bend, impact.ball[0].radius)
                               : 0;
    const double allowed = of.tolerances_.relative * scale + by_wall;
    LoggedImpact seen = impact;  // by the velocity of the contact point
    LoggedEvent seen_event;
    if (terms.arm != 1) {
      seen_event = event;
      for (auto& body : seen_event.body) body.spin_before *= terms.arm;
      seen.event = &seen_event;
    }
    const auto speeds = audit::speeds_before(seen);
    if (after && spins) {
      const auto expected = audit::outcome(seen, formula_of(terms, impact));
      for (std::size_t b = 0; b < impact.count(); ++b) {
        const auto &logged = event.body[b], &due = expected[b];
        at.body = static_cast<int>(b);
        const Vec spin_change = due.spin_after - seen.event->body[b].spin_before;
        add(RowKind::law, Vec(logged.velocity_after - due.velocity_after), allowed);
        add(RowKind::law, Vec((logged.spin_after - logged.spin_before - spin_change) * impact.ball[b].radius),
            allowed);
      }
      at.body = -1;
    } else if (after) {
      add(RowKind::law, impact.g_n_after() - impact.separation_speed(speeds.g_n), allowed);
      if (!event.with_wall) {
        Vec momentum(0, 0, 0);
        for (std::size_t b = 0; b < 2; ++b)
          momentum += (event.body[b].velocity_after - event.body[b].velocity_before) *
                      (impact.ball[b].mass / impact.effective_mass);
        add(RowKind::law, momentum, allowed);
      }
    }
    if (has.approach_speed)
      add(RowKind::speed, event.approach_speed + speeds.g_n * terms.approach_speed, allowed);
    if (has.slip_speed && spins)
      add(RowKind::speed, event.slip_speed - speeds.slip * terms.slip_speed, allowed);
    if (after && spins) energy_rows(impact, speeds, 4 * allowed * impact.effective_mass * scale);
  }

  void energy_rows(const LoggedImpact& impact, const audit::Speeds& speeds, double allowed) {
    const LoggedEvent& event = *impact.event;
    const double work = audit::work_of_wall(impact);
    if (of.log_.available.milling_dose) {
      const double supplied = audit::supplied(impact, speeds.g_n, impact.g_n_after());
      const double dose = work * terms.work_in_dose - audit::kinetic_change(impact, terms.spin_in_dose) +
                          supplied * terms.supply_in_dose;
      double off = event.milling_dose - dose * terms.dose;
      // A code whose impulse is wrong may have its dose from the law of the case.
      if (terms.change_impulse())
        if (const double other = event.milling_dose - terms.dose * audit::dose_by_law(impact, speeds);
            std::abs(other) < std::abs(off))
          off = other;
      add(RowKind::energy, off, allowed);
    }
    if (of.log_.available.wall_work && event.with_wall)
      add(RowKind::energy, event.wall_work - work * terms.wall_work, allowed);
  }

  /// Without states the dose follows from the logged speeds.
  void speed_rows(const LoggedImpact& impact) {
    const auto& has = of.log_.available;
    if (!has.approach_speed || !has.slip_speed || !has.milling_dose) return;
    const LoggedEvent& event = *impact.event;
    const auto true_of = [](double logged, double factor) { return factor == 0 ? logged : logged / factor; };
    const double approach = true_of(event.approach_speed, terms.approach_speed);
    const double slip = true_of(event.slip_speed, terms.slip_speed);
    const double speed = std::max({std::abs(approach), slip, impact.law->least_separation});
    add(RowKind::energy, event.milling_dose - terms.dose * audit::dose_by_law(impact, {-approach, slip}),
        4 * of.tolerances_.relative * impact.effective_mass * speed * speed);
  }

  void flight_rows(std::size_t k, std::size_t body, const LoggedEvent& event) {
    const auto& has = of.log_.available.body[body];
    const Before& begin = of.before_[k][body];
    if (!has.position || begin.event < 0) return;
    const auto& had = of.log_.available.body[begin.body];
    if (!had.position || !had.velocity_after) return;
    at = {k, static_cast<int>(body), true};
    LoggedEvent copy;
    const LoggedEvent& earlier = event_at(static_cast<std::size_t>(begin.event), copy);
    const auto &from = earlier.body[begin.body], &to = event.body[body];
    const double dt = event.time - earlier.time + terms.time_of_flight;
    const Vec g = model.mill.gravity * terms.gravity;
    const double path = audit::size(from.velocity_after) * dt, speed = audit::size(from.velocity_after);
    const Vec in_places = g * terms.gravity_in_places;
    add(RowKind::place,
        Vec(to.position - (from.position + (from.velocity_after + in_places * (dt / 2)) * dt)),
        of.tolerances_.position(event.time, path, speed));
    if (!has.velocity_before) return;
    const double allowed =
        of.tolerances_.velocity(event.time, std::max(speed, audit::size(to.velocity_before)));
    const Vec fallen = g * (terms.gravity_in_velocities * (dt - terms.age_of_velocities));
    add(RowKind::velocity, Vec(to.velocity_before - (from.velocity_after + fallen)), allowed);
    if (has.spin_before && had.spin_after) {
      const double radius = model.balls[event.ball_at(body)].radius;
      const double spin = radius * std::max(audit::size(to.spin_before), audit::size(from.spin_after));
      add(RowKind::velocity, Vec((to.spin_before - from.spin_after * terms.spin_in_flight) * radius),
          allowed + of.tolerances_.velocity(event.time, spin));
    }
  }
};

LogResiduals::LogResiduals(const audit::EventsAtHand& log, const audit::Tolerances& tolerances,
                           const model::Case<double>& nominal)
    : log_(log),
      tolerances_(tolerances),
      before_(log.events.size()),
      in_stall_(log.events.size()),
      branches_(log.events.size()),
      nominal_(nominal) {
  std::vector<Before> last(nominal.balls.size());
  audit::StallHistory stalls(nominal.mill, nominal.balls.size());
  for (std::size_t k = 0; k < log.events.size(); ++k) {
    const auto& event = log.events[k];
    if (!event.problem.empty()) {  // what follows has no known beginning
      std::fill(last.begin(), last.end(), Before{});
      for (std::size_t ball = 0; ball < last.size(); ++ball) stalls.forget(static_cast<int>(ball));
      continue;
    }
    for (std::size_t body = 0; body < event.count(); ++body) {
      auto& own = last[event.ball_at(body)];
      before_[k][body] = own;
      own = {static_cast<long>(k), body};
    }
    const auto& law = *audit::impact_of(event, nominal, {}, false).law;
    in_stall_[k] = stalls.take(event, law, tolerances.relative) == audit::Friction::rests;
    branches_[k] = branches_of(event);
  }
}

Branches LogResiduals::branches_of(const LoggedEvent& event) const {
  const auto& has = log_.available;
  if (!has.positions(event.with_wall) || !has.velocities_before(event.with_wall)) return {};
  const auto impact = audit::impact_of(
      event, nominal_,
      event.with_wall ? audit::vessel_at(nominal_.mill, event.time, false) : audit::VesselFrame{}, true);
  const auto speeds = audit::speeds_before(impact);
  const double separation = impact.separation_speed(speeds.g_n), bounce = separation - speeds.g_n;
  // Twice the impulse changes nothing where contacts stick.
  const auto e_t = [&](double impulse) {
    return impact.tangential_restitution(impact.compliance, impulse, speeds.slip);
  };
  return {true, has.spins(event.with_wall) && e_t(bounce) == e_t(2 * bounce),
          separation > impact.by_restitution(speeds.g_n)};
}

Residuals LogResiduals::on(const std::vector<std::size_t>& events) const {
  Residuals sample(*this);
  const LogChange as_it_is;
  const Terms right;
  Writer out{*this, nominal_, as_it_is, right, true};
  for (const std::size_t k : events) {
    if (!log_.events[k].problem.empty()) continue;
    out.event_rows(k);
    sample.chosen_.push_back(k);
  }
  sample.of_case_ = std::move(out.rows);
  return sample;
}

std::vector<double> Residuals::rows(const Assumptions& assumed) const {
  if (assumed.restricted.empty()) return of_whole(assumed);
  Assumptions whole = assumed;
  whole.restricted.clear();
  auto values = of_whole(whole);
  // Each set of parts that a row may be in has rows of its own.
  std::vector<std::size_t> set_of(count(), 0);
  for (std::size_t r = 0; r < assumed.restricted.size(); ++r)
    for (std::size_t k = 0; k < count(); ++k)
      if (assumed.restricted[r].part->holds(of_case_[k].at)) set_of[k] |= std::size_t{1} << r;
  for (const std::size_t set : std::set<std::size_t>(set_of.begin(), set_of.end())) {
    if (set == 0) continue;
    Assumptions here = whole;
    for (std::size_t r = 0; r < assumed.restricted.size(); ++r)
      if (set >> r & 1) assumed.restricted[r].make(here);
    const auto own = of_whole(here);
    for (std::size_t k = 0; k < count(); ++k)
      if (set_of[k] == set) values[k] = own[k];
  }
  return values;
}

std::vector<double> Residuals::of_whole(const Assumptions& assumed) const {
  const auto model = assumed.built();
  if (!model) return std::vector<double>(count(), out_of_range);
  const auto& nominal = log_->nominal_;
  EDMILL_REQUIRE(model->balls.size() == nominal.balls.size() &&
                     model->mill.vessel.wall_count() == nominal.mill.vessel.wall_count(),
                 "the bodies that the log is of");
  LogResiduals::Writer out{*log_, *model, assumed.log, assumed.terms, false};
  out.rows.reserve(count());
  for (const std::size_t k : chosen_) out.event_rows(k);
  std::vector<double> values(count());
  std::transform(
      out.rows.begin(), out.rows.end(), of_case_.begin(), values.begin(), [](const Row& r, const Row& due) {
        const double value = r.difference / due.allowed;
        return std::isfinite(value) ? std::clamp(value, -out_of_range, out_of_range) : out_of_range;
      });
  return values;
}

}  // namespace edmill::identify
