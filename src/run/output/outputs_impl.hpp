// Implementation of Outputs; included by the instantiation files only.
#pragma once

#include <fmt/format.h>

#include "base/version.hpp"
#include "output/outputs.hpp"
#include "output/registry.hpp"

namespace edmill::output {

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
Outputs<Real>::Outputs(const casefile::CaseSpec& spec, const model::AnyVessel<Real>& vessel,
                       const std::filesystem::path& folder, const Real& start)
    : previous_(start) {
  RunContext<Real> run{.folder = folder,
                       .start = start,
                       .partners = model::partners_of(vessel),
                       .powder_mass = {},
                       .vessel_colour = spec.vessel_colour,
                       .ball_colours = spec.ball_colours(),
                       .walls = vessel.surfaces(),
                       .notes = notes_of<Real>(spec)};
  walls_ = run.partners.walls();
  if (spec.powder_mass) run.powder_mass = spec.powder_mass->template to<Real>();
  for (const auto& output : spec.outputs) outputs_.push_back(make_output<Real>(output, run));
}

template <class Real>
Outputs<Real>::~Outputs() = default;

template <class Real>
void Outputs<Real>::on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) {
  const ImpactFacts<Real> facts{impact, simulation, previous_, walls_};
  for (auto& output : outputs_) output->on_impact(facts);
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
