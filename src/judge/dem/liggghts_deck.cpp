// LIGGGHTS 3.8: walls as triangles that several moves carry along: turns about fixed axes through the origin,
// and the velocity that is left. The formulas of both are written by joints, in its own variables.
#include <fmt/format.h>

#include "base/errors.hpp"
#include "dem/deck.hpp"
#include "dem/soft_contact.hpp"
#include "dem/wall_mesh.hpp"

namespace edmill::dem {

namespace {

/// A formula; empty for zero.
using Formula = std::string;
using FormulaVector = std::array<Formula, 3>;

Formula product(const Formula& a, const Formula& b) {
  if (a.empty() || b.empty()) return "";
  if (a == "1") return b;
  if (b == "1") return a;
  return a + "*" + b;
}
Formula sum(const Formula& a, const Formula& b) {
  if (a.empty() || b.empty()) return a + b;
  return a + "+" + b;
}
Formula negative(const Formula& a) { return a.empty() ? "" : "(-1)*(" + a + ")"; }
Formula number(double x) {
  if (x == 0) return "";
  return x == 1 ? "1" : fmt::format("({})", x);
}
FormulaVector number(const std::array<double, 3>& x) { return {number(x[0]), number(x[1]), number(x[2])}; }

/// Orientation, angular velocity, and place and velocity of the vessel as variables of LIGGGHTS.
class Chain {
 public:
  explicit Chain(const DeckCase& c) {
    // Moves of a step ask for rates when its number is that of its end: those of its middle keep the walls in
    // place.
    lines_ = fmt::format("variable t equal {}+(step-0.5)*dt\n", c.begin);
    for (std::size_t i = 0; i < 3; ++i) orientation_[i][i] = "1";
    for (const auto& joint : c.joints.list) joint.rotates ? add_rotation(joint) : add_translation(joint);
    // The velocity that the material point at the origin has.
    for (std::size_t i = 0; i < 3; ++i)
      velocity_[i] = named(sum(velocity_[i], negative(cross(spin_, centre_)[i])));
    // A turn carries the vessel from where it is at the beginning of a step, before it is shifted.
    const auto turned_shift = cross(spin_, velocity_);
    for (std::size_t i = 0; i < 3; ++i)
      velocity_[i] = named(sum(velocity_[i], product("(0.5*dt)", turned_shift[i])));
  }

  const std::string& lines() const { return lines_; }
  /// "v_q7" or empty.
  Formula spin(std::size_t axis) { return spin_[axis]; }
  Formula velocity(std::size_t axis) { return velocity_[axis]; }
  bool shifts() const { return !(velocity_[0] + velocity_[1] + velocity_[2]).empty(); }

 private:
  using Joint = model::Joint<double>;

