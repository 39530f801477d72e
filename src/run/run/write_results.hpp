// What a run leaves in its folder, written and put in place: by the command line and by programs alike.
#pragma once

#include <string>

#include "casefile/case_spec.hpp"
#include "io/final_state.hpp"
#include "io/summary.hpp"
#include "output/outputs.hpp"
#include "run/run_folder.hpp"

namespace edmill::run {

/// Nothing is put in place before everything is written. The summary comes last: results that it tells of are
/// there.
/// @param goes_on  the run can be resumed
template <class Real>
void write_results(RunFolder& folder, output::Outputs<Real>& outputs, const io::SavedState<Real>& saved,
                   const DriveClock<Real>& clock, const std::string& summary_json,
                   const casefile::CaseSpec& spec, bool goes_on) {
  outputs.complete(goes_on);
  folder.write("final_state.csv", [&](std::ostream& out) { io::write_final_state<Real>(out, saved, clock); });
  folder.write("case.toml", [&](std::ostream& out) { out << casefile::text_with_settings(spec); });
  folder.write("summary.json", [&](std::ostream& out) { out << summary_json; });
  folder.commit(outputs.places(), [&] { outputs.commit(goes_on); });
}

}  // namespace edmill::run
