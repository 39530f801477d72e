#include "audit/equations.hpp"

#include <variant>

namespace edmill::audit {

void Equations::of_touch(const LoggedEvent& event, double gap, Rows& rows) const {
  rows.scalar(Check::touch, gap - terms_.contact_gap,
      tolerances_.touch(event.time, event.with_wall), gap, 0);
}

ImpactTolerance Equations::of_impact(const LoggedImpact& impact, Rows& rows) const {
  const LoggedEvent& event = *impact.event;
  const bool with_wall = impact.with_wall();
  if (!has_.positions(with_wall) || !has_.velocities_before(with_wall)) {
    of_logged_speeds(impact, rows);
    return {};
  }
  const bool after = has_.velocities_after(with_wall), spins = has_.spins(with_wall);
  const double scale = velocity_scale(impact, spins);
  const double by_wall =
      with_wall ? tolerances_.of_wall(event.time, scale, impact.bend, impact.ball[0].radius) : 0;
  const double allowed = tolerances_.relative * scale + by_wall;
  const double energy = 4 * allowed * impact.effective_mass * scale;
  const Speeds speeds = speeds_before(impact);
  rows.scalar(Check::approach, std::max(0.0, speeds.g_n), allowed, -speeds.g_n, 0);
  if (after) of_states(impact, speeds, allowed, rows);
  if (has_.approach_speed)
    rows.scalar(Check::approach_speed, event.approach_speed + speeds.g_n * terms_.approach_speed,
        allowed, event.approach_speed, -speeds.g_n);
  if (has_.slip_speed && spins)
    rows.scalar(Check::slip_speed, event.slip_speed - speeds.slip * terms_.slip_speed, allowed,
        event.slip_speed, speeds.slip);
  if (after && spins) of_energies(impact, speeds, energy, rows);
  return {energy, by_wall == 0 || by_wall < scale};
}

/// Residuals of the states after an impact: of each body, or as in (2.23'), (2.28'), (2.35) and
/// (2.24'), where the logged impulse limits the friction.
void Equations::of_states(
    const LoggedImpact& impact, Speeds speeds, double allowed, Rows& rows) const {
  const auto& logged = impact.event->body;
  const bool spins = has_.spins(impact.with_wall()), summed = !by_body_ || !spins;
  const auto due = outcome(impact, terms_, summed);
  // A large friction coefficient amplifies the uncertainty of the normal velocity.
  const auto* coulomb = std::get_if<model::WaltonBraun<double>>(&impact.law->law);
  allowed *= 1 + (coulomb ? std::min(coulomb->friction, 10.0) : 0) * impact.compliance;
  Vec relative(0, 0, 0), slip(0, 0, 0), momentum(0, 0, 0);
  std::array<Vec, 2> torque;
  for (std::size_t k = 0; k < impact.count(); ++k) {
    const auto& ball = impact.ball[k];
    const double side = k == 0 ? 1 : -1;
    const Vec arm = impact.normal * (-side * ball.radius);
    const Vec velocity = logged[k].velocity_after - due.body[k].velocity_after;
    const Vec spin = logged[k].spin_after - due.body[k].spin_after;
    relative += velocity * side;
    slip += Vec(velocity + edmill::cross<double>(spin, arm)) * side;
    momentum += velocity * (ball.mass / impact.effective_mass);
    torque[k] = spin * (ball.reduced_inertia * ball.radius) -
        edmill::cross<double>(arm, velocity) * (1 / ball.radius);
    if (summed) continue;
    rows.vector(Check::momentum, k, velocity, allowed);
    rows.vector(Check::spin_change, k, spin * ball.radius, allowed);
  }
  if (!summed) return;
  const double g_n = speeds.g_n, g_n_after = impact.g_n_after();
  double normal = impact.along(relative);
  // If bodies separate before the impact, which is reported, reflecting g_n is accepted too.
  if (const double other = g_n_after - impact.by_restitution(g_n);
      g_n > allowed && std::abs(other) < std::abs(normal))
    normal = other;
  rows.scalar(Check::normal_law, normal, allowed, g_n != 0 ? -g_n_after / g_n : unknown,
      g_n != 0 ? -impact.separation_speed(g_n) / g_n : unknown);
  if (!impact.with_wall()) rows.vector(Check::momentum, -1, momentum, allowed);
  if (!spins) return;
  for (std::size_t k = 0; k < impact.count(); ++k)
    rows.vector(Check::spin_change, k, torque[k], allowed);
  Row& tangential = rows.vector(Check::tangential_law, -1, impact.across(slip), allowed);
  const Vec before = impact.across(impact.before());
  tangential.found = speeds.slip > 0 ? dot(before, impact.after()) / dot(before, before) : unknown;
  tangential.expected = due.restitution_tangential;
}

/// Dose = wall work + what the least separation supplies - what balls gain. (2.36'), (A.82)
void Equations::of_energies(
    const LoggedImpact& impact, Speeds speeds, double allowed, Rows& rows) const {
  const LoggedEvent& event = *impact.event;
  const double work = work_of_wall(impact);
  if (has_.milling_dose) {
    const double balance = work * terms_.work_in_dose - kinetic_change(impact, terms_.spin_in_dose);
    const double expected =
        balance + terms_.supply_in_dose * supplied(impact, speeds.g_n, impact.g_n_after());
    double off = event.milling_dose - terms_.dose * expected;
    const auto or_else = [&](double dose) {
      if (const double other = event.milling_dose - terms_.dose * dose;
          std::abs(other) < std::abs(off))
        off = other;
    };
    // A code with a wrong impulse may compute its dose from the law, or supply no energy: the law
    // is violated, not the dose. In a fit, of smooth rows, only if a term changes the impulse.
    if (!by_body_ || terms_.change_impulse()) or_else(dose_by_law(impact, speeds));
    const bool supplies = supplied(impact, speeds.g_n, impact.separation_speed(speeds.g_n)) > 0;
    if (!by_body_ && !supplies) or_else(balance);
    rows.scalar(Check::milling_dose, off, allowed, event.milling_dose, expected);
  }
  if (has_.wall_work)
    rows.scalar(Check::wall_work, event.wall_work - work * terms_.wall_work, allowed,
        event.wall_work, work);
}

void Equations::of_logged_speeds(const LoggedImpact& impact, Rows& rows) const {
  const LoggedEvent& event = *impact.event;
  if (has_.approach_speed) {
    const auto true_of = [](double logged, double factor) {
      return factor == 0 ? logged : logged / factor;
    };
    const double approach = true_of(event.approach_speed, terms_.approach_speed);
    const double slip = has_.slip_speed ? true_of(event.slip_speed, terms_.slip_speed) : 0;
    const double scale = std::max(std::abs(approach), slip);
    rows.scalar(Check::approach, std::max(0.0, -approach),
        tolerances_.relative * std::max(scale, 1.0), approach, 0);
    if (has_.slip_speed && has_.milling_dose) {
      const double expected = terms_.dose * dose_by_law(impact, {-approach, slip});
      const double speed = std::max(scale, impact.law->least_separation);
      rows.scalar(Check::milling_dose, event.milling_dose - expected,
          4 * tolerances_.relative * impact.effective_mass * speed * speed, event.milling_dose,
          expected);
    }
  }
  if (has_.wall_work && !event.with_wall)
    rows.scalar(Check::wall_work, event.wall_work, 0, event.wall_work, 0);
}

void Equations::of_flight(const LoggedFlight& flight, const Vec& gravity, Rows& rows) const {
  const auto& [from, to, had, has, begin, time, radius, body] = flight;
  if (had.position && had.velocity_after && has.position) {
    const double dt = time - begin + terms_.time_of_flight;
    const double speed = std::max(size(from.velocity_after), size(to.velocity_before));
    const Vec g = gravity * terms_.gravity;
    const double fastest = speed + size(g) * std::abs(dt);
    const Vec path = (from.velocity_after + g * (terms_.gravity_in_places * (dt / 2))) * dt;
    rows.vector(Check::flight, body, to.position - (from.position + path),
            tolerances_.position(time, speed * dt, fastest))
        .kind = RowKind::place;
    const Vec fallen = g * (terms_.gravity_in_velocities * (dt - terms_.age_of_velocities));
    if (has.velocity_before)
      rows.vector(Check::flight, body, to.velocity_before - (from.velocity_after + fallen),
          tolerances_.velocity(time, fastest));
  }
  if (has.spin_before && had.spin_after) {
    const double scale = std::max({size(from.velocity_after), size(to.velocity_before),
        radius * size(from.spin_after), radius * size(to.spin_before)});
    rows.vector(Check::spin_kept, body,
        (to.spin_before - from.spin_after * terms_.spin_in_flight) * radius,
        tolerances_.relative * scale);
  }
}

}  // namespace edmill::audit
