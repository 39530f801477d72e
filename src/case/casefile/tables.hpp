// Tables of a case file that are converted to parts of the model, and the functions that read them.
#pragma once

#include <map>

#include "casefile/case_spec.hpp"
#include "casefile/keys.hpp"

namespace edmill::casefile {

/// Harmonic parts of a joint or of a piston.
struct SwingTable {
  Dimension dimension = Dimension::none;  ///< of the amplitude; none where the joint decides
  const char* meaning = "amplitude of the rotation or translation";
  Quantity amplitude{}, speed{}, phase{};

  static constexpr const char* what =
      "A list of tables: `swing = [{ amplitude = \"5 mm\", speed = \"1500 rpm\" }]`.";
  static constexpr Parameter key{
      "swing", Dimension::none, "harmonic parts, amplitude sin(speed t + phase)"};
  static void keys(auto& s, auto&& row) {
    const Parameter amplitude{"amplitude", s.dimension, s.meaning};
    row(s.dimension == Dimension::none ? amplitude.as("angle or length") : amplitude, s.amplitude);
    row({"speed", Dimension::angular_speed, "angular frequency, 2 pi times the frequency"},
        s.speed);
    row({"phase", Dimension::angle, "phase at time 0", Range::any, "0 deg"}, s.phase);
  }
};

/// An axis: "x", "y", "z", or three numbers; three lengths to translate by are a constant shift.
struct Axis {
  QuantityVector direction{Quantity{1}};
  std::optional<QuantityVector> shift;
  void read_from(Section& joint, const char* key);
};

struct JointTable {
  std::optional<bool> rotates;  ///< empty in the reference, which lists the keys of both
  Axis axis;
  Quantity angle, speed, distance;
  Entries<SwingTable> swings;

  static constexpr const char* what = "Joints of a chain.";
  static void keys(auto& j, auto&& row) {
    using enum Dimension;
    const bool rotates = j.rotates.value_or(true), translates = !j.rotates.value_or(false);
    if (rotates)
      row(described_key("rotate", "axis", "this or `translate`",
              "axis of rotation in the frame of the previous joint: `\"x\"`, `\"y\"`, `\"z\"` or "
              "three numbers"),
          j.axis);
    if (translates)
      row(described_key("translate", "axis or three lengths", "this or `rotate`",
              "axis of translation: `\"x\"`, `\"y\"`, `\"z\"`, or three numbers with `speed` or "
              "`swing`; without them, three lengths are a constant shift"),
          j.axis);
    if (rotates) row({"angle", angle, "constant part of a rotation", Range::any, "0 deg"}, j.angle);
    row(Parameter{"speed", translates ? speed : angular_speed,
            "constant part of the speed of rotation or translation; rotations need no common "
            "period, a translation needs `run.end_time`",
            Range::any, translates ? "0 m/s" : "0 rad/s", "`0`"}
            .as("angular speed or speed"),
        j.speed);
    if (translates)
      row({"distance", length, "constant part of a translation along `\"x\"`, `\"y\"` or `\"z\"`",
              Range::any, "0 m"},
          j.distance);
    row(SwingTable::key, j.swings);
  }
};

enum class Solidity { box, cylinder };
inline constexpr std::array<std::string_view, 2> choices_of(Solidity) {
  return {"box", "cylinder"};
}
enum class Base { vessel, ground };
inline constexpr std::array<std::string_view, 2> choices_of(Base) { return {"vessel", "ground"}; }

struct BodyTable {
  std::string name;
  Solidity type = Solidity::box;
  Base on = Base::vessel;
  std::optional<Quantity> diameter, height;
  QuantityVector size{};
  Quantity rounding;
  Entries<JointTable> joints;
  int repeat = 1;
  std::string material;
  Colour colour{0.5, 0.5, 0.5};

