// The commands that show what is certain about a case.
#pragma once

#include "app/certify.hpp"
#include "base/errors.hpp"
#include "casefile/case_spec.hpp"
#include "cli/commands/case_argument.hpp"
#include "cli/exit_codes.hpp"
#include "io/progress_line.hpp"
#include "io/terminal.hpp"

namespace edmill::cli {

struct Certify : CaseCommand<app::CertifyOptions> {
  static constexpr const char* name = "certify";
  static constexpr const char* what =
      "raise the precision until the first events are certain, and write them";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    command.add_option("--collisions", options_.collisions, "number of events (default: all of the case)")
        ->check(CLI::Range(1, 10000000));
    command.add_option("--digits", options_.digits, "number of correct digits of each value (default: 25)")
        ->check(CLI::Range(1, 100000));
    command.add_option("--out", options_.file,
                       "file for the events (CSV; default: out/<case name>.reference.csv)");
    command.add_flag("--quiet", quiet_, "print no progress and no report");
  }
  int run() {
    name_file(".reference.csv");
    return interruptible(given_.read(), options_, [this](const auto& spec, auto& options) -> int {
      io::ProgressLine line(quiet_);
      options.progress = [&](const std::string& precision, std::size_t events) {
        const auto all = options.collisions == 0 ? "" : fmt::format(" of {}", options.collisions);
        line.show(fmt::format("{}: {}{} events ", precision, events, all));
      };
      options.found = [&](const app::Evidence& evidence) {
        line.clear();
        if (!quiet_) io::print("{} ({:.1f} s)\n", evidence.text(), evidence.seconds);
      };
      const auto result = app::certify(spec, options);
      line.clear();
      if (result.interrupted) return ok;
      if (!result.undecided.empty()) return tell_undecided(result.undecided);
      if (!quiet_) io::print("certified: {}\n", options.file);
      return ok;
    });
  }
};

struct Prove : CaseCommand<app::ProveOptions> {
  static constexpr const char* name = "prove";
  static constexpr const char* what = "prove the first events of a case in ball arithmetic";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    auto* check = command.add_option("--check", checked_,
                                     "certificate whose header is compared with the case; nothing is proven");
    command.add_option("--collisions", options_.collisions, "number of events to prove")
        ->check(CLI::Range(1, 10000000))
        ->excludes(check);
    command.add_option("--out", options_.file, "file for the events, each number with its radius (CSV)")
        ->excludes(check);
    command
        .add_option("--certificate", options_.certificate,
                    "file for a certificate that can be checked without edmill")
        ->excludes(check);
    command.add_option("--most-bits", options_.most_bits, "highest precision in bits (default: 16384)")
        ->check(CLI::Range(128, 1048576))
        ->excludes(check);
    command.add_flag("--compare", compare_, "also report how many events each precision gets right")
        ->excludes(check);
    command.add_flag("--quiet", quiet_, "print no progress and no report");
  }
  int run() {
    return interruptible(given_.read(), options_, [this](const auto& spec, auto& options) {
      return checked_.empty() ? prove(spec, options) : check_header(spec);
    });
  }

 private:
  int prove(const casefile::CaseSpec& spec, app::ProveOptions& options) const {
    if (options.collisions == 0)
      throw InputError("prove: give --collisions, the number of events, or --check, a certificate");
    io::ProgressLine line(quiet_);
    options.progress = [&](long bits, std::size_t events) {
      if (events % 16 == 0)
        line.show(fmt::format("{} bits: {} of {} events ", bits, events, options.collisions));
    };
    const auto proof = app::prove(spec, options);
    line.clear();
    if (!quiet_)
      for (const auto& attempt : proof.attempts)
        io::print("{} bits: {} events{}\n", attempt.bits, attempt.events,
                  attempt.undecided.empty() ? "" : "; undecided: " + attempt.undecided);
    if (proof.interrupted) return ok;
    if (!proof.impossible.empty()) return tell_undecided(proof.impossible);
    if (quiet_) return ok;
    io::print("proven: {} events in {} bits, {:.2f} bits lost per event ({:.1f} s)\n", proof.events.size(),
              proof.bits,
              static_cast<double>(proof.bits - proof.accuracy) / static_cast<double>(proof.events.size()),
              proof.seconds);
    if (compare_)
      for (const auto& precision : casefile::precisions())
        io::print("{:<9} {} events right\n", precision, app::right_events(precision, spec, proof));
    return ok;
  }

  /// Whether the certificate is one of this case.
  int check_header(const casefile::CaseSpec& spec) const {
    const auto differences = app::check_certificate(spec, checked_);
    for (const auto& line : differences) io::print("{}\n", line);
    if (!quiet_ && differences.empty())
      io::print("{} is of the case {}; check_certificate says whether its events are proven\n", checked_,
                spec.file);
    if (!quiet_ && !differences.empty()) io::print("{} is of another case than {}\n", checked_, spec.file);
    return differences.empty() ? ok : outputs_differ;
  }

  std::string checked_;   ///< a certificate whose header is to be that of the case; else one is proven
  bool compare_ = false;  ///< also print how many events each scalar gets right
};

}  // namespace edmill::cli
