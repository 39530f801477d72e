#include "decks/deck.hpp"

#include <fmt/args.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/version.hpp"
#include "casefile/build_case.hpp"
#include "casefile/case_spec.hpp"
#include "decks/moving_vessel.hpp"
#include "decks/soft_contact.hpp"

namespace edmill::decks {

// Templates with named fields, the files *.in of this folder. One that may be empty ends its line.
extern const std::string_view lammps_in, lammps_frame_in, liggghts_in, pose_in, yade_in,
    yade_planes_in, yade_triangles_in;

namespace {

using namespace std::string_literals;

const double turn = 2 * numerics::pi<double>();  ///< [rad]

/// Parameters of a contact law in a DEM code.
struct SoftLaw {
  double restitution, friction;
  double damping;  ///< soft_contact.hpp
};

/// The data from which a deck is written; SI.
struct DeckCase {
  const std::string& file;
  DeckOptions options;
  std::vector<model::BallProperties<double>> balls;
  std::vector<model::BallState<double>> states;  ///< inertial
  SoftLaw of_balls, of_walls;
  model::Mill<double> mill;
  model::Joints<double> joints;                       ///< of the vessel
  double begin;                                       ///< time of the states [s]
  model::AnyPose<double> pose;                        ///< of the vessel at the begin
  std::vector<model::Joints<double>> of_bodies = {};  ///< from the ground
  std::vector<bool> on_vessel = {};                   ///< by body
  /// Values of the templates' fields, by name.
  fmt::dynamic_format_arg_store<fmt::format_context> fields = {};

  /// Adds fields: names, each followed by its value.
  void add(const char* name, const auto& value, const auto&... more) {
    fields.push_back(fmt::arg(name, value));
    if constexpr (sizeof...(more) > 0) add(more...);
  }
  Instant<double> at_begin() const { return DriveClock<double>(mill.motion.period()).at(begin); }
  std::string filled(std::string_view text) const { return fmt::vformat(text, fields); }

  /// Density of a ball as given in the case: computed from the mass, without its rounding.
  double density(std::size_t ball) const {
    const double r = balls[ball].radius, volume = 4.0 / 3 * numerics::pi<double>() * r * r * r;
    return std::stod(fmt::format("{:.14g}", balls[ball].mass / volume));
  }
  /// No joint turns: the vessel translates, or is at rest.
  bool translates() const {
    const auto rotates = [](const auto& joint) { return joint.rotates; };
    return std::none_of(joints.list.begin(), joints.list.end(), rotates);
  }
};

SoftLaw soft_law(
    const model::ContactLaw<double>& law, const std::string& file, const DeckOptions& options) {
  if (law.name() != std::string("walton-braun"))
    throw InputError(
        fmt::format("{}: key 'contact.model': found \"{}\", expected \"walton-braun\": a deck has "
                    "contacts of one restitution and friction",
            file, law.name()));
  SoftLaw soft{};
  law.parameters([&](const model::Parameter& p, double value) {
    if (p.key == std::string("restitution")) soft.restitution = value;
    if (p.key == std::string("friction")) soft.friction = value;
  });
  if (soft.restitution < 0.05)
    throw InputError(
        fmt::format("{}: key 'contact.restitution': found {}, expected 0.05 or more: with a lower "
                    "one the contacts of DEM codes stick",
            file, soft.restitution));
  soft.damping = damping_for(soft.restitution, options.steps,
      options.code == "yade" ? Separation::attracts : Separation::free);
  return soft;
}

void refuse_what_no_code_has(
    const casefile::CaseSpec& spec, const casefile::InitialCase<double>& built) {
  std::vector<std::string> problems;
  const auto problem = [&](const std::string& found, const std::string& expected) {
    problems.push_back(fmt::format("{}: found {}, expected {}", spec.file, found, expected));
  };
  if (!spec.pistons.empty())
    problem("pistons",
        "walls that move together: decks have no walls that move relative to each other");
  if (!spec.pairs.empty())
    problem("laws of pairs of materials", "one law between balls and one at walls");
  const auto& balls = built.the_case.balls;
  const auto is_hollow = [](const auto& ball) {
    return std::abs(ball.reduced_inertia - 0.4) > 1e-12;
  };
  if (const auto hollow = std::find_if(balls.begin(), balls.end(), is_hollow);
      hollow != balls.end())
    problem(fmt::format("a reduced inertia of {}", hollow->reduced_inertia),
        "0.4: DEM codes have solid spheres");
  if (!problems.empty()) throw InputError(problems);
}

model::Joints<double> in_double(const model::Joints<casefile::Quantity>& joints) {
  return model::converted_joints<double>(
      joints, [](const casefile::Quantity& q) { return q.to<double>(); });
}

/// Gravity as a command of LAMMPS and LIGGGHTS; empty where there is none.
std::string weight_of(const Vec3<double>& g) {
  const double size = norm<double>(g);
  if (!(size > 0)) return "";
  return fmt::format(
      "fix weight all gravity {} vector {}\n", size, fmt::join(Vec3<double>(g / size), " "));
}

bool moves(const model::Joint<double>& joint) { return joint.speed != 0 || !joint.swings.empty(); }

/// Unit; zero for a joint without one.
std::array<double, 3> axis_of(const model::Joint<double>& joint) {
  auto axis = joint.axis;
  const double length = std::hypot(axis[0], axis[1], axis[2]);
  for (double& part : axis) part = length > 0 ? part / length : 0;
  return axis;
}

/// The text of a formula; empty for zero.
struct Formula {
  std::string text;

