// Implementation of Run; included by the instantiation files only.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.hpp"
#include "base/standard_arithmetic.hpp"
#include "casefile/build_case.hpp"
#include "casefile/joints.hpp"
#include "edmill/run.hpp"
#include "io/final_state.hpp"
#include "io/summary_impl.hpp"
#include "output/write_results.hpp"
#include "run/simulate_impl.hpp"

namespace edmill {

namespace detail {

template <class Real>
Vector<Real> to_vector(const Vec3<Real>& v) {
  return {v[0], v[1], v[2]};
}

template <class Real>
Impact<Real> to_public(const engine::Impact<Real>& i, const Real& time) {
  const auto& o = i.outcome;
  return {i.index,
          time,
          i.ball,
          i.with_wall,
          i.partner,
          to_vector<Real>(i.normal),
          o.approach_speed,
          o.slip_speed,
          o.separation_speed,
          o.restitution_tangential,
          o.normal_impulse,
          o.tangential_impulse,
          o.milling_dose,
          o.supplied_energy,
          o.wall_work};
}

/// Numbers of turns are exact until the scalar is chosen.
template <class Real>
model::AnyMotion<Real> to_motion(const Joints<Real>& given, const Real& period) {
  using casefile::Quantity;
  const auto exactly = [](const TurnsPerPeriod& t) {
    if (t.of < 1)
      throw InputError("joint: found turns per " + std::to_string(t.of) + " periods, expected 1 or more");
    return Quantity{t.turns, t.of};
  };
  model::Joints<Quantity> phases{{}, Quantity{1}};
  model::Joints<Real> joints{{}, period};
  for (const auto& j : given) {
    model::Joint<Quantity> phase;
    phase.rotates = j.rotates, phase.speed = exactly(j.speed);
    model::Joint<Real> joint{j.rotates, j.axis, j.shift, j.angle, Real(0)};
    for (const auto& h : j.harmonics) {
      phase.swings.push_back({Quantity{1}, exactly(h.frequency), Quantity{0}});
      joint.swings.push_back({h.amplitude, Real(0), h.phase});
    }
    if (!j.rotates && j.speed.turns != 0)
      throw InputError("joint: found a translation with turns per period, expected harmonics");
    if ((j.rotates || !joint.swings.empty()) && j.axis == std::array<Real, 3>{})
      throw InputError("joint: found an axis of no length");
    phases.list.push_back(std::move(phase)), joints.list.push_back(std::move(joint));
  }
  phases = casefile::with_phases(std::move(phases));
  for (std::size_t k = 0; k < joints.list.size(); ++k) {
    joints.list[k].per_period = phases.list[k].per_period;
    for (std::size_t s = 0; s < joints.list[k].swings.size(); ++s)
      joints.list[k].swings[s].per_period = phases.list[k].swings[s].per_period;
  }
  return model::ChainMotion<Real>(joints);
}

/// What a case says of the walls of its own vessel.
/// @throws InputError when the program's vessel would have it
template <class Real>
void forget_walls(model::Mill<Real>& mill, const model::AnyVessel<Real>& own) {
  auto& of_walls = mill.pairs.of_walls;
  if (mill.vessel.pistons() ||
      std::any_of(of_walls.begin(), of_walls.end(), [](int law) { return law >= 0; }))
    throw InputError(
        "vessel of the program: found a case whose walls move or have materials, expected a case without");
  if (!mill.pairs.empty())
    of_walls.assign(mill.pairs.materials * static_cast<std::size_t>(own.wall_count()), -1);
  mill.vessel = own;
}

/// The case with the parts that the user gives.
template <class Real>
casefile::InitialCase<Real> build(const casefile::CaseSpec& spec, const OwnParts<Real>& own) {
  auto mill = casefile::build_mill<Real>(spec);
  if (own.laws.ball_ball) mill.ball_ball.law = model::LawOfProgram<Real>{own.laws.ball_ball};
  if (own.laws.ball_wall) mill.ball_wall.law = model::LawOfProgram<Real>{own.laws.ball_wall};
  if (!own.planes.empty()) {
    std::vector<typename model::PolyhedronVessel<Real>::Plane> planes;
    for (const auto& [n, distance] : own.planes) planes.push_back({{n[0], n[1], n[2]}, distance});
    forget_walls<Real>(mill, model::PolyhedronVessel<Real>(planes));
  } else if (own.vessel) {
    const auto& half = own.vessel->half_sizes;
    forget_walls<Real>(mill, model::AlgebraicVessel<Real>(own.vessel->walls, {half[0], half[1], half[2]}));
  }
  if (!own.joints.empty()) mill.motion = to_motion<Real>(own.joints, mill.motion.period());
  return casefile::build_case_in<Real>(mill, spec);
}

}  // namespace detail

template <class Real>
class Run<Real>::Implementation : public engine::Observer<Real> {
 public:
  Implementation(const Case& the_case, const OwnParts<Real>& own, Run& run)
      : run_(run),
        case_(the_case),
        built_(detail::build(*the_case.spec_, own)),
        guests_{{this}, nullptr},
        own_laws_(own.laws.ball_ball || own.laws.ball_wall),
        driver_(built_, guests_) {}

  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override {
    if (own_laws_) require_no_gain(impact);
    if (outputs_) outputs_->on_impact(impact, simulation);
    if (observers.empty()) return;
    const auto seen = detail::to_public<Real>(impact, simulation.seconds());
    for (auto* observer : observers) observer->on_impact(seen, run_);
  }

