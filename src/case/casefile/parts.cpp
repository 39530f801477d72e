// Reads motions and vessels of a case file: joints of a chain, shapes, pistons.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "base/scalar_list.hpp"
#include "casefile/build_case.hpp"
#include "casefile/rational.hpp"
#include "casefile/tables.hpp"

namespace edmill::casefile {

namespace {

using boost::multiprecision::cpp_int;
using model::Face;
using model::Joint;
using model::Joints;
using model::Range;
using model::Swing;
using model::TurnFraction;
using PistonSpec = model::Piston<Quantity>;

/// Whole turns and a fraction, truncated to a TurnFraction's bits, or more if `mpfr` needs them.
TurnFraction fraction_of(const Quantity& turns) {
  TurnFraction fraction;
#if !defined(EDMILL_WITHOUT_MPFR)
  const std::size_t needed = TurnFraction::words_for(binary_digits<mpfr>());
  fraction.bits.resize(std::max(needed, TurnFraction::words));
#endif
  const int fraction_bits = 64 * static_cast<int>(fraction.bits.size());
  const Rational value = value_of(turns, 2 * fraction_bits);
  cpp_int scaled = (numerator(value) << fraction_bits) / denominator(value);
  const cpp_int one = cpp_int(1) << fraction_bits;
  const cpp_int whole = scaled / one - (scaled % one < 0 ? 1 : 0);  // rounded down
  fraction.whole = static_cast<std::int64_t>(whole);
  scaled -= whole * one;
  for (std::size_t k = fraction.bits.size(); k-- > 0; scaled >>= 64)
    fraction.bits[k] = static_cast<std::uint64_t>(scaled & 0xffffffffffffffffu);
  return fraction;
}

/// An angle or phase without its whole turns, so that a scalar represents it to its last digit.
Quantity without_whole_turns(const Quantity& turns) {
  const auto fraction = fraction_of(turns);
  if (fraction.whole == 0 || fraction.whole == -1) return turns;
  if (turns.pi_power == 0) return quantity_of(rational(turns) - fraction.whole);
  cpp_int bits = 0;
  for (const std::uint64_t word : fraction.bits) bits = (bits << 64) + word;
  return quantity_of({bits, cpp_int(1) << (64 * fraction.bits.size())});
}

/// Converts an angular speed [rad/s] to a frequency [1/s], or an angle [rad] to turns.
Quantity in_turns(const Quantity& radians) {
  return quantity_of(rational(radians) / 2, radians.pi_power - 1);
}

void require_speed(Section& swing, const Quantity& speed) {
  swing.require(speed.positive() && speed.to<double>() < 1e6, "speed",
      "a positive angular speed below 1e6 rad/s");
}

std::vector<Swing<Quantity>> read_swings(Entries<SwingTable>& entries) {
  std::vector<Swing<Quantity>> swings;
  const bool rotates = entries.like.dimension == Dimension::angle;
  read_entries(entries, [&](Section& entry, const SwingTable& swing) {
    require_speed(entry, swing.speed);
    swings.push_back({rotates ? in_turns(swing.amplitude) : swing.amplitude, in_turns(swing.speed),
        in_turns(swing.phase)});
  });
  return swings;
}

const std::array<std::string, 3> axes{"x", "y", "z"};

bool is_zero(const QuantityVector& v) { return v[0].zero() && v[1].zero() && v[2].zero(); }

/// @param copied  the joint may rest: copies of a body follow it at equal angles
Joint<Quantity> joint_of(Section& section, JointTable& table, bool copied) {
  Joint<Quantity> joint;
  joint.rotates = *table.rotates;
  joint.speed = joint.rotates ? in_turns(table.speed) : table.speed;
  joint.swings = read_swings(table.swings);
  joint.axis = table.axis.direction;
  const bool moves = !joint.speed.zero() || !joint.swings.empty();
  if (joint.rotates) {
    joint.angle = in_turns(table.angle);
    if (joint.angle.zero() && !moves && !copied)
      section.problem(first_of(section, {"speed", "angle", "rotate"}), "a joint that does not turn",
          "one with angle, speed or swing");
    return joint;
  }
  const auto& shift = table.axis.shift;
  const bool named = !section.is_array("translate");
  if (!named && section.has("distance"))
    section.problem("distance",
        shift ? "a distance in addition to three lengths"
              : "a distance along an axis of three numbers",
        shift ? "translate = \"x\", \"y\" or \"z\", or no distance"
              : "a separate joint for it, translate = [..] with three lengths");
  if (shift) joint.shift = *shift;
  if (!named) return joint;
  for (std::size_t k = 0; k < 3; ++k) joint.shift[k] = joint.axis[k] * table.distance;
  if (table.distance.zero() && !moves)
    section.problem(first_of(section, {"speed", "distance", "translate"}),
        "a joint that shifts nothing", "one with distance, speed or swing");
  return joint;
}

/// Period of the fastest rotation or swing, which becomes the drive period [s].
Quantity period_of_fastest(const std::vector<Joint<Quantity>>& joints) {
  Quantity fastest{0};
  const auto see = [&](const Quantity& frequency) {
    if (std::abs(frequency.to<double>()) > std::abs(fastest.to<double>())) fastest = frequency;
  };
  for (const auto& joint : joints) {
    if (joint.rotates) see(joint.speed);
    for (const auto& swing : joint.swings) see(swing.frequency);
  }
  if (fastest.zero()) return {1, 16};
  if (fastest.negative()) fastest = -fastest;
  return Quantity{1} / fastest;
}

std::string text_of(const QuantityVector& v) {
  return fmt::format("({:g}, {:g}, {:g})", v[0].to<double>(), v[1].to<double>(), v[2].to<double>());
}

std::string axis_name(const QuantityVector& axis) {
  for (std::size_t k = 0; k < 3; ++k)
    if (axis[k] == 1 && axis[(k + 1) % 3].zero() && axis[(k + 2) % 3].zero()) return axes[k];
  return text_of(axis);
}

/// A term of a sum with its sign, " + 5".
std::string term(double value) {
  return fmt::format(" {} {:g}", value < 0 ? '-' : '+', std::abs(value));
}

/// The sum of terms with signs as text, without a leading plus.
std::string as_sum(const std::string& terms) {
  if (terms.empty()) return "0 deg";
  if (terms.starts_with(" + ")) return terms.substr(3);
  return terms.starts_with(" - ") ? "-" + terms.substr(3) : terms;
}

std::string text_of_joint(const Joint<Quantity>& joint) {
  if (joint.rotates) {
    std::string angle;
    if (!joint.angle.zero()) angle = fmt::format("{:g} deg", 360 * joint.angle.to<double>());
    if (!joint.speed.zero()) angle += term(360 * joint.speed.to<double>()) + " deg/s t";
    return "turn about " + axis_name(joint.axis) + " by " +
        as_sum(angle + equation_of(joint.swings, joint.rotates));
  }
  std::string text = "shift by " + text_of(joint.shift) + " m";
  if (!joint.speed.zero()) text += term(joint.speed.to<double>()) + " m/s t";
  text += equation_of(joint.swings, joint.rotates);
  if (!joint.speed.zero() || !joint.swings.empty()) text += " along " + axis_name(joint.axis);
  return text;
}

std::vector<Joint<Quantity>> read_joints(Entries<JointTable>& entries, bool copied) {
  std::vector<Joint<Quantity>> joints;
  for (Section& entry : entries) {
    const bool rotates = entry.has("rotate");
    if (rotates == entry.has("translate")) {
      entry.problem("rotate", rotates ? "both 'rotate' and 'translate'" : "nothing",
          rotates ? "one of them" : "'rotate' or 'translate'");
      continue;
    }
    JointTable table;
    table.rotates = rotates;
    table.swings.like.dimension = rotates ? Dimension::angle : Dimension::length;
    read_keys(entry, table);
    joints.push_back(joint_of(entry, table, copied));
    entry.reject_unknown_keys();
  }
  return joints;
}

Joints<Quantity> read_joints(Section& mill) {
  ChainTable chain;
  read_keys(mill, chain);
  if (chain.joints.empty() && !mill.has("joint"))
    mill.problem("joint", "nothing", "at least one [[mill.joint]]");
  const auto joints = read_joints(chain.joints, false);
  return {joints, period_of_fastest(joints)};
}

/// Checks conditions between the parameters of a vessel.
void require_shape(Section&, const auto&) {}
void require_shape(Section& vessel, const model::Capsule<Quantity>& capsule) {
  vessel.require(capsule.height >= capsule.diameter, "height", "the diameter or more");
}
void require_shape(Section& vessel, const model::RoundedCylinder<Quantity>& cylinder) {
  const Quantity width = Quantity(2) * cylinder.edge;
  vessel.require(width <= cylinder.diameter && width <= cylinder.height, "edge_radius",
      "at most half of the diameter and of the height");
}

using Point = Vec3<Rational>;

QuantityVector quantities(const Point& p) {
  return {quantity_of(p[0]), quantity_of(p[1]), quantity_of(p[2])};
}

/// The convex hull in exact numbers: planes through three or more vertices with no others outside.
/// @param corners  the vertices on each face are added
std::vector<Face<Quantity>> hull_of(
    const std::vector<Point>& vertices, std::set<std::set<std::size_t>>& corners) {
  std::vector<Face<Quantity>> faces;
  const auto add = [&](const Point& a, const Point& b, const Point& c) {
    Point normal = cross<Rational>(b - a, c - a);
    if (dot<Rational>(normal, normal) == 0) return;
    std::set<std::size_t> on;
    bool below = false, above = false;
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const Rational side = dot<Rational>(normal, vertices[v] - a);
      below = below || side < 0;
      above = above || side > 0;
      if (side == 0) on.insert(v);
    }
    if (below == above || !corners.insert(on).second) return;
    if (above) normal = -normal;
    faces.push_back({quantities(normal), quantities(a), Quantity{0}});
  };
  for (auto a = vertices.begin(); a != vertices.end(); ++a)
    for (auto b = a + 1; b != vertices.end(); ++b)
      for (auto c = b + 1; c != vertices.end(); ++c) add(*a, *b, *c);
  return faces;
}

std::vector<Face<Quantity>> read_planes(Entries<PlaneTable>& planes) {
  std::vector<Face<Quantity>> faces;
  read_entries(planes, [&](Section&, const PlaneTable& plane) {
    faces.push_back({.normal = plane.normal, .point = {}, .distance = plane.distance});
  });
  return faces;
}

std::vector<Face<Quantity>> read_vertices(Section& vessel, Entries<VertexTable>& entries) {
  std::vector<Point> vertices;
  read_entries(entries, [&](Section&, const VertexTable& vertex) {
    vertices.push_back({rational(vertex.at[0]), rational(vertex.at[1]), rational(vertex.at[2])});
  });
  if (vertices.size() < 4 || vertices.size() > 60) {
    vessel.problem("vertex", std::to_string(vertices.size()) + " vertices", "4 to 60");
    return {};
  }
  std::set<std::set<std::size_t>> corners;
  const auto faces = hull_of(vertices, corners);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const auto has_it = [v](const auto& face) { return face.contains(v); };
    if (std::count_if(corners.begin(), corners.end(), has_it) >= 3) continue;
    vessel.problem("vertex", fmt::format("a vertex {} that is not a corner of the convex hull", v),
        "the corners of a convex vessel");
    return {};
  }
  return faces;
}

