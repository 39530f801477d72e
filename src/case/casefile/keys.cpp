#include "casefile/keys.hpp"

#include <fmt/format.h>

#include <set>
#include <sstream>
#include <utility>

#include "casefile/case_spec.hpp"
#include "casefile/key_reader.hpp"
#include "casefile/output_entry.hpp"
#include "casefile/parts.hpp"
#include "casefile/study_spec.hpp"

namespace edmill::casefile {

namespace {

struct FixedKey {
  std::string_view section, name, kind, fallback, meaning, of = "";
};

// clang-format off
constexpr FixedKey fixed_keys[] = {
    {"run", "precision", "name of a scalar", "`\"double\"`", "scalar of the run; `edmill --version` lists all, and `\"mpfr:3000\"` has 3000 digits"},
    {"run", "gravity", "acceleration, or a vector", "none", "along -Y when it is one number"},

    {"mill", "type", "name", "`\"spex8000\"`", "how the vessel moves"},
    {"mill", "joint", "tables", "required", "from the ground to the vessel, any number of entries `[[mill.joint]]`", "chain"},
    {"mill.joint", "rotate", "axis", "this or `translate`", "`\"x\"`, `\"y\"`, `\"z\"` or three numbers: the axis in the frame of the joint before"},
    {"mill.joint", "translate", "axis or three lengths", "this or `rotate`", "along an axis: `\"x\"`, `\"y\"`, `\"z\"`, or three numbers with `speed` or `swing`; without them, three lengths are a constant shift"},
    {"mill.joint", "angle", "angle", "`\"0 deg\"`", "constant part of a rotation"},
    {"mill.joint", "speed", "angular speed or speed", "`0`", "constant, as the joint rotates or translates; rotations need no common period, a translation needs `run.end_time`"},
    {"mill.joint", "distance", "length", "`\"0 m\"`", "constant part of a translation along `\"x\"`, `\"y\"` or `\"z\"`"},
    {"mill.joint", "swing", "tables", "none", "harmonic parts, amplitude sin(speed t + phase)"},
    {"mill.joint.swing", "amplitude", "angle or length", "required", "as the joint rotates or translates"},
    {"mill.joint.swing", "speed", "angular speed", "required", "2 pi times the frequency"},
    {"mill.joint.swing", "phase", "angle", "`\"0 deg\"`", "at the time 0"},

    {"vessel", "type", "name", "`\"cylinder\"`", "shape of the inside; its y axis is the axis of round vessels"},
    {"vessel", "plane", "tables", "this or `vertex`", "entries `[[vessel.plane]]`, one for each wall", "polyhedron"},
    {"vessel", "vertex", "tables", "this or `plane`", "entries `[[vessel.vertex]]`, the corners of a convex vessel", "polyhedron"},
    {"vessel", "colour", "colour", "yellow", "in pictures: a name, three integers up to 255 or three decimals up to 1"},
    {"vessel", "material", "name", "none", "of all walls"},
    {"vessel", "materials", "table", "none", "by wall, `[vessel.materials]`"},
    {"vessel", "piston", "tables", "none", "flat walls that move, entries `[[vessel.piston]]`"},
    {"vessel.plane", "normal", "three numbers", "required", "outward, of any length"},
    {"vessel.plane", "distance", "length", "required", "from the vessel's origin, which is inside"},
    {"vessel.vertex", "at", "three lengths", "required", "in the vessel frame"},
    {"vessel.materials", "*", "name", "`vessel.material`", "the key is a wall by its label or its number: `\"cap +y\"`, `wall_1`"},
    {"vessel.piston", "wall", "name", "required", "a flat wall by its label or its number: `\"cap -y\"`, `wall_0`"},
    {"vessel.piston", "distance", "length", "`\"0 m\"`", "inward of the wall's nominal position at time 0"},
    {"vessel.piston", "speed", "speed", "`\"0 m/s\"`", "inward; needs `run.end_time`"},
    {"vessel.piston", "swing", "tables", "none", "harmonic parts, amplitude sin(speed t + phase)"},
    {"vessel.piston.swing", "amplitude", "length", "required", "inward"},
    {"vessel.piston.swing", "speed", "angular speed", "required", "2 pi times the frequency"},
    {"vessel.piston.swing", "phase", "angle", "`\"0 deg\"`", "at the time 0"},

    {"contact", "model", "name", "`\"walton-braun\"`", "the contact law"},
    {"contact", "restitution_normal", "number", "none", "another name of `restitution`", "walton-braun, constant"},
    {"contact", "restitution_by_speed", "list of pairs", "required", "points `[[\"0.1 m/s\", 0.9], [\"3 m/s\", 0.6]]`; straight lines between, constant beyond", "restitution-by-speed"},
    {"contact", "tangential_by_slip", "list of pairs", "required", "points `[[0, -0.4], [3, 0.1]]` of the ratio of slip to approach, and e_t; straight lines between, constant below the first, sliding beyond the last", "restitution-by-slip"},
    {"contact", "least_separation", "speed", "`\"1 cm/s\"`", "bodies do not separate more slowly after an impact; `\"0 m/s\"` is the exact model, which ends at a Zeno point"},
    {"contact", "ball_ball", "table", "none", "keys that override those of `[contact]` between balls"},
    {"contact", "ball_wall", "table", "none", "keys that override those of `[contact]` at walls"},
    {"contact", "pair", "tables", "none", "keys that override those of `[contact]` between two materials, entries `[[contact.pair]]`"},
    {"contact.pair", "materials", "two names", "required", "beside these, all keys of `[contact]` that describe a law"},

    {"powder", "mass", "mass", "required", "for the charge ratio and the specific dose"},
    {"powder", "counts", "`\"all\"` or `\"normal\"`", "`\"all\"`", "which part of the dose counts toward the target: all of it, or the part along the normal"},

    {"balls", "material", "name", "none", "of a `[[material]]`"},

    {"ball", "material", "name", "none", "of a `[[material]]`"},

    {"output", "type", "name", "required", "which table or picture"},
    {"output", "file", "text", "type and extension", "a plain name; a table whose name ends in `.h5` is written as HDF5"},
    {"output", "folder", "text", "the run's folder", "inside the run's folder; created if absent"},
    {"output", "append", "true or false", "false", "of CSV: keep the content of the file and add to it; outputs that all append can share a file"},
    {"output", "only", "table", "all impacts", "only impacts with these values of flags and counts"},
    {"output.only", "*", "true, false or count", "", "the key is a flag or a count"},
    {"output.columns", "variable", "name", "required", "a variable; of `trends_balls` a quantity of a ball"},
    {"output.columns", "statistics", "list of names", "required", "`sum`, `average`, `minimum`, `maximum`, `rate` (per second), `percentage` (of the total's sum); of flags `sum`, `rate` and `percentage`. Not of `trends_instant`"},
    {"output.columns", "label", "text", "the variable's name", "in the table's header"},
    {"output.columns", "true_text", "text", "`\"1\"`", "for a flag that is true", "trends_instant"},
    {"output.columns", "false_text", "text", "`\"0\"`", "for a flag that is false", "trends_instant"},
    {"output.columns", "with_ball", "true or false", "false", "also which ball has the minimum or maximum", "trends_balls"},

    {"audit", "columns", "table", "none", "names of columns in the other code's log, `[audit.columns]`"},
    {"audit.columns", "*", "text", "the same name", "ours = theirs, with a unit in brackets: `approach_speed = \"vn [mm/s]\"`"},

    {"sweep", "case", "file", "required", "relative to the sweep file"},
    {"sweep", "precision", "name of a scalar", "that of the case", "of all runs"},
    {"sweep", "max_cpu_time", "time", "none", "of processor time, after which a run ends without a result"},
    {"sweep", "grid", "table", "none", "every combination of the values, `[sweep.grid]`"},
    {"sweep", "point", "tables", "none", "single points, each with all of the grid, entries `[[sweep.point]]`"},
    {"sweep.grid", "*", "list of values", "", "the key is one of the case, as `--set` takes it, or `charge_ratio`"},
    {"sweep.point", "name", "text", "none", "of the point in the tables"},
    {"sweep.point", "set", "table", "this or a list", "keys of the case with their values"},
    {"sweep.point", "balls", "tables", "those of the case", "whole list, entries `[[sweep.point.balls]]`"},
    {"sweep.point", "ball", "tables", "those of the case", "whole list, entries `[[sweep.point.ball]]`"},
    {"sweep.point.set", "*", "value", "", "the key is one of the case"},

    {"optimize", "case", "file", "required", "relative to the optimisation file"},
    {"optimize", "precision", "name of a scalar", "that of the case", "of all runs"},
    {"optimize", "max_cpu_time", "time", "none", "of processor time, after which a run ends without a result"},
    {"optimize", "objective", "name", "`\"specific_milling_dose_rate\"`", "this or `milling_dose_rate`"},
    {"optimize", "variable", "tables", "required", "one to three entries `[[optimize.variable]]`"},
    {"optimize.variable", "key", "text", "required", "a key of the case, or `charge_ratio`"},
    {"optimize.variable", "low", "value", "required without `values`", "lower bound"},
    {"optimize.variable", "high", "value", "required without `values`", "upper bound"},
    {"optimize.variable", "integer", "true or false", "false", "whole numbers only"},
    {"optimize.variable", "values", "list of values", "none", "the only values, in place of bounds"},
};

constexpr SectionText texts[] = {
    {"run", "[run]", "Begin and end of the run, its scalar, gravity."},
    {"mill", "[mill]", "How the vessel moves."},
    {"mill.joint", "[[mill.joint]]", "Joints of a chain."},
    {"mill.joint.swing", "swing of [[mill.joint]]", "A list of tables: `swing = [{ amplitude = \"5 mm\", speed = \"1500 rpm\" }]`."},
    {"vessel", "[vessel]", "Shape, walls and materials of the vessel, inside."},
    {"vessel.plane", "[[vessel.plane]]", "Walls of a polyhedron."},
    {"vessel.vertex", "[[vessel.vertex]]", "Corners of a polyhedron."},
    {"vessel.materials", "[vessel.materials]", "Materials of single walls."},
    {"vessel.piston", "[[vessel.piston]]", "A wall that stands inward of its nominal position by distance + speed t + swings."},
    {"vessel.piston.swing", "swing of [[vessel.piston]]", "A list of tables."},
    {"material", "[[material]]", "Materials of balls and walls."},
    {"contact", "[contact]", "The contact law. `[contact.ball_ball]`, `[contact.ball_wall]` and `[[contact.pair]]` take the same keys except the last three."},
    {"contact.pair", "[[contact.pair]]", "A law for two materials."},
    {"powder", "[powder]", "Powder that the balls mill."},
    {"balls", "[[balls]]", "Batches of balls, placed at random after the single balls."},
    {"ball", "[[ball]]", "Single balls."},
    {"output", "[[output]]", "Tables and pictures that the run writes."},
    {"output.only", "only of [[output]]", "`only = { ball_ball = false, partner = 1 }`"},
    {"output.columns", "columns of [[output]]", "A list of tables, one for each column."},
    {"output.contact_point", "contact_point of [[output]]", "A table."},
    {"audit", "[audit]", "How `edmill audit` reads another code's log."},
    {"audit.columns", "[audit.columns]", "Names of columns."},
    {"sweep", "[sweep]", "Of a sweep file."},
    {"sweep.grid", "[sweep.grid]", "Values of keys."},
    {"sweep.point", "[[sweep.point]]", "Single points."},
    {"sweep.point.set", "set of [[sweep.point]]", "A table."},
    {"optimize", "[optimize]", "Of an optimisation file."},
    {"optimize.variable", "[[optimize.variable]]", "What is varied."},
};
// clang-format on

/// The sections whose keys stand in a struct.
struct KeyedSection {
  std::string_view section;
  void (*see)(const SeeKey& see);
};
constexpr KeyedSection keyed_sections[] = {
    {"run", see_keys<CaseSpec>},     {"material", see_keys<MaterialSpec>},
    {"balls", see_keys<BallBatch>},  {"ball", see_keys<ExplicitBall>},
    {"output", see_keys<TimerSpec>}, {"output.contact_point", see_keys<ContactPointSpec>},
    {"audit", see_keys<AuditSpec>},  {"powder", see_keys<TargetSpec>},
    {"sweep", see_keys<SweepSpec>},  {"optimize", see_keys<OptimizeSpec>},
};

class Table {
 public:
  Table() {
    for (const auto& section : texts) {
      const std::string name(section.name);
      // What chooses a type comes before the keys of the types.
      add_fixed(name, true);
      for (const auto& keyed : keyed_sections)
        if (keyed.section == name) keyed.see(adder(name, ""));
      if (name == "run") add_stop_rules();
      if (name == "mill") add_parts<MotionSpec>(name);
      if (name == "vessel") add_parts<VesselSpec>(name);
      if (name == "contact") add_parts<model::NamedLaws<Quantity>>(name);
      add_fixed(name, false);
      if (name == "output") add_outputs();
    }
    for (const auto& text : texts)
      if (text.name.find('.') == std::string_view::npos) names_.insert("." + std::string(text.name));
    for (const auto& key : rows_) names_.insert(key.section + "." + key.name);
  }