  /// A variable for what is longer than a variable.
  Formula named(const Formula& formula) {
    const bool is_variable = formula.starts_with("v_") && formula.find_first_of("*+(") == Formula::npos;
    if (formula.empty() || formula == "1" || is_variable) return formula;
    const auto name = fmt::format("q{}", count_++);
    lines_ += fmt::format("variable {} equal {}\n", name, formula);
    return "v_" + name;
  }
  FormulaVector cross(const FormulaVector& a, const FormulaVector& b) {
    FormulaVector c;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      c[i] = named(sum(product(a[j], b[k]), negative(product(a[k], b[j]))));
    }
    return c;
  }
  FormulaVector turned(const FormulaVector& v) {
    FormulaVector w;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) w[i] = sum(w[i], product(orientation_[i][j], v[j]));
      w[i] = named(w[i]);
    }
    return w;
  }
  /// The joint's own coordinate and its rate.
  std::pair<Formula, Formula> coordinate(const Joint& joint, double unit) {
    Formula value = number(joint.rotates ? unit * joint.angle : 0), rate = number(unit * joint.speed);
    if (joint.speed != 0) value = sum(value, product(rate, "v_t"));
    for (const auto& s : joint.swings) {
      const auto phase = fmt::format("({}*v_t+{})", turn * s.frequency, turn * s.phase);
      value = sum(value, product(number(unit * s.amplitude), "sin" + phase));
      rate = sum(rate, product(number(unit * s.amplitude * turn * s.frequency), "cos" + phase));
    }
    return {named(value), named(rate)};
  }
  void add_rotation(const Joint& joint) {
    const auto [angle, rate] = coordinate(joint, turn);
    const auto own = number(axis_of(joint)), axis = turned(own);
    for (std::size_t i = 0; i < 3; ++i) spin_[i] = named(sum(spin_[i], product(axis[i], rate)));
    if (angle.empty()) return;
    // Rodrigues: cos + (1 - cos) n n + sin [n].
    const auto cosine = named("cos(" + angle + ")"), sine = named("sin(" + angle + ")"),
               rest = named("1-" + cosine);
    std::array<FormulaVector, 3> turn_of;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        Formula entry = product(product(own[i], own[j]), rest);
        if (i == j) entry = sum(entry, cosine);
        const std::size_t k = 3 - i - j;
        if (i != j)
          entry = sum(entry, (j == (i + 1) % 3) ? negative(product(own[k], sine)) : product(own[k], sine));
        turn_of[i][j] = named(entry);
      }
    std::array<FormulaVector, 3> behind;
    for (std::size_t j = 0; j < 3; ++j) {
      const auto column = turned({turn_of[0][j], turn_of[1][j], turn_of[2][j]});
      for (std::size_t i = 0; i < 3; ++i) behind[i][j] = column[i];
    }
    orientation_ = behind;
  }

  void add_translation(const Joint& joint) {
    const auto [way, rate] = coordinate(joint, 1);
    const auto axis = number(axis_of(joint));
    FormulaVector shift, speed;
    for (std::size_t i = 0; i < 3; ++i) {
      shift[i] = named(sum(number(joint.shift[i]), product(axis[i], way)));
      speed[i] = product(axis[i], rate);
    }
    const auto placed = turned(shift), moving = turned(speed), carried = cross(spin_, placed);
    for (std::size_t i = 0; i < 3; ++i) {
      centre_[i] = named(sum(centre_[i], placed[i]));
      velocity_[i] = named(sum(velocity_[i], sum(moving[i], carried[i])));
    }
  }

  std::string lines_;
  int count_ = 0;
  std::array<FormulaVector, 3> orientation_;
  FormulaVector spin_, centre_, velocity_;
};

std::string moves_of(Chain& chain, const std::vector<WallMesh>& meshes) {
  constexpr const char* axes[] = {"1 0 0", "0 1 0", "0 0 1"};
  std::string text;
  for (const auto& mesh : meshes) {
    for (std::size_t k = 0; k < 3; ++k)
      if (!chain.spin(k).empty())
        text += fmt::format(
            "fix turn_{0}_{1} all move/mesh mesh {0} rotate/variable origin 0 0 0 axis {2} omega {3}\n",
            mesh.name, "xyz"[k], axes[k], chain.spin(k));
    if (chain.shifts()) {
      std::string speeds;
      for (std::size_t k = 0; k < 3; ++k)
        speeds += " " + (chain.velocity(k).empty() ? "v_zero" : chain.velocity(k));
      text += fmt::format("fix shift_{0} all move/mesh mesh {0} linear/variable{1}\n", mesh.name, speeds);
    }
  }
  return text;
}

std::string properties_of(const DeckCase& c) {
  const double balls = formula_restitution(c.of_balls.damping),
               walls = formula_restitution(c.of_walls.damping);
  return fmt::format(R"(fix m1 all property/global youngsModulus peratomtype {0:.12g} {0:.12g}
fix m2 all property/global poissonsRatio peratomtype {1} {1}
fix m3 all property/global coefficientRestitution peratomtypepair 2 {2:.9g} {3:.9g} {3:.9g} {3:.9g}
fix m4 all property/global coefficientFriction peratomtypepair 2 {4:.12g} {5:.12g} {5:.12g} {5:.12g}
)",
                     c.young, DeckCase::poisson, balls, walls, c.of_balls.friction, c.of_walls.friction);
}