model::Polyhedron<Quantity> read_polyhedron(Section& vessel) {
  PolyhedronTable table;
  read_keys(vessel, table);
  const std::string key = vessel.has("vertex") ? "vertex" : "plane";
  if (vessel.has("vertex") == vessel.has("plane")) {
    vessel.problem("plane", vessel.has("plane") ? "both planes and vertices" : "nothing",
        "[[vessel.plane]] or [[vessel.vertex]]");
    return {};
  }
  model::Polyhedron<Quantity> vessel_of{
      key == "vertex" ? read_vertices(vessel, table.vertices) : read_planes(table.planes)};
  if (vessel_of.faces.empty()) return vessel_of;
  const auto planes = model::converted<model::Polyhedron, double>(
      vessel_of, [](const Quantity& q) { return q.to<double>(); });
  if (const auto problem = model::PolyhedronVessel<double>::problem_of(planes.planes()))
    vessel.problem(key, problem->found, problem->expected);
  return vessel_of;
}

template <class Variant> Variant read_part(Section& given, const char* key) {
  Variant chosen;
  const auto name = given.kind(key, names_of_kinds<Variant>());
  // If the type is unknown, no other key can be checked.
  Document ignored;
  Section nothing(ignored, nullptr, given.path());
  Section& section = given.of_unknown_kind() ? nothing : given;
  for_each_kind<Variant>([&]<class Part>(Part part) {
    if (name != Part::name) return;
    KeyReader read_key(section);
    if constexpr (requires { part.given; })
      part.given = read_joints(section);
    else if constexpr (requires { part.faces; })
      part = read_polyhedron(section);
    else
      Part::parameters(part, read_key);
    if (read_key.complete()) require_shape(section, part);
    chosen = part;
  });
  return chosen;
}

