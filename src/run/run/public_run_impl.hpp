// The public Run, and what runs a case, compiled once for each scalar; included by the instantiation files
// only.
#pragma once

#include <vector>

#include "base/wide_trigonometry.hpp"
#include "edmill/run.hpp"
#include "run/event_source_impl.hpp"
#include "run/run_of.hpp"

namespace edmill {

template <class Real>
class Run<Real>::Implementation {
 public:
  Implementation(const Case& the_case, const OwnParts<Real>& own) : run(the_case.spec_, own) { run.begin(); }

  run::RunOf<Real> run;
  std::vector<Observer<Real>*> observers;
};

template <class Real>
Run<Real>::Run(const Case& the_case, const Laws<Real>& laws, const Planes<Real>& vessel)
    : Run(the_case, OwnParts<Real>{vessel, {}, {}, laws}) {}
template <class Real>
Run<Real>::Run(const Case& the_case, const OwnParts<Real>& own)
    : implementation_([&] {
        const StandardArithmetic scope;
        return std::make_unique<Implementation>(the_case, own);
      }()) {}
template <class Real>
Run<Real>::~Run() = default;

template <class Real>
void Run<Real>::attach(Observer<Real>& observer) {
  auto& observers = implementation_->observers;
  const auto call_all = [this, &observers](const Impact<Real>& impact) {
    for (auto* each : observers) each->on_impact(impact, *this);
  };
  if (observers.empty()) implementation_->run.attach(call_all);
  observers.push_back(&observer);
}
template <class Real>
void Run<Real>::write_to(const std::string& folder) {
  implementation_->run.write_to(folder, std::nullopt, {});
}
template <class Real>
void Run<Real>::commit() {
  implementation_->run.commit([] { return std::string(); });
}
template <class Real>
bool Run<Real>::advance_to(const Real& time) {
  return implementation_->run.advance(time);
}
template <class Real>
void Run<Real>::finish() {
  implementation_->run.finish();
}
template <class Real>
void Run<Real>::stop() {
  implementation_->run.stop(model::EndReason::stopped);
}
template <class Real>
void Run<Real>::interrupt() {
  implementation_->run.stop(model::EndReason::interrupted);
}
template <class Real>
Real Run<Real>::time() const {
  const auto scope = implementation_->run.use();
  return implementation_->run.now();
}
template <class Real>
int Run<Real>::ball_count() const {
  return implementation_->run.ball_count();
}
template <class Real>
BallState<Real> Run<Real>::ball(int i) const {
  const auto scope = implementation_->run.use();
  return run::to_public<Real>(implementation_->run.state_of(i), [](const Real& x) { return x; });
}
template <class Real>
Summary<Real> Run<Real>::summary() const {
  const auto scope = implementation_->run.use();
  const auto s = implementation_->run.result();
  Summary<Real> out;
  out.start_time = s.start_time;
  out.end_time = s.end_time;
  for (int k = 0; k < s.partners.count(); ++k) out.partners.push_back(s.partners[k].key);
  out.collisions = s.collisions;
  out.dose_by_partner = s.dose_by_partner;
  out.milling_dose = s.milling_dose;
  out.wall_work = s.wall_work;
  out.supplied_energy = s.supplied_energy;
  out.energy_closure = s.energy_closure;
  out.simultaneous_contacts = s.simultaneous_contacts;
  out.cpu_seconds = s.cpu_seconds;
  out.end_reason = model::name(s.end_reason);
  out.warnings.reserve(s.warnings.size());
  for (const auto& warning : s.warnings) out.warnings.push_back(warning.text);
  if (s.intervals.any()) out.milling_dose_rate_half_width = s.intervals.dose_rate.half_width;
  out.milling_time = s.milling_time();
  out.json = io::summary_json(s);
  return out;
}

}  // namespace edmill

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
