// The commands that judge logs, and those between edmill and DEM codes.
#pragma once

#include <filesystem>
#include <optional>
#include <variant>

#include "app/judge.hpp"
#include "casefile/quantity.hpp"
#include "cli/commands/case_argument.hpp"
#include "decks/deck.hpp"
#include "dem/contact_rates.hpp"
#include "dem/import_dump.hpp"
#include "io/output_folder.hpp"
#include "io/progress_line.hpp"
#include "io/terminal.hpp"

namespace edmill::cli {

inline int code_of(compare::Verdict verdict) {
  using compare::Verdict;
  return verdict == Verdict::differ ? outputs_differ
      : verdict == Verdict::too_few ? too_few_data
                                    : ok;
}

/// Options of a command that judges, its output files and its exit code.
class Judgement {
 public:
  void add_to(CLI::App& command, const char* meaning_of_quiet) {
    command.add_option("--json", json_, "file for the result as JSON");
    command.add_option("--junit", junit_, "file for the result as JUnit XML");
    command.add_flag("--quiet", quiet, meaning_of_quiet);
  }
  /// Makes the files, then judges. @return the exit code
  int of(const auto& judge) const {
    io::NamedFile json(json_), junit(junit_);
    const app::Judged judged = judge();
    json.write(judged.json);
    junit.write(judged.junit);
    if (!quiet) io::print("{}", judged.table);
    return code_of(judged.verdict);
  }

  bool quiet = false;
 private:
  std::string json_, junit_;
};

struct Compare {
  static constexpr const char* name = "compare";
  static constexpr const char* what = "compare two collision logs event by event and by statistics";

  void add_options(CLI::App& command) {
    add_required(command, "A", options_.a, "reference: folder of a run, or a collision log (CSV)");
    add_required(command, "B", options_.b,
        "log to compare with it: folder of a run, or a collision log (CSV)");
    add_checked(command, "--tolerance", options_.tolerance, CLI::Range(0.0, 1.0),
        "relative tolerance for single events (default: 1e-9)");
    command.add_option(
        "--events", options_.events, "number of events that must agree one by one (default: none)");
    command.add_option("--from", options_.limits.from,
        "start of the statistics, in s (default: where those of both runs begin)");
    command.add_option("--until", options_.limits.until,
        "end of the statistics, in s (default: the end of the shorter log)");
    command.add_option("--within", within_,
        "largest relative difference of dose rates that agree, for contacts that last: \"5%\" "
        "or 0.05 (default: by their 95 % intervals)");
    add_checked(command, "--batch", options_.batch, CLI::PositiveNumber,
        "length of a batch in s (default: a twentieth of the common time)");
    judgement_.add_to(command, "print no table");
  }
  int run() {
    if (!within_.empty()) options_.within = part_of_one("--within", within_);
    return judgement_.of([this] { return app::compare(options_); });
  }
 private:
  compare::ComparisonOptions options_;
  std::string within_;
  Judgement judgement_;
};

struct Audit {
  static constexpr const char* name = "audit";
  static constexpr const char* what =
      "check another code's collision log against the physics of a case";

