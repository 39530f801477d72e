#include "cli/run_folder_guard.hpp"

#include "base/errors.hpp"
#include "casefile/quantity.hpp"

namespace edmill::cli {

namespace fs = std::filesystem;

RunFolderGuard::RunFolderGuard(const casefile::CaseSpec& spec, const RunOptions& options)
    : place_(options.folder), spec_(spec), checkpoint_(options.checkpoint) {
  io::prepare_folder(place_);
  lock_.emplace(place_, checkpoint_.has_value());
  const bool begins = !checkpoint_ || checkpoint_->state.empty();
  if (const auto found = io::checkpoint_place(place_); begins && fs::exists(found))
    throw InputError(found.string() +
                     ": found the checkpoint of an unfinished run, expected none: continue with " +
                     "`edmill resume " + place_.string() + "`, or remove it");
  if (!checkpoint_) return;
  if (begins) checkpoint_->temporary_mark = io::temporary_mark();
  remove_temporaries(checkpoint_->temporary_mark);
}

RunFolderGuard::~RunFolderGuard() {
  std::error_code error;
  if (checkpoint_ && !fs::exists(io::checkpoint_place(place_), error) && !error) remove_temporaries("");
}

void RunFolderGuard::remove_temporaries(const std::string& kept) {
  for (const auto* name : {"summary.json", "final_state.csv", "case.toml", "report.html"})
    io::remove_temporaries(place_ / name, kept);
  io::remove_temporaries(io::checkpoint_place(place_), kept);
  for (const auto& output : spec_.outputs) io::remove_temporaries(place_ / output.folder / output.file, kept);
}

run::Checkpoints RunFolderGuard::checkpoints() {
  if (!checkpoint_) return {};
  const auto save = [this](const std::string& state) {
    checkpoint_->state = state;
    io::write_checkpoint(place_, *checkpoint_);
  };
  return {parse_checkpoint_interval(checkpoint_->interval), save, checkpoint_->state};
}

void RunFolderGuard::remove_checkpoint() {
  if (!checkpoint_) return;
  // First: without the checkpoint, files left by killed processes of this run are no longer found.
  remove_temporaries("");
  fs::remove(io::checkpoint_place(place_));
}

run::CheckpointInterval parse_checkpoint_interval(const std::string& text) {
  const std::string mark = " simulated";
  const bool simulated = text.ends_with(mark);
  const auto parsed = casefile::parse_quantity(text.substr(0, text.size() - (simulated ? mark.size() : 0)),
                                               casefile::Dimension::time);
  const auto* time = std::get_if<casefile::Quantity>(&parsed);
  if (!time || !time->positive())
    throw InputError("--checkpoint: found " +
                     (time ? "\"" + text + "\"" : std::get<casefile::QuantityProblem>(parsed).found) +
                     ", expected a time above 0 by the clock, such as '10 min', or in the run, such as '2 s "
                     "simulated'");
  return {time->to<double>(), simulated};
}

}  // namespace edmill::cli