  static constexpr const char* what =
      "Convex bodies inside the vessel: stirrers, pins, discs, lifters, baffles. They may overlap "
      "walls and each other.";
  static void keys(auto& b, auto&& row) {
    using enum Dimension;
    row(Parameter{"name", "name of the body in tables", Range::any, nullptr,
            "`body 0`, `body 1`, ..."},
        b.name);
    row(described_key("type", "`\"box\"` or `\"cylinder\"`", "`\"box\"`",
            "shape of the body; the axis of a cylinder is y"),
        b.type);
    row({"size", length, "sizes of a box along x, y, z, including roundings; up to two may be zero",
            Range::any, nullptr, "required for a box"},
        b.size);
    row(Parameter{"diameter", length, "diameter of a cylinder", Range::positive}.usually(
            "required for a cylinder"),
        b.diameter);
    row(Parameter{"height", length,
            "height of a cylinder, including roundings; zero for a disc without thickness",
            Range::not_negative}
            .usually("required for a cylinder"),
        b.height);
    row({"rounding", length,
            "radius of all edges; a box whose sizes are all twice the radius is a sphere",
            Range::not_negative, "0 m"},
        b.rounding);
    row(described_key("on", "`\"vessel\"` or `\"ground\"`", "`\"vessel\"`",
            "frame in which its joints begin"),
        b.on);
    row(Parameter{"joint", "joints from there to the body, as in `[[mill.joint]]`"}.usually("none"),
        b.joints);
    row({"repeat",
            "number of copies, at equal angles about the axis of the first joint that rotates",
            {1, 24}, "1"},
        b.repeat);
    row(Parameter{"material", "material of the surface"}.as("name").usually("none"), b.material);
    row({"colour", "colour in pictures", Range::any, nullptr, "grey"}, b.colour);
  }
};

/// [mill] type = "chain"
struct ChainTable {
  Entries<JointTable> joints;

  static void keys(auto& c, auto&& row) {
    row({"joint", "joints from the ground to the vessel, any number of entries `[[mill.joint]]`",
            Range::any, nullptr, "required"},
        c.joints);
  }
};

struct MillTable {
  MotionSpec motion;

  static constexpr const char* what = "How the vessel moves.";
  static void keys(auto& m, auto&& row) {
    row(Parameter{"type", "how the vessel moves"}.as("name").usually("`\"spex8000\"`"), m.motion);
  }
};

struct PlaneTable {
  QuantityVector normal{Quantity{1}};
  Quantity distance;

  static constexpr const char* what = "Walls of a polyhedron.";
  static void keys(auto& p, auto&& row) {
    row({"normal", "outward normal, of any length"}, p.normal);
    row({"distance", Dimension::length, "distance from the vessel's origin, which is inside"},
        p.distance);
  }
};

struct VertexTable {
  QuantityVector at{};

  static constexpr const char* what = "Corners of a polyhedron.";
  static void keys(auto& v, auto&& row) {
    row({"at", Dimension::length, "position in the vessel frame"}, v.at);
  }
};

/// [vessel] type = "polyhedron"
struct PolyhedronTable {
  Entries<PlaneTable> planes;
  Entries<VertexTable> vertices;

  static void keys(auto& p, auto&& row) {
    row(Parameter{"plane", "planes of the walls, one entry `[[vessel.plane]]` for each"}.usually(
            "this or `vertex`"),
        p.planes);
    row(Parameter{"vertex", "corners of a convex vessel, entries `[[vessel.vertex]]`"}.usually(
            "this or `plane`"),
        p.vertices);
  }
};

/// The table of a type of mill or vessel that has other keys besides parameters.
inline ChainTable table_of(const model::Chain<Quantity>&) { return {}; }
inline PolyhedronTable table_of(const model::Polyhedron<Quantity>&) { return {}; }

/// A name in [vessel.materials]. It is compared with the walls when the vessel has been read.
struct WallName : std::string {
  static constexpr const char* what = "Materials of single walls.";
  static constexpr Parameter entry = described_key("*", "name", "`vessel.material`",
      "material of the wall that the key names, by label or number: `\"cap +y\"`, `wall_1`");
  static std::optional<WallName> read(Section&, const std::string& name) { return WallName{name}; }
};

struct PistonTable {
  std::string wall;
  Quantity distance, speed;
  Entries<SwingTable> swings{{}, {Dimension::length, "amplitude, positive inward"}};

