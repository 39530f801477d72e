#include "casefile/parts.hpp"

#include <fmt/format.h>

#include <utility>

#include "base/errors.hpp"
#include "casefile/case_parts.hpp"
#include "casefile/joints.hpp"
#include "casefile/polyhedron.hpp"
#include "casefile/section.hpp"

namespace edmill::casefile {

namespace {

using boost::multiprecision::cpp_rational;
using model::PartParameter;
using model::Range;

bool in_range(const Quantity& q, Range range) {
  switch (range) {
    case Range::any:
      return true;
    case Range::not_negative:
      return !q.negative();
    case Range::positive:
    case Range::count:
    case Range::drive:
      return q.positive();
    case Range::quarter_turn:
      return !q.negative() && q.value <= (q.pi_power == 1 ? cpp_rational(1, 2) : cpp_rational(157, 100));
  }
  return false;
}

std::string expected(const PartParameter& p) {
  if (p.range == Range::quarter_turn) return "an angle from 0 to 90 deg";
  if (p.range == Range::count) return "at least 1";
  const auto what = noun(p.dimension);
  return p.range == Range::any            ? "a " + what
         : p.range == Range::not_negative ? "a " + what + " of 0 or more"
                                          : "a positive " + what;
}

/// What is kept of a value that was read.
Quantity kept(const Quantity& q, Range range) {
  if (range != Range::drive) return q;
  return q.positive() ? Quantity{2 / q.value, 1 - q.pi_power} : Quantity{1};
}

Quantity fallback_of(const PartParameter& p) {
  const auto result = parse_quantity(p.fallback, p.dimension);
  EDMILL_REQUIRE(std::holds_alternative<Quantity>(result), "a default that can be read");
  return std::get<Quantity>(result);
}

struct Reader {
  Section& section;
  bool& complete;  ///< no value is missing or cannot be read

  void operator()(const PartParameter& p, Quantity& value) const {
    const Quantity found = !p.key       ? fallback_of(p)
                           : p.fallback ? section.quantity(p.key, p.dimension, fallback_of(p))
                                        : section.required(p.key, p.dimension);
    if (p.key) section.require(in_range(found, p.range), p.key, expected(p));
    if (p.key && (!p.fallback || section.has(p.key)) && !section.quantity(p.key, p.dimension))
      complete = false;
    value = kept(found, p.range);
  }
  void operator()(const PartParameter& p, std::array<Quantity, 3>& values) const {
    const auto found = section.vector(p.key, p.dimension);
    if (!found) {
      if (p.fallback && !section.has(p.key))
        values.fill(fallback_of(p));
      else if (!section.has(p.key))
        section.problem(p.key, "nothing", "three of " + casefile::describe(p.dimension));
      return;
    }
    for (const auto& value : *found) section.require(in_range(value, p.range), p.key, expected(p));
    values = *found;
  }
};

/// What the ranges of single parameters do not say.
void require_shape(Section&, const auto&) {}
void require_shape(Section& vessel, const model::Capsule<Quantity>& capsule) {
  vessel.require(capsule.height.value >= capsule.diameter.value, "height", "the diameter or more");
}
void require_shape(Section& vessel, const model::RoundedCylinder<Quantity>& cylinder) {
  const cpp_rational width = 2 * cylinder.edge.value;
  vessel.require(width <= cylinder.diameter.value && width <= cylinder.height.value, "edge_radius",
                 "at most half of the diameter and of the height");
}

/// Checks values that were not read in the same way.
struct Checker {
  Section& section;

  void operator()(const PartParameter& p, const Quantity& value) const {
    if (p.key) section.require(in_range(value, p.range), p.key, expected(p));
  }
  void operator()(const PartParameter& p, const std::array<Quantity, 3>& values) const {
    for (const auto& value : values) (*this)(p, value);
  }
};

template <class Variant>
Variant read_part(Section& given) {
  Variant chosen;
  [&]<std::size_t... kind>(std::index_sequence<kind...>) {
    const auto name = given.kind("type", {std::variant_alternative_t<kind, Variant>::name...});
    // Where the type is unknown, nothing else can be judged.
    Document ignored;
    Section nothing(ignored, nullptr, given.path());
    Section& section = given.of_unknown_kind() ? nothing : given;
    const auto read = [&]<class Part>(Part part) {
      if (name != Part::name) return;
      bool complete = true;
      if constexpr (requires { part.given; })
        part.given = read_joints(section);
      else if constexpr (requires { part.faces; })
        part = read_polyhedron(section);
      else
        Part::parameters(part, Reader{section, complete});
      if (complete) require_shape(section, part);
      chosen = part;
    };
    (read(std::variant_alternative_t<kind, Variant>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<Variant>>{});
  return chosen;
}

template <class Variant>
std::string described(const Variant& part) {
  std::string text;
  for_each_parameter(part, [&](const PartParameter& p, const std::vector<Quantity>& values) {
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
          m.parameters(m, Checker{mill});
      },
      motion);
}
void check(Section vessel, const VesselSpec& shape) {
  std::visit(
      [&](const auto& v) {
        if constexpr (!requires { v.faces; }) v.parameters(v, Checker{vessel});
        require_shape(vessel, v);
      },
      shape);
}

std::optional<Quantity> read_if_given(Section& section, const PartParameter& p) {
  std::optional<Quantity> value;
  if (p.range != Range::count)
    value = section.quantity(p.key, p.dimension);
  else if (const auto count = section.count(p.key))
    value = Quantity{cpp_rational(*count)};
  if (value) section.require(in_range(*value, p.range), p.key, expected(p));
  return value;
}

MotionSpec read_motion(Section& mill) { return read_part<MotionSpec>(mill); }
VesselSpec read_vessel(Section& vessel) { return read_part<VesselSpec>(vessel); }

}  // namespace edmill::casefile
