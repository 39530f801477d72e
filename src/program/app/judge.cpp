#include "app/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "audit/audit_fields.hpp"
#include "base/clean_text.hpp"
#include "base/errors.hpp"
#include "casefile/build_case.hpp"
#include "casefile/case_spec.hpp"
#include "dem/contact_rates.hpp"
#include "dem/contacts.hpp"
#include "identify/identify_fields.hpp"
#include "io/csv_reader.hpp"
#include "io/input_file.hpp"
#include "io/json_text.hpp"
#include "io/output_folder.hpp"
#include "logs/event_log.hpp"
#include "report/report_page.hpp"
#include "run/any_run.hpp"

namespace edmill::app {

namespace {

std::string describe_law(const model::ContactLaw<double>& law) {
  std::string text = law.name();
  const char* separator = ": ";
  law.parameters([&](const model::Parameter& p, double value) {
    text += fmt::format("{}{} {}", std::exchange(separator, ", "), p.key, value);
  });
  return text +
      (law.least_separation > 0 ? fmt::format(", least separation {:g} m/s", law.least_separation)
                                : ", no least separation");
}

/// "Y", "-X", "(0.966, 0.259, 0)"
std::string direction(const Vec3<double>& v) {
  for (int k = 0; k < 3; ++k)
    if (std::abs(v[k]) > 1 - 1e-12) return std::string(v[k] < 0 ? "-" : "") + "XYZ"[k];
  return fmt::format("({:.3g}, {:.3g}, {:.3g})", v[0], v[1], v[2]);
}

constexpr int version = 1;  // of the format of logs

/// The unit of a column by its name: "vx_before" is a velocity.
std::string unit_of(const std::string& column) {
  const auto name = column.starts_with("partner_") ? column.substr(8) : column;
  if (name == "time" || name == "end" || name.starts_with("free_")) return "s";
  if (name.ends_with("_speed")) return "m/s";
  if (name == "milling_dose" || name == "wall_work") return "J";
  const auto quantity = name.substr(0, name.find('_'));
  if (quantity.size() == 1 && quantity >= "x" && quantity <= "z") return "m";
  if (quantity.size() == 2 && quantity[0] == 'v') return "m/s";
  if (quantity.size() == 2 && quantity[0] == 'w') return "rad/s";
  return "";
}

/// @throws InputError when a comment before the header names another version
void check_version(const std::string& file) {
  io::InputFile in(file, "a collision log");
  std::string line;
  const std::string mark = "# collision log ";
  while (std::getline(in, line) && (line.empty() || line[0] == '#'))
    if (line.starts_with(mark) && trimmed(line.substr(mark.size())) != std::to_string(version))
      throw InputError(fmt::format("{}: the log has version {}, this program reads version {}",
          file, clean_text(line.substr(mark.size())), version));
}

void take_columns(LogDescription& log, const std::string& file) {
  const auto& known = logs::column_names();
  const io::CsvReader csv(file, "a collision log");
  for (const auto& name : csv.header())
    if (log.kind == "contacts" || std::find(known.begin(), known.end(), name) != known.end())
      log.columns.push_back({name, unit_of(name)});
    else if (name != "index")
      log.skipped.push_back(name);
}

void take_row(LogDescription& log, double time, int ball, bool with_wall, int partner) {
  ++log.rows;
  if (!log.first) log.first = time;
  log.last = std::max(log.last.value_or(time), time);
  log.balls = std::max({log.balls, ball + 1, with_wall ? 0 : partner + 1});
  if (with_wall) log.walls = std::max(log.walls, partner + 1);
}

void read_impacts(LogDescription& log, const std::string& file) {
  constexpr int any = 1000000000, walls = 1000;
  logs::EventLog in(file, {}, any, walls, 1e15);
  std::vector<std::string> problems;  // the first of those of single lines
  std::size_t more = 0;
  constexpr std::size_t most_problems = 10;
  const auto add = [&](std::uint64_t line, const std::string& problem) {
    if (problems.size() < most_problems)
      problems.push_back(fmt::format("{}:{}: {}", in.file(), line, problem));
    else
      ++more;
  };
  try {
    while (const auto event = in.next()) {
      if (!event->problem.empty()) {
        add(event->line, event->problem);
        continue;
      }
      if (event->earlier_by > 0)
        add(event->line,
            fmt::format("the time is {:g} s before that of an earlier line", event->earlier_by));
      take_row(log, event->time, event->ball, event->with_wall, event->partner);
    }
  } catch (const InputError& error) {  // a line that cannot be read
    problems.insert(problems.end(), error.problems().begin(), error.problems().end());
  }
  if (more > 0) problems.push_back(fmt::format("{}: {} more problems", in.file(), more));
  if (!problems.empty()) throw InputError(problems);
}

void read_contacts(LogDescription& log, const std::string& file) {
  dem::ContactLogReader in(file);
  while (const auto contact = in.next())
    take_row(log, contact->begin, contact->ball, contact->bodies == 1 && contact->partner >= 0,
        contact->partner);
}

/// The case's section [audit], overridden by the command line's options.
audit::Options merged(const casefile::CaseSpec& spec, const AuditOptions& given) {
  auto options = audit::options_of(spec);
  options.log = given.log;
  for (const auto& text : given.columns) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0)
      throw InputError(
          fmt::format("--column {}: {} is missing, expected ours=theirs, e.g. \"time=t [ms]\"",
              text, equals == 0 ? "the name" : "'='"));
    const std::string ours = text.substr(0, equals);
    std::erase_if(
        options.conventions.columns, [&](const auto& column) { return column.first == ours; });
    options.conventions.columns.emplace_back(ours, text.substr(equals + 1));
  }
  if (given.first_ball) options.conventions.first_ball = *given.first_ball;
  if (!given.walls.empty())
    options.conventions.walls =
        logs::parse_walls(given.walls, casefile::partners_of(spec), "--walls");
  if (given.tolerance) options.tolerance = *given.tolerance;
  if (given.gap_tolerance) options.gap_tolerance = given.gap_tolerance;
  options.from_start = options.from_start || given.from_start;
  options.examples = given.examples.value_or(options.examples);
  options.interrupt = given.interrupt;
  options.progress = given.progress;
  return options;
}

