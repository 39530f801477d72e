// A case as written in its file: exact quantities, not yet converted to a scalar type.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "casefile/output_spec.hpp"
#include "casefile/quantity.hpp"
#include "model/case.hpp"
#include "model/contact_law.hpp"
#include "model/motion.hpp"
#include "model/parts/partners.hpp"
#include "model/stop_rules.hpp"
#include "model/vessel.hpp"

namespace edmill::casefile {

class Section;

using QuantityVector = std::array<Quantity, 3>;
using MotionSpec = model::NamedMotions<Quantity>;
using VesselSpec = model::NamedVessels<Quantity>;

/// Calls visit(kind) with a value of each type that a variant can hold, in their order.
template <class Variant, class Visit> void for_each_kind(const Visit& visit) {
  const auto visit_all = [&]<class... Kind>(const std::variant<Kind...>*) { (visit(Kind{}), ...); };
  visit_all(static_cast<const Variant*>(nullptr));
}

/// The names of these types.
template <class Variant> std::vector<std::string> names_of_kinds() {
  std::vector<std::string> names;
  for_each_kind<Variant>([&](const auto& kind) { names.emplace_back(kind.name); });
  return names;
}

/// The name of a part's type, "spex8000".
template <class... Part> std::string name_of(const std::variant<Part...>& part) {
  return std::visit([](const auto& p) { return std::string(p.name); }, part);
}

/// Period of the drive, or the clock unit of a still vessel [s].
inline const Quantity& period_of(const MotionSpec& motion) {
  const auto own = [](const auto& m) -> const Quantity& {
    if constexpr (requires { m.period; })
      return m.period;
    else
      return m.given.period;
  };
  return std::visit(own, motion);
}

/// Type and parameters, exact: "cylinder 19/500 57/1000".
template <class... Part> std::string text_of(const std::variant<Part...>& part) {
  std::string text = name_of(part);
  const auto add = [&](const Quantity& number) { text += " " + number.text(); };
  const auto add_all = [&](const model::Parameter&, const auto& value) {
    model::for_each_number(value, add);
  };
  std::visit([&](const auto& p) { p.parameters(p, add_all); }, part);
  return text;
}

/// Any motion as joints from the ground to the vessel.
std::vector<model::Joint<Quantity>> joints_of(const MotionSpec& motion);

/// The joints, each with the exact number of its turns in a drive period.
model::Joints<Quantity> with_phases(model::Joints<Quantity> joints);

/// The swings, each with the exact number of its turns in a drive period.
std::vector<model::Swing<Quantity>> with_phases(
    std::vector<model::Swing<Quantity>> swings, const Quantity& period);

/// "turn about y at 300 rpm, shift by (0.15, 0, 0) m, turn about y at -600 rpm".
std::string equation_of(const model::Joints<Quantity>& joints);
/// " + 0.01 m sin(2 pi 5 t)" for each.
std::string equation_of(const std::vector<model::Swing<Quantity>>& swings, bool rotate);

/// Returns the number of a key as written in the file, "38 mm"; nothing if there is none.
using Written = std::function<std::optional<std::string>(const std::string& key)>;
/// "cylinder: diameter 38 mm, height 57 mm", for readers. @param written  otherwise in SI
std::string describe(const MotionSpec& motion, const Written& written = {});
std::string describe(const VesselSpec& vessel, const Written& written = {});

/// Reads type and parameters of [mill] or [vessel]. @param key  the one of the type
MotionSpec read_motion(Section& mill, const char* key);
VesselSpec read_vessel(Section& vessel, const char* key);

/// An entry [[material]].
struct MaterialSpec {
  std::string name;
  std::optional<Quantity> density;

  static constexpr const char* what = "Materials of balls and walls.";
  static void keys(auto& m, auto&& row) {
    row({"name", "name by which balls, walls and pairs refer to the material"}, m.name);
    row({"density", Dimension::density,
            "density of balls of this material; required if they give none themselves",
            Range::positive},
        m.density);
  }
};

/// Keys that single balls and batches have in common.
struct BallSpec {
  int count = 1;
  Quantity diameter, diameter_spread;
  Quantity density{8000};
  std::string material_name;
  int material = 0;  ///< number in CaseSpec::materials, from 1; 0 for none
  Quantity reduced_inertia{2, 5};
  QuantityVector velocity{};
  Colour colour{0, 0, 1};
  std::string where;  ///< "case.toml:12: [[balls]] 1", for messages

