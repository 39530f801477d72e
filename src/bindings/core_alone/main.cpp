// Runs of cases by the core alone, for machines that have none of the libraries of the whole program.
#include <atomic>
#include <csignal>
#include <cstring>
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

std::atomic<bool> interrupted{false};
volatile std::sig_atomic_t last_signal = 0;

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

int with_signal(int code) { return code == cli::interrupted ? code + last_signal : code; }

int tell(const RunResult& result) {
  if (!result.error.empty()) edmill::io::tell("edmill-core: {}\n", result.error);
  edmill::io::print_text(result.table);
  if (const int error = edmill::io::output_error()) {
    edmill::io::tell("edmill-core: standard output: {}\n", std::strerror(error));
    return cli::internal_error;
  }
  return with_signal(cli::code_of(result.end_reason));
}

}  // namespace

int main(int argc, char** argv) {
  const Words words(argv + 1, argv + argc);
  if (!looks_right(words)) return edmill::io::tell_text(usage), cli::bad_input;
  for (const int signal : {SIGINT, SIGTERM})
    std::signal(signal, [](int number) {
      last_signal = number;
      interrupted = true;
    });
  RunOptions options;
  options.interrupt = &interrupted;
  options.without_locks = [](const auto& place) {
    edmill::io::tell("edmill-core: {}: this file system has no locks\n", place.string());
  };
  try {
    return tell(words[0] == "resume" ? resume(words, options) : run(words, options));
  } catch (const InputError& error) {
    for (const auto& problem : error.problems()) edmill::io::tell("{}\n", problem);
    return cli::bad_input;
  } catch (const std::exception& error) {
    edmill::io::tell("edmill-core: {}\n", error.what());
    return interrupted ? with_signal(cli::interrupted) : cli::internal_error;
  }
}