std::string to_junit(const audit::Audit& result) {
  std::vector<compare::JunitCase> cases;
  for (std::size_t k = 0; k < audit::check_count; ++k) {
    const auto check = static_cast<audit::Check>(k);
    if (result.findings.judged_number(check) == 0) continue;
    std::string problem;
    for (const auto kind : result.findings.ranked()) {
      const auto& [name, unit, meaning, own] = audit::info(kind);
      const auto& tally = result.findings.of(kind);
      if (own == check)
        problem += fmt::format("{}{}: {} times, at worst {:.3g} {}; {}",
            problem.empty() ? "" : "\n", name, tally.count, tally.worst, unit, meaning);
    }
    cases.push_back({std::string(audit::info(check).name), problem});
  }
  cases.push_back({"enough impacts",
      result.verdict == audit::Verdict::too_few ? "too few impacts to judge" : ""});
  return compare::junit_text("edmill audit of " + result.log_name, cases);
}

void refuse(bool given, const char* options, const char* found, const char* expected) {
  if (given)
    throw InputError(
        fmt::format("{}: found a log of {}, expected one of {}", options, found, expected));
}

Judged judged(const auto& found) {
  return {found.verdict, to_json(found), to_junit(found), table(found)};
}

}  // namespace

CheckedCase check(const casefile::CaseSpec& spec) {
  return casefile::with_memory_for(spec, [&] {
    // The case must be valid in its own scalar; double is sufficient for the description.
    run::make_run(spec.precision, spec)->begin();
    const auto built = casefile::build_case<double>(spec, false);
    const auto& c = built.the_case;
    const auto& m = c.mill;
    CheckedCase result{spec.file, {}};
    const auto row = [&](const std::string& name, const std::string& value) {
      result.facts.emplace_back(name, value);
    };

    row("digest", spec.digest);
    row("precision, seed",
        fmt::format("{}, {}",
            spec.digits ? fmt::format("for {} right digits at the end", *spec.digits)
                        : spec.precision,
            spec.seed));
    row("statistics from", fmt::format("{} s", spec.statistics_start.to<double>()));
    if (spec.end_time) row("end_time", fmt::format("{} s", spec.end_time->to<double>()));
    model::for_each_stop_rule([&](auto rule, std::size_t place) {
      if (const auto& limit = c.stop.limits[place])
        row(rule.key.key, fmt::format("{}{}", *limit, casefile::si_unit(rule.key.dimension)));
    });

    row("gravity", casefile::describe_gravity(spec));
    row("mill", casefile::describe(spec.mill));
    const auto pose =
        m.motion.pose(DriveClock<double>(m.motion.period()).at(spec.initial_time.to<double>()));
    row("vessel's x, y, z",
        fmt::format("along {}, {}, {} of the laboratory at the start",
            direction(m.motion.axis_x(pose)), direction(m.motion.axis_y(pose)),
            direction(m.motion.axis_z(pose))));
    if (const double peak = m.motion.wall_speed(0); peak > 0)
      row("peak wall speed", fmt::format("{:g} m/s at the vessel's centre", peak));
    row("vessel", casefile::describe(spec.vessel));
    const auto partners = casefile::partners_of(spec);
    for (const auto& piston : spec.pistons)
      row("piston " + partners[piston.wall].label, casefile::describe(piston));
    for (const auto& body : spec.bodies) row(body.name, casefile::describe(body));
    if (!spec.pairs_only) {
      row("contact ball-ball", describe_law(m.ball_ball));
      row("contact ball-wall", describe_law(m.ball_wall));
    }
    for (std::size_t k = 0; k < spec.pairs.size(); ++k)
      row("contact " + spec.names_of(spec.pairs[k]), describe_law(m.pairs.laws[k]));

    double mass = 0, volume = 0;
    for (const auto& ball : c.balls) {
      mass += ball.mass;
      volume += 4.0 / 3 * numerics::pi<double>() * ball.radius * ball.radius * ball.radius;
    }
    row("balls", fmt::format("{}, together {:g} kg", c.balls.size(), mass));
    const auto kind = [&](const casefile::BallSpec& b, int count) {
      const double d = b.diameter.to<double>(), density = b.density.to<double>();
      row("",
          fmt::format("{} x {:g} m, {:g} kg/m^3: {:g} kg each", count, d, density,
              density * numerics::pi<double>() * d * d * d / 6));
    };
    for (const auto& b : spec.balls) kind(b, 1);
    for (const auto& b : spec.batches) kind(b, b.count);
    row("packing fraction",
        fmt::format("{:.4g}{}", volume / casefile::free_volume(m, built.start),
            !spec.pistons.empty()  ? " of the vessel without its pistons"
                : m.bodies.empty() ? ""
                                   : " of the volume between the bodies"));
    for (const auto& gap : casefile::narrow_gaps(spec, m))
      row("narrow gap",
          fmt::format("{} and {}: {:.3g} mm at {:.4g} s, less than a ball: balls that are squeezed "
                      "there end the run as stalled",
              gap.one, gap.other, 1000 * gap.width, gap.time));
    if (spec.powder_mass)
      row("charge ratio",
          fmt::format("{:.4g} on {:g} kg of powder", mass / spec.powder_mass->to<double>(),
              spec.powder_mass->to<double>()));
    for (const auto& output : spec.outputs) row("output", output.type + " to " + output.file);
    return result;
  });
}

