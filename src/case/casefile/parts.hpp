// Motions and vessels of a case file.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "casefile/quantity.hpp"
#include "model/motion.hpp"
#include "model/vessel.hpp"

namespace edmill::casefile {

using MotionSpec = model::NamedMotions<Quantity>;
using VesselSpec = model::NamedVessels<Quantity>;

/// Calls visit(kind) with a value of each type that a variant can hold, in their order.
template <class Variant, class Visit>
void for_each_kind(const Visit& visit) {
  const auto visit_all = [&]<class... Kind>(const std::variant<Kind...>*) { (visit(Kind{}), ...); };
  visit_all(static_cast<const Variant*>(nullptr));
}

/// The names of these types.
template <class Variant>
std::vector<std::string> names_of_kinds() {
  std::vector<std::string> names;
  for_each_kind<Variant>([&](const auto& kind) { names.emplace_back(kind.name); });
  return names;
}

/// The name of a part's type, "spex8000".
template <class... Part>
std::string name_of(const std::variant<Part...>& part) {
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
template <class... Part>
std::string text_of(const std::variant<Part...>& part) {
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
std::vector<model::Swing<Quantity>> with_phases(std::vector<model::Swing<Quantity>> swings,
                                                const Quantity& period);

/// "turn about y at 300 rpm, shift by (0.15, 0, 0) m, turn about y at -600 rpm".
std::string equation_of(const model::Joints<Quantity>& joints);
/// " + 0.01 m sin(2 pi 5 t)" for each.
std::string equation_of(const std::vector<model::Swing<Quantity>>& swings, bool rotate);

/// Returns the number of a key as written in the file, "38 mm"; nothing if there is none.
using Written = std::function<std::optional<std::string>(const std::string& key)>;
/// "cylinder: diameter 38 mm, height 57 mm", for readers. @param written  otherwise in SI
std::string describe(const MotionSpec& motion, const Written& written = {});
std::string describe(const VesselSpec& vessel, const Written& written = {});

class Section;
/// Reads type and parameters of [mill] or [vessel]. @param key  the one of the type
MotionSpec read_motion(Section& mill, const char* key);
VesselSpec read_vessel(Section& vessel, const char* key);

}  // namespace edmill::casefile