  static constexpr Parameter diameter_key{
      "diameter", Dimension::length, "diameter of each ball", Range::positive};
  static constexpr Parameter density_key{"density", Dimension::density,
      "density of the balls; omit it if their material has one", Range::positive, "8 g/cm3"};
  static constexpr Parameter inertia_key{"reduced_inertia", Dimension::none,
      "moment of inertia divided by m R^2; 0.4 for a solid sphere", Range::share, "0.4"};
  static constexpr Parameter colour_key{"colour", Dimension::none, "colour in pictures", Range::any,
      nullptr, "blue", Parameter::Digest::none};
  static constexpr Parameter material_key =
      Parameter{"material", "name of a `[[material]]`"}.as("name").usually("none").undigested();
  static constexpr Parameter velocity_of(const char* meaning) {
    return {"velocity", Dimension::speed, meaning, Range::any, nullptr, "at rest"};
  }
};

inline constexpr int largest_count = 100000000;  ///< of balls

/// A batch of balls placed at random. (thesis D.2.4)
struct BallBatch : BallSpec {
  std::optional<Quantity> mass;          ///< of the batch; determines the count
  std::optional<Quantity> random_speed;  ///< largest; magnitude and direction are random
  Quantity gap_ball{1, 1000};
  Quantity gap_wall{1, 1000};
  std::uint64_t max_relocations = 100000;

  static constexpr const char* what = "Batches of balls, placed at random after the single balls.";
  static void keys(auto& b, auto&& row) {
    row({"count", "number of balls, placed at random", {0, largest_count}, "1"}, b.count);
    row({"mass", Dimension::mass,
            "mass of the whole batch, in place of `count`; gives the nearest number of balls",
            Range::not_negative, nullptr, "none", Parameter::Digest::none},
        b.mass);
    row(diameter_key, b.diameter);
    row({"diameter_spread", Dimension::length,
            "half-width of the uniform distribution of diameters about `diameter`",
            Range::not_negative, "0 m"},
        b.diameter_spread);
    row(density_key, b.density);
    row(inertia_key, b.reduced_inertia);
    row(velocity_of("initial velocity of each ball of the batch"), b.velocity);
    row({"random_speed", Dimension::speed,
            "each ball gets a random direction and a random speed up to this one, in place of "
            "`velocity`",
            Range::not_negative},
        b.random_speed);
    row({"gap_ball", Dimension::length, "smallest initial distance to other balls",
            Range::not_negative, "1 mm"},
        b.gap_ball);
    row({"gap_wall", Dimension::length, "smallest initial distance to walls", Range::not_negative,
            "1 mm"},
        b.gap_wall);
    row({"max_relocations", "largest number of attempts to place a ball", Range::any, "100000"},
        b.max_relocations);
    row(colour_key, b.colour);
    row(material_key, b.material_name);
  }
};

/// A ball with its state at the initial time, in the inertial frame.
struct ExplicitBall : BallSpec {
  QuantityVector position{};
  QuantityVector spin{};

  static constexpr const char* what = "Single balls.";
  static void keys(auto& b, auto&& row) {
    row(diameter_key, b.diameter);
    row(density_key, b.density);
    row(inertia_key, b.reduced_inertia);
    row({"position", Dimension::length, "initial position of the centre, in the inertial frame",
            Range::any, nullptr, "required without `run.initial_state`"},
        b.position);
    row(velocity_of("initial velocity, in the inertial frame"), b.velocity);
    row({"spin", Dimension::angular_speed, "initial angular velocity, in the inertial frame",
            Range::any, nullptr, "none"},
        b.spin);
    row(colour_key, b.colour);
    row(material_key, b.material_name);
  }
};

using ContactSpec = model::ContactLaw<Quantity>;

/// An entry [[contact.pair]].
struct PairSpec {
  std::array<int, 2> materials{};  ///< from 1
  ContactSpec law;