std::string CheckedCase::text() const {
  std::string out = fmt::format("{} is a valid case\n", file);
  for (const auto& [name, value] : facts) out += fmt::format("  {:<24}{}\n", name, value);
  return out;
}

void draw_mill(const casefile::CaseSpec& spec, const std::filesystem::path& file) {
  const auto built = casefile::build_case<double>(spec, false);
  io::NamedFile(file).write(report::mill_drawing(built.the_case.mill));
}

std::string LogDescription::text() const {
  std::string out = fmt::format("a log of {}, version {}\n", kind, version);
  const auto row = [&](const char* name, const std::string& value) {
    out += fmt::format("  {:<18}{}\n", name, value);
  };
  row("rows", std::to_string(rows));
  if (first) row("time", fmt::format("{:.6g} s to {:.6g} s", *first, *last));
  row("balls, walls", fmt::format("{}, {}", balls, walls));
  std::string names, others;
  for (const auto& column : columns)
    names += (names.empty() ? "" : ", ") + column.name +
        (column.unit.empty() ? "" : " [" + column.unit + "]");
  for (const auto& name : skipped) others += (others.empty() ? "" : ", ") + name;
  row("columns", names);
  if (!others.empty()) row("skipped", others);
  return out;
}

std::string LogDescription::json() const {
  std::string list;
  for (const auto& column : columns)
    list += fmt::format("{}{{\"name\": {}, \"unit\": {}}}", list.empty() ? "" : ", ",
        io::JsonText::of(column.name), io::JsonText::of(column.unit));
  return fmt::format(
      "{{\n  \"format\": \"collision log\",\n  \"version\": {},\n  \"kind\": \"{}\",\n  \"units\": "
      "\"SI\",\n  \"frame\": \"inertial\",\n  \"columns\": [{}],\n  \"skipped\": {},\n  \"rows\": "
      "{},\n  \"first\": {},\n  \"last\": {},\n  \"balls\": {},\n  \"walls\": {}\n}}\n",
      version, kind, list, io::JsonText::of(skipped), rows, io::JsonText::of(first),
      io::JsonText::of(last), balls, walls);
}