std::string described(const auto& part, const Written& written) {
  std::string text;
  const auto add = [&](const Parameter& p, const auto& value) {
    if (!p.key) return;
    if (const auto given = written ? written(p.key) : std::nullopt) {
      text += fmt::format("{}{} {}", text.empty() ? ": " : ", ", p.key, *given);
      return;
    }
    const bool drive = p.range == Range::drive;
    text += fmt::format("{}{}", text.empty() ? ": " : ", ", drive ? "period" : p.key);
    model::for_each_number(
        value, [&](const Quantity& q) { text += fmt::format(" {:g}", q.to<double>()); });
    text += drive ? " s" : si_unit(p.dimension);
  };
  std::visit([&](const auto& p) { p.parameters(p, add); }, part);
  return name_of(part) + text;
}

/// Bounds of a piston's displacement between two times [m].
struct Travel {
  double least, most;
};

Travel travel_of(const PistonSpec& piston, double from, double to) {
  const double begin = piston.distance.to<double>() + piston.speed.to<double>() * from;
  const double end = piston.distance.to<double>() + piston.speed.to<double>() * to;
  double swings = 0;
  for (const auto& s : piston.swings) swings += std::abs(s.amplitude.to<double>());
  return {std::min(begin, end) - swings, std::max(begin, end) + swings};
}