  bool is_of(int one, int other) const {
    return materials == std::array{one, other} || materials == std::array{other, one};
  }
};

/// An entry [[body]], or one of its copies.
struct Solid {
  std::string name;
  bool is_round = false;  ///< a cylinder, otherwise a box
  QuantityVector size{};  ///< edges, or diameter, height and diameter, over all [m]
  Quantity rounding{};    ///< of the edges [m]
  bool on_vessel = true;  ///< its joints begin at the vessel, otherwise at the ground
  std::vector<model::Joint<Quantity>> joints;
  Colour colour{};
  std::string where;  ///< "case.toml:12: [[body]] 1", for messages

  /// Half edges of the core.
  QuantityVector core() const;
};

/// A column of another code's log: its name here, and its name there with its unit, "t [ms]".
struct ColumnName : std::pair<std::string, std::string> {
  using pair::pair;
  static constexpr const char* what = "Names of columns.";
  static constexpr Parameter entry = described_key("*", "text", "the same name",
      "edmill's name = the log's name, with a unit in brackets: `approach_speed = \"vn [mm/s]\"`");
  static std::optional<ColumnName> read(Section& section, const std::string& ours);
};

/// Section [audit]: how another code's collision log is to be read and judged. docs/audit.md
struct AuditSpec {
  Named<ColumnName> columns;
  std::optional<Quantity> tolerance, gap_tolerance;
  std::optional<std::uint64_t> first_ball;
  std::string walls;  ///< "-1, -2, -3": the log's numbers of the walls, by id; empty when not given
  bool from_start = false;

  static constexpr const char* what = "How `edmill audit` reads another code's log.";
  static void keys(auto& a, auto&& row) {
    row({"tolerance", "relative tolerance", Range::share, nullptr, "1e-9"}, a.tolerance);
    row({"gap_tolerance", Dimension::length, "largest gap or overlap of bodies in contact",
            Range::positive, nullptr, "by rounding"},
        a.gap_tolerance);
    row({"first_ball", "number of the log's first ball", Range(0, largest_count), nullptr, "0"},
        a.first_ball);
    row({"walls", "the log's numbers of the walls, in the order of edmill's ids: `\"1, 2, 3\"`",
            Range::any, nullptr, "those of edmill"},
        a.walls);
    row({"from_start", "the log begins at the initial state of the case", Range::any, "false"},
        a.from_start);
    row({"columns", "names of columns in the other code's log, `[audit.columns]`"}, a.columns);
  }
};

/// Keys of [powder]: the target dose, and which impacts count toward it.
struct TargetSpec {
  std::optional<Quantity> dose;
  model::CountedDose<Quantity> counted{false, {}};

  static void keys(auto& t, auto&& row) {
    row({"target_dose", Dimension::specific_energy,
            "target milling dose per mass of powder, \"10 kJ/g\", from which the milling time "
            "follows",
            Range::positive, nullptr, "none"},
        t.dose);
    row({"counts_above", Dimension::energy,
            "smallest dose of an impact, of the kind `counts`, that counts toward the target",
            Range::not_negative, "0 J"},
        t.counted.least);
  }
  /// "the dose along the normal, of impacts with 0.001 J of it or more", for readers.
  std::string counts() const;
};

/// An acceleration along -Y, or a vector of three.
struct Gravity : QuantityVector {
  void read_from(Section& run, const char* key);
};

struct CaseSpec {
  std::string file;                   ///< path of the case file
  std::string text;                   ///< of the case file
  std::vector<std::string> settings;  ///< that override the file, "section.key=value"
  bool reported = false;              ///< the outputs of the report were added to those of the file
  std::string digest;                 ///< SHA-256 of the case's canonical text
  std::string precision = "double";
  std::optional<std::uint64_t> digits;        ///< that must be correct; determines the precision
  std::optional<std::uint64_t> right_digits;  ///< correct digits, by comparison of two runs
  std::uint64_t seed = 1;
  Quantity initial_time, statistics_start;
  std::optional<Quantity> end_time;
  model::StopLimits<Quantity> stop_limits;
  std::string initial_state;  ///< path of a final_state.csv, or empty
  Gravity gravity{};
  MotionSpec mill;
  VesselSpec vessel;
  std::vector<model::Piston<Quantity>> pistons;
  Colour vessel_colour{1, 1, 0};  ///< in pictures
  std::vector<Solid> bodies;      ///< inside the vessel; numbered as walls, after the vessel's own
  std::vector<MaterialSpec> materials;
  std::vector<int> wall_materials;  ///< by wall and body, from 1; 0 for none
  ContactSpec ball_ball, ball_wall;
  std::vector<PairSpec> pairs;  ///< replace both for the named pairs of materials
  bool pairs_only = false;      ///< every possible contact has a law among them
  std::optional<Quantity> powder_mass;
  TargetSpec target;
  std::vector<ExplicitBall> balls;
  std::vector<BallBatch> batches;
  std::vector<OutputSpec> outputs;
  AuditSpec audit;  ///< affects neither the simulation nor the digest

