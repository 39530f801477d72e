#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "app/certify.hpp"
#include "app/run.hpp"
#include "base/errors.hpp"
#include "casefile/quantity.hpp"
#include "cli/commands/run.hpp"
#include "cli/exit_codes.hpp"
#include "cli/failures.hpp"
#include "cli/progress_line.hpp"
#include "io/terminal.hpp"
#include "run/run_folder.hpp"

namespace edmill::cli {

namespace {

app::RunOptions options_of(const RunCommand& command) {
  app::RunOptions options;
  options.folder = command.folder;
  options.report = command.report;
  options.interrupt = &interrupt_flag();
  options.begun = listen_for_signals;
  options.without_locks = [](const std::filesystem::path& place) {
    io::tell(
        "edmill: {}: this file system has no locks; nothing but you keeps another process out of the "
        "folder\n",
        place.string());
  };
  return options;
}

int tell(const app::RunResult& result, const RunCommand& command) {
  if (!command.quiet) {
    io::print("{}\nResults are in {}\n", result.table, command.folder);
    if (result.goes_on) io::print("Continue with: edmill resume {}\n", command.folder);
  }
  if (!result.error.empty()) io::tell("edmill: {}\n", result.error);
  if (!result.report.empty() && !command.quiet) io::print("The report is {}\n", result.report.string());
  return code_of(result.end_reason);
}

/// Does `work` with a progress line on a terminal.
int with_progress(app::RunOptions& options, const RunCommand& command, const auto& work) {
  std::optional<ProgressLine> line;
  if (shows_progress(command.quiet)) {
    line.emplace();
    options.progress = [&](const run::Progress& p) {
      line->show(p.now, p.end, p.collisions, p.milling_dose);
    };
  }
  const auto result = work();
  line.reset();
  return with_signal(tell(result, command));
}

/// Keeps a folder for a run whose digits are sought first: what refuses it is told before. Leaves none empty.
class ReservedFolder {
 public:
  ReservedFolder(const RunCommand& command, const casefile::CaseSpec& spec) {
    std::error_code error;
    for (auto place = std::filesystem::absolute(command.folder); !std::filesystem::exists(place, error);
         place = place.parent_path())
      made_.push_back(place);
    std::optional<io::Checkpoint> checkpoint;
    if (!command.checkpoint.empty()) checkpoint.emplace();
    folder_.emplace(command.folder, spec, checkpoint);
  }
  ~ReservedFolder() {
    folder_.reset();
    std::error_code error;
    for (const auto& place : made_) std::filesystem::remove(place, error);
  }
  ReservedFolder(const ReservedFolder&) = delete;
  ReservedFolder& operator=(const ReservedFolder&) = delete;

 private:
  std::vector<std::filesystem::path> made_;  ///< the innermost first
  std::optional<run::RunFolder> folder_;
};

/// For runs that write nothing. @return what `work` finds in the case
auto after_trials(const casefile::CaseSpec& spec, bool quiet, const auto& work) {
  app::DigitsOptions options;
  options.interrupt = &interrupt_flag();
  listen_for_signals();
  if (shows_progress(quiet))
    options.progress = [](const std::string& precision, std::size_t events, double expected) {
      io::tell("{}{}: {} of about {:.0f} events ", no_line, precision, events, expected);
    };
  auto found = casefile::with_memory_for(spec, [&] { return work(options); });
  if (shows_progress(quiet)) io::tell("{}", no_line);
  return found;
}

/// Prints what the run will take. @param precision  empty where the case asks for digits
/// @return an exit code
int run_estimate(const casefile::CaseSpec& spec, const std::string& precision, bool quiet) {
  const auto estimate = after_trials(
      spec, quiet, [&](const auto& options) { return app::estimate_run(spec, precision, options); });
  if (estimate.interrupted) return after_signals(interrupted);
  io::print("{}", estimate.text());
  return after_signals(precision.empty() && !estimate.undecided.empty() ? undecided : ok);
}

/// Finds the precision of a case that asks for digits, and prints the evidence.
/// @return an exit code; `undecided` when no number of digits suffices
int choose_digits(casefile::CaseSpec& spec, bool quiet, std::string& precision) {
  const auto found =
      after_trials(spec, quiet, [&](const auto& options) { return app::find_digits(spec, options); });
  if (found.interrupted) {
    io::tell("edmill: interrupted before the digits were found; nothing is written\n");
    return after_signals(interrupted);
  }
  if (!found.undecided.empty()) return tell_undecided(found.undecided);
  if (!quiet) io::print("{}", found.text());
  precision = found.precision;
  spec.right_digits = found.right();
  return ok;
}

}  // namespace

void until_precision(const std::string& precision, const casefile::CaseSpec& spec,
                     std::vector<std::string>& settings) {
  std::string_view number = precision;
  const bool percent = number.ends_with('%');
  if (percent) number.remove_suffix(1);
  while (number.ends_with(' ')) number.remove_suffix(1);
  const auto value = casefile::parse_decimal(number);
  const double part = value ? value->to<double>() / (percent ? 100 : 1) : 0;
  if (!(part > 0 && part < 1))
    throw InputError("--until-precision: found \"" + precision +
                     "\", expected a part of the dose rate above 0 and below 1: \"1%\" or 0.01");
  settings.push_back(fmt::format("run.dose_rate_precision={}", part));
  const bool limited =
      std::ranges::any_of(settings, [](const auto& s) { return s.starts_with("run.end_time="); });
  if (!limited && spec.end_time)
    settings.push_back(fmt::format("run.end_time=\"{} s\"", 100 * spec.end_time->to<double>()));
}

int run_case(casefile::CaseSpec spec, const RunCommand& given) {
  auto command = given;
  if (command.folder.empty()) command.folder = "out/" + name_of(spec.file);
  const bool by_digits = spec.digits && command.precision.empty();
  auto scalar = command.precision.empty() ? spec.precision : command.precision;
  if (command.estimate) return run_estimate(spec, by_digits ? "" : scalar, command.quiet);
  if (by_digits && !command.shadow.empty())
    throw InputError(
        "--shadow: found digits that are asked for, expected a run in one precision: they are "
        "verified by a wider run anyway");
  if (!command.shadow.empty()) app::require_wider(scalar, command.shadow, "option '--shadow'");
  auto options = options_of(command);
  if (!command.checkpoint.empty()) run::parse_checkpoint_interval(command.checkpoint);
  if (by_digits) {
    const ReservedFolder folder(command, spec);
    if (const int code = choose_digits(spec, command.quiet, scalar); code != ok) return code;
  }
  if (!command.checkpoint.empty()) {
    options.checkpoint =
        app::first_checkpoint(spec, command.overrides, scalar, command.report, command.checkpoint);
  }
  int code = with_progress(options, command, [&] { return app::run(scalar, spec, options); });
  if (code == ok && !command.shadow.empty()) {
    const auto result = app::shadow(spec, scalar, command.shadow, options.interrupt);
    io::print("{}", result.text());
    code = with_signal(result.interrupted ? interrupted : ok);
  }
  return code;
}

int run_resume(const RunCommand& command) {
  if (!command.checkpoint.empty()) run::parse_checkpoint_interval(command.checkpoint);
  auto options = options_of(command);
  return with_progress(options, command, [&] { return app::resume(command.checkpoint, options); });
}

}  // namespace edmill::cli