using PolyhedronVessel = model::PolyhedronVessel<double>;

/// Whether the wall can move along its normal and leave its neighbours as they are.
bool can_move(const model::AnyVessel<double>& vessel, int wall) {
  return vessel.get_if<PolyhedronVessel>() ||
      (vessel.is_flat(wall) && vessel.function_count() == vessel.wall_count());
}

/// Distance from a flat wall to the opposite side of the vessel [m].
double depth_of(const model::AnyVessel<double>& vessel, int wall) {
  const Vec3<double> origin = Vec3<double>::Zero(), normal = vessel.normal(wall, origin);
  return vessel.gap(wall, origin) + dot<double>(normal.cwiseAbs(), vessel.half_sizes());
}

/// Reports pistons that, all as far inward as they go, leave too little room at the origin.
void require_room(Section& entry, const PolyhedronVessel& polyhedron,
    const std::vector<PistonSpec>& pistons, double from, double to, double diameter) {
  auto planes = polyhedron.planes();
  for (const auto& piston : pistons)
    planes[static_cast<std::size_t>(piston.wall)].distance -= travel_of(piston, from, to).most;
  for (const auto& plane : planes)
    if (plane.distance < diameter / 2)
      return entry.problem("wall",
          fmt::format("pistons or walls that come as near as {:g} m to the origin", plane.distance),
          fmt::format("room for a ball of {:g} m there at all times", diameter));
}

/// A body without its joints; nothing where a size is missing.
std::optional<Solid> read_shape(Section& entry, const BodyTable& table) {
  Solid body;
  body.rounding = table.rounding;
  body.on_vessel = table.on == Base::vessel;
  body.colour = table.colour;
  body.where = entry.where();
  const bool round = table.type == Solidity::cylinder;
  for (const char* key : round ? std::array{"diameter", "height"} : std::array{"size", "size"})
    if (!entry.has(key)) {
      entry.problem(key, "nothing", round ? "a length" : "three lengths");
      return std::nullopt;
    }
  for (const char* key : {"diameter", "height", "size"})
    if (entry.has(key) && round == (key == std::string("size")))
      entry.problem(key, "a key of the other type", round ? "diameter and height" : "size");
  if (round && table.diameter && table.height)
    body.size = {*table.diameter, *table.height, *table.diameter};
  else
    body.size = table.size;
  const Quantity width = Quantity(2) * body.rounding;
  bool fits = true, negative = false, nothing = true;
  for (const auto& size : body.size) {
    fits = fits && width <= size;
    negative = negative || size.negative();
    nothing = nothing && size.zero();
  }
  if (negative || nothing)
    entry.problem("size", nothing ? "a body without size" : "a negative length",
        "three lengths, at least one of them positive");
  else
    entry.require(fits, "rounding", "at most half of each size");
  body.is_round = round && width < body.size[0];
  return body;
}

