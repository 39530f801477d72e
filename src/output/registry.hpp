// Every type of output. A new one is a file of its own and a row here.
#pragma once

#include <memory>
#include <tuple>

#include "base/errors.hpp"
#include "casefile/output_entry.hpp"
#include "output/animation_output.hpp"
#include "output/collisions_output.hpp"
#include "output/coverage_output.hpp"
#include "output/events_output.hpp"
#include "output/frequency_output.hpp"
#include "output/iterations_output.hpp"
#include "output/milling_dose_output.hpp"
#include "output/paraview_output.hpp"
#include "output/rates_above_output.hpp"
#include "output/snapshot_output.hpp"
#include "output/spectra_output.hpp"
#include "output/statistics_output.hpp"
#include "output/trace_output.hpp"
#include "output/trends_balls_output.hpp"
#include "output/trends_instant_output.hpp"
#include "output/trends_output.hpp"
#include "output/vessel_load_output.hpp"

namespace edmill::output {

/// How a type of output is read from a case, and, in any scalar, made.
template <template <class> class Type>
struct OutputRow : casefile::OutputType {
  template <class Real>
  std::unique_ptr<Output<Real>> make(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                                     const RunContext<Real>& run) const {
    return std::make_unique<Type<Real>>(spec, folder, run);
  }
};

inline constexpr std::tuple output_registry{
    OutputRow<CollisionsOutput>{{"collisions", ".csv", read_collisions}},
    OutputRow<MillingDoseOutput>{{"milling_dose", ".csv", read_milling_dose}},
    OutputRow<FrequencyOutput>{{"frequency", ".csv", read_frequency}},
    OutputRow<StatisticsOutput>{{"statistics", ".csv", read_statistics_output}},
    OutputRow<TrendsOutput>{{"trends", ".csv", read_trends}},
    OutputRow<TrendsInstantOutput>{{"trends_instant", ".csv", read_trends_instant}},
    OutputRow<TrendsBallsOutput>{{"trends_balls", ".csv", read_trends_balls}},
    OutputRow<TraceOutput>{{"trace", ".csv", read_trace}},
    OutputRow<IterationsOutput>{{"iterations", ".csv", read_iterations}},
    OutputRow<EventsOutput>{{"events", ".h5", read_events}},
    OutputRow<SpectraOutput>{{"spectra", ".csv", read_spectra}},
    OutputRow<RatesAboveOutput>{{"rates_above", ".csv", read_rates_above}},
    OutputRow<VesselLoadOutput>{{"vessel_load", ".csv", read_vessel_load}},
    OutputRow<CoverageOutput>{{"coverage", ".csv", read_coverage}},
    OutputRow<SnapshotOutput>{{"snapshot", ".x3d", read_snapshot}},
    OutputRow<AnimationOutput>{{"animation", ".x3d", read_animation}},
    OutputRow<ParaviewOutput>{{"paraview", ".pvd", read_paraview}}};

/// @throws ContractError when there is no such type
template <class Real>
std::unique_ptr<Output<Real>> make_output(const casefile::OutputSpec& spec,
                                          const std::filesystem::path& folder, const RunContext<Real>& run) {
  std::unique_ptr<Output<Real>> made;
  const auto try_row = [&](const auto& row) {
    if (row.name == spec.type) made = row.template make<Real>(spec, folder, run);
  };
  std::apply([&](const auto&... row) { (try_row(row), ...); }, output_registry);
  EDMILL_REQUIRE(made != nullptr, "the registry has the type of an output");
  return made;
}

}  // namespace edmill::output