std::string granules_of(const DeckCase& c) {
  std::string text, sets;
  for (std::size_t k = 0; k < c.balls.size(); ++k) {
    const auto& [x, v, w] = c.states[k];
    text += fmt::format("create_atoms 1 single {} {} {} units box\n", x[0], x[1], x[2]);
    sets +=
        fmt::format("set atom {0} diameter {1} density {2}\n", k + 1, 2 * c.balls[k].radius, c.density(k));
    if (norm<double>(v) > 0 || norm<double>(w) > 0)
      sets += fmt::format("set atom {0} vx {1} vy {2} vz {3} omegax {4} omegay {5} omegaz {6}\n", k + 1, v[0],
                          v[1], v[2], w[0], w[1], w[2]);
  }
  return text + sets;
}

/// The meshes, placed as at the begin: their commands, and their files.
std::string walls_of(const DeckCase& c, const DeckOptions& options, const std::vector<WallMesh>& meshes,
                     std::vector<DeckFile>& files) {
  std::string text, names;
  for (const auto& mesh : meshes) {
    const auto file = fmt::format("{}_{}.stl", options.name, mesh.name);
    files.push_back({file, stl_text({&mesh, 1}, c.mill.motion, c.pose)});
    text += fmt::format("fix {0} all mesh/surface file {1} type 2 curvature {2:.6g} curvature_tolerant yes\n",
                        mesh.name, file, mesh.smooth_angle > 0 ? mesh.smooth_angle : 0.26);
    names += " " + mesh.name;
  }
  return text + fmt::format(
                    "fix contacts all wall/gran model hertz tangential history mesh n_meshes {} meshes{} "
                    "tangential_damping off limitForce on\n",
                    meshes.size(), names);
}

}  // namespace

Deck liggghts_deck(const DeckCase& c, const DeckOptions& options) {
  const auto meshes = meshes_of(c.mill.vessel, options.facets);
  if (meshes.empty())
    throw InputError(
        fmt::format("{}: key 'vessel.type': found a vessel with walls that are round in two ways, expected "
                    "flat walls or a cylinder, which LIGGGHTS can have as triangles",
                    c.file));
  Chain chain(c);
  const double reach = 1.5 * c.mill.motion.reach(c.mill.vessel.reach());
  Deck deck;
  std::string text = header_of(c, options) + facts_of(meshes, options.facets);
  text += fmt::format(R"(atom_style granular
atom_modify map array
communicate single vel yes
boundary f f f
newton off
units si
hard_particles yes
region space block {0:.6g} {1:.6g} {0:.6g} {1:.6g} {0:.6g} {1:.6g} units box
create_box 2 space
neighbor {2:.6g} bin
neigh_modify delay 0
{3}pair_style gran model hertz tangential history tangential_damping off limitForce on
pair_coeff * *
timestep {4}
)",
                      -reach, reach, c.largest_radius / 2, properties_of(c), c.time_step);
  text += granules_of(c) + chain.lines() + "variable zero equal 0.0\n";
  text += walls_of(c, options, meshes, deck.files) + moves_of(chain, meshes) + weight_of(c);
  std::string format = "%d";
  for (int k = 0; k < 11; ++k) format += " %.15g";
  text += fmt::format(R"(fix motion all nve/sphere
dump frames all custom {} {}.dump id x y z vx vy vz omegax omegay omegaz mass radius
dump_modify frames sort id format "{}"
thermo {}
thermo_modify lost error norm no
run {}
)",
                      c.frame_every, options.name, format, std::max(1L, c.steps / 20), c.steps);
  deck.files.insert(deck.files.begin(), {options.name + ".in", std::move(text)});
  deck.command = fmt::format("liggghts -in {}.in", options.name);
  deck.notes = notes_on(meshes, options.facets);
  return deck;
}

}  // namespace edmill::dem
