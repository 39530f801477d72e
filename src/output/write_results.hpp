// What a run leaves in its folder, written and put in place: by the command line and by programs alike.
#pragma once

#include <string>

#include "io/final_state.hpp"
#include "io/summary.hpp"
#include "output/outputs.hpp"
#include "run/run_folder.hpp"

namespace edmill::output {

/// Nothing is put in place before everything is written. The summary comes last: results that it tells of are
/// there.
/// @param case_text  for case.toml
/// @param goes_on    the run can be resumed
template <class Real>
void write_results(run::RunFolder& folder, Outputs<Real>& outputs, const io::SavedState<Real>& saved,
                   const DriveClock<Real>& clock, const std::string& summary_json,
                   const std::string& case_text, bool goes_on) {
  outputs.complete(goes_on);
  folder.write("final_state.csv", [&](std::ostream& out) { io::write_final_state<Real>(out, saved, clock); });
  folder.write("case.toml", [&](std::ostream& out) { out << case_text; });
  folder.write("summary.json", [&](std::ostream& out) { out << summary_json; });
  folder.commit(outputs.places(), [&] { outputs.commit(goes_on); });
}

}  // namespace edmill::output
