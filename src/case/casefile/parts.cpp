#include "casefile/parts.hpp"

#include <fmt/format.h>

#include "casefile/case_parts.hpp"
#include "casefile/joints.hpp"
#include "casefile/key_reader.hpp"

namespace edmill::casefile {

namespace {

using model::Range;

/// What the ranges of single parameters do not say.
void require_shape(Section&, const auto&) {}
void require_shape(Section& vessel, const model::Capsule<Quantity>& capsule) {
  vessel.require(capsule.height >= capsule.diameter, "height", "the diameter or more");
}
void require_shape(Section& vessel, const model::RoundedCylinder<Quantity>& cylinder) {
  const Quantity width = Quantity(2) * cylinder.edge;
  vessel.require(width <= cylinder.diameter && width <= cylinder.height, "edge_radius",
                 "at most half of the diameter and of the height");
}

template <class Variant>
Variant read_part(Section& given) {
  Variant chosen;
  const auto name = given.kind("type", names_of_kinds<Variant>());
  // Where the type is unknown, nothing else can be judged.
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

std::string described(const auto& part) {
  std::string text;
  for_each_parameter(part, [&](const model::Parameter& p, const std::vector<Quantity>& values) {
    if (!p.key) return;
    const bool drive = p.range == Range::drive;
    text += fmt::format("{}{}", text.empty() ? ": " : ", ", drive ? "period" : p.key);
    for (const auto& value : values) text += fmt::format(" {:g}", value.to<double>());
    text += drive ? " s" : si_unit(p.dimension);
  });
  return name_of(part) + text;
}

}  // namespace

std::string describe(const MotionSpec& motion) {
  if (const auto* chain = std::get_if<model::Chain<Quantity>>(&motion))
    return std::string(chain->name) + ": " + equation_of(chain->given);
  return described(motion);
}
std::string describe(const VesselSpec& vessel) {
  if (const auto* polyhedron = std::get_if<model::Polyhedron<Quantity>>(&vessel))
    return fmt::format("{} of {} walls", polyhedron->name, polyhedron->faces.size());
  return described(vessel);
}

void check(Section mill, const MotionSpec& motion) {
  std::visit(
      [&](const auto& m) {
        if constexpr (requires { m.given; })
          for (const auto& joint : m.given.list) check_swings(mill, joint.swings);
        else
          m.parameters(m, KeyChecker{mill});
      },
      motion);
}
void check(Section vessel, const VesselSpec& shape) {
  std::visit(
      [&](const auto& v) {
        if constexpr (!requires { v.faces; }) v.parameters(v, KeyChecker{vessel});
        require_shape(vessel, v);
      },
      shape);
}

MotionSpec read_motion(Section& mill) { return read_part<MotionSpec>(mill); }
VesselSpec read_vessel(Section& vessel) { return read_part<VesselSpec>(vessel); }

}  // namespace edmill::casefile