  Formula(double x = 0) : text(x == 0 ? "" : x == 1 ? "1" : fmt::format("({})", x)) {}
  Formula(std::string written) : text(std::move(written)) {}

  Formula operator-() const { return text.empty() ? text : "(-1)*(" + text + ")"; }
  Formula operator+(const Formula& b) const {
    return text.empty() || b.text.empty() ? text + b.text : text + "+" + b.text;
  }
  Formula operator-(const Formula& b) const { return *this + -b; }
  Formula& operator+=(const Formula& b) { return *this = *this + b; }
  Formula operator*(const Formula& b) const {
    if (text.empty() || b.text.empty()) return {};
    if (text == "1") return b;
    return b.text == "1" ? text : text + "*" + b.text;
  }
};
using FormulaVector = Vec3<Formula>;

FormulaVector numbers(const std::array<double, 3>& x) { return {x[0], x[1], x[2]}; }

/// [0.003 * sin(62.8 * t + 0.5)]: the speed and swings of a joint at the time `t`, times a factor.
Formula moved_formula(const model::Joint<double>& joint, double factor, const std::string& time) {
  Formula sum;
  if (joint.speed != 0) sum += fmt::format("{}*{}", factor * joint.speed, time);
  for (const auto& s : joint.swings)
    if (s.amplitude != 0)
      sum += fmt::format(
          "{}*sin({}*{}+{})", factor * s.amplitude, turn * s.frequency, time, turn * s.phase);
  return sum;
}

/// The sum of all translations along each axis at the time `t`, as a formula of LAMMPS and Python.
/// @pre none of the joints turns
std::array<Formula, 3> displacement_formulas(
    const std::vector<model::Joint<double>>& joints, const std::string& time) {
  std::array<Formula, 3> sums;
  for (const auto& joint : joints) {
    const auto axis = axis_of(joint);
    for (std::size_t k = 0; k < 3; ++k) {
      if (joint.shift[k] != 0) sums[k] += fmt::format("{}", joint.shift[k]);
      if (axis[k] != 0) sums[k] += moved_formula(joint, axis[k], time);
    }
  }
  for (auto& sum : sums)
    if (sum.text.empty()) sum.text = "0.0";
  return sums;
}

/// A chain of joints as rows of a list in Python.
std::string joints_in_python(const model::Joints<double>& chain) {
  std::string joints;
  for (const auto& j : chain.list) {
    std::string swings;
    for (const auto& s : j.swings)
      swings += fmt::format("({}, {}, {}), ", j.rotates ? turn * s.amplitude : s.amplitude,
          turn * s.frequency, turn * s.phase);
    joints += fmt::format("    ({}, np.array([{}]), np.array([{}]), {}, {}, [{}]),\n",
        j.rotates ? "True" : "False", fmt::join(axis_of(j), ", "), fmt::join(j.shift, ", "),
        turn * j.angle, j.rotates ? turn * j.speed : j.speed, swings);
  }
  return joints;
}

/// Needs `import numpy as np`.
std::string pose_in_python(DeckCase& c) {
  c.add("joints", joints_in_python(c.joints));
  return c.filled(pose_in);
}

/// The balls as commands of LAMMPS and LIGGGHTS.
/// @param spin  format of the command that sets the spin
std::string atoms_of(const DeckCase& c, const char* spin, bool also_at_rest) {
  std::string text, sets;
  for (std::size_t k = 0; k < c.balls.size(); ++k) {
    const auto& [x, v, w] = c.states[k];
    text += fmt::format("create_atoms 1 single {} {} {} units box\n", x[0], x[1], x[2]);
    sets += fmt::format(
        "set atom {} diameter {} density {}\n", k + 1, 2 * c.balls[k].radius, c.density(k));
    if (also_at_rest || norm<double>(v) > 0 || norm<double>(w) > 0)
      sets += fmt::format("set atom {} vx {} vy {} vz {} ", k + 1, v[0], v[1], v[2]) +
          fmt::format(fmt::runtime(spin), w[0], w[1], w[2]) + "\n";
  }
  return text + sets;
}

/// Writes the number of facets of a round wall to the deck, for `facts_of_deck`, and notes about
/// triangles.
void tell_triangles(DeckCase& c, const std::vector<WallMesh>& meshes, Deck& deck) {
  const int facets = c.options.facets;
  const bool is_round = std::any_of(
      meshes.begin(), meshes.end(), [](const WallMesh& mesh) { return mesh.smooth_angle > 0; });
  c.add("facets", is_round ? fmt::format("# facets {}\n", facets) : "");
  if (is_round)
    deck.notes.push_back(
        fmt::format("the cylinder is a prism of {} facets around it, {:.2g} % wider at its corners",
            facets, 100 * (1 / std::cos(numerics::pi<double>() / facets) - 1)));
  if (!c.mill.bodies.empty())
    deck.notes.push_back(
        "bodies in the vessel are triangles; round parts are prisms of 48 facets within them, 0.2 "
        "% narrower in the middle of a facet");
}

// LAMMPS of 2021 and later: exact regions. Regions turn about one axis at most, so a vessel that
// turns is simulated in its own frame, with fictitious forces and torques computed in Python.

using Place = std::array<double, 3>;

std::string block(const Place& p, const Vec3<double>& half) {
  return fmt::format("block {} {} {} {} {} {}", p[0] - half[0], p[0] + half[0], p[1] - half[1],
      p[1] + half[1], p[2] - half[2], p[2] + half[2]);
}
std::string upright(const Place& p, double radius, double half_height) {
  return fmt::format(
      "cylinder y {} {} {} {} {}", p[0], p[2], radius, p[1] - half_height, p[1] + half_height);
}

std::string region_of(const DeckCase& c, const std::string& moves) {
  const auto& v = c.mill.vessel;
  const auto region = [&](const std::string& shape) {
    return "region vessel " + shape + " side in units box" + moves + "\n";
  };
  if (const auto* box = v.get_if<model::BoxVessel<double>>()) return region(block({}, box->half));
  if (const auto* cylinder = v.get_if<model::CylinderVessel<double>>())
    return region(upright({}, cylinder->radius, cylinder->half_height));
  if (const auto* sphere = v.get_if<model::SphereVessel<double>>())
    return region(fmt::format("sphere 0 0 0 {}", sphere->radius));
  throw InputError(
      fmt::format("{}: key 'vessel.type': found a vessel that is not a single region of LAMMPS, "
                  "expected cylinder, box or sphere",
          c.file));
}

/// The motion of a region in LAMMPS: it turns about an axis through the origin, then it is shifted.
struct RegionMotion {
  std::vector<model::Joint<double>> shifts;
  Place axis{}, place{};  ///< place: of the body, before it turns [m]
  Formula angle;
};

InputError no_region(const DeckCase& c, std::size_t body, const char* found, const char* expected) {
  return InputError(
      fmt::format("{}: found {}, {}, expected {}, as LAMMPS's regions require; LIGGGHTS and YADE "
                  "represent bodies by triangles",
          c.file, c.mill.bodies[body].name.label, found, expected));
}

/// @throws InputError for a body that turns about several axes, or that slides on a part that turns
RegionMotion motion_of_region(const DeckCase& c, std::size_t k) {
  auto joints = c.of_bodies[k].list;
  if (!c.translates()) {  // in the vessel's frame
    const auto& vessel = c.joints.list;
    if (c.on_vessel[k]) joints.erase(joints.begin(), joints.begin() + std::ssize(vessel));
    for (std::size_t j = 0; j < vessel.size() && !c.on_vessel[k]; ++j) {
      auto back = vessel[j];
      back.angle = -back.angle;
      for (auto& part : back.shift) part = -part;
      joints.insert(joints.begin(), back);
    }
  }
  RegionMotion motion;
  auto& [shifts, axis, place, angle] = motion;
  const Place none{};
  for (const auto& joint : joints) {
    if (joint.rotates) {
      const auto own = axis_of(joint);
      if (axis == none) axis = own;
      const Vec3<double> off(place.data()), about(own.data());
      if (own != axis || norm<double>(cross<double>(off, about)) > 1e-15)
        throw no_region(
            c, k, "whose joints turn about several axes", "one that turns about one axis");
      angle += Formula(turn * joint.angle) + moved_formula(joint, turn, "v_t");
    } else if (axis == none) {
      shifts.push_back(joint);
    } else if (moves(joint)) {
      throw no_region(
          c, k, "which slides on a joint that turns", "one that slides before it turns");
    } else {
      for (std::size_t i = 0; i < 3; ++i) place[i] += joint.shift[i];
    }
  }
  return motion;
}

/// A body as a region of LAMMPS, and the fix of its contacts. Regions have sharp edges.
std::string body_of(const DeckCase& c, std::size_t k, const std::string& contact) {
  const auto& body = c.mill.bodies[k];
  const auto motion = motion_of_region(c, k);
  const auto& place = motion.place;
  const auto& half = body.shape.half();
  const double rounding = body.shape.rounding();
  const bool sphere = half == Vec3<double>::Zero();
  if (rounding > 0 && !sphere)
    throw no_region(c, k, "with rounded edges", "sharp edges or a sphere");
  std::string text,
      region = sphere         ? fmt::format("sphere {} {}", fmt::join(place, " "), rounding)
      : body.shape.is_round() ? upright(place, half[0], half[1])
                              : block(place, half);
  const auto shift = displacement_formulas(motion.shifts, "v_t");
  for (std::size_t i = 0; i < 3; ++i)
    text += fmt::format("variable shift{}{} equal {}\n", k, "xyz"[i], shift[i].text);
  region += fmt::format(" side out units box move v_shift{0}x v_shift{0}y v_shift{0}z", k);
  if (!motion.angle.text.empty()) {
    text += fmt::format("variable angle{} equal {}\n", k, motion.angle.text);
    region += fmt::format(" rotate v_angle{} 0 0 0 {}", k, fmt::join(motion.axis, " "));
  }
  return text +
      fmt::format(
          "region body{0} {1}\nfix body{0} all wall/gran/region granular {2} region body{0}\n", k,
          region, contact);
}

/// The parameter of LAMMPS's `damping tsuji` for a law.
double tsuji_of(const DeckCase& c, const SoftLaw& law) {
  if (law.damping > 1.2728)
    throw InputError(
        fmt::format("{}: key 'contact.restitution': found {}, expected {:.2g} or more: LAMMPS's "
                    "damping tsuji allows no lower one",
            c.file, law.restitution, restitution_of(1.2728, c.options.steps) + 0.005));
  return lammps_restitution(law.damping);
}

void put_in_vessel(DeckCase& c) {
  const auto& motion = c.mill.motion;
  const Vec3<double> turning = motion.angular_velocity(c.pose);
  for (auto& [x, v, w] : c.states) {
    const auto seen = motion.to_vessel_frame(c.pose, x, v);
    x = seen.position, v = seen.velocity, w = motion.in_axes(c.pose, w - turning);
  }
}

/// @return the commands for fictitious forces and torques. They use the velocity at the step.
std::string fictitious_forces(DeckCase& c) {
  std::string masses, radii;
  for (const auto& ball : c.balls) {
    masses += fmt::format("{}, ", ball.mass);
    radii += fmt::format("{}, ", ball.radius);
  }
  c.add("pose", pose_in_python(c), "masses", masses, "radii", radii);
  return c.filled(lammps_frame_in);
}

Deck lammps_deck(DeckCase& c) {
  const bool in_vessel = !c.translates(),
             at_rest = std::none_of(c.joints.list.begin(), c.joints.list.end(), moves);
  for (std::size_t k = 0; k < c.mill.bodies.size(); ++k)
    if (in_vessel && !at_rest && !c.on_vessel[k])
      throw InputError(fmt::format(
          "{}: found {} on the ground in a vessel that turns, expected a body on the vessel or a "
          "vessel that does not turn: the deck computes in the vessel's frame",
          c.file, c.mill.bodies[k].name.label));
  if (in_vessel) put_in_vessel(c);
  c.add("forces", in_vessel && !at_rest ? fictitious_forces(c) : "");
  const auto time = fmt::format("variable t equal {}+step*dt\n", c.begin);
  std::string vessel;
  if (!in_vessel) {
    const auto formulas = displacement_formulas(c.joints.list, "v_t");
    vessel = time;
    for (std::size_t k = 0; k < 3; ++k)
      vessel += fmt::format("variable move{} equal {}\n", "xyz"[k], formulas[k].text);
  }
  const bool shifted = !in_vessel && !c.joints.list.empty();
  c.add("frame", in_vessel ? "vessel" : "laboratory", "balls", atoms_of(c, "omega {} {} {}", true));
  c.add("tsuji", tsuji_of(c, c.of_balls));
  c.add("vessel", vessel + region_of(c, shifted ? " move v_movex v_movey v_movez" : ""));
  c.add("wall_tsuji", tsuji_of(c, c.of_walls), "weight",
      !in_vessel    ? weight_of(c.mill.gravity)
          : at_rest ? weight_of(c.mill.motion.in_axes(c.pose, c.mill.gravity))
                    : "");
  std::string bodies;
  if (in_vessel && !c.mill.bodies.empty()) bodies = time;
  const auto contact = c.filled(
      "hertz/material {young:.12g} {wall_tsuji:.9g} {poisson:g} tangential mindlin NULL 0.0 "
      "{wall_friction:.12g} damping tsuji limit_damping");
  for (std::size_t k = 0; k < c.mill.bodies.size(); ++k) bodies += body_of(c, k, contact);
  c.add("bodies", bodies);
  const auto file = c.options.name + ".in";
  Deck deck{{{file, c.filled(lammps_in)}}, "lmp -in " + file, {}};
  if (in_vessel && !at_rest)
    deck.notes = {
        "the vessel turns, which LAMMPS's regions do about one axis at most: the deck computes in "
        "the vessel's frame, with fictitious forces by python3-lammps"};
  return deck;
}

// LIGGGHTS 3.8: walls are triangles, moved by several commands: rotations about fixed axes through
// the origin, and a translation by the remaining velocity. Their formulas are built joint by joint.

/// Orientation, spin, place and velocity of the vessel or a body as variables of LIGGGHTS.
class Chain {
 public:
  /// @param prefix  of the names of its variables
  Chain(const model::Joints<double>& joints, std::string prefix) : prefix_(std::move(prefix)) {
    for (const auto& joint : joints.list)
      joint.rotates ? add_rotation(joint) : add_translation(joint);
    // The velocity that the material point at the origin has.
    for (int i = 0; i < 3; ++i) velocity[i] = named(velocity[i] - named(spin.cross(centre_))[i]);
    // A rotation acts on the position at the beginning of a step, before the translation.
    const auto turned_shift = named(spin.cross(velocity));
    velocity = named(velocity + Formula("(0.5*dt)"s) * turned_shift);
  }

