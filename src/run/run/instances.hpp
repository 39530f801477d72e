// What runs a case, compiled once for each scalar; included by the instantiation files only.
#pragma once

#include "base/wide_trigonometry.hpp"
#include "run/event_source_impl.hpp"
#include "run/public_run_impl.hpp"

#define EDMILL_RUN(Real)                                                                                \
  namespace edmill {                                                                                    \
  template run::Result<Real> run::simulate<Real>(const casefile::CaseSpec&,                             \
                                                 const casefile::InitialCase<Real>&,                    \
                                                 const run::Guests<Real>&);                             \
  template std::unique_ptr<run::EventSource> run::make_source_in<Real>(const casefile::CaseSpec&, bool, \
                                                                       const std::atomic<bool>*);       \
  template std::unique_ptr<run::AnyRun> run::make_run_in<Real>(const casefile::CaseSpec&,               \
                                                               const run::RunSetup&);                   \
  template class Run<Real>;                                                                             \
  }