/// A vessel at rest has the clock of the fastest body.
void set_clock(CaseSpec& spec) {
  const auto moves = [](const auto& joint) { return !joint.speed.zero() || !joint.swings.empty(); };
  const auto own = joints_of(spec.mill);
  auto* still = std::get_if<model::StillMill<Quantity>>(&spec.mill);
  if (!still && std::any_of(own.begin(), own.end(), moves)) return;
  std::vector<Joint<Quantity>> all;
  for (const auto& body : spec.bodies)
    all.insert(all.end(), body.joints.begin(), body.joints.end());
  if (still)
    still->period = period_of_fastest(all);
  else if (auto* chain = std::get_if<model::Chain<Quantity>>(&spec.mill))
    chain->given.period = period_of_fastest(all);
}

}  // namespace

void Axis::read_from(Section& joint, const char* key) {
  if (!joint.has(key)) return;
  if (!joint.is_array(key)) {
    const auto axis = std::find(axes.begin(), axes.end(), joint.text(key).value_or("x"));
    joint.require(axis != axes.end(), key, "\"x\", \"y\", \"z\" or an array of three numbers");
    direction = {};
    if (axis != axes.end()) direction[static_cast<std::size_t>(axis - axes.begin())] = Quantity{1};
    return;
  }
  const bool shifts = key == std::string("translate") && !joint.has("swing") && !joint.has("speed");
  direction = joint.vector(key, shifts ? Dimension::length : Dimension::none)
                  .value_or(QuantityVector{Quantity{1}});
  joint.require(shifts || !is_zero(direction), key, "an axis other than zero");
  if (shifts) shift = std::exchange(direction, {});
}

std::string equation_of(const std::vector<Swing<Quantity>>& swings, bool rotate) {
  std::string text;
  for (const auto& s : swings) {
    text += term(s.amplitude.to<double>() * (rotate ? 360 : 1)) +
        fmt::format(" {} sin(2 pi {:g} t/s", rotate ? "deg" : "m", s.frequency.to<double>());
    if (!s.phase.zero()) text += term(360 * s.phase.to<double>()) + " deg";
    text += ")";
  }
  return text;
}

std::vector<Swing<Quantity>> with_phases(
    std::vector<Swing<Quantity>> swings, const Quantity& period) {
  for (auto& swing : swings) {
    swing.per_period = fraction_of(swing.frequency * period);
    swing.phase = without_whole_turns(swing.phase);
  }
  return swings;
}

Joints<Quantity> with_phases(Joints<Quantity> joints) {
  for (auto& joint : joints.list) {
    if (joint.rotates) joint.per_period = fraction_of(joint.speed * joints.period);
    joint.angle = without_whole_turns(joint.angle);
    joint.swings = with_phases(std::move(joint.swings), joints.period);
  }
  return joints;
}

void require_end(Section& mill) {
  for (Section& entry : mill.sections("joint"))
    if (entry.has("translate") && entry.has("speed"))
      entry.problem("speed", "a translation without end", "a run.end_time");
}

std::string equation_of(const Joints<Quantity>& joints) {
  std::string text;
  for (const auto& joint : joints.list) text += (text.empty() ? "" : "; ") + text_of_joint(joint);
  return text;
}

std::vector<model::Joint<Quantity>> joints_of(const MotionSpec& motion) {
  const auto list_of = [](const auto& m) {
    if constexpr (requires { m.joints(); })
      return m.joints().list;
    else
      return model::spex_joints(m.arm, in_turns(m.theta_max), in_turns(m.gamma_max), m.period).list;
  };
  return std::visit(list_of, motion);
}

std::string describe(const MotionSpec& motion, const Written& written) {
  if (const auto* chain = std::get_if<model::Chain<Quantity>>(&motion))
    return std::string(chain->name) + ": " + equation_of(chain->given);
  return described(motion, written);
}
std::string describe(const VesselSpec& vessel, const Written& written) {
  if (const auto* polyhedron = std::get_if<model::Polyhedron<Quantity>>(&vessel))
    return fmt::format("{} of {} walls", polyhedron->name, polyhedron->faces.size());
  return described(vessel, written);
}

