// Implementation of build_case; included by the instantiation files only.
#pragma once

#include <fmt/format.h>

#include <string>

#include "base/errors.hpp"
#include "base/wide_trigonometry.hpp"
#include "casefile/build_case.hpp"
#include "casefile/filling.hpp"
#include "casefile/quantity_value.hpp"
#include "io/final_state.hpp"

namespace edmill::casefile {

namespace detail {

template <class Real>
model::ContactLaw<Real> to_law(const casefile::ContactSpec& spec) {
  return model::convert_law<Real>(spec, [](const casefile::Quantity& q) { return q.to<Real>(); });
}

template <class Real, template <class> class Part>
Part<Real> to_part(const Part<casefile::Quantity>& part) {
  return model::converted<Part, Real>(part, [](const casefile::Quantity& q) { return q.to<Real>(); });
}

template <class Real>
model::AnyMotion<Real> to_motion(const auto& part, const casefile::CaseSpec& spec) {
  if constexpr (requires { part.joints(); }) {
    const auto to = [](const casefile::Quantity& q) { return q.to<Real>(); };
    auto joints = model::converted_joints<Real>(with_phases(part.joints()), to);
    // Events are predicted some time beyond the end.
    if (spec.end_time) joints.times = {to(spec.initial_time), to(*spec.end_time) + joints.period};
    return model::ChainMotion<Real>(joints);
  } else {
    return to_part<Real>(part).motion();
  }
}

template <class Real>
model::Pistons<Real> to_pistons(const casefile::CaseSpec& spec) {
  const auto to = [](const casefile::Quantity& q) { return q.to<Real>(); };
  const auto& period = period_of(spec.mill);
  std::vector<model::Piston<Real>> pistons;
  for (const auto& p : spec.pistons)
    pistons.push_back({p.wall, to(p.distance), to(p.speed),
                       model::converted_swings<Real>(with_phases(p.swings, period), to)});
  return {std::move(pistons), to(period)};
}

/// The laws of pairs, with a table of which applies where.
template <class Real>
model::PairLaws<Real> to_pairs(const casefile::CaseSpec& spec, int walls) {
  model::PairLaws<Real> pairs;
  if (spec.pairs.empty()) return pairs;
  pairs.materials = spec.materials.size() + 1;
  const auto law_of = [&](int one, int other) {
    for (std::size_t k = 0; k < spec.pairs.size(); ++k)
      if (spec.pairs[k].is_of(one, other)) return static_cast<int>(k);
    return -1;
  };
  for (int one = 0; one < static_cast<int>(pairs.materials); ++one) {
    for (int other = 0; other < static_cast<int>(pairs.materials); ++other)
      pairs.of_balls.push_back(law_of(one, other));
    for (std::size_t wall = 0; wall < static_cast<std::size_t>(walls); ++wall)
      pairs.of_walls.push_back(law_of(one, spec.wall_materials.at(wall)));
  }
  for (const auto& pair : spec.pairs) pairs.laws.push_back(to_law<Real>(pair.law));
  return pairs;
}

/// Diameters as the case says, states from a final_state.csv.
template <class Real>
void fill_from_file(const casefile::CaseSpec& spec, InitialCase<Real>& result) {
  const auto saved = io::read_final_state<Real>(spec.initial_state);
  if (saved.states.size() != spec.ball_count())
    throw InputError(spec.initial_state + ": found " + std::to_string(saved.states.size()) +
                     " balls, expected the case's " + std::to_string(spec.ball_count()));
  const DriveClock<Real> clock(result.the_case.mill.motion.period());
  if (saved.time.offset >= clock.period())
    throw InputError(spec.initial_state +
                     ":2: found a drive_offset of a whole drive period or more, expected " +
                     "one below the case's period of " + to_text<Real>(clock.period()) + " s");
  if (spec.end_time && saved.time >= *result.the_case.stop.end_time)
    throw InputError(spec.initial_state + ":2: found a state at " + to_text<Real>(clock.seconds(saved.time)) +
                     " s, expected one before the case's end_time");
  result.start = saved.time;
  Filling<Real> filling(spec, result);
  std::size_t k = 0;
  for (const auto& b : spec.balls)
    filling.add_checked(to_ball<Real>(b, b.diameter.template to<Real>()), saved.states[k++], b.where);
  for (const auto& b : spec.batches) {
    if (b.diameter_spread.positive())
      throw InputError(b.where +
                       ": found diameter_spread with an initial state, expected balls of one diameter");
    for (int n = 0; n < b.count; ++n)
      filling.add_checked(to_ball<Real>(b, b.diameter.template to<Real>()), saved.states[k++], b.where);
  }
  if (!filling.problems().empty()) throw InputError(filling.problems());
}

/// Refuses what the scalar cannot resolve: balls about as small as the rounding of a position, and a least
/// separation speed whose hops are lower than that.
template <class Real>
void require_resolution(const casefile::CaseSpec& spec, const InitialCase<Real>& built) {
  using std::sqrt;
  const auto& mill = built.the_case.mill;
  const Real reach = mill.motion.reach(mill.vessel.reach()), gravity = norm<Real>(mill.gravity);
  Real fastest = 2 * mill.motion.speed_within(reach) + 4 * sqrt(gravity * reach);
  for (const auto& state : built.states) fastest = std::max(fastest, norm<Real>(state.velocity));
  const Real rounding = epsilon<Real>() / 2 * (24 * reach + 16 * fastest * mill.motion.period());
  const Real least_radius = 8000000 * rounding;  // so that a missed impact is told from rounding
  const auto number = [](const Real& x) { return fmt::format("{:.3g}", static_cast<double>(x)); };
  std::vector<std::string> problems;
  const auto check = [&](const casefile::BallSpec& ball, const Real& diameter) {
    if (diameter / 2 < least_radius)
      problems.push_back(ball.where + ": found a ball of radius " + number(diameter / 2) +
                         " m, expected at least " + number(least_radius) + " m: in this mill " +
                         scalar_name<Real>() + " knows a position to " + number(rounding) +
                         " m; a wider precision knows it better");
  };
  for (const auto& ball : spec.balls) check(ball, ball.diameter.template to<Real>());
  for (const auto& ball : spec.batches)
    check(ball, ball.diameter.template to<Real>() - ball.diameter_spread.template to<Real>());
  const Real least_hop = 4 * sqrt(rounding * (mill.motion.acceleration_within(reach) + gravity));
  const auto check_least = [&](const Real& speed, const std::string& section) {
    if (speed > 0 && speed < least_hop)
      problems.push_back(spec.file + ": key '" + section + ".least_separation': found " + number(speed) +
                         " m/s, expected 0 or at least " + number(least_hop) +
                         " m/s: hops of a slower ball are lost in the rounding of " + scalar_name<Real>());
  };
  check_least(mill.ball_ball.least_separation, "contact.ball_ball");
  check_least(mill.ball_wall.least_separation, "contact.ball_wall");
  for (std::size_t k = 0; k < mill.pairs.laws.size(); ++k)
    check_least(mill.pairs.laws[k].least_separation, "contact.pair." + std::to_string(k));
  if (!problems.empty()) throw InputError(problems);
}

}  // namespace detail

template <class Real>
model::AnyVessel<Real> build_vessel(const VesselSpec& spec) {
  return std::visit([](const auto& v) { return model::AnyVessel<Real>(detail::to_part<Real>(v).vessel()); },
                    spec);
}

template <class Real>
model::Mill<Real> build_mill(const casefile::CaseSpec& spec) {
  auto vessel = build_vessel<Real>(spec.vessel);
  if (!spec.pistons.empty()) vessel.set(detail::to_pistons<Real>(spec));
  const int walls = vessel.wall_count();
  return {std::visit([&](const auto& m) { return detail::to_motion<Real>(m, spec); }, spec.mill),
          std::move(vessel),
          detail::to_vector<Real>(spec.gravity),
          detail::to_law<Real>(spec.ball_ball),
          detail::to_law<Real>(spec.ball_wall),
          detail::to_pairs<Real>(spec, walls)};
}

template <class Real>
InitialCase<Real> build_case(const casefile::CaseSpec& spec, bool resolved) {
  return build_case_in(build_mill<Real>(spec), spec, resolved);
}

template <class Real>
InitialCase<Real> build_case_in(const model::Mill<Real>& mill, const casefile::CaseSpec& spec,
                                bool resolved) {
  InitialCase<Real> result;
  auto& c = result.the_case;
  c.mill = mill;
  const auto instant = [&](const casefile::Quantity& time) {
    return casefile::instant_at<Real>(time, casefile::period_of(spec.mill));
  };
  c.initial_time = instant(spec.initial_time);
  c.statistics_start = instant(spec.statistics_start);
  if (spec.target.dose)
    c.counted_dose = {spec.target.counted.normal_only, spec.target.counted.least.template to<Real>()};
  if (spec.end_time) c.stop.end_time = instant(*spec.end_time);
  for (std::size_t place = 0; place < model::stop_rule_count; ++place)
    if (const auto& limit = spec.stop_limits[place]) c.stop.limits[place] = limit->template to<Real>();
  result.start = c.initial_time;
  if (!spec.initial_state.empty()) {
    detail::fill_from_file(spec, result);
    if (resolved) detail::require_resolution(spec, result);
    return result;
  }
  detail::Filling<Real> filling(spec, result);
  for (const auto& ball : spec.balls) filling.add_explicit(ball);
  filling.add_batches();
  if (!filling.problems().empty()) throw InputError(filling.problems());
  if (resolved) detail::require_resolution(spec, result);
  return result;
}

}  // namespace edmill::casefile
