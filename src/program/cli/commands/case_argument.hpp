// The common part of commands that take a case.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.hpp"
#include "casefile/case_spec.hpp"
#include "casefile/quantity.hpp"
#include "cli/exit_codes.hpp"
#include "io/input_file.hpp"

namespace edmill::cli {

/// Adds an option whose value keeps to a rule.
CLI::Option* add_checked(CLI::App& command, const std::string& name, auto& target,
    const CLI::Validator& rule, const std::string& what) {
  return command.add_option(name, target, what)->check(rule);
}
CLI::Option* add_required(
    CLI::App& command, const std::string& name, auto& target, const std::string& what) {
  return command.add_option(name, target, what)->required();
}
/// Adds an option that can be repeated, with one value each time.
void add_list(CLI::App& command, const std::string& name, auto& target, const std::string& what) {
  command.add_option(name, target, what)->take_all()->expected(1);
}

struct CaseArgument {
  std::string file;
  std::vector<std::string> overrides;

  void add_to(CLI::App& command, const std::string& name = "case") {
    add_required(command, name, file, "case file (TOML)");
    add_list(command, "--set", overrides,
        "section.key=value that overrides the case file; can be repeated");
  }
  casefile::CaseSpec read() const { return casefile::read_case(file, overrides); }
};

/// "1%" or "0.01". @throws InputError when it is no part of 1
inline double part_of_one(const std::string& option, const std::string& text) {
  std::string_view number = text;
  const bool percent = number.ends_with('%');
  if (percent) number.remove_suffix(1);
  while (number.ends_with(' ')) number.remove_suffix(1);
  const auto value = casefile::parse_decimal(number);
  const double part = value ? value->to<double>() / (percent ? 100 : 1) : 0;
  if (!(part > 0 && part < 1))
    throw InputError(option + ": found \"" + text +
        "\", expected a part of the dose rate above 0 and below 1: \"1%\" or 0.01");
  return part;
}

/// Name for the outputs of a case: the stem of its file.
inline std::string name_of(const std::string& case_file) {
  return io::is_stream(case_file) ? "stdin" : std::filesystem::path(case_file).stem().string();
}

/// A command on a case, with the values of its options.
template <class Options> class CaseCommand {
 protected:
  /// Unless a name is given, the output file is beside other outputs of the case.
  void name_file(const std::string& ending) {
    if (options_.file.empty()) options_.file = "out/" + name_of(given_.file) + ending;
  }

  CaseArgument given_;
  Options options_;
  bool quiet_ = false;
};

/// For work that does not report interruptions itself. @return the exit code of work()
int interruptible(auto& options, const auto& work) {
  options.interrupt = &interrupt_flag();
  listen_for_signals();
  return after_signals(work());
}
int interruptible(const casefile::CaseSpec& spec, auto& options, const auto& command) {
  return interruptible(options,
      [&] { return casefile::with_memory_for(spec, [&] { return command(spec, options); }); });
}

}  // namespace edmill::cli