void check(Section mill, const MotionSpec& motion) {
  std::visit([&](const auto& m) { m.parameters(m, KeyChecker{mill}); }, motion);
  if (const auto* chain = std::get_if<model::Chain<Quantity>>(&motion))
    for (const auto& joint : chain->given.list)
      for (const auto& swing : joint.swings)
        require_speed(
            mill, quantity_of(2 * rational(swing.frequency), 1 + swing.frequency.pi_power));
}
void check(Section vessel, const VesselSpec& shape) {
  const auto check_shape = [&](const auto& v) {
    v.parameters(v, KeyChecker{vessel});
    require_shape(vessel, v);
  };
  std::visit(check_shape, shape);
}

MotionSpec read_motion(Section& mill, const char* key) { return read_part<MotionSpec>(mill, key); }
VesselSpec read_vessel(Section& vessel, const char* key) {
  return read_part<VesselSpec>(vessel, key);
}

void read_pistons(Section& vessel, Entries<PistonTable>& entries, CaseSpec& spec) {
  if (entries.empty() || vessel.of_unknown_kind()) return;
  const auto built = known_vessel(spec);
  if (!built) return entries.clear();
  const auto partners = model::partners_of(*built);
  std::vector<std::string> flat;
  for (int wall = 0; wall < partners.walls(); ++wall)
    if (can_move(*built, wall)) flat.push_back(partners[wall].label);
  read_entries(entries, [&](Section& entry, PistonTable& table) {
    PistonSpec piston{
        wall_named(table.wall, partners), table.distance, table.speed, read_swings(table.swings)};
    if (piston.wall >= 0 && !can_move(*built, piston.wall)) piston.wall = -1;
    entry.require(piston.wall >= 0, "wall",
        flat.empty() ? "a vessel with flat walls and sharp edges" : one_of(flat));
    for (const auto& other : spec.pistons)
      entry.require(
          other.wall != piston.wall || piston.wall < 0, "wall", "one piston for each wall");
    if (piston.distance.zero() && piston.speed.zero() && piston.swings.empty())
      entry.problem(first_of(entry, {"speed", "distance", "wall"}), "a piston that does not move",
          "one with distance, speed or swing");
    spec.pistons.push_back(std::move(piston));
  });
}

void require_travel(std::vector<Section>& entries, const CaseSpec& spec) {
  if (entries.empty()) return;
  const auto vessel = build_mill<double>(spec).vessel;
  const double from = spec.initial_time.to<double>(),
               to = spec.end_time ? spec.end_time->to<double>() : from;
  const double diameter = spec.largest_diameter();
  const auto normal = [&](int wall) { return vessel.normal(wall, Vec3<double>::Zero()); };
  for (std::size_t k = 0; k < spec.pistons.size(); ++k) {
    const auto& piston = spec.pistons[k];
    auto& entry = entries[k];
    if (!piston.speed.zero() && !spec.end_time) {
      entry.problem("speed", "a piston that moves without end", "a run.end_time");
      continue;
    }
    const auto own = travel_of(piston, from, to);
    const double depth = depth_of(vessel, piston.wall);
    if (own.least < -1e-14 * depth)  // beyond rounding
      entry.problem("wall", fmt::format("a piston that leaves the vessel by {:g} m", -own.least),
          "a distance, speed and swings that keep it inside");
    if (const auto* polyhedron = vessel.get_if<PolyhedronVessel>()) {
      if (k == 0) require_room(entry, *polyhedron, spec.pistons, from, to, diameter);
      continue;
    }
    double room = depth - own.most;
    for (const auto& other : spec.pistons)
      if (dot<double>(normal(piston.wall), normal(other.wall)) < -0.5)
        room -= travel_of(other, from, to).most;
    if (room < diameter)
      entry.problem("wall",
          fmt::format("a piston that comes too close to the other end: it leaves {:g} m",
              std::max(room, 0.0)),
          fmt::format("room for a ball of {:g} m at all times", diameter));
  }
}

QuantityVector Solid::core() const {
  QuantityVector half;
  for (std::size_t k = 0; k < 3; ++k)
    half[k] = quantity_of(rational(size[k]) / 2 - rational(rounding));
  return half;
}