  const std::vector<Key>& rows() const { return rows_; }
  bool has(const std::string& section, const std::string& name) const {
    return names_.contains(section + "." + name) || names_.contains(section + ".*");
  }

 private:
  void add_fixed(const std::string& section, bool choice) {
    for (const auto& k : fixed_keys)
      if (k.section == section && (k.name == "type" || k.name == "model") == choice)
        rows_.push_back({section, std::string(k.of), std::string(k.name), std::string(k.kind),
                         std::string(k.fallback), std::string(k.meaning) + (choice ? choices(section) : "")});
  }

  /// ": `cylinder`, `box`", of the keys that choose a type.
  static std::string choices(const std::string& section) {
    if (section == "mill") return names_of<MotionSpec>();
    if (section == "vessel") return names_of<VesselSpec>();
    if (section == "contact") return names_of<model::NamedLaws<Quantity>>();
    return ": see the types of outputs above";
  }
  template <class Variant>
  static std::string names_of() {
    return fmt::format(": `{}`", fmt::join(names_of_kinds<Variant>(), "`, `"));
  }

  /// A parameter that several types have in the same sense is one row.
  void add(Key key) {
    for (auto& row : rows_) {
      if (row.section != key.section || row.name != key.name || row.kind != key.kind ||
          row.fallback != key.fallback || row.meaning != key.meaning || row.of.empty())
        continue;
      if (row.of.find(key.of) == std::string::npos) row.of += ", " + key.of;
      return;
    }
    rows_.push_back(std::move(key));
  }