  void add_options(CLI::App& command) {
    given_.add_to(command);
    add_required(command, "log", options_.log, "collision log (CSV), or folder of a run");
    add_list(command, "--column", options_.columns,
        "ours=theirs [unit]: edmill's name of a column, and its name in the log; can be repeated");
    add_checked(command, "--first-ball", options_.first_ball, CLI::Range(0, 1000000000),
        "number of the log's first ball (default: 0)");
    command.add_option("--walls", options_.walls,
        "the log's numbers of the walls, in the order of edmill's ids: \"1, 2, 3\" for the "
        "caps at -y and +y and the cylinder (default: those of edmill)");
    add_checked(command, "--tolerance", options_.tolerance, CLI::Range(1e-15, 0.5),
        "relative tolerance (default: 1e-9)");
    add_checked(command, "--gap-tolerance", options_.gap_tolerance, CLI::PositiveNumber,
        "largest gap or overlap of bodies in contact, in m (default: by rounding)");
    command.add_flag("--from-start", options_.from_start,
        "treat the log as one that begins at the initial state of the case");
    command.add_flag("--identify", options_.identify,
        "also search for causes in parts of the log, and for combinations of two and three causes");
    add_checked(command, "--examples", options_.examples, CLI::Range(0, 1000),
        "number of examples of each kind of violation (default: 3)");
    judgement_.add_to(command, "print no progress line and no table");
  }
  int run() {
    return interruptible(
        given_.read(), options_, [this](const casefile::CaseSpec& spec, auto& options) {
          return judgement_.of([&] {
            io::ProgressLine line(judgement_.quiet);
            if (line) {
              std::optional<double> end;
              if (spec.end_time) end = spec.end_time->to<double>();
              options.progress = [&line, end](double time, std::uint64_t events) {
                line.show(time, end, events);
              };
              options.searching = [&line](const std::string& stage) {
                line.show("searching: " + stage);
              };
            }
            return app::audit(spec, options);
          });
        });
  }
 private:
  CaseArgument given_;
  app::AuditOptions options_;
  Judgement judgement_;
};

/// The value of an option that is a quantity with a unit, "50 us", in SI.
inline double quantity_from(
    const std::string& name, const std::string& text, casefile::Dimension dimension) {
  const auto read = casefile::parse_quantity(text, dimension);
  if (const auto* problem = std::get_if<casefile::QuantityProblem>(&read))
    throw CLI::ValidationError(
        name, "found " + problem->found + ", expected " + casefile::describe(dimension));
  return std::get<casefile::Quantity>(read).to<double>();
}

CLI::Option* add_quantity(CLI::App& command, const std::string& name, auto& target,
    casefile::Dimension dimension, const std::string& what) {
  return command.add_option_function<std::string>(
      name,
      [&target, name, dimension](const std::string& text) {
        target = quantity_from(name, text, dimension);
        if (!(target > 0))
          throw CLI::ValidationError(
              name, "found " + text + ", expected a positive " + casefile::noun(dimension));
      },
      what);
}

struct Export : CaseCommand<decks::DeckOptions> {
  static constexpr const char* name = "export";
  static constexpr const char* what = "write a case as the input of a DEM code";

  void add_options(CLI::App& command) {
    using casefile::Dimension;
    given_.add_to(command);
    command.add_option("--to", options_.code, "DEM code: lammps, liggghts or yade")
        ->required()
        ->check(CLI::IsMember(
            std::vector<std::string>(decks::deck_codes.begin(), decks::deck_codes.end())));
    command.add_option("--out", folder_, "folder for the deck (default: the working directory)");
    command.add_option("--name", options_.name, "base name of the files (default: deck)")
        ->check(problem_of_name);
    add_quantity(command, "--contact-time", options_.contact_time, Dimension::time,
        "duration of the largest ball's contact with a wall (default: \"50 us\")");
    add_quantity(command, "--contact-speed", options_.speed, Dimension::speed,
        "approach speed at which a contact takes that time (default: \"1 m/s\")");
    add_quantity(command, "--duration", options_.duration, Dimension::time,
        "simulated time (default: until the end of the case)");
    add_quantity(command, "--frames", options_.frame_interval, Dimension::time,
        "time between frames of the dump (default: a fifth of the contact time)");
    add_checked(command, "--steps", options_.steps, CLI::Range(10, 10000),
        "number of time steps in a contact (default: 50)");
    add_checked(command, "--facets", options_.facets, CLI::Range(8, 4096),
        "number of facets of a cylinder, for codes that have only triangles (default: 128 in "
        "LIGGGHTS and 24 in YADE)");
    command.add_flag("--quiet", quiet_, "print nothing");
  }
  int run() {
    const auto spec = given_.read();
    const auto deck = decks::make_deck(spec, options_);
    const std::filesystem::path folder(folder_);
    for (const auto& file : deck.files) io::NamedFile(folder / file.name).write(file.text);
    if (quiet_) return ok;
    for (const auto& file : deck.files) io::print("wrote {}\n", (folder / file.name).string());
    for (const auto& note : deck.notes) io::print("note: {}\n", note);
    io::print(
        "run it there:    {}\nthen:            edmill import {}.dump --case {} --deck {} --out "
        "{}.contacts.csv\n",
        deck.command, options_.name, spec.file, deck.files.front().name, options_.name);
    return ok;
  }
 private:
  static std::string problem_of_name(const std::string& text) {
    const bool plain = text.find_first_of("/ \t'\"") == std::string::npos && !text.empty();
    return plain ? "" : "expected a plain file name";
  }

