// The commands that show what is certain about a case, or follow it through its parameters.
#pragma once

#include "app/certify.hpp"
#include "app/study.hpp"
#include "base/errors.hpp"
#include "casefile/case_spec.hpp"
#include "casefile/quantity.hpp"
#include "cli/commands/case_argument.hpp"
#include "cli/commands/run.hpp"
#include "io/progress_line.hpp"
#include "io/terminal.hpp"
#include "run/sensitivity.hpp"

namespace edmill::cli {

struct Certify : CaseCommand<app::CertifyOptions> {
  static constexpr const char* name = "certify";
  static constexpr const char* what =
      "raise the precision until the first events are certain, and write them";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    add_checked(command, "--collisions", options_.collisions, CLI::Range(1, 10000000),
        "number of events (default: all of the case)");
    add_checked(command, "--digits", options_.digits, CLI::Range(1, 100000),
        "number of correct digits of each value (default: 25)");
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
    add_checked(command, "--collisions", options_.collisions, CLI::Range(1, 10000000),
        "number of events to prove");
    command.add_option(
        "--out", options_.file, "file for the events, each number with its radius (CSV)");
    command.add_option("--certificate", options_.certificate,
        "file for a certificate that can be checked without edmill");
    add_checked(command, "--most-bits", options_.most_bits, CLI::Range(128, 1048576),
        "highest precision in bits (default: 16384)");
    command.add_flag(
        "--compare", compare_, "also report how many events each precision gets right");
    check->excludes("--collisions", "--out", "--certificate", "--most-bits", "--compare");
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
    io::print("proven: {} events in {} bits, {:.2f} bits lost per event ({:.1f} s)\n",
        proof.events.size(), proof.bits,
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
      io::print("{} is of the case {}; check_certificate says whether its events are proven\n",
          checked_, spec.file);
    if (!quiet_ && !differences.empty())
      io::print("{} is of another case than {}\n", checked_, spec.file);
    return differences.empty() ? ok : outputs_differ;
  }

  std::string checked_;   ///< a certificate whose header is to be that of the case
  bool compare_ = false;  ///< also print how many events each scalar gets right
};

struct Bifurcation : CaseCommand<app::BifurcationOptions> {
  static constexpr const char* name = "bifurcation";
  static constexpr const char* what =
      "plot the phases of a ball's impacts against a case parameter";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    add_required(command, "--over", options_.over,
        "key of the case whose value is varied, \"contact.restitution\"");
    add_required(command, "--from", options_.from, "first value, in the unit of the case file");
    add_required(command, "--to", options_.to, "last value, in the unit of the case file");
    add_checked(command, "--steps", options_.steps, CLI::Range(2, 100000),
        "number of values (default: 400)");
    add_checked(command, "--skip", options_.skip, CLI::Range(0, 100000000),
        "number of impacts of ball 0 with walls before the first phase is drawn (default: 1000)");
    add_checked(command, "--keep", options_.keep, CLI::Range(1, 100000),
        "number of phases drawn for each value (default: 100)");
    command.add_option("--above", above_,
        "lowest approach speed of impacts that count, \"2 cm/s\", which excludes the hops of a "
        "ball at rest (default: all impacts)");
    command.add_option("--out", options_.file,
        "file for the drawing (SVG; default: out/<case name>.bifurcation.svg); its points are "
        "written beside it (CSV)");
    command.add_flag("--quiet", quiet_, "print no progress and no report");
  }
  int run() {
    if (!above_.empty()) {
      const auto speed = casefile::parse_quantity(above_, casefile::Dimension::speed);
      const auto* known = std::get_if<casefile::Quantity>(&speed);
      if (known == nullptr)
        throw InputError("--above: found " + std::get<casefile::QuantityProblem>(speed).found +
            ", expected a speed such as \"2 cm/s\"");
      options_.least_approach = known->to<double>();
    }
    name_file(".bifurcation.svg");
    return interruptible(given_.read(), options_, [this](const auto& spec, auto& options) {
      io::ProgressLine line(quiet_);
      options.progress = [&](std::size_t step) {
        line.show(fmt::format("{} of {} values ", step, options.steps));
      };
      const auto found = app::bifurcation(spec, options);
      line.clear();
      if (quiet_ || found.interrupted) return ok;
      io::print("{} phases: {}\n", found.points.size(), options.file);
      if (found.ended > 0) io::print("{} runs ended before they had all phases\n", found.ended);
      return ok;
    });
  }
 private:
  std::string above_;
};

struct Sensitivity : CaseCommand<run::SensitivityOptions> {
  static constexpr const char* name = "sensitivity";
  static constexpr const char* what =
      "compute the derivatives of the first events with respect to parameters of the case and the "
      "initial state";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    add_required(command, "--by", options_.by,
        "key of the case, \"contact.restitution\", or a coordinate of a ball at the start, "
        "\"initial.3.vx\"; can be repeated");
    add_checked(command, "--events", options_.events, CLI::Range(1, 1000000), "number of events")
        ->required();
    add_checked(command, "--digits", options_.digits, CLI::Range(1, 1000),
        "number of digits of each derivative (default: 17)");
    command.add_flag("--states", options_.states,
        "also write the derivatives of the states of the balls after each impact");
    command.add_option("--out", options_.file,
        "file for the derivatives (CSV; default: out/<case name>.sensitivity.csv)");
    command.add_flag("--quiet", quiet_, "print no progress and no report");
  }
  int run() {
    name_file(".sensitivity.csv");
    return interruptible(given_.read(), options_, [this](const auto& spec, auto& options) {
      io::ProgressLine line(quiet_);
      options.progress = [&line](const std::string& precision, std::size_t events) {
        line.show(fmt::format("{}: {} events ", precision, events));
      };
      const auto found = run::sensitivity(spec, options);
      line.clear();
      if (!quiet_ && !found.interrupted)
        io::print("{} events in {}; derivatives to {} digits: {}\n", found.events.size(),
            found.precision, options.digits, options.file);
      return ok;
    });
  }
};

/// @tparam work  what it does; its result is nothing on ranks that only do runs of rank 0
template <std::optional<app::StudyResult> (*work)(const app::StudyOptions&)> struct Study {
  void add_options(CLI::App& command) {
    add_required(command, "file", options_.file, "sweep or optimisation file (TOML)");
    command.add_option(
        "--out", options_.folder, "folder for the tables (default: out/<name of the file>)");
    add_checked(command, "--jobs", options_.jobs, CLI::Range(1, 4096),
        "number of simultaneous runs in each process (default: all cores)");
    command.add_flag("--estimate", options_.estimate,
        "only report the number of runs and how long they will take, after short trial runs");
    command.add_flag("--quiet", options_.quiet, "print no progress line and no report");
  }
  int run() {
    return interruptible(options_, [&] { return end_of_study(work(options_), options_.quiet); });
  }
 private:
  app::StudyOptions options_;
};

struct Sweep : Study<app::sweep> {
  static constexpr const char* name = "sweep";
  static constexpr const char* what =
      "run a case with many combinations of parameters and tabulate the results";
};
struct Optimize : Study<app::optimize> {
  static constexpr const char* name = "optimize";
  static constexpr const char* what =
      "search for the parameters with the largest dose rate, within bounds";
};

}  // namespace edmill::cli
