// The core in every scalar: what is compiled once, declared. Heavy; include it where scalars are chosen.
#pragma once

#include "base/scalar_list.hpp"
//
#include "base/scalar_text.hpp"
#include "base/wide_trigonometry.hpp"
#include "casefile/build_case.hpp"
#include "dynamics/any_wall_search.hpp"
#include "dynamics/decision_ladder.hpp"
#include "edmill/run.hpp"
#include "engine/simulation.hpp"
#include "io/final_state.hpp"
#include "io/summary.hpp"
#include "output/outputs.hpp"
#include "run/event_source.hpp"
#include "run/simulate.hpp"

/// `prefix` is `extern template` to declare and `template` to define.
#define EDMILL_INSTANCES(prefix, Real)                                                               \
  namespace edmill {                                                                                 \
  prefix std::string to_text<Real>(const Real&);                                                     \
  prefix Real from_text<Real>(const std::string&);                                                   \
  prefix class dynamics::DecisionLadder<Real>;                                                       \
  prefix class engine::Simulation<Real>;                                                             \
  prefix Real casefile::Quantity::to<Real>() const;                                                  \
  prefix model::AnyVessel<Real> casefile::build_vessel<Real>(const casefile::VesselSpec&);           \
  prefix model::Mill<Real> casefile::build_mill<Real>(const casefile::CaseSpec&);                    \
  prefix casefile::InitialCase<Real> casefile::build_case<Real>(const casefile::CaseSpec&, bool);    \
  prefix casefile::InitialCase<Real> casefile::build_case_in<Real>(const model::Mill<Real>&,         \
                                                                   const casefile::CaseSpec&, bool); \
  prefix void io::write_final_state<Real>(std::ostream&, const io::SavedState<Real>&,                \
                                          const DriveClock<Real>&);                                  \
  prefix io::SavedState<Real> io::read_final_state<Real>(const std::string&);                        \
  prefix std::string io::summary_json<Real>(const io::Summary<Real>&);                               \
  prefix std::string io::stall_message<Real>(const io::Summary<Real>&);                              \
  prefix run::Result<Real> run::simulate<Real>(const casefile::CaseSpec&,                            \
                                               const casefile::InitialCase<Real>&,                   \
                                               const run::Guests<Real>&);                            \
  prefix std::unique_ptr<run::EventSource> run::make_source<Real>(const casefile::CaseSpec&, bool,   \
                                                                  const std::atomic<bool>*);         \
  prefix class output::Outputs<Real>;                                                                \
  prefix class Run<Real>;                                                                            \
  }

#define EDMILL_GENERAL_SEARCH(prefix, Real)                                          \
  namespace edmill {                                                                 \
  prefix class dynamics::WallSearch<model::AnyMotion<Real>, model::AnyVessel<Real>>; \
  }

#define EDMILL_DECLARE_INSTANCES(Real)         \
  EDMILL_GENERAL_SEARCH(extern template, Real) \
  EDMILL_INSTANCES(extern template, Real)
EDMILL_FOR_EACH_SCALAR(EDMILL_DECLARE_INSTANCES)
#undef EDMILL_DECLARE_INSTANCES

// In double the searches for any mill and for a cylinder on a chain stand in a file of their own: beside
// them, that of the SPEX would be inlined less.
extern template class edmill::dynamics::WallSearch<edmill::model::SpexMotion<double>,
                                                   edmill::model::CylinderVessel<double>>;
extern template class edmill::dynamics::WallSearch<edmill::model::ChainMotion<double>,
                                                   edmill::model::CylinderVessel<double>>;
