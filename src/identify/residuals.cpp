#include "identify/residuals.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/instant.hpp"

namespace edmill::identify {

using audit::LoggedEvent;
using audit::LoggedImpact;
using audit::Vec;

namespace {

constexpr double out_of_range = 1e15;

int ball_of(const LoggedEvent& event, std::size_t body) { return body == 0 ? event.ball : event.partner; }

audit::VesselFrame frame_at(const model::Mill<double>& mill, double time) {
  const auto when = DriveClock<double>(mill.motion.period()).at(time);
  auto frame = audit::frame_of(mill.motion, mill.motion.pose(when), false);
  frame.moved = audit::moved_walls(mill.vessel, when);
  return frame;
}

LoggedImpact impact_of(const LoggedEvent& event, const model::Case<double>& model,
                       const audit::VesselFrame& frame, bool with_positions) {
  LoggedImpact impact;
  impact.with_wall = event.with_wall;
  impact.ball[0] = model.balls[static_cast<std::size_t>(event.ball)];
  impact.normal = {1, 0, 0};
  const Vec& place = event.body[0].position;
  if (event.with_wall) {
    impact.wall = event.partner;
    if (with_positions) {
      const double radius = impact.ball[0].radius;
      impact.normal = audit::wall_normal(frame, model.mill.vessel, event.partner, radius, place);
      impact.bend = audit::wall_bend(frame, model.mill.vessel, event.partner, radius, place);
      const Vec point = place - impact.normal * impact.ball[0].radius;
      impact.wall_velocity = audit::wall_velocity(audit::WallVelocity::nested, frame, frame, point, place) +
                             audit::piston_velocity(frame, event.partner, impact.normal);
    }
  } else {
    impact.ball[1] = model.balls[static_cast<std::size_t>(event.partner)];
    const Vec apart = place - event.body[1].position;
    const double distance = audit::size(apart);
    if (with_positions && distance > 0) impact.normal = apart * (1 / distance);
  }
  impact.set_masses();
  return impact;
}

const model::ContactLaw<double>& law_of(const model::Mill<double>& mill, const LoggedImpact& impact) {
  return impact.with_wall ? mill.law_with_wall(impact.ball[0], impact.wall)
                          : mill.law_between(impact.ball[0], impact.ball[1]);
}

}  // namespace

/// Takes rows; when `allowed` is given they are divided by it, otherwise what they are allowed is noted.
struct LogResiduals::Writer {
  std::vector<double>* values = nullptr;
  const std::vector<double>* allowed = nullptr;
  std::vector<double>* note = nullptr;
  std::vector<RowKind>* kinds = nullptr;

  void add(RowKind kind, double off, double allow) {
    if (note) {
      note->push_back(allow > 0 && std::isfinite(allow) ? allow : 1.0);
      kinds->push_back(kind);
      return;
    }
    const double row = off / (*allowed)[values->size()];
    values->push_back(std::isfinite(row) ? std::clamp(row, -out_of_range, out_of_range) : out_of_range);
  }
  void add(RowKind kind, const Vec& off, double allow) {
    for (int k = 0; k < 3; ++k) add(kind, off[k], allow);
  }
};

LogResiduals::LogResiduals(const audit::EventsAtHand& log, const audit::Tolerances& tolerances,
                           const model::Case<double>& nominal)
    : log_(log),
      tolerances_(tolerances),
      before_(log.events.size()),
      in_stall_(log.events.size()),
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
    for (std::size_t body = 0; body < (event.with_wall ? 1u : 2u); ++body) {
      auto& own = last[static_cast<std::size_t>(ball_of(event, body))];
      before_[k][body] = own;
      own = {static_cast<long>(k), body};
    }
    const auto friction =
        stalls.take(event, law_of(nominal.mill, impact_of(event, nominal, {}, false)), tolerances.relative);
    in_stall_[k] = friction == audit::Friction::rests;
  }
}

Residuals LogResiduals::on(const std::vector<std::size_t>& events) const {
  Residuals sample(*this);
  Writer note{nullptr, nullptr, &sample.allowed_, &sample.kinds_};
  for (const std::size_t k : events) {
    if (!log_.events[k].problem.empty()) continue;
    event_rows(k, nominal_, {}, note);
    sample.row_events_.resize(sample.kinds_.size(), k);
    sample.chosen_.push_back(k);
  }
  return sample;
}

std::vector<double> Residuals::rows(const Assumptions& assumed) const {
  const auto model = assumed.built();
  if (!model) return std::vector<double>(count(), out_of_range);
  const auto& nominal = log_->nominal_;
  EDMILL_REQUIRE(model->balls.size() == nominal.balls.size() &&
                     model->mill.vessel.wall_count() == nominal.mill.vessel.wall_count(),
                 "the bodies that the log is of");
  std::vector<double> values;
  values.reserve(count());
  LogResiduals::Writer out{&values, &allowed_, nullptr, nullptr};
  for (const std::size_t k : chosen_) log_->event_rows(k, *model, assumed.log, out);
  return values;
}

