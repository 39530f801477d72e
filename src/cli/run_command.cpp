#include "cli/run_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "app/certify.hpp"
#include "app/run.hpp"
#include "base/errors.hpp"
#include "casefile/quantity.hpp"
#include "cli/exit_codes.hpp"
#include "cli/precision_commands.hpp"
#include "cli/progress_line.hpp"
#include "cli/signals.hpp"
#include "io/input_file.hpp"
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
template <class Work>
int with_progress(app::RunOptions& options, const RunCommand& command, const Work& work) {
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

/// Keeps a folder for a run whose digits are sought first: what would refuse it is told before. Leaves no
/// empty folders.
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

}  // namespace

std::string name_of(const std::string& case_file) {
  return io::is_stream(case_file) ? "stdin" : std::filesystem::path(case_file).stem().string();
}

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
  if (code == ok && !command.shadow.empty())
    code = with_signal(run_shadow(spec, scalar, command.shadow, options.interrupt));
  return code;
}

int run_resume(const RunCommand& command) {
  if (!command.checkpoint.empty()) run::parse_checkpoint_interval(command.checkpoint);
  auto options = options_of(command);
  return with_progress(options, command, [&] { return app::resume(command.checkpoint, options); });
}

}  // namespace edmill::cli
