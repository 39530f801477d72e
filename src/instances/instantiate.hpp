// Everything that is instantiated once for each scalar.
#pragma once

#include "edmill/core/scalar_list.hpp"
//
#include "edmill/app/run_case_impl.hpp"
#include "edmill/core/scalar_text.hpp"
#include "edmill/dynamics/decision_ladder_impl.hpp"
#include "edmill/dynamics/wall_search_impl.hpp"
#include "edmill/engine/simulation_impl.hpp"
#include "edmill/numerics/wide_trigonometry.hpp"
#include "edmill/record/final_state_impl.hpp"
#include "edmill/record/summary_impl.hpp"
#include "edmill/report/result_table_impl.hpp"
#include "edmill/setup/build_case_impl.hpp"

#define EDMILL_INSTANTIATE(Real)                                                                \
  namespace edmill {                                                                            \
  template std::string to_text<Real>(const Real&);                                              \
  template Real from_text<Real>(const std::string&);                                            \
  template class dynamics::WallSearch<Real>;                                                    \
  template class dynamics::DecisionLadder<Real>;                                                \
  template class engine::Simulation<Real>;                                                      \
  template Real casefile::Quantity::to<Real>() const;                                           \
  template model::Mill<Real> setup::build_mill<Real>(const casefile::CaseSpec&);                \
  template setup::InitialCase<Real> setup::build_case<Real>(const casefile::CaseSpec&);         \
  template void record::write_final_state<Real>(std::ostream&, const record::SavedState<Real>&, \
                                                const DriveClock<Real>&);                       \
  template record::SavedState<Real> record::read_final_state<Real>(const std::string&);         \
  template std::string record::summary_json<Real>(const record::Summary<Real>&);                \
  template std::string report::result_table<Real>(const record::Summary<Real>&);                \
  template int app::run_case<Real>(const casefile::CaseSpec&, const app::RunOptions&);          \
  }