  std::string lines;             ///< definitions of the variables
  FormulaVector spin, velocity;  ///< each "v_q7" or empty
 private:
  using Joint = model::Joint<double>;
  using Matrix = Eigen::Matrix<Formula, 3, 3>;

  /// Defines a variable for a formula, unless that is as short as a variable.
  Formula named(const Formula& formula) {
    const auto& text = formula.text;
    const bool is_variable =
        text.starts_with("v_") && text.find_first_of("*+(") == std::string::npos;
    if (text.empty() || text == "1" || is_variable) return formula;
    const auto name = fmt::format("{}q{}", prefix_, count_++);
    lines += fmt::format("variable {} equal {}\n", name, text);
    return "v_" + name;
  }
  template <class Formulas>
  typename Formulas::PlainObject named(const Eigen::MatrixBase<Formulas>& formulas) {
    typename Formulas::PlainObject variables = formulas;
    for (auto& variable : variables.reshaped()) variable = named(variable);
    return variables;
  }
  /// The joint's own coordinate and its rate.
  std::pair<Formula, Formula> coordinate(const Joint& joint, double unit) {
    Formula value = joint.rotates ? unit * joint.angle : 0, rate = unit * joint.speed;
    if (joint.speed != 0) value += rate * "v_t"s;
    for (const auto& s : joint.swings) {
      const auto phase = fmt::format("({}*v_t+{})", turn * s.frequency, turn * s.phase);
      value += Formula(unit * s.amplitude) * ("sin" + phase);
      rate += Formula(unit * s.amplitude * turn * s.frequency) * ("cos" + phase);
    }
    return {named(value), named(rate)};
  }
  void add_rotation(const Joint& joint) {
    const auto [angle, rate] = coordinate(joint, turn);
    const auto n = numbers(axis_of(joint)), axis = named(orientation_ * n);
    spin = named(spin + axis * rate);
    if (angle.text.empty()) return;
    // Rodrigues: cos + (1 - cos) n n + sin [n].
    const auto cosine = named("cos(" + angle.text + ")"), sine = named("sin(" + angle.text + ")"),
               rest = named("1-" + cosine.text);
    Matrix turned;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const Formula across = i == j ? cosine : n[3 - i - j] * sine;
        turned(i, j) = named(n[i] * n[j] * rest + (j == (i + 1) % 3 ? -across : across));
      }
    orientation_ = named(orientation_ * turned);
  }

