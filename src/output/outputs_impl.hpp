// Implementation of Outputs; included by the instantiation files only.
#pragma once

#include <fmt/format.h>

#include "base/version.hpp"
#include "casefile/build_case.hpp"
#include "output/outputs.hpp"
#include "output/registry.hpp"

namespace edmill::output {

namespace detail {

template <class Real>
std::vector<io::FileNote> notes_of(const casefile::CaseSpec& spec) {
  std::vector<io::FileNote> notes{
      {"program", "edmill " + std::string(version()) + " (" + std::string(commit()) + ")"},
      {"compiler", std::string(compiler())},
      {"precision", scalar_name<Real>()},
      {"seed", std::to_string(spec.seed)},
      {"case_file", spec.file},
      {"case_digest", spec.digest},
      {"case", spec.text, true}};
  if (!spec.settings.empty())
    notes.push_back({"settings", fmt::format("{}", fmt::join(spec.settings, "\n")), true});
  return notes;
}

template <class Real>
model::ImpactFacts<Real> facts_of(const engine::Impact<Real>& impact,
                                  const engine::Simulation<Real>& simulation, const Real& previous,
                                  int walls) {
  model::ImpactFacts<Real> f;
  f.index = impact.index;
  f.time = simulation.clock().seconds(impact.time);
  f.time_previous = previous;
  f.ball = impact.ball, f.partner = impact.partner;
  f.ball_ball = !impact.with_wall;
  f.least_separation = impact.outcome.least_separation;
  f.balls = simulation.ball_count(), f.walls = walls;
  f.gravity = simulation.mill().gravity;
  f.normal = impact.normal;
  const auto fill = [&](model::ImpactBody<Real>& body, int place, int ball) {
    body = {&simulation.properties(ball), impact.velocity_before[place], simulation.flight(ball).velocity,
            impact.spin_before[place],    simulation.spin(ball),         impact.flight_time[place]};
  };
  fill(f.one, 0, impact.ball);
  if (f.ball_ball)
    fill(f.two, 1, impact.partner);
  else
    f.two.velocity_before = f.two.velocity_after = impact.wall_velocity;
  f.contact_point = simulation.flight(impact.ball).position - impact.normal * f.one.ball->radius;
  const auto& o = impact.outcome;
  f.milling_dose = o.milling_dose, f.wall_work = o.wall_work;
  f.normal_impulse = o.normal_impulse, f.tangential_impulse = o.tangential_impulse;
  f.restitution_normal = o.restitution_normal(), f.restitution_tangential = o.restitution_tangential;
  f.dose_normal = o.normal_dose, f.supplied_energy = o.supplied_energy;
  return f;
}

}  // namespace detail

template <class Real>
Outputs<Real>::Outputs(const casefile::CaseSpec& spec, const std::filesystem::path& folder, const Real& start)
    : previous_(start) {
  const auto vessel = casefile::build_mill<Real>(spec).vessel;
  RunContext<Real> run{start,
                       model::partners_of(vessel),
                       std::nullopt,
                       spec.vessel_colour,
                       spec.ball_colours(),
                       vessel.surfaces(),
                       detail::notes_of<Real>(spec)};
  walls_ = run.partners.walls();
  if (spec.powder_mass) run.powder_mass = spec.powder_mass->template to<Real>();
  for (const auto& output : spec.outputs) outputs_.push_back(make_output<Real>(output, folder, run));
}

template <class Real>
Outputs<Real>::~Outputs() = default;

template <class Real>
void Outputs<Real>::on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) {
  const auto facts = detail::facts_of<Real>(impact, simulation, previous_, walls_);
  const Seen<Real> seen{facts, impact, simulation};
  for (auto& output : outputs_) output->on_impact(seen);
  previous_ = facts.time;
}

template <class Real>
void Outputs<Real>::on_end(const engine::Simulation<Real>& simulation) {
  for (auto& output : outputs_) output->finish(simulation);
}

template <class Real>
void Outputs<Real>::archive(Archive& a) {
  a(previous_);
  for (auto& output : outputs_) a(*output);
}

template <class Real>
void Outputs<Real>::complete(bool goes_on) {
  for (auto& output : outputs_)
    if (!goes_on || !output->appends()) output->complete();
}

template <class Real>
std::vector<std::filesystem::path> Outputs<Real>::places() const {
  std::vector<std::filesystem::path> all;
  for (const auto& output : outputs_)
    for (auto& place : output->places()) all.push_back(std::move(place));
  return all;
}

template <class Real>
void Outputs<Real>::commit(bool goes_on) {
  for (auto& output : outputs_)
    if (!goes_on || !output->appends()) output->commit();
}

}  // namespace edmill::output
