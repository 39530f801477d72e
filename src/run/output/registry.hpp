// The registry of output types, and the outputs of a case. A new type is a file and a row here.
#pragma once

#include <fmt/format.h>

#include <memory>
#include <tuple>

#include "base/errors.hpp"
#include "base/version.hpp"
#include "output/coverage_output.hpp"
#include "output/events_output.hpp"
#include "output/lyapunov_output.hpp"
#include "output/outputs.hpp"
#include "output/pictures_output.hpp"
#include "output/spectra_output.hpp"
#include "output/statistics_output.hpp"
#include "output/trends_output.hpp"

namespace edmill::output {

/// An entry of the registry: how a type of output is read from a case, and its class in any scalar.
template <template <class> class Type> struct OutputRow : casefile::OutputType {};

/// @tparam Keys  keys that only this type has
template <template <class> class Type, class Keys = casefile::NoKeys>
constexpr OutputRow<Type> row(
    std::string_view name, std::string_view what, std::string_view extension = ".csv") {
  return {{name, extension, what, casefile::output_keys<Keys>}};
}

inline constexpr std::tuple output_registry{row<CollisionsOutput, CollisionsKeys>("collisions",
                                                "the log of files.md, a row for each impact"),
    row<MillingDoseOutput, MillingDoseKeys>(
        "milling_dose", "one row: dose, rates and specific doses of the record"),
    row<FrequencyOutput, FrequencyKeys>(
        "frequency", "how often a number falls in each of equal intervals, lower <= value < upper"),
    row<StatisticsOutput, StatisticsKeys>("statistics",
        "statistics of flags and numbers, for each wall, all walls, other balls, all impacts"),
    row<TrendsOutput, TrendsKeys>("trends",
        "statistics of each interval of time, with a last, shorter one if the record ends within "
        "it"),
    row<TrendsInstantOutput, TrendsInstantKeys>("trends_instant",
        "values of variables at each impact, or at the first after each interval"),
    row<TrendsBallsOutput, TrendsBallsKeys>(
        "trends_balls", "statistics over the balls at the end of each interval"),
    row<TraceOutput, TraceKeys>(
        "trace", "position of one ball at each of its impacts, or at the end of each interval"),
    row<IterationsOutput>("iterations", "all variables of each impact"),
    row<EventsOutput, OwnKeys<StatesKey>>("events",
        "the log as HDF5: `/events` with one dataset per column, and the final state of the balls; "
        "64-bit numbers in every scalar",
        ".h5"),
    row<SpectraOutput, SpectraKeys>("spectra",
        "impact energies, normal, tangential and total, or impact speeds, in logarithmic bins"),
    row<RatesAboveOutput, RatesAboveKeys>(
        "rates_above", "collision rates and dose rates of the impacts above speed cutoffs"),
    row<VesselLoadOutput, VesselLoadKeys>("vessel_load",
        "impulse, force and torque on the vessel, and the power draw, of each interval"),
    row<BodiesOutput>("bodies", "dose of each ball and of each wall"),
    row<TreatmentOutput, OwnKeys<TreatmentKeys>>(
        "treatment", "how often powder has been hit, if it is mixed and if it stays in place"),
    row<LyapunovOutput, LyapunovKeys>("lyapunov",
        "Lyapunov exponents: how fast neighbouring motions diverge from that of the run"),
    row<CoverageOutput, OwnKeys<CoverageKeys>>(
        "coverage", "dose and impacts by position on the vessel's walls"),
    row<SnapshotOutput, SnapshotKeys>(
        "snapshot", "an X3D page for each impact, `NAME_<index>.x3d`", ".x3d"),
    row<AnimationOutput, AnimationKeys>("animation", "an X3D page that plays the record", ".x3d"),
    row<ParaviewOutput, ParaviewKeys>("paraview",
        "`NAME.pvd` and a folder `NAME` with balls and vessel of each frame as VTP", ".pvd")};

/// @throws ContractError when there is no such type
template <class Real>
std::unique_ptr<Output<Real>> make_output(const OutputSpec& spec, const RunContext<Real>& run) {
  std::unique_ptr<Output<Real>> made;
  const auto try_row = [&]<template <class> class Type>(const OutputRow<Type>& row) {
    if (row.name == spec.type) made = std::make_unique<Type<Real>>(spec, run);
  };
  std::apply([&](const auto&... row) { (try_row(row), ...); }, output_registry);
  EDMILL_REQUIRE(made != nullptr, "the registry has the type of an output");
  return made;
}

template <class Real> std::vector<io::FileNote> notes_of(const CaseSpec& spec) {
  std::vector<io::FileNote> notes{{"program", fmt::format("edmill {} ({})", version(), commit())},
      {"compiler", std::string(compiler())}, {"precision", scalar_name<Real>()},
      {"seed", std::to_string(spec.seed)}, {"case_file", spec.file}, {"case_digest", spec.digest},
      {"case", spec.text, true}};
  if (!spec.settings.empty())
    notes.push_back({"settings", fmt::format("{}", fmt::join(spec.settings, "\n")), true});
  return notes;
}

template <class Real>
Outputs<Real>::Outputs(const CaseSpec& spec, const model::Mill<Real>& mill,
    const std::filesystem::path& folder, const Real& start)
    : previous_(start) {
  RunContext<Real> run{.folder = folder,
      .start = start,
      .partners = model::partners_of(mill),
      .vessel_colour = spec.vessel_colour,
      .ball_colours = spec.ball_colours(),
      .walls = mill.vessel.surfaces(),
      .bodies = mill.bodies,
      .notes = notes_of<Real>(spec)};
  walls_ = run.partners.walls();
  for (const auto& body : spec.bodies) run.body_colours.push_back(body.colour);
  if (spec.powder_mass) run.powder_mass = spec.powder_mass->template to<Real>();
  for (const auto& output : spec.outputs) outputs_.push_back(make_output<Real>(output, run));
}

template <class Real> Outputs<Real>::~Outputs() = default;

template <class Real>
void Outputs<Real>::on_impact(const engine::Impact<Real>& impact, Simulation<Real>& simulation) {
  const ImpactFacts<Real> facts{impact, simulation, previous_, walls_};
  for (auto& output : outputs_) output->on_impact(facts);
  previous_ = facts.time;
}

template <class Real> void Outputs<Real>::on_end(const Simulation<Real>& simulation) {
  for (auto& output : outputs_) output->finish(simulation);
}

template <class Real> void Outputs<Real>::archive(Archive& a) {
  a(previous_);
  for (auto& output : outputs_) a(*output);
}

template <class Real> std::vector<io::WholeFile*> Outputs<Real>::complete(bool goes_on) {
  std::vector<io::WholeFile*> files;
  for (auto& output : outputs_)
    if (!goes_on || !output->appends())
      for (auto* file : output->complete()) files.push_back(file);
  return files;
}

}  // namespace edmill::output