  template <class Variant>
  void add_parts(const std::string& section) {
    for_each_kind<Variant>([&](const auto& part) {
      if constexpr (
          requires { part.given; } || requires { part.faces; })
        return;
      const auto see = adder(section, part.name);
      part.parameters(part, [&](const Parameter& p, const auto& value) {
        if (p.key) see(p, kind_of(p, value), default_of(p, false));
      });
    });
  }

  SeeKey adder(const std::string& section, const std::string& of) {
    return [this, section, of](const Parameter& p, const std::string& kind, const std::string& fallback) {
      add({section, of, p.key, kind, fallback, p.meaning});
    };
  }

  void add_stop_rules() {
    const auto see = adder("run", "");
    model::for_each_stop_rule([&](auto rule, std::size_t) {
      see(rule.key, kind_of(rule.key, Quantity{}), default_of(rule.key, true));
    });
  }

  void add_outputs() {
    for (const auto& type : output_types()) {
      for (const auto& k : type.keys)
        add({"output", std::string(type.name), std::string(k.name), std::string(k.kind),
             std::string(k.fallback), std::string(k.meaning)});
      if (type.see) type.see(adder("output", std::string(type.name)));
    }
  }

  std::vector<Key> rows_;
  std::set<std::string> names_;
};

const Table& table() {
  static const Table table;
  return table;
}

/// "output.0.columns.1" is a section "output.columns".
std::string section_of(const std::string& path) {
  std::string section;
  std::istringstream parts(path);
  for (std::string part; std::getline(parts, part, '.');)
    if (part.find_first_not_of("0123456789") != std::string::npos)
      section += (section.empty() ? "" : ".") + part;
  return section;
}

}  // namespace

std::span<const SectionText> section_texts() { return texts; }

const std::vector<Key>& keys() { return table().rows(); }

bool is_key(const std::string& path, const std::string& name) {
  const auto section = section_of(path);
  if (table().has(section, name)) return true;
  const bool law =
      section == "contact.ball_ball" || section == "contact.ball_wall" || section == "contact.pair";
  return law && table().has("contact", name);
}

}  // namespace edmill::casefile