  std::string folder_ = ".";
};

struct Import : CaseCommand<dem::ImportOptions> {
  static constexpr const char* name = "import";
  static constexpr const char* what = "turn the dump of a DEM code into a log of contacts";

  void add_options(CLI::App& command) {
    add_required(command, "dump", options_.dump,
        "dump with frames: `dump custom` of LAMMPS (text or binary) or LIGGGHTS, or a table; may "
        "be compressed; - is standard input");
    given_.add_to(command, "--case");
    command.add_option(
        "--out", options_.log, "file for the log of contacts (CSV; default: contacts.csv)");
    command.add_option("--deck", options_.deck,
        "input file of the DEM code, from which time step, units and frame are read");
    add_quantity(command, "--timestep", options_.time_step, casefile::Dimension::time,
        "time step of a dump without times (default: that of the deck)");
    add_checked(command, "--units", options_.units,
        CLI::IsMember({"si", "cgs", "mm", "micro", "nano"}),
        "units of the dump; mm means mm, s, kg (default: those that the dump or the deck names, or "
        "si)");
    command.add_option("--axes", axes_,
        "axes X, Y and Z of the case in those of the dump: \"x z -y\" if its y is the case's "
        "-Z (default: \"x y z\")");
    command
        .add_option("--shift", shift_,
            "position of the dump's origin in the case: \"0 mm\" \"0 mm\" \"10 mm\" (default: the "
            "origin)")
        ->expected(3);
    add_checked(command, "--frame", frame_, CLI::IsMember({"laboratory", "vessel"}),
        "frame of the dump: laboratory or vessel (default: that of the deck, or laboratory)");
    command.add_flag("--quiet", quiet_, "print no progress line and no table");
  }
  int run() {
    options_.in_vessel = frame_ == "vessel";
    if (options_.log.empty()) options_.log = "contacts.csv";
    if (!axes_.empty()) options_.axes = dem::axes_from(axes_);
    for (std::size_t k = 0; k < shift_.size(); ++k)
      options_.origin[static_cast<Eigen::Index>(k)] =
          quantity_from("--shift", shift_[k], casefile::Dimension::length);
    return interruptible(given_.read(), options_, [this](const auto& spec, auto& options) {
      io::ProgressLine line(quiet_);
      if (line)
        options.progress = [&line](double time, std::uint64_t contacts) {
          line.show(time, std::nullopt, contacts);
        };
      const auto imported = dem::import_dump(spec, options);
      line.clear();
      if (!quiet_) io::print("{}", dem::table(imported));
      return ok;
    });
  }
 private:
  std::string frame_, axes_;
  std::vector<std::string> shift_;
};

struct Limit {
  static constexpr const char* name = "limit";
  static constexpr const char* what =
      "extrapolate the dose rates of logs of contacts to contacts of zero duration";

  void add_options(CLI::App& command) {
    add_required(command, "logs", logs_,
        "logs of contacts from decks of one case with different contact times")
        ->expected(2, 100);
    command.add_option(
        "--edmill", run_, "folder of a run, or its collision log, to compare the limit with");
    add_quantity(command, "--from", from_, casefile::Dimension::time,
        "time at which the statistics begin (default: the start of each log)");
    command.add_option("--within", within_,
        "largest relative difference of the limit from edmill: \"5%\" or 0.05 (default: by "
        "their 95 % intervals)");
    command.add_option("--json", json_, "file for the result as JSON");
    command.add_option("--draw", svg_, "file for a drawing (SVG)");
    command.add_flag("--quiet", quiet_, "print no table");
  }
  int run() {
    std::optional<double> within;
    if (!within_.empty()) within = part_of_one("--within", within_);
    const auto limit = dem::limit_of(logs_, run_, from_, within);
    io::NamedFile(json_).write(dem::to_json(limit));
    io::NamedFile(svg_).write(app::limit_drawing(limit));
    if (!quiet_) io::print("{}", dem::table(limit));
    return code_of(limit.to_edmill ? limit.to_edmill->verdict : compare::Verdict::not_compared);
  }
 private:
  std::vector<std::string> logs_;
  std::string run_, json_, svg_, within_;
  double from_ = 0;
  bool quiet_ = false;
};

}  // namespace edmill::cli