bool is_log(const std::string& file) try {
  io::InputFile in(file, "a log");
  std::string line;
  while (std::getline(in, line))
    if (const auto text = trimmed(line); !text.empty() && text[0] != '#')
      return text[0] != '[' && text.find_first_of(",;\t") != text.npos &&
          text.find('=') == text.npos;
  return false;
} catch (const InputError&) {  // reading the case says why
  return false;
}

LogDescription describe_log(const std::string& file) {
  LogDescription log;
  log.kind = dem::is_contact_log(file) ? "contacts" : "impacts";
  check_version(file);
  take_columns(log, file);
  log.kind == "contacts" ? read_contacts(log, file) : read_impacts(log, file);
  return log;
}

Judged compare(const compare::ComparisonOptions& options) {
  const io::Spool pipes;
  const auto a = options.a.string(), b = options.b.string();
  if (dem::is_contact_log(a) || dem::is_contact_log(b)) {
    refuse(options.tolerance || options.events || options.batch, "--tolerance, --events, --batch",
        "contacts that last", "impacts");
    return judged(dem::compare_contacts(options));
  }
  refuse(options.within.has_value(), "--within", "impacts", "contacts that last");
  return judged(compare::compare(options));
}

Judged audit(const casefile::CaseSpec& spec, const AuditOptions& given) {
  const io::Spool pipes;
  if (dem::is_contact_log(given.log)) {
    refuse(!given.columns.empty() || given.first_ball || !given.walls.empty() || given.tolerance ||
            given.gap_tolerance || given.from_start || given.identify || given.examples,
        "--column, --first-ball, --walls, --tolerance, --gap-tolerance, --from-start, --identify, "
        "--examples",
        "contacts that last", "impacts");
    return judged(dem::audit_contacts(spec, given.log, given.interrupt));
  }
  const auto options = merged(spec, given);
  const auto built = casefile::build_case<double>(spec);
  auto found = audit::audit(built.the_case, built.states, options);
  found.case_name = spec.file;
  std::string table = audit::table(found);
  using identify::Search;
  std::uint64_t explained = 0;
  for (const auto& diagnosis : found.diagnoses) explained += diagnosis.events;
  const bool is_open = found.verdict == audit::Verdict::differ &&
      !audit::accounts_for(explained, found.findings.total());
  std::optional<identify::Identification> identified;
  if (!found.interrupted && (given.identify || is_open)) {
    identified = identify::identify(
        spec, options, given.identify ? Search::all : Search::single, given.searching);
    table += identify::table(*identified);
  }
  const auto json = io::JsonFields::of([&](auto& v) {
    audit::Fields{found}(v);
    if (identified) identify::Fields{*identified}(v);
  });
  return {found.verdict, json, to_junit(found), table};
}

std::string document_keys() {
  const auto section = [](const char* command, const std::string& keys) {
    return fmt::format("### {}\n\n{}\n", command, keys);
  };
  return section("compare", compare::comparison_keys()) +
      section("compare, of contacts that last", dem::contact_comparison_keys()) +
      section("audit", io::KeyTable::of([](auto& v) {
        audit::Fields{{}}(v);
        identify::Fields{{}}(v);
      })) +
      section("audit, of contacts that last", dem::contact_audit_keys()) +
      section("limit", dem::limit_keys());
}

}  // namespace edmill::app
