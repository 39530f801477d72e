#include "casefile/case_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "base/digest.hpp"
#include "base/errors.hpp"
#include "casefile/build_case.hpp"
#include "casefile/case_parts.hpp"
#include "casefile/key_reader.hpp"
#include "casefile/output_entry.hpp"
#include "casefile/precisions.hpp"
#include "casefile/rational.hpp"
#include "casefile/section.hpp"
#include "casefile/value_of_key.hpp"
#include "io/input_file.hpp"

namespace edmill::casefile {

namespace {

void read_run(Section run, CaseSpec& spec) {
  run.require(run.present(), "end_time", "a section [run] with at least one stop rule");
  spec.precision = read_precision(run);
  read_keys(run, spec);
  run.require(!spec.digits || !run.has("precision"), "digits", "digits or a precision, not both");
  if (!run.has("start_time")) spec.statistics_start = spec.initial_time;
  run.require(spec.statistics_start >= spec.initial_time, "start_time", "a time not before the initial time");
  if (spec.end_time)
    run.require(*spec.end_time > spec.statistics_start, "end_time", "a time after the start time");
  bool stops = run.has("end_time");
  std::string rules = "end_time";
  model::for_each_stop_rule([&](auto rule, std::size_t place) {
    KeyReader{run}(rule.key, spec.stop_limits[place]);
    stops = stops || run.has(rule.key.key);
    rules += std::string(", ") + rule.key.key;
  });
  if (!stops) run.problem("end_time", "no stop rule", "at least one of " + rules);
  // Along -Y when one acceleration is given.
  if (run.has("gravity")) {
    if (run.is_array("gravity")) {
      spec.gravity = run.vector("gravity", Dimension::acceleration).value_or(QuantityVector{});
    } else if (const auto strength = run.quantity("gravity", Dimension::acceleration)) {
      spec.gravity[1] = -*strength;
    }
  }
  run.reject_unknown_keys();
}

/// Instants count drive periods, so a run has no more of them than an integer holds.
void check_times(Section run, const CaseSpec& spec) {
  const auto within = [&](const Quantity& time) {
    return rational(time) < rational(period_of(spec.mill)) * 1000000000000000;
  };
  const std::string expected = "a time of less than 1e15 drive periods";
  run.require(within(spec.initial_time), "initial_time", expected);
  // Unless given it is the initial time.
  if (run.has("start_time")) run.require(within(spec.statistics_start), "start_time", expected);
  run.require(!spec.end_time || within(*spec.end_time), "end_time", expected);
}

void read_audit(Section audit, AuditSpec& spec) {
  Section columns = audit.section("columns");
  for (const auto& ours : columns.keys())
    if (const auto theirs = columns.text(ours)) spec.columns.emplace_back(ours, *theirs);
  read_keys(audit, spec);
  audit.reject_unknown_keys();
}

/// Digests of 1.0 name its stop rules in this order, and whether they are in force or not.
std::string stop_rules_text(const model::StopLimits<Quantity>& limits) {
  constexpr std::array<std::string_view, 3> of_1_0{"max_milling_dose", "max_ball_speed", "max_collisions"};
  std::string first[of_1_0.size()], others;
  model::for_each_stop_rule([&](auto rule, std::size_t place) {
    const auto& limit = limits[place];
    const std::string line = std::string("\n") + rule.key.key + " " + (limit ? limit->text() : "-");
    const auto found = std::find(of_1_0.begin(), of_1_0.end(), rule.key.key);
    if (found != of_1_0.end())
      first[found - of_1_0.begin()] = line;
    else if (limit)
      others += line;
  });
  return first[0] + first[1] + first[2] + others;
}

/// Everything that a run depends on, in one order and exact.
std::string canonical_text(const CaseSpec& c) {
  std::ostringstream out;
  out << "edmill case 2\nprecision " << c.precision << digest_text(c, true) << stop_rules_text(c.stop_limits)
      << "\ngravity " << digest_of(c.gravity) << "\nmill " << text_of(c.mill) << "\nvessel "
      << text_of(c.vessel) << "\n";
  for (const auto& piston : c.pistons) {
    out << "piston " << piston.wall << " " << piston.distance.text() << " " << piston.speed.text();
    for (const auto& swing : piston.swings)
      out << " " << swing.amplitude.text() << " " << swing.frequency.text() << " " << swing.phase.text();
    out << "\n";
  }
  const auto write_law = [&](const ContactSpec& law) {
    out << "contact " << law.name();
    law.parameters([&](const Parameter&, const Quantity& value) { out << " " << value.text(); });
    out << " " << law.least_separation.text() << "\n";
  };
  write_law(c.ball_ball);
  write_law(c.ball_wall);
  for (const auto& pair : c.pairs) {
    out << "pair " << pair.materials[0] << " " << pair.materials[1] << " ";
    write_law(pair.law);
  }
  if (!c.pairs.empty()) {
    out << "materials";
    for (const int wall : c.wall_materials) out << " " << wall;
    for (const auto& b : c.balls) out << " " << b.material;
    for (const auto& b : c.batches) out << " " << b.material;
    out << "\n";
  }
  for (const auto& b : c.balls) out << "ball" << digest_text(b) << "\n";
  for (const auto& b : c.batches) out << "balls" << digest_text(b) << "\n";
  if (c.target.dose && (c.target.counted.normal_only || c.target.counted.least.positive()))
    out << "counts " << c.target.counted.normal_only << " " << c.target.counted.least.text() << "\n";
  if (!c.initial_state.empty()) {
    out << "initial_state " << sha256(io::read_whole(c.initial_state, "a final_state.csv")) << "\n";
  }
  return out.str();
}

/// @param finished  a run of it is over: the file that it began from is not looked for
CaseSpec parse(const std::string& text, const std::string& name, const std::vector<std::string>& overrides,
               bool finished, SizeLimit sizes = SizeLimit::physical) {
  Document document;
  document.name = name;
  document.sizes = sizes;
  toml::table root = parse_toml(text, "a case file", overrides, document);

  CaseSpec spec;
  spec.file = name;
  spec.text = text;
  spec.settings = overrides;
  Section top(document, &root, "");
  read_run(top.section("run"), spec);
  Section mill = top.section("mill"), vessel = top.section("vessel");
  spec.mill = read_motion(mill);
  if (!top.section("run").has("end_time")) require_end(mill);
  spec.vessel = read_vessel(vessel);
  spec.vessel_colour = vessel.colour("colour", spec.vessel_colour);
  auto pistons = read_pistons(vessel, spec);
  for (const auto& entry : top.sections("material")) read_material(entry, spec);
  read_wall_materials(vessel, spec);
  mill.reject_unknown_keys();
  vessel.reject_unknown_keys();
  if (Section powder = top.section("powder"); powder.present()) {
    spec.powder_mass = powder.required("mass", Dimension::mass);
    powder.require(spec.powder_mass->positive(), "mass", "a positive mass");
    read_keys(powder, spec.target);
    spec.target.counted.normal_only = powder.choice("counts", {"all", "normal"}) == "normal";
    powder.reject_unknown_keys();
  }
  for (const auto& entry : top.sections("ball")) read_ball(entry, spec);
  for (const auto& entry : top.sections("balls")) read_batch(entry, spec);
  read_contact(top.section("contact"), spec);
  for (const auto& entry : top.sections("output", true)) read_output(entry, spec);
  read_audit(top.section("audit"), spec.audit);
  if (!top.has("ball") && !top.has("balls"))
    top.problem("balls", "no balls", "entries [[balls]] or [[ball]]");
  else if (document.problems.empty() && spec.ball_count() == 0)
    top.sections("balls").front().problem("count", "no balls", "a count above 0 in one of the entries");
  top.reject_unknown_keys();
  check_times(top.section("run"), spec);
  if (document.problems.empty()) require_travel(pistons, spec);
  if (!spec.initial_state.empty() && !finished) {
    const std::filesystem::path given(spec.initial_state);
    const bool stream = io::is_stream(spec.initial_state);
    if (given.is_relative() && !stream) spec.initial_state = (io::folder_of(name) / given).string();
    // It is read more than once.
    if (!io::is_readable(spec.initial_state) || (stream && !io::Spool::is_active()))
      top.section("run").problem("initial_state", "no file '" + spec.initial_state + "'",
                                 "a final_state.csv");
  }
  if (!document.problems.empty()) throw InputError(document.problems_by_line());
  if (spec.initial_state.empty() || !finished) spec.digest = sha256(canonical_text(spec));
  return spec;
}

}  // namespace

std::vector<Colour> CaseSpec::ball_colours() const {
  std::vector<Colour> colours;
  for (const auto& ball : balls) colours.push_back(ball.colour);
  for (const auto& batch : batches)
    colours.insert(colours.end(), static_cast<std::size_t>(batch.count), batch.colour);
  return colours;
}

std::string TargetSpec::counts() const {
  std::string text = counted.normal_only ? "the dose along the normal" : "all of the dose";
  if (counted.least.positive())
    text +=
        fmt::format("{} {:g} J or more", counted.normal_only ? " of impacts where it is" : " of impacts of",
                    counted.least.to<double>());
  return text;
}

std::size_t CaseSpec::ball_count() const {
  std::size_t count = balls.size();
  for (const auto& batch : batches) count += static_cast<std::size_t>(batch.count);
  return count;
}

std::vector<std::string> problems_of(const CaseSpec& spec) {
  Document document;
  document.name = spec.file;
  Section top(document, nullptr, "");
  const Section vessel = top.section("vessel"), contact = top.section("contact");
  check(top.section("mill"), spec.mill);
  check(vessel, spec.vessel);
  for (const auto& ball : spec.balls) ball.keys(ball, KeyChecker{top});
  for (const auto& batch : spec.batches) batch.keys(batch, KeyChecker{top});
  check(contact, spec.ball_ball, spec);
  check(contact, spec.ball_wall, spec);
  for (const auto& pair : spec.pairs) check(contact, pair.law, spec);
  check_times(top.section("run"), spec);
  std::vector<Section> pistons(spec.pistons.size(), vessel);
  if (document.problems.empty()) require_travel(pistons, spec);
  return document.problems;
}

CaseSpec parse_case(const std::string& text, const std::string& name,
                    const std::vector<std::string>& overrides) {
  return parse(text, name, overrides, false);
}

CaseSpec parse_close_case(const CaseSpec& spec, const std::vector<std::string>& settings) {
  return parse(spec.text, spec.file, settings, false, SizeLimit::none);
}

std::string text_with_settings(const CaseSpec& spec) {
  std::string text = spec.text;
  for (const auto& setting : spec.settings) {
    text += "\n# --set ";
    for (const char c : setting) text += c == '\n' ? ' ' : c;  // a line of the text for each
  }
  return text;
}

CaseSpec read_case_of_run(const std::string& path, const std::vector<std::string>& settings,
                          const std::string& digest) {
  auto spec = parse(read_file(path, "the case of the run"), path, settings, true);
  if (!spec.digest.empty() && spec.digest != digest)
    throw InputError(path + ": found a case with digest " + spec.digest + ", expected that of the run, " +
                     digest);
  return spec;
}

void add_outputs(const std::string& text, const std::string& name, CaseSpec& spec) {
  Document document;
  document.name = name;
  const toml::table root = parse_toml(text, "entries [[output]]", document);
  Section top(document, &root, "");
  for (const auto& entry : top.sections("output", true)) read_output(entry, spec);
  top.reject_unknown_keys();
  if (!document.problems.empty()) throw InputError(document.problems);
}

std::string describe_gravity(const CaseSpec& spec) {
  const auto& g = spec.gravity;
  if (std::all_of(g.begin(), g.end(), [](const Quantity& q) { return q.zero(); })) return "none";
  return fmt::format("({:g}, {:g}, {:g}) m/s^2", g[0].to<double>(), g[1].to<double>(), g[2].to<double>());
}

model::Partners partners_of(const CaseSpec& spec) {
  return model::partners_of(build_mill<double>(spec).vessel);
}

CaseSpec read_case(const std::string& path, const std::vector<std::string>& overrides) {
  return parse_case(read_file(path, "a case file"), path, overrides);
}

}  // namespace edmill::casefile
