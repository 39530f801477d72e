// The core in every scalar: what is compiled once, declared. Heavy; include it where scalars are chosen.
#pragma once

#include "edmill/core/scalar_list.hpp"
//
#include "edmill/app/run_case.hpp"
#include "edmill/certify/event_source.hpp"
#include "edmill/driver/simulate.hpp"
#include "edmill/dynamics/decision_ladder.hpp"
#include "edmill/dynamics/wall_search.hpp"
#include "edmill/engine/simulation.hpp"
#include "edmill/numerics/wide_trigonometry.hpp"
#include "edmill/outputs/output.hpp"
#include "edmill/record/final_state.hpp"
#include "edmill/record/summary.hpp"
#include "edmill/report/result_table.hpp"
#include "edmill/setup/build_case.hpp"

/// `prefix` is `extern template` to declare and `template` to define.
#define EDMILL_INSTANCES(prefix, Real)                                                                      \
  namespace edmill {                                                                                        \
  prefix std::string to_text<Real>(const Real&);                                                            \
  prefix Real from_text<Real>(const std::string&);                                                          \
  prefix class dynamics::WallSearch<Real>;                                                                  \
  prefix class dynamics::DecisionLadder<Real>;                                                              \
  prefix class engine::Simulation<Real>;                                                                    \
  prefix Real casefile::Quantity::to<Real>() const;                                                         \
  prefix model::Mill<Real> setup::build_mill<Real>(const casefile::CaseSpec&);                              \
  prefix setup::InitialCase<Real> setup::build_case<Real>(const casefile::CaseSpec&, bool);                 \
  prefix void record::write_final_state<Real>(std::ostream&, const record::SavedState<Real>&,               \
                                              const DriveClock<Real>&);                                     \
  prefix record::SavedState<Real> record::read_final_state<Real>(const std::string&);                       \
  prefix std::string record::summary_json<Real>(const record::Summary<Real>&);                              \
  prefix std::string report::result_table<Real>(const record::Summary<Real>&);                              \
  prefix driver::Result<Real> driver::simulate<Real>(const casefile::CaseSpec&,                             \
                                                     const setup::InitialCase<Real>&,                       \
                                                     const driver::Guests<Real>&);                          \
  prefix std::unique_ptr<certify::EventSource> certify::make_source<Real>(const casefile::CaseSpec&, bool); \
  prefix int app::run_case<Real>(const casefile::CaseSpec&, const app::RunOptions&);                        \
  }

/// Outputs are compiled apart: they change more often than the core.
#define EDMILL_OUTPUT_INSTANCES(prefix, Real) \
  namespace edmill {                          \
  prefix class outputs::Outputs<Real>;        \
  }

#define EDMILL_DECLARE_INSTANCES(Real)    \
  EDMILL_INSTANCES(extern template, Real) \
  EDMILL_OUTPUT_INSTANCES(extern template, Real)
EDMILL_FOR_EACH_SCALAR(EDMILL_DECLARE_INSTANCES)
#undef EDMILL_DECLARE_INSTANCES
