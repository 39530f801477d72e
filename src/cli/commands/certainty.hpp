// The commands that show what is certain about a case.
#pragma once

#include "cli/commands/case_argument.hpp"
#include "cli/precision_commands.hpp"
#include "cli/run_command.hpp"

namespace edmill::cli {

struct Certify {
  static constexpr const char* name = "certify";
  static constexpr const char* what =
      "raise the precision until the first events are certain, and write them";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    command.add_option("--collisions", options_.collisions, "how many events; all of the case unless given")
        ->check(CLI::Range(1, 10000000));
    command.add_option("--digits", options_.digits, "to how many digits; 25 unless given")
        ->check(CLI::Range(1, 100000));
    command.add_option("--out", options_.file, "file; out/<case name>.reference.csv unless given");
    command.add_flag("--quiet", options_.quiet, "no progress and no report");
  }
  int run() {
    if (options_.file.empty()) options_.file = "out/" + name_of(given_.file) + ".reference.csv";
    return interruptible(given_.read(), options_, run_certify);
  }

 private:
  CaseArgument given_;
  CertifyOptions options_;
};

struct Prove {
  static constexpr const char* name = "prove";
  static constexpr const char* what = "prove the first events of a case in ball arithmetic";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    auto* check = command.add_option(
        "--check", options_.checked,
        "prove nothing, but check whether the header of this certificate is that of the case");
    command.add_option("--collisions", options_.collisions, "how many events")
        ->check(CLI::Range(1, 10000000))
        ->excludes(check);
    command.add_option("--out", options_.file, "file for the events, each number with its radius (CSV)")
        ->excludes(check);
    command
        .add_option("--certificate", options_.certificate,
                    "file for a certificate that can be checked without edmill")
        ->excludes(check);
    command.add_option("--most-bits", options_.most_bits, "largest number of bits; 16384 unless given")
        ->check(CLI::Range(128, 1048576))
        ->excludes(check);
    command.add_flag("--compare", options_.compare, "also report how many events each precision gets right")
        ->excludes(check);
    command.add_flag("--quiet", options_.quiet, "no progress and no report");
  }
  int run() { return interruptible(given_.read(), options_, run_prove); }

 private:
  CaseArgument given_;
  ProveOptions options_;
};

}  // namespace edmill::cli
