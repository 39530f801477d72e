// Runs of cases by the core alone, for machines without the libraries of the whole program.
#include <string>
#include <vector>

#include "app/run.hpp"
#include "base/errors.hpp"
#include "casefile/case_spec.hpp"
#include "cli/exit_codes.hpp"
#include "io/checkpoint_file.hpp"
#include "io/terminal.hpp"
#include "run/run_folder.hpp"

namespace {

using edmill::InputError;
using edmill::app::RunOptions;
using edmill::app::RunResult;
namespace cli = edmill::cli;

constexpr const char* usage =
    "usage: edmill-core [--checkpoint INTERVAL] CASE.toml FOLDER double|float128 [key=value ...]\n"
    "       edmill-core resume FOLDER\n";

using Words = std::vector<std::string>;

bool looks_right(const Words& words) {
  if (words.empty()) return false;
  if (words[0] == "resume") return words.size() == 2;
  const std::size_t first = words[0] == "--checkpoint" ? 2 : 0;
  if (words.size() < first + 3) return false;
  for (std::size_t k = first; k < words.size(); ++k)
    if (words[k].starts_with("--")) return false;
  return true;
}

void require_precision(const std::string& found) {
  if (found != "double" && found != "float128")
    throw InputError("found precision '" + found + "', expected double or float128");
}

RunResult resume(const Words& words, RunOptions options) {
  options.folder = words.at(1);
  require_precision(edmill::io::read_checkpoint(options.folder).precision);
  return edmill::app::resume("", options);
}

RunResult run(const Words& words, RunOptions options) {
  const bool saves = words[0] == "--checkpoint";
  const std::size_t first = saves ? 2 : 0;
  const std::string &precision = words[first + 2], interval = saves ? words[1] : "";
  const Words settings(words.begin() + static_cast<std::ptrdiff_t>(first) + 3, words.end());
  require_precision(precision);
  if (saves) edmill::run::parse_checkpoint_interval(interval);
  const auto spec = edmill::casefile::read_case(words[first], settings);
  options.folder = words[first + 1];
  if (saves) options.checkpoint = edmill::app::first_checkpoint(spec, precision, false, interval);
  return edmill::app::run(precision, spec, options);
}

int do_command(const Words& words) {
  if (!looks_right(words)) {
    edmill::io::tell_text(usage);
    return cli::bad_input;
  }
  RunOptions options;
  options.interrupt = &cli::interrupt_flag();
  options.begun = cli::listen_for_signals;
  options.without_locks = [](const auto& place) {
    edmill::io::tell("edmill: {}: this file system has no locks\n", place.string());
  };
  const auto result = words[0] == "resume" ? resume(words, options) : run(words, options);
  if (!result.error.empty()) edmill::io::tell("edmill: {}\n", result.error);
  edmill::io::print_text(result.table);
  return cli::plus_signal(cli::code_of(result.end_reason));
}

}  // namespace

int main(int argc, char** argv) {
  return cli::as_program([&] { return do_command({argv + 1, argv + argc}); });
}
