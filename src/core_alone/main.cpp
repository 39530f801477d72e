// Runs of cases by the core alone, for machines that have none of the libraries of the whole program.
#include <atomic>
#include <csignal>
#include <cstdio>
#include <string>
#include <vector>

#include "app/run.hpp"
#include "base/errors.hpp"
#include "casefile/case_spec.hpp"

namespace {

constexpr const char* usage =
    "usage: edmill-core [--checkpoint INTERVAL] CASE.toml FOLDER double|float128 [key=value ...]\n"
    "       edmill-core resume FOLDER\n";

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);  // else a signal handler may not set it

using Words = std::vector<std::string>;

edmill::app::RunResult resume(const Words& words, edmill::app::RunOptions options) {
  options.folder = words.at(1);
  return edmill::app::resume("", options);
}

edmill::app::RunResult run(Words words, edmill::app::RunOptions options) {
  std::string interval;
  if (words[0] == "--checkpoint") {
    interval = words.at(1);
    words.erase(words.begin(), words.begin() + 2);
  }
  const Words settings(words.begin() + 3, words.end());
  const std::string precision = words.at(2);
  if (precision != "double" && precision != "float128")
    throw edmill::InputError("found precision '" + precision + "', expected double or float128");
  const auto spec = edmill::casefile::read_case(words.at(0), settings);
  options.folder = words.at(1);
  if (!interval.empty())
    options.checkpoint = edmill::app::first_checkpoint(spec, settings, precision, false, interval);
  return edmill::app::run(precision, spec, options);
}

}  // namespace

int main(int argc, char** argv) {
  const Words words(argv + 1, argv + argc);
  const bool resumes = !words.empty() && words[0] == "resume",
             saves = !words.empty() && words[0] == "--checkpoint";
  if (resumes ? words.size() != 2 : words.size() < (saves ? 5u : 3u)) return std::fputs(usage, stderr), 2;
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { interrupted = true; });
  edmill::app::RunOptions options;
  options.interrupt = &interrupted;
  try {
    const auto result = resumes ? resume(words, options) : run(words, options);
    std::fputs(result.table.c_str(), stdout);
    if (!result.error.empty()) return std::fprintf(stderr, "%s\n", result.error.c_str()), 1;
    return 0;
  } catch (const edmill::InputError& error) {
    for (const auto& problem : error.problems()) std::fprintf(stderr, "%s\n", problem.c_str());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
