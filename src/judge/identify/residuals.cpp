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

/// Calls f(number, row, place) for each number of the rows of an event that an assumption may change.
/// @param change  how the log is written
template <class F>
void LogResiduals::each_number(std::size_t k, const model::Case<double>& model, const LogChange& change,
                               const audit::Equations& equations, F&& f) const {
  LoggedEvent copy, copy_of_earlier;
  const auto event_at = [&, is_changed = !(change == LogChange{})](std::size_t place,
                                                                   LoggedEvent& own) -> const LoggedEvent& {
    if (!is_changed) return log_.events[place];
    own = log_.events[place];
    change.apply(own, model.mill);
    return own;
  };
  const auto& terms = equations.terms();
  const LoggedEvent& event = event_at(k, copy);
  const bool placed = log_.available.positions(event.with_wall);
  const auto frame =
      event.with_wall && placed ? audit::vessel_at(model.mill, event.time, false) : audit::VesselFrame{};
  auto impact = audit::impact_of(event, model, frame, placed);
  impact.in_stall = in_stall_[k];
  impact.arm = terms.arm;
  if (event.with_wall && placed) assume_wall_velocity(model.mill, terms, impact);
  std::vector<audit::Row> rows;
  if (placed) {
    impact.bend = audit::bend_of(event, model, frame);
    rows.push_back(equations.of_touch(event, audit::gap_of(event, model, frame)));
  }
  equations.of_impact(impact, rows);
  for (std::size_t body = 0; body < impact.count(); ++body) {
    const Before& begin = before_[k][body];
    if (begin.event < 0) continue;
    const LoggedEvent& earlier = event_at(static_cast<std::size_t>(begin.event), copy_of_earlier);
    equations.of_flight({earlier.body[begin.body], event.body[body], log_.available.body[begin.body],
                         log_.available.body[body], earlier.time, event.time,
                         model.balls[event.ball_at(body)].radius, static_cast<int>(body)},
                        model.mill.gravity, rows);
  }
  for (const auto& row : rows) {
    if (row.equation == audit::Check::approach) continue;
    const bool of_flight = row.equation == audit::Check::flight || row.equation == audit::Check::spin_kept;
    for (int n = 0; n < row.count; ++n) f(row.difference[n], row, RowPlace{k, row.body, of_flight});
  }
}

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
  const audit::Equations equations(log_.available, tolerances_, {}, true);
  for (const std::size_t k : events) {
    if (!log_.events[k].problem.empty()) continue;
    each_number(k, nominal_, {}, equations, [&](double, const audit::Row& row, const RowPlace& at) {
      const bool known = row.allowed > 0 && std::isfinite(row.allowed);
      sample.of_case_.push_back({known ? row.allowed : 1.0, row.kind, at});
    });
    sample.chosen_.push_back(k);
  }
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
  const audit::Equations equations(log_->log_.available, log_->tolerances_, assumed.terms, true);
  std::vector<double> values;
  values.reserve(count());
  for (const std::size_t k : chosen_)
    log_->each_number(k, *model, assumed.log, equations, [&](double difference, const auto&, const auto&) {
      const double value = difference / of_case_[values.size()].allowed;
      values.push_back(std::isfinite(value) ? std::clamp(value, -out_of_range, out_of_range) : out_of_range);
    });
  return values;
}

}  // namespace edmill::identify