  void add_translation(const Joint& joint) {
    const auto [way, rate] = coordinate(joint, 1);
    const auto axis = numbers(axis_of(joint)),
               placed = named(orientation_ * named(numbers(joint.shift) + axis * way)),
               moving = named(orientation_ * (axis * rate)), carried = named(spin.cross(placed));
    for (int i = 0; i < 3; ++i) {
      centre_[i] = named(centre_[i] + placed[i]);
      velocity[i] = named(velocity[i] + moving[i] + carried[i]);
    }
  }

  std::string prefix_;
  int count_ = 0;
  Matrix orientation_ = Matrix::Identity();
  FormulaVector centre_;
};

std::string moves_of(const Chain& chain, const std::vector<WallMesh>& meshes) {
  constexpr const char* axes[] = {"1 0 0", "0 1 0", "0 0 1"};
  std::string text;
  for (const auto& mesh : meshes) {
    for (std::size_t k = 0; k < 3; ++k)
      if (!chain.spin[k].text.empty())
        text += fmt::format(
            "fix turn_{0}_{1} all move/mesh mesh {0} rotate/variable origin 0 0 0 axis {2} omega "
            "{3}\n",
            mesh.name, "xyz"[k], axes[k], chain.spin[k].text);
    if (!chain.velocity.sum().text.empty()) {
      std::string speeds;
      for (std::size_t k = 0; k < 3; ++k)
        speeds += " " + (chain.velocity[k].text.empty() ? "v_zero" : chain.velocity[k].text);
      text += fmt::format(
          "fix shift_{0} all move/mesh mesh {0} linear/variable{1}\n", mesh.name, speeds);
    }
  }
  return text;
}

Deck liggghts_deck(DeckCase& c) {
  const auto meshes = meshes_of(c.mill.vessel, c.options.facets);
  if (meshes.empty())
    throw InputError(
        fmt::format("{}: key 'vessel.type': found a vessel with doubly curved walls, expected flat "
                    "walls or a cylinder, which LIGGGHTS can represent by triangles",
            c.file));
  Deck deck{{{}}, fmt::format("liggghts -in {}.in", c.options.name), {}};
  // During a step the commands evaluate their rates with the step number of its end. The rates of
  // its middle keep the walls in place.
  std::string rates = fmt::format("variable t equal {}+(step-0.5)*dt\n", c.begin), walls, names,
              moves;
  const auto put = [&](const WallMesh& mesh, const auto& motion, const auto& pose) {
    const auto file = fmt::format("{}_{}.stl", c.options.name, mesh.name);
    deck.files.push_back({file, stl_text({&mesh, 1}, motion, pose)});
    walls += fmt::format(
        "fix {0} all mesh/surface file {1} type 2 curvature {2:.6g} curvature_tolerant yes\n",
        mesh.name, file, mesh.smooth_angle > 0 ? mesh.smooth_angle : 0.26);
    names += " " + mesh.name;
  };
  const auto move = [&](const model::Joints<double>& joints, const std::string& prefix,
                        const std::vector<WallMesh>& own) {
    const Chain chain(joints, prefix);
    rates += chain.lines;
    moves += moves_of(chain, own);
  };
  for (const auto& mesh : meshes) put(mesh, c.mill.motion, c.pose);
  move(c.joints, "", meshes);
  for (std::size_t k = 0; k < c.mill.bodies.size(); ++k) {
    const auto& body = c.mill.bodies[k];
    const auto mesh = mesh_of(body.shape, fmt::format("body{}", k));
    put(mesh, body.motion, body.motion.pose(c.at_begin()));
    move(c.of_bodies[k], mesh.name, {mesh});
  }
  tell_triangles(c, meshes, deck);
  c.add("balls", atoms_of(c, "omegax {} omegay {} omegaz {}", false), "rates", rates, "walls",
      walls, "mesh_count", meshes.size() + c.mill.bodies.size(), "meshes", names);
  c.add("moves", moves, "weight", weight_of(c.mill.gravity));
  deck.files.front() = {c.options.name + ".in", c.filled(liggghts_in)};
  return deck;
}

// YADE 2023: infinite planes if the vessel only translates, else triangles about its point at rest.

/// True if a point of the vessel or body rests at all sampled times: its centre moves across its
/// spin.
bool turns_about_a_point(const DeckCase& c, const auto& motion) {
  const DriveClock<double> clock(motion.period());
  for (int k = 0; k < 64; ++k) {
    const auto pose = motion.pose(clock.at(c.begin + c.joints.period * k / 64));
    const Vec3<double> spin = motion.angular_velocity(pose),
                       velocity = motion.wall_velocity(
                           pose, motion.to_inertial(pose, Vec3<double>::Zero()));
    const double size = norm<double>(spin), speed = norm<double>(velocity);
    if (speed > 1e-12 && !(size > 1e-9)) return false;
    if (std::abs(dot<double>(spin, velocity)) > 1e-9 * (1 + size * speed)) return false;
  }
  return true;
}

Deck yade_deck(DeckCase& c) {
  const auto* box = c.mill.vessel.get_if<model::BoxVessel<double>>();
  const bool planes = box && c.translates() && c.mill.bodies.empty();
  const auto meshes = meshes_of(c.mill.vessel, c.options.facets);
  for (const auto& body : c.mill.bodies)
    if (!turns_about_a_point(c, body.motion))
      throw InputError(
          fmt::format("{}: found {}, which has no point at rest, expected a body that turns about "
                      "one, as YADE's engines require",
              c.file, body.name.label));
  if (!planes && (meshes.empty() || !turns_about_a_point(c, c.mill.motion)))
    throw InputError(fmt::format(
        "{}: found a {}, expected a box that translates, or flat walls or a cylinder that turn "
        "about a point at rest, as YADE's engines require",
        c.file, meshes.empty() ? "vessel with doubly curved walls" : "motion along its own axis"));
  std::string balls;
  for (std::size_t k = 0; k < c.balls.size(); ++k) {
    const auto& [x, v, w] = c.states[k];
    balls += fmt::format("    (({}), {}, {}, ({}), ({})),\n", fmt::join(x, ", "), c.balls[k].radius,
        c.density(k), fmt::join(v, ", "), fmt::join(w, ", "));
  }
  Deck deck{{{}}, fmt::format("yade -n -x -j1 {}.py", c.options.name), {}};
  tell_triangles(c, meshes, deck);
  c.add("balls", balls);
  if (planes) {
    const auto [x, y, z] = displacement_formulas(c.joints.list, "t");
    c.add("half", fmt::format("{}", fmt::join(box->half, ", ")), "place",
        x.text + ", " + y.text + ", " + z.text);
    c.add("walls", c.filled(yade_planes_in));
  } else {
    std::string solids;
    for (std::size_t k = 0; k < c.mill.bodies.size(); ++k) {
      const auto& body = c.mill.bodies[k];
      const auto mesh = mesh_of(body.shape, fmt::format("body{}", k));
      const auto file = fmt::format("{}_{}.stl", c.options.name, mesh.name);
      solids += fmt::format("    ('{}', [\n{}    ]),\n", file, joints_in_python(c.of_bodies[k]));
      deck.files.push_back(
          {file, stl_text({&mesh, 1}, body.motion, body.motion.pose(c.at_begin()))});
    }
    c.add("pose", pose_in_python(c), "solids", solids);
    c.add("walls", c.filled(yade_triangles_in));
    deck.files.push_back({c.options.name + "_walls.stl", stl_text(meshes, c.mill.motion, c.pose)});
  }
  deck.files.front() = {c.options.name + ".py", c.filled(yade_in)};
  return deck;
}

}  // namespace