  static constexpr const char* what =
      "A wall that is displaced inward from its nominal position by distance + speed t + swings.";
  static void keys(auto& p, auto&& row) {
    row(described_key(
            "wall", "name", "required", "flat wall, by label or number: `\"cap -y\"`, `wall_0`"),
        p.wall);
    row({"distance", Dimension::length,
            "distance inward from the wall's nominal position at time 0", Range::any, "0 m"},
        p.distance);
    row({"speed", Dimension::speed, "speed inward; needs `run.end_time`", Range::any, "0 m/s"},
        p.speed);
    row(SwingTable::key, p.swings);
  }
};

struct VesselTable {
  VesselSpec shape;
  Colour colour{1, 1, 0};
  std::string material;
  Inner<Named<WallName>> materials;
  Entries<PistonTable> pistons;

  static constexpr const char* what =
      "Shape of the inside of the vessel, its walls and their materials.";
  static void keys(auto& v, auto&& row) {
    row(described_key("type", "name", "`\"cylinder\"`",
            "shape of the inside; its y axis is the axis of round vessels"),
        v.shape);
    row({"colour", "colour in pictures: a name, three integers up to 255 or three decimals up to 1",
            Range::any, nullptr, "yellow"},
        v.colour);
    row(Parameter{"material", "material of all walls"}.as("name").usually("none"), v.material);
    row({"materials", "materials of single walls, `[vessel.materials]`"}, v.materials);
    row({"piston", "moving flat walls, entries `[[vessel.piston]]`"}, v.pistons);
  }
};

/// The names of two materials, which can be the same.
struct TwoMaterials {
  std::vector<std::string> names;
  void read_from(Section& section, const char* key) {
    names = section.settings(key, Section::Twice::allowed);
  }
};

struct PairTable {
  TwoMaterials materials;

  static constexpr const char* what = "A law for two materials.";
  static void keys(auto& p, auto&& row) {
    row(described_key("materials", "two names", "required",
            "names of the two materials; the entry also takes all keys of `[contact]` that "
            "describe a law"),
        p.materials);
  }
};

using Laws = model::NamedLaws<Quantity>;

/// The keys of a contact law. Those of other laws may be given too, for sweeps over laws.
struct LawTable {
  /// The law's name. An inherited name has precedence over the default.
  struct Name {
    using Kinds = Laws;
    std::string text;
    void read_from(Section& section, const char* key);
  };
  using Points = std::map<std::string, std::vector<std::array<Quantity, 2>>>;  ///< by key
  template <class Law> struct PointsOf {
    Points& points;
    void read_from(Section& section, const char* key);
  };

  Name name;
  std::map<std::string, std::optional<Quantity>> parameters;
  Points points;
  Quantity least_separation{1, 100};

  static void keys(auto& given, auto&& row) {
    using enum Dimension;
    row(Parameter{"model", "name of the contact law"}.as("name").usually("`\"walton-braun\"`"),
        given.name);
    for_each_kind<Laws>([&](auto law) {
      law.parameters(law, [&](const Parameter& p, const Quantity&) {
        const Parameter own = p.only_of(law.name);
        row(p.fallback || p.otherwise ? own : own.usually("required"), given.parameters[p.key]);
      });
    });
    row(Parameter{"restitution_normal", "another name for `restitution`", {0, 1}}.only_of(
            "walton-braun, constant"),
        given.parameters["restitution"]);
    for_each_kind<Laws>([&]<class Law>(const Law&) {
      if constexpr (requires { Law::table; })
        row(Law::table.as("list of pairs").usually("required").only_of(Law::name),
            PointsOf<Law>{given.points});
    });
    row({"least_separation", speed,
            "lowest speed at which bodies separate after an impact; `\"0 m/s\"` is the exact "
            "model, in which infinitely many impacts in a finite time end the run",
            Range::not_negative, "1 cm/s"},
        given.least_separation);
  }
};

struct ContactTable {
  LawTable shared;
  std::optional<Section> ball_ball, ball_wall;  ///< with the keys of a LawTable
  Entries<PairTable> pairs;