void read_bodies(Entries<BodyTable>& entries, CaseSpec& spec) {
  constexpr std::size_t most = 48;  // walls and bodies together
  const auto vessel = known_vessel(spec);
  read_entries(entries, [&](Section& entry, BodyTable& table) {
    auto body = read_shape(entry, table);
    if (!body) return;
    const bool copied = table.repeat > 1;
    auto& joints = body->joints;
    joints = read_joints(table.joints, copied);
    if (!spec.end_time) require_end(entry);
    const auto turning =
        std::find_if(joints.begin(), joints.end(), [](const auto& joint) { return joint.rotates; });
    if (copied && turning == joints.end())
      return entry.problem("repeat", "copies without a rotating joint",
          "a joint with 'rotate', about whose axis they are placed");
    const int material = material_of(entry, "material", table.material, spec);
    const std::string name =
        table.name.empty() ? fmt::format("body {}", spec.bodies.size()) : table.name;
    const auto place = turning - joints.begin();
    for (int k = 0; k < table.repeat; ++k) {
      auto copy = *body;
      copy.name = copied ? fmt::format("{} {}", name, k) : name;
      for (const auto& other : spec.bodies)
        entry.require(other.name != copy.name, "name", "a name that no other body has");
      if (vessel)
        for (const auto& wall : vessel->walls())
          entry.require(wall.label != copy.name, "name", "a name that no wall has");
      if (k > 0) {
        Joint<Quantity> turn;
        turn.axis = turning->axis;
        turn.angle = quantity_of(Rational(k) / table.repeat);
        copy.joints.insert(copy.joints.begin() + place, turn);
      }
      spec.bodies.push_back(std::move(copy));
      spec.wall_materials.push_back(material);
    }
  });
  if (spec.bodies.empty()) return;
  if (spec.wall_materials.size() > most) {
    entries.back().problem("repeat", fmt::format("{} walls and bodies", spec.wall_materials.size()),
        fmt::format("at most {}", most));
    spec.bodies.clear();
  }
  set_clock(spec);
}

void require_bodies_inside(Entries<BodyTable>& entries, const CaseSpec& spec) {
  if (entries.empty()) return;
  const auto mill = build_mill<double>(spec);
  const DriveClock<double> clock(mill.motion.period());
  const double from = spec.initial_time.to<double>(),
               to = spec.end_time ? spec.end_time->to<double>() : from + 16 * clock.period();
  constexpr int samples = 256;  // of the start of the run, and of all of it
  for (std::size_t k = 0; k < mill.bodies.size(); ++k) {
    const auto& body = mill.bodies[k];
    for (int n = 0; n <= 2 * samples; ++n) {
      const double time = n < samples ? from + std::min(to - from, clock.period()) * n / samples
                                      : from + (to - from) * (n - samples) / samples;
      const auto when = clock.at(time);
      const auto centre =
          mill.motion.position_in_vessel(mill.motion.pose(when), body.motion.pose(when).centre);
      bool outside = false;
      for (int wall = 0; wall < mill.vessel.wall_count(); ++wall)
        outside = outside || mill.vessel.overlap(wall, centre) > body.shape.size();
      if (!outside) continue;
      const auto& where = spec.bodies[k].where;
      for (auto& entry : entries)
        if (entry.where() == where)
          entry.problem("joint",
              fmt::format("{} outside of the vessel at {:g} s", spec.bodies[k].name, time),
              "joints that keep it inside");
      return;
    }
  }
}

std::vector<Joint<Quantity>> joints_from_ground(const Solid& body, const CaseSpec& spec) {
  auto joints = body.on_vessel ? joints_of(spec.mill) : std::vector<Joint<Quantity>>{};
  joints.insert(joints.end(), body.joints.begin(), body.joints.end());
  return joints;
}

std::string describe(const Solid& body) {
  std::string text = body.is_round ? "cylinder" : "box";
  for (std::size_t k = 0; k < (body.is_round ? 2 : 3); ++k)
    text += fmt::format("{} {:g}", k == 0 ? " of" : " x", 1000 * body.size[k].to<double>());
  text += " mm";
  if (body.rounding.positive())
    text += fmt::format(", rounded by {:g} mm", 1000 * body.rounding.to<double>());
  text += body.on_vessel ? ", on the vessel" : ", on the ground";
  return body.joints.empty() ? text : text + ": " + equation_of(Joints<Quantity>{body.joints});
}

std::string describe_gravity(const CaseSpec& spec) {
  return is_zero(spec.gravity) ? "none" : text_of(spec.gravity) + " m/s^2";
}

std::string describe(const PistonSpec& piston) {
  std::string text = fmt::format("{:g} m", piston.distance.to<double>());
  if (!piston.speed.zero()) text += term(piston.speed.to<double>()) + " m/s t";
  return text + equation_of(piston.swings, false) + " inward";
}

}  // namespace edmill::casefile