  static constexpr const char* what = "Start and end of the run, its scalar, and gravity.";
  static void keys(auto& c, auto&& row) {
    row({"seed", "seed of the random placement of balls", Range::any, "1"}, c.seed);
    row({"digits",
            "number of correct digits in every number of the logs, with all events in their true "
            "order; edmill chooses the precision",
            {1, 100000}, nullptr, nullptr, Parameter::Digest::none},
        c.digits);
    row({"initial_time", Dimension::time, "time of the initial state", Range::not_negative, "0 s"},
        c.initial_time);
    row({"start_time", Dimension::time, "start of the statistics", Range::any, nullptr,
            "`initial_time`"},
        c.statistics_start);
    row({"end_time", Dimension::time,
            "end of the run; this or another stop rule, such as `max_collisions`, is required, and "
            "the first one met ends the run"},
        c.end_time);
    row({"initial_state",
            "`final_state.csv` to start from, relative to the case file; the properties of the "
            "balls are those of the case",
            Range::any, nullptr, "none", Parameter::Digest::none},
        c.initial_state);
    model::for_each_stop_rule(
        [&](auto rule, std::size_t place) { row(rule.key, c.stop_limits[place]); });
    row(Parameter{"precision",
            "scalar of the run; `edmill --version` lists all, and `\"mpfr:3000\"` has 3000 digits",
            Range::any, "double", "`\"double\"`"}
            .as("name of a scalar"),
        c.precision);
    row(Parameter{"gravity", Dimension::acceleration,
            "acceleration of gravity; one number acts along -Y"}
            .as("acceleration, or a vector")
            .usually("none"),
        c.gravity);
  }

  /// From 1; 0 when there is none.
  int material_named(const std::string& name) const;
  /// "steel, rubber", for readers.
  std::string names_of(const PairSpec& pair) const {
    return materials[static_cast<std::size_t>(pair.materials[0]) - 1].name + ", " +
        materials[static_cast<std::size_t>(pair.materials[1]) - 1].name;
  }
  /// Calls visit(spec) with each single ball, then with each batch.
  void for_each_ball(const auto& visit) const {
    for (const auto& ball : balls) visit(ball);
    for (const auto& batch : batches) visit(batch);
  }
  std::size_t ball_count() const {
    std::size_t count = 0;
    for_each_ball([&](const BallSpec& b) { count += static_cast<std::size_t>(b.count); });
    return count;
  }
  /// [m]
  double largest_diameter() const {
    double largest = 0;
    for_each_ball([&](const BallSpec& b) {
      largest = std::max(largest, b.diameter.to<double>() + b.diameter_spread.to<double>());
    });
    return largest;
  }
  /// Colours of all balls, in their order.
  std::vector<Colour> ball_colours() const {
    std::vector<Colour> colours;
    for_each_ball([&](const BallSpec& b) {
      colours.insert(colours.end(), static_cast<std::size_t>(b.count), b.colour);
    });
    return colours;
  }
};

/// "0.01 m + 0.001 m sin(2 pi 5 t) inward", for readers.
std::string describe(const model::Piston<Quantity>& piston);
/// The joints of a body, those of the vessel that carries it before its own.
std::vector<model::Joint<Quantity>> joints_from_ground(const Solid& body, const CaseSpec& spec);
/// "box of 60 x 4 x 10 mm, on the ground: turn about y by 600 deg/s t", for readers.
std::string describe(const Solid& body);

/// "(0, -9.8, 0) m/s^2" or "none", for readers.
std::string describe_gravity(const CaseSpec& spec);

/// The walls and bodies that the balls of a case can collide with, and the balls themselves.
model::Partners partners_of(const CaseSpec& spec);

/// Reads and checks a case file.
/// @param overrides  "section.key=value", over the file; a value that is not TOML is a text
/// @throws InputError with every problem of the file: file, line, key, found, expected
CaseSpec read_case(const std::string& path, const std::vector<std::string>& overrides = {});

/// Reads and checks the text of a case; `name` is the name of the file in messages.
/// @param finished  the run is over: the file of its initial state need not exist
CaseSpec parse_case(const std::string& text, const std::string& name,
    const std::vector<std::string>& overrides = {}, bool finished = false,
    SizeLimit sizes = SizeLimit::physical);

/// "12.7 mm": digits and unit as they are written.
struct WrittenNumber {
  std::string number, unit;