  /// @param limit  nothing for the end of the case
  bool advance(const std::optional<Real>& limit) {
    if (end_reason_ != model::EndReason::paused) return false;
    advanced_ = true;
    const auto& simulation = driver_.simulation();
    if (limit && !(*limit > time())) return true;
    if (limit) asked_ = {simulation.clock().at(*limit), *limit};
    end_reason_ = limit ? driver_.go(asked_.first) : driver_.go();
    return end_reason_ == model::EndReason::paused;
  }

  void write_to(const std::string& folder) {
    EDMILL_REQUIRE(!advanced_ && !outputs_, "write_to is called once, before the run advances");
    folder_.emplace(folder, *case_.spec_);
    try {
      outputs_.emplace(*case_.spec_, built_.the_case.mill.vessel, folder_->place(),
                       driver_.simulation().clock().seconds(built_.start));
    } catch (...) {
      folder_.reset();  // free for others
      throw;
    }
  }
  void commit(const std::function<void()>& when_written) {
    EDMILL_REQUIRE(outputs_, "write_to was called");
    const auto& simulation = driver_.simulation();
    outputs_->on_end(simulation);
    io::SavedState<Real> saved{simulation.now(), {}};
    for (int k = 0; k < simulation.ball_count(); ++k)
      saved.states.push_back(simulation.state_at(k, simulation.now()));
    output::write_results<Real>(*folder_, *outputs_, saved, simulation.clock(), summary().json, *case_.spec_,
                                false);
    when_written();
    outputs_.reset();
    folder_.reset();
  }

  /// As it was asked for, where the run stands there: the sum of periods and a rest is rounded.
  Real time() const {
    const auto& now = driver_.simulation().now();
    const auto& end = built_.the_case.stop.end_time;
    const auto& given = case_.spec_->end_time;
    if (end && now == *end) return given->template to<Real>();
    return now == asked_.first ? asked_.second : driver_.simulation().seconds();
  }
  void stop(model::EndReason why) { driver_.simulation().request_stop(why); }
  const engine::Simulation<Real>& simulation() const { return driver_.simulation(); }

  Summary<Real> summary() const {
    auto s = run::summary_of(*case_.spec_, built_, driver_);
    s.end_reason = end_reason_;
    s.end_time = time();
    s.warnings = run::warnings_of(run::measures_of(s));
    Summary<Real> out;
    out.start_time = s.start_time, out.end_time = s.end_time;
    for (int k = 0; k < s.partners.count(); ++k) out.partners.push_back(s.partners[k].key);
    out.collisions = s.collisions, out.dose_by_partner = s.dose_by_partner;
    out.milling_dose = s.milling_dose, out.wall_work = s.wall_work, out.supplied_energy = s.supplied_energy;
    out.energy_closure = s.energy_closure();
    out.simultaneous_contacts = s.simultaneous_contacts;
    out.cpu_seconds = s.cpu_seconds;
    out.end_reason = model::name(end_reason_);
    out.warnings.reserve(s.warnings.size());
    for (const auto& warning : s.warnings) out.warnings.push_back(warning.text);
    if (s.intervals.any()) out.milling_dose_rate_half_width = s.intervals.dose_rate.half_width;
    out.milling_time = s.milling_time();
    out.json = io::summary_json(s);
    return out;
  }