void LogResiduals::event_rows(std::size_t k, const model::Case<double>& model, const LogChange& change,
                              Writer& out) const {
  LoggedEvent event = log_.events[k];
  change.apply(event);
  const bool placed = log_.available.positions(event.with_wall);
  const auto frame = event.with_wall && placed ? frame_at(model.mill, event.time) : audit::VesselFrame{};
  auto impact = impact_of(event, model, frame, placed);
  impact.in_stall = in_stall_[k];
  if (placed) {
    double gap;
    if (event.with_wall)
      gap = audit::wall_gap(frame, model.mill.vessel, event.partner, impact.ball[0].radius,
                            event.body[0].position);
    else
      gap = audit::size(Vec(event.body[0].position - event.body[1].position)) - impact.ball[0].radius -
            impact.ball[1].radius;
    out.add(RowKind::touch, gap, tolerances_.touch(event.time, event.with_wall));
  }
  const auto& law = law_of(model.mill, impact);
  if (placed && log_.available.velocities_before(event.with_wall))
    impact_rows(event, impact, law, out);
  else
    speed_rows(event, impact, law, out);
  for (std::size_t body = 0; body < impact.count(); ++body) flight_rows(k, body, event, model, change, out);
}

void LogResiduals::impact_rows(const LoggedEvent& event, const LoggedImpact& impact,
                               const model::ContactLaw<double>& law, Writer& out) const {
  const auto& has = log_.available;
  const bool after = has.velocities_after(event.with_wall), spins = has.spins(event.with_wall);
  const double scale = audit::velocity_scale(impact, event, spins);
  const double by_wall =
      event.with_wall ? tolerances_.of_wall(event.time, scale, impact.bend, impact.ball[0].radius) : 0;
  const double allowed = tolerances_.relative * scale + by_wall;
  const auto speeds = audit::speeds_before(event, impact);
  if (after && spins) {
    const auto expected = audit::outcome(impact, law, event, {});
    for (std::size_t b = 0; b < impact.count(); ++b) {
      out.add(RowKind::law, Vec(event.body[b].velocity_after - expected[b].velocity_after), allowed);
      out.add(RowKind::law, Vec((event.body[b].spin_after - expected[b].spin_after) * impact.ball[b].radius),
              allowed);
    }
  } else if (after) {
    out.add(RowKind::law,
            audit::dot(impact.after(event), impact.normal) - audit::separation_speed(law, impact, speeds.g_n),
            allowed);
    if (!event.with_wall) {
      Vec momentum(0, 0, 0);
      for (std::size_t b = 0; b < 2; ++b)
        momentum += (event.body[b].velocity_after - event.body[b].velocity_before) *
                    (impact.ball[b].mass / impact.effective_mass);
      out.add(RowKind::law, momentum, allowed);
    }
  }
  if (has.approach_speed) out.add(RowKind::speed, event.approach_speed + speeds.g_n, allowed);
  if (has.slip_speed && spins) out.add(RowKind::speed, event.slip_speed - speeds.slip, allowed);
  if (!after || !spins) return;
  const double energy = 4 * allowed * impact.effective_mass * scale;
  const double work = audit::work_of_wall(event, impact);
  if (has.milling_dose)
    out.add(RowKind::energy,
            event.milling_dose -
                (work - audit::kinetic_change(event, impact) +
                 audit::supplied(impact, speeds.g_n, audit::dot(impact.after(event), impact.normal))),
            energy);
  if (has.wall_work && event.with_wall) out.add(RowKind::energy, event.wall_work - work, energy);
}

/// Without states the dose follows from the logged speeds.
void LogResiduals::speed_rows(const LoggedEvent& event, const LoggedImpact& impact,
                              const model::ContactLaw<double>& law, Writer& out) const {
  const auto& has = log_.available;
  if (!has.approach_speed || !has.slip_speed || !has.milling_dose) return;
  const double speed = std::max({std::abs(event.approach_speed), event.slip_speed, law.least_separation});
  out.add(RowKind::energy,
          event.milling_dose - audit::dose_by_law(impact, law, {-event.approach_speed, event.slip_speed}),
          4 * tolerances_.relative * impact.effective_mass * speed * speed);
}

void LogResiduals::flight_rows(std::size_t k, std::size_t body, const LoggedEvent& event,
                               const model::Case<double>& model, const LogChange& change, Writer& out) const {
  const auto& has = log_.available.body[body];
  const Before& begin = before_[k][body];
  if (!has.position || begin.event < 0) return;
  const auto& had = log_.available.body[begin.body];
  if (!had.position || !had.velocity_after) return;
  LoggedEvent earlier = log_.events[static_cast<std::size_t>(begin.event)];
  change.apply(earlier);
  const auto &from = earlier.body[begin.body], &to = event.body[body];
  const double dt = event.time - earlier.time;
  const Vec& g = model.mill.gravity;
  const double path = audit::size(from.velocity_after) * dt, speed = audit::size(from.velocity_after);
  out.add(RowKind::place, Vec(to.position - (from.position + (from.velocity_after + g * (dt / 2)) * dt)),
          tolerances_.position(event.time, path, speed));
  if (has.velocity_before)
    out.add(RowKind::velocity, Vec(to.velocity_before - (from.velocity_after + g * dt)),
            tolerances_.velocity(event.time, std::max(speed, audit::size(to.velocity_before))));
}

}  // namespace edmill::identify