  /// The exact text of number + sign * 10^-digits, with the unit.
  std::string plus(int sign, unsigned digits) const;
};

/// The number of a key, "balls.0.diameter", as the file or a setting gives it.
/// @throws InputError when the case gives no such number
WrittenNumber value_of_key(const CaseSpec& spec, const std::string& key);
/// The number of a key with its unit as text, "12.7 mm"; nothing if the case gives no such number.
std::optional<std::string> text_of_key(const CaseSpec& spec, const std::string& key);

/// The case with another value of a key, read anew; without SizeLimit even 1e-380, for differences.
CaseSpec with_value(const CaseSpec& spec, const std::string& key, const std::string& value,
    SizeLimit sizes = SizeLimit::physical);

/// Problems for which a file with the numbers of this case, changed since it was read, is refused.
std::vector<std::string> problems_of(const CaseSpec& spec);

/// The text of a case file, followed by the settings over it as comments, for readers.
std::string text_with_settings(const CaseSpec& spec);

/// The case that a run left in its folder, a file with `text_with_settings`. If the run began from
/// a final state, that file is not read, and the digest, which depends on it, is empty.
/// @param settings  of the run, which override the file
/// @throws InputError also when the case has another digest
CaseSpec read_case_of_run(
    const std::string& path, const std::vector<std::string>& settings, const std::string& digest);

/// Adds the entries [[output]] of a text. @throws InputError for a wrong one or a taken file's name
void add_outputs(const std::string& text, const std::string& name, CaseSpec& spec);

/// The scalars of a fixed number of digits, the narrowest first: "double", "float128"...
const std::vector<std::string>& precisions();

/// True if the name is one of these, or "mpfr:DIGITS".
bool is_precision(const std::string& name);

/// The valid names, for messages.
std::string choices_of_precision();

/// Decimal digits of a scalar. @pre is_precision(precision)
double digits_of(const std::string& precision);

/// Reports an unknown value of the key `precision` and replaces it by "double".
void check_precision(Section& section, std::string& name);

/// Lack of memory as an error message that names the case.
class OutOfMemory : public std::bad_alloc {
 public:
  explicit OutOfMemory(const CaseSpec& spec)
      : text_(spec.file + ": not enough memory for " + std::to_string(spec.ball_count()) +
            " balls: use fewer balls, or a computer with more memory") {}
  const char* what() const noexcept override { return text_.c_str(); }
 private:
  std::string text_;
};

/// Calls work() and returns its result. @throws OutOfMemory when there is too little memory
auto with_memory_for(const CaseSpec& spec, const auto& work) try {
  return work();
} catch (const std::bad_alloc&) {
  throw OutOfMemory(spec);
} catch (const std::length_error&) {
  throw OutOfMemory(spec);
}

}  // namespace edmill::casefile