  std::vector<edmill::Observer<Real>*> observers;

 private:
  /// A law with e_t beyond -1 may give an impact more energy than it had.
  static void require_no_gain(const engine::Impact<Real>& impact) {
    const auto& o = impact.outcome;
    const Real rounding =
        (o.normal_impulse * o.approach_speed + o.tangential_impulse * o.slip_speed) / 1000000000;
    if (!(o.milling_dose >= -rounding))
      throw InputError("contact law of the program: impact " + std::to_string(impact.index) + " of ball " +
                       std::to_string(impact.ball) + " and " + (impact.with_wall ? "wall " : "ball ") +
                       std::to_string(impact.partner) + " gains " + to_text<Real>(-o.milling_dose) +
                       " J: e_t is " + to_text<Real>(o.restitution_tangential) + ", expected -1 to 1");
  }

  Run& run_;
  Case case_;
  casefile::InitialCase<Real> built_;
  run::Guests<Real> guests_;
  bool own_laws_;
  run::RunDriver<Real> driver_;
  std::optional<run::RunFolder> folder_;
  std::optional<output::Outputs<Real>> outputs_;
  bool advanced_ = false;
  std::pair<Instant<Real>, Real> asked_{Instant<Real>::long_ago(), Real(0)};  ///< of the last advance [s]
  model::EndReason end_reason_ = model::EndReason::paused;
};

template <class Real>
Run<Real>::Run(const Case& the_case, const Laws<Real>& laws, const Planes<Real>& vessel)
    : Run(the_case, OwnParts<Real>{vessel, {}, {}, laws}) {}
template <class Real>
Run<Real>::Run(const Case& the_case, const OwnParts<Real>& own)
    : implementation_([&] {
        const StandardArithmetic scope;
        return std::make_unique<Implementation>(the_case, own, *this);
      }()) {}
template <class Real>
Run<Real>::~Run() = default;

template <class Real>
void Run<Real>::attach(Observer<Real>& observer) {
  implementation_->observers.push_back(&observer);
}
template <class Real>
void Run<Real>::write_to(const std::string& folder) {
  const StandardArithmetic scope;
  implementation_->write_to(folder);
}
template <class Real>
void Run<Real>::commit() {
  const StandardArithmetic scope;
  implementation_->commit([] {});
}
template <class Real>
void Run<Real>::commit(const std::function<void()>& when_written) {
  const StandardArithmetic scope;
  implementation_->commit(when_written);
}
template <class Real>
bool Run<Real>::advance_to(const Real& time) {
  const StandardArithmetic scope;
  return implementation_->advance(time);
}
template <class Real>
void Run<Real>::finish() {
  const StandardArithmetic scope;
  implementation_->advance(std::nullopt);
}
template <class Real>
void Run<Real>::stop() {
  implementation_->stop(model::EndReason::stopped);
}
template <class Real>
void Run<Real>::interrupt() {
  implementation_->stop(model::EndReason::interrupted);
}
template <class Real>
Real Run<Real>::time() const {
  const StandardArithmetic scope;
  return implementation_->time();
}
template <class Real>
int Run<Real>::ball_count() const {
  return implementation_->simulation().ball_count();
}
template <class Real>
BallState<Real> Run<Real>::ball(int i) const {
  const StandardArithmetic scope;
  const auto& simulation = implementation_->simulation();
  EDMILL_REQUIRE(i >= 0 && i < simulation.ball_count(), "the number of a ball");
  const auto state = simulation.state_at(i, simulation.now());
  return {detail::to_vector<Real>(state.position), detail::to_vector<Real>(state.velocity),
          detail::to_vector<Real>(state.spin)};
}
template <class Real>
Summary<Real> Run<Real>::summary() const {
  const StandardArithmetic scope;
  return implementation_->summary();
}

}  // namespace edmill