  static constexpr const char* what =
      "The contact law. `[contact.ball_ball]`, `[contact.ball_wall]` and `[[contact.pair]]` take "
      "the same keys except the last three.";
  static void keys(auto& c, auto&& row) {
    LawTable::keys(c.shared, row);
    row(Parameter{"ball_ball", "keys that override those of `[contact]` between balls"}.as("table"),
        c.ball_ball);
    row(Parameter{"ball_wall", "keys that override those of `[contact]` at walls"}.as("table"),
        c.ball_wall);
    row({"pair",
            "keys that override those of `[contact]` between two materials, entries "
            "`[[contact.pair]]`"},
        c.pairs);
  }
};

enum class CountedPart { all, normal };
inline constexpr std::array<std::string_view, 2> choices_of(CountedPart) {
  return {"all", "normal"};
}

struct PowderTable {
  Quantity mass;
  TargetSpec target;
  CountedPart counts = CountedPart::all;

  static constexpr const char* what = "Powder that the balls mill.";
  static void keys(auto& p, auto&& row) {
    TargetSpec::keys(p.target, row);
    row({"mass", Dimension::mass, "mass of the powder, for the charge ratio and the specific dose",
            Range::positive},
        p.mass);
    row(described_key("counts", "`\"all\"` or `\"normal\"`", "`\"all\"`",
            "which part of the dose counts toward the target: all of it, or the part along the "
            "normal"),
        p.counts);
  }
};

/// The sections of a case file.
struct CaseFile {
  Inner<CaseSpec> run;
  Inner<MillTable> mill;
  Inner<VesselTable> vessel;
  Entries<BodyTable> bodies;
  Entries<MaterialSpec> materials;
  Inner<ContactTable> contact;
  Inner<PowderTable> powder;
  Entries<BallBatch> batches;
  Entries<ExplicitBall> balls;
  Entries<OutputSpec> outputs{{}, {}, true};
  Inner<AuditSpec> audit;

  static void keys(auto& f, auto&& row) {
    row({"run", ""}, f.run);
    row({"mill", ""}, f.mill);
    row({"vessel", ""}, f.vessel);
    row({"body", ""}, f.bodies);
    row({"material", ""}, f.materials);
    row({"contact", ""}, f.contact);
    row({"powder", ""}, f.powder);
    row({"balls", ""}, f.batches);
    row({"ball", ""}, f.balls);
    row({"output", ""}, f.outputs);
    row({"audit", ""}, f.audit);
  }
};

/// Number of the material that a key names; 0 without a name, and for an unknown, reported one.
int material_of(
    Section& section, const std::string& key, const std::string& name, const CaseSpec& spec);
/// The vessel in double; nothing if it is invalid, which has been reported.
std::optional<model::AnyVessel<double>> known_vessel(const CaseSpec& spec);
/// The wall of a label or a key; -1 for none.
int wall_named(const std::string& name, const model::Partners& partners);
/// Reports translations at constant speed, which only the end of a run bounds.
void require_end(Section& mill);
/// [[vessel.piston]]
void read_pistons(Section& vessel, Entries<PistonTable>& entries, CaseSpec& spec);
/// Reports pistons that leave the vessel or meet the other end.
void require_travel(std::vector<Section>& entries, const CaseSpec& spec);
/// [[body]]. @pre materials, vessel and mill have been read
void read_bodies(Entries<BodyTable>& entries, CaseSpec& spec);
/// Reports bodies that are outside of the vessel. @pre the case has no other problems
void require_bodies_inside(Entries<BodyTable>& entries, const CaseSpec& spec);
/// [contact], [contact.ball_ball], [contact.ball_wall] and [[contact.pair]].
/// @pre materials, vessel, powder and balls have been read, to which laws may refer
void read_contact(Section& contact, CaseSpec& spec);
/// Reports values of a part or a law, not from a file, that a file may not contain.
void check(Section mill, const MotionSpec& motion);
void check(Section vessel, const VesselSpec& shape);
void check(Section contact, const ContactSpec& law, const CaseSpec& spec);

}  // namespace edmill::casefile
