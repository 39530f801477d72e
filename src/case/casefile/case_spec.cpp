#include "casefile/case_spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <sstream>

#include "base/digest.hpp"
#include "base/errors.hpp"
#include "base/scalar.hpp"
#include "casefile/build_case.hpp"
#include "casefile/output_entry.hpp"
#include "casefile/rational.hpp"
#include "casefile/tables.hpp"
#include "io/input_file.hpp"

namespace edmill::casefile {

namespace {

using boost::multiprecision::cpp_int;

void read_run(Section& run, CaseSpec& spec) {
  run.require(run.present(), "end_time", "a section [run] with at least one stop rule");
  read_keys(run, spec);
  check_precision(run, spec.precision);
  run.require(!spec.digits || !run.has("precision"), "digits", "digits or a precision, not both");
  if (!run.has("start_time")) spec.statistics_start = spec.initial_time;
  run.require(spec.statistics_start >= spec.initial_time, "start_time",
      "a time not before the initial time");
  if (spec.end_time)
    run.require(*spec.end_time > spec.statistics_start, "end_time", "a time after the start time");
  bool stops = run.has("end_time");
  std::string rules = "end_time";
  model::for_each_stop_rule([&](auto rule, std::size_t) {
    stops = stops || run.has(rule.key.key);
    rules += std::string(", ") + rule.key.key;
  });
  if (!stops) run.problem("end_time", "nothing", "at least one of " + rules);
  run.reject_unknown_keys();
}

/// A ball's own density, or that of its material.
void read_density(Section& s, BallSpec& ball, const CaseSpec& spec) {
  ball.material = material_of(s, "material", ball.material_name, spec);
  if (ball.material == 0) return;
  const auto& material = spec.materials[static_cast<std::size_t>(ball.material) - 1];
  if (!material.density && !s.has("density"))
    s.problem("density", "nothing",
        describe(Dimension::density) + ": material \"" + material.name + "\" has none");
  if (!material.density) return;
  ball.density = *material.density;
  if (s.has("density"))
    s.problem("density", "a density in addition to that of material \"" + material.name + "\"",
        "one of them");
}

/// The number of balls whose mass is nearest to that of the batch.
void count_by_mass(Section& s, BallBatch& batch) {
  if (!batch.mass || !batch.diameter.positive() || !batch.density.positive()) return;
  if (s.has("count")) return s.problem("mass", "both 'count' and 'mass'", "one of them");
  const double d = batch.diameter.to<double>();
  const double one = batch.density.to<double>() * std::numbers::pi / 6 * d * d * d;
  const double count = std::round(batch.mass->to<double>() / one);
  s.require(count <= largest_count, "mass",
      "that of at most " + std::to_string(largest_count) + " balls");
  batch.count = count <= largest_count ? static_cast<int>(count) : 0;
}

void read_materials(Entries<MaterialSpec>& entries, CaseSpec& spec) {
  read_entries(entries, [&](Section& entry, MaterialSpec& material) {
    entry.require(material.name.empty() || spec.material_named(material.name) == 0, "name",
        "a name that no other material has");
    // An invalid density is reported here, but not again at each ball of the material.
    if (entry.has("density") && !(material.density && material.density->positive()))
      material.density = BallSpec{}.density;
    spec.materials.push_back(std::move(material));
  });
}

/// vessel.material and [vessel.materials].
void read_wall_materials(Section& vessel, VesselTable& table, CaseSpec& spec) {
  const int common = material_of(vessel, "material", table.material, spec);
  if (vessel.of_unknown_kind()) return;
  Section& walls = *table.materials.section;
  Named<WallName> given;
  read_keys(walls, given);
  const auto known = known_vessel(spec);
  if (!known) return;
  const auto partners = model::partners_of(*known);
  spec.wall_materials.assign(static_cast<std::size_t>(partners.walls()), common);
  std::vector<std::string> labels;
  for (int wall = 0; wall < partners.walls(); ++wall) labels.push_back(partners[wall].label);
  std::set<int> named;
  for (const auto& key : given) {
    const int wall = wall_named(key, partners);
    if (wall < 0) {
      walls.problem(key, "a wall that the vessel does not have", one_of(labels));
      continue;
    }
    if (!named.insert(wall).second)
      walls.problem(
          key, "two materials for a wall, one by its key and one by its label", "one of them");
    spec.wall_materials[static_cast<std::size_t>(wall)] =
        material_of(walls, key, walls.text(key).value_or(""), spec);
  }
}

void read_balls(CaseFile& file, CaseSpec& spec) {
  read_entries(file.balls, [&](Section& s, ExplicitBall& ball) {
    ball.where = s.where();
    read_density(s, ball, spec);
    if (!s.has("position") && spec.initial_state.empty())
      s.problem("position", "nothing", "an array of three lengths");
    spec.balls.push_back(std::move(ball));
  });
  read_entries(file.batches, [&](Section& s, BallBatch& batch) {
    batch.where = s.where();
    read_density(s, batch, spec);
    count_by_mass(s, batch);
    const bool narrow = batch.diameter_spread < batch.diameter || !batch.diameter.positive();
    s.require(narrow, "diameter_spread", "a length from 0 to less than the diameter");
    if (batch.random_speed && s.has("velocity"))
      s.problem("random_speed", "both 'velocity' and 'random_speed'", "one of them");
    spec.batches.push_back(std::move(batch));
  });
}

/// Reports times that are too large: instants count drive periods in an integer.
void check_times(Section run, const CaseSpec& spec) {
  const auto within = [&](const Quantity& time) {
    return rational(time) < rational(period_of(spec.mill)) * 1000000000000000;
  };
  const std::string expected = "a time of less than 1e15 drive periods";
  run.require(within(spec.initial_time), "initial_time", expected);
  // The default is the initial time.
  if (run.has("start_time")) run.require(within(spec.statistics_start), "start_time", expected);
  run.require(!spec.end_time || within(*spec.end_time), "end_time", expected);
}

/// Lines of [run]: first the keys of version 1.0, even without a value, then later ones if given.
std::string text_of_run(const CaseSpec& c) {
  constexpr std::array<std::string_view, 8> of_1_0{"precision", "seed", "initial_time",
      "start_time", "end_time", "max_milling_dose", "max_ball_speed", "max_collisions"};
  std::string first[of_1_0.size()], others;
  for (const auto& [key, value, named] : digest_values(c)) {
    const auto found = std::find(of_1_0.begin(), of_1_0.end(), key);
    if (found == of_1_0.end() && value == "-") continue;
    (found == of_1_0.end() ? others : first[found - of_1_0.begin()]) += "\n" + key + " " + value;
  }
  std::string text;
  for (const auto& line : first) text += line;
  return text + others;
}

/// " 1 0 4/5": the values of an entry.
std::string values_of(const auto& entry) {
  std::string text;
  for (const auto& [key, value, named] : digest_values(entry))
    text += " " + (named ? key + " " : "") + value;
  return text;
}

/// Everything that a run depends on, in one order and exact.
std::string canonical_text(const CaseSpec& c) {
  std::ostringstream out;
  out << "edmill case 2" << text_of_run(c) << "\nmill " << text_of(c.mill) << "\nvessel "
      << text_of(c.vessel) << "\n";
  const auto put = [&](const auto&... numbers) { (out << ... << (" " + numbers.text())); };
  const auto put_swings = [&](const auto& swings) {
    for (const auto& swing : swings) put(swing.amplitude, swing.frequency, swing.phase);
  };
  for (const auto& piston : c.pistons) {
    out << "piston " << piston.wall;
    put(piston.distance, piston.speed);
    put_swings(piston.swings);
    out << "\n";
  }
  for (const auto& body : c.bodies) {
    out << "body " << body.is_round << " " << body.on_vessel;
    put(body.rounding, body.size[0], body.size[1], body.size[2]);
    for (const auto& joint : body.joints) {
      out << " joint " << joint.rotates;
      put(joint.angle, joint.speed);
      for (const auto& [x, y, z] : {joint.axis, joint.shift}) put(x, y, z);
      put_swings(joint.swings);
    }
    out << "\n";
  }
  const auto write_law = [&](const ContactSpec& law) {
    out << "contact " << law.name();
    law.parameters([&](const Parameter&, const Quantity& value) { put(value); });
    put(law.least_separation);
    out << "\n";
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
    c.for_each_ball([&](const BallSpec& b) { out << " " << b.material; });
    out << "\n";
  }
  for (const auto& b : c.balls) out << "ball" << values_of(b) << "\n";
  for (const auto& b : c.batches) out << "balls" << values_of(b) << "\n";
  if (c.target.dose && (c.target.counted.normal_only || c.target.counted.least.positive()))
    out << "counts " << c.target.counted.normal_only << " " << c.target.counted.least.text()
        << "\n";
  if (!c.initial_state.empty())
    out << "initial_state " << sha256(io::read_whole(c.initial_state, "a final_state.csv")) << "\n";
  return out.str();
}

}  // namespace

CaseSpec parse_case(const std::string& text, const std::string& name,
    const std::vector<std::string>& overrides, bool finished, SizeLimit sizes) {
  Document document(name);
  document.sizes = sizes;
  toml::table root = parse_toml(text, "a case file", document, overrides);
  for (const std::string study : {"sweep", "optimize"})
    if (root.contains(study))
      throw InputError(fmt::format(
          "{}: found a section [{}], expected a case file: use edmill {}", name, study, study));

  CaseSpec spec;
  spec.file = name;
  spec.text = text;
  spec.settings = overrides;
  Section top(document, &root, "");
  CaseFile file;
  read_keys(top, file);
  Section &run = *file.run.section, &mill = *file.mill.section, &vessel = *file.vessel.section;
  read_run(run, spec);
  spec.mill = read_motion(mill, "type");
  if (!run.has("end_time")) require_end(mill);
  VesselTable walls;
  read_keys(vessel, walls);
  spec.vessel = std::move(walls.shape);
  spec.vessel_colour = walls.colour;
  read_pistons(vessel, walls.pistons, spec);
  read_materials(file.materials, spec);
  read_wall_materials(vessel, walls, spec);
  read_bodies(file.bodies, spec);
  mill.reject_unknown_keys();
  vessel.reject_unknown_keys();
  if (Section& section = *file.powder.section; section.present()) {
    PowderTable powder;
    read_all_keys(section, powder);
    spec.powder_mass = powder.mass;
    spec.target = powder.target;
    spec.target.counted.normal_only = powder.counts == CountedPart::normal;
  }
  read_balls(file, spec);
  read_contact(*file.contact.section, spec);
  for (auto& entry : file.outputs) read_output(entry, spec);
  read_all_keys(*file.audit.section, spec.audit);
  if (!top.has("ball") && !top.has("balls"))
    top.problem("balls", "nothing", "entries [[balls]] or [[ball]]");
  else if (document.problems.empty() && spec.ball_count() == 0)
    file.batches.front().problem("count", "0 in all entries", "a count above 0 in one of them");
  top.reject_unknown_keys();
  check_times(run, spec);
  if (document.problems.empty()) require_travel(walls.pistons, spec);
  if (document.problems.empty()) require_bodies_inside(file.bodies, spec);
  if (!spec.initial_state.empty() && !finished) {
    const bool stream = io::is_stream(spec.initial_state);
    if (!stream) spec.initial_state = (io::folder_of(name) / spec.initial_state).string();
    // It is read more than once.
    if (!io::is_readable(spec.initial_state) || (stream && !io::Spool::is_active()))
      run.problem("initial_state", "\"" + spec.initial_state + "\", which cannot be read",
          "a final_state.csv");
  }
  if (!document.problems.empty()) throw InputError(document.problems_by_line());
  if (spec.initial_state.empty() || !finished) spec.digest = sha256(canonical_text(spec));
  return spec;
}

int material_of(
    Section& section, const std::string& key, const std::string& name, const CaseSpec& spec) {
  if (name.empty()) return 0;
  const int material = spec.material_named(name);
  std::vector<std::string> names;
  for (const auto& m : spec.materials) names.push_back(m.name);
  section.require(
      material > 0, key, names.empty() ? "the name of a [[material]] entry" : one_of(names));
  return material;
}

std::optional<model::AnyVessel<double>> known_vessel(const CaseSpec& spec) try {
  return build_mill<double>(spec).vessel;
} catch (const InputError&) {
  return std::nullopt;
}

int wall_named(const std::string& name, const model::Partners& partners) {
  int wall = partners.walls() - 1;
  while (wall >= 0 && name != partners[wall].label && name != partners[wall].key) --wall;
  return wall;
}

int CaseSpec::material_named(const std::string& name) const {
  const auto found = std::find_if(
      materials.begin(), materials.end(), [&](const auto& m) { return m.name == name; });
  return found == materials.end() ? 0 : static_cast<int>(found - materials.begin()) + 1;
}

void Gravity::read_from(Section& run, const char* key) {
  if (run.is_array(key))
    QuantityVector::operator=(run.vector(key, Dimension::acceleration).value_or(QuantityVector{}));
  else if (const auto strength = run.quantity(key, Dimension::acceleration))
    (*this)[1] = -*strength;
}

std::optional<ColumnName> ColumnName::read(Section& columns, const std::string& ours) {
  const auto theirs = columns.text(ours);
  return theirs ? std::optional(ColumnName(ours, *theirs)) : std::nullopt;
}

std::string TargetSpec::counts() const {
  std::string text = counted.normal_only ? "the dose along the normal" : "all of the dose";
  if (counted.least.positive())
    text += fmt::format("{} {:g} J or more",
        counted.normal_only ? " of impacts where it is" : " of impacts of",
        counted.least.to<double>());
  return text;
}

std::vector<std::string> problems_of(const CaseSpec& spec) {
  Document document(spec.file);
  Section top(document, nullptr, "");
  const Section vessel = top.section("vessel"), contact = top.section("contact");
  check(top.section("mill"), spec.mill);
  check(vessel, spec.vessel);
  spec.for_each_ball([&](const auto& ball) { ball.keys(ball, KeyChecker{top}); });
  check(contact, spec.ball_ball, spec);
  check(contact, spec.ball_wall, spec);
  for (const auto& pair : spec.pairs) check(contact, pair.law, spec);
  for (const auto& body : spec.bodies)
    for (const auto& half : body.core())
      top.require(!half.negative() && !body.rounding.negative(), "body",
          "sizes of at least twice the rounding");
  check_times(top.section("run"), spec);
  std::vector<Section> pistons(spec.pistons.size(), vessel);
  if (document.problems.empty()) require_travel(pistons, spec);
  return document.problems;
}

std::string WrittenNumber::plus(int sign, unsigned digits) const {
  const Rational value = rational(*parse_decimal(number));
  // Both are integers over a power of ten.
  cpp_int scale = pow(cpp_int(10), digits), step = 1;
  int exponent = -static_cast<int>(digits);
  for (; scale % denominator(value) != 0; scale *= 10, step *= 10) --exponent;
  const cpp_int sum = numerator(value) * (scale / denominator(value)) + sign * step;
  const std::string text = sum.str() + "e" + std::to_string(exponent);
  return unit.empty() ? text : text + " " + unit;
}

WrittenNumber value_of_key(const CaseSpec& spec, const std::string& key) {
  Document document(spec.file);
  const auto table = parse_toml(spec.text, "a case file", document, spec.settings);
  const auto* node = node_at(table, key);
  const std::string text =
      node && (node->is_string() || node->is_number()) ? document.raw(*node, key) : "";
  const auto end = std::min(text.find_first_not_of("0123456789+-.eE"), text.size());
  WrittenNumber found{text.substr(0, end), ""};
  const auto unit = text.find_first_not_of(' ', end);
  if (unit != std::string::npos) found.unit = text.substr(unit);
  if (!parse_decimal(found.number))
    throw InputError(fmt::format("{}: key '{}': {}, expected a number in the case file or in --set",
        spec.file, key, text.empty() ? "missing" : "found \"" + text + "\""));
  return found;
}

std::optional<std::string> text_of_key(const CaseSpec& spec, const std::string& key) try {
  const auto value = value_of_key(spec, key);
  return value.number + (value.unit.empty() ? "" : " " + value.unit);
} catch (const InputError&) {
  return std::nullopt;
}

CaseSpec with_value(
    const CaseSpec& spec, const std::string& key, const std::string& value, SizeLimit sizes) {
  auto settings = spec.settings;
  const bool plain = value.find(' ') == std::string::npos;  // a number without a unit
  settings.push_back(key + "=" + (plain ? value : "\"" + value + "\""));
  return parse_case(spec.text, spec.file, settings, false, sizes);
}

std::string text_with_settings(const CaseSpec& spec) {
  std::string text = spec.text;
  for (const auto& setting : spec.settings) {
    text += "\n# --set ";
    for (const char c : setting) text += c == '\n' ? ' ' : c;  // a line of the text for each
  }
  return text;
}

CaseSpec read_case_of_run(
    const std::string& path, const std::vector<std::string>& settings, const std::string& digest) {
  auto spec = parse_case(io::read_whole(path, "the case of the run (TOML)"), path, settings, true);
  if (!spec.digest.empty() && spec.digest != digest)
    throw InputError(path + ": found a case with digest " + spec.digest +
        ", expected that of the run, " + digest);
  return spec;
}

void add_outputs(const std::string& text, const std::string& name, CaseSpec& spec) {
  Document document(name);
  const toml::table root = parse_toml(text, "entries [[output]]", document);
  Section top(document, &root, "");
  for (auto& entry : top.sections("output", true)) read_output(entry, spec);
  top.reject_unknown_keys();
  if (!document.problems.empty()) throw InputError(document.problems_by_line());
}

model::Partners partners_of(const CaseSpec& spec) {
  return model::partners_of(build_mill<double>(spec));
}

CaseSpec read_case(const std::string& path, const std::vector<std::string>& overrides) {
  return parse_case(io::read_whole(path, "a case file (TOML)"), path, overrides);
}

const std::vector<std::string>& precisions() {
  static const auto names = [] {
    std::vector<std::string> all{"double", "float128"};
#if !defined(EDMILL_WITHOUT_MPFR)
    for (const unsigned digits : named_digits) all.push_back("mpfr" + std::to_string(digits));
#endif
    return all;
  }();
  return names;
}

std::string choices_of_precision() {
  return fmt::format("one of \"{}\", \"mpfr:DIGITS\" with {} to {} digits",
      fmt::join(precisions(), "\", \""), fewest_digits, most_digits);
}

bool is_precision(const std::string& name) {
  return name == "double" || name == "float128" || chosen_digits_of(name) > 0;
}

double digits_of(const std::string& precision) {
  if (precision == "double") return 15.95;
  if (precision == "float128") return 34.02;
  return chosen_digits_of(precision);
}

void check_precision(Section& section, std::string& name) {
  if (is_precision(name)) return;
  section.require(false, "precision", choices_of_precision());
  name = precisions().front();
}

}  // namespace edmill::casefile