Deck make_deck(const casefile::CaseSpec& spec, const DeckOptions& options) {
  const auto built = casefile::build_case<double>(spec);
  refuse_what_no_code_has(spec, built);
  const auto& mill = built.the_case.mill;
  const auto& balls = built.the_case.balls;
  const DriveClock<double> clock(mill.motion.period());
  const double begin = clock.seconds(built.start), time_step = options.contact_time / options.steps;
  const double duration = options.duration > 0 ? options.duration
      : spec.end_time                          ? spec.end_time->to<double>() - begin
                                               : 0;
  const double interval =
      options.frame_interval > 0 ? options.frame_interval : options.contact_time / 5;
  const auto smaller = [](const auto& a, const auto& b) { return a.radius < b.radius; };
  const auto& largest = *std::max_element(balls.begin(), balls.end(), smaller);
  const auto period = casefile::period_of(spec.mill);
  DeckCase c{.file = spec.file,
      .options = options,
      .balls = balls,
      .states = built.states,
      .of_balls = soft_law(mill.ball_ball, spec.file, options),
      .of_walls = soft_law(mill.ball_wall, spec.file, options),
      .mill = mill,
      .joints = in_double({casefile::joints_of(spec.mill), period}),
      .begin = begin,
      .pose = mill.motion.pose(clock.at(begin))};
  for (const auto& body : spec.bodies) {
    c.of_bodies.push_back(in_double({casefile::joints_from_ground(body, spec), period}));
    c.on_vessel.push_back(body.on_vessel);
  }
  if (!(duration > 0))
    throw InputError(spec.file + ": no run.end_time: set it, or give --duration");
  // A ball at an edge between two triangles of YADE touches both, so that they must be few.
  if (c.options.facets == 0) c.options.facets = options.code == "yade" ? 24 : 128;
  const long steps = std::lround(duration / time_step);
  constexpr double poisson = 0.3;
  c.add("file", spec.file, "version", version(), "digest", spec.digest, "name", options.name,
      "contact_time", options.contact_time, "speed", options.speed, "restitution",
      c.of_balls.restitution, "wall_restitution", c.of_walls.restitution, "en",
      formula_restitution(c.of_balls.damping), "wall_en", formula_restitution(c.of_walls.damping),
      "friction", c.of_balls.friction, "wall_friction", c.of_walls.friction);
  c.add("young",
      young_for(options.contact_time, options.speed, largest.radius, largest.mass, poisson),
      "poisson", poisson, "gravity", fmt::format("{}", fmt::join(mill.gravity, ", ")), "reach",
      1.5 * mill.motion.reach(mill.vessel.reach()), "skin", largest.radius / 2);
  c.add("begin", begin, "time_step", time_step, "steps", steps, "frame_every",
      std::max(1L, std::lround(interval / time_step)), "thermo", std::max(1L, steps / 20));
  if (options.code == "lammps") return lammps_deck(c);
  return options.code == "liggghts" ? liggghts_deck(c) : yade_deck(c);
}

}  // namespace edmill::decks
