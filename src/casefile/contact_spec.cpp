#include <fmt/format.h>

#include <map>
#include <utility>

#include "casefile/case_parts.hpp"

namespace edmill::casefile {

using boost::multiprecision::cpp_rational;

namespace {

/// What a section gives of a law, over what it inherits.
struct GivenLaw {
  std::string name;
  std::map<std::string, Quantity> parameters;
  Quantity least_separation{cpp_rational(1, 100)};
};

/// Calls visit(law) with one law of each kind.
template <class Visit>
void for_each_law(const Visit& visit) {
  [&]<std::size_t... kind>(std::index_sequence<kind...>) {
    (visit(std::variant_alternative_t<kind, model::NamedLaws<Quantity>>{}), ...);
  }
  (std::make_index_sequence<std::variant_size_v<model::NamedLaws<Quantity>>>{});
}

std::vector<std::string> law_names() {
  std::vector<std::string> names;
  for_each_law([&](const auto& law) { names.push_back(law.name); });
  return names;
}

std::string expected(const model::LawParameter& p) {
  return fmt::format("a number from {} to {}", p.low, p.high);
}

/// Parameters of every law may be given, so that a sweep over laws has all that it needs in one section.
void read_law(Section& s, GivenLaw& given) {
  const bool chosen = s.has("model");
  const auto name = s.choice("model", law_names());
  if (chosen || given.name.empty()) given.name = name;
  if (s.has("restitution") && s.has("restitution_normal"))
    s.problem("restitution_normal", "both 'restitution' and 'restitution_normal'", "one of them");
  const auto take = [&](const std::string& key, const model::LawParameter& p) {
    const bool here = s.has(key);
    const auto found = s.quantity(key, Dimension::none);
    if (found) s.require(found->value >= p.low && found->value <= p.high, key, expected(p));
    if (here) given.parameters[p.key] = found.value_or(Quantity{});  // what is wrong has been reported
  };
  std::map<std::string, bool> read;
  for_each_law([&](const auto& law) {
    law.parameters(law, [&](const model::LawParameter& p, const Quantity&) {
      if (std::exchange(read[p.key], true)) return;
      take(p.key, p);
      if (p.key == std::string("restitution")) take("restitution_normal", p);
    });
  });
  if (const auto speed = s.quantity("least_separation", Dimension::speed)) {
    given.least_separation = *speed;
    s.require(!speed->negative(), "least_separation", "a speed of 0 or more");
  }
  s.replaced("collapse_time", "'least_separation', the least speed at which bodies leave an impact");
}

ContactSpec to_spec(Section& contact, const GivenLaw& given) {
  ContactSpec spec;
  spec.least_separation = given.least_separation;
  for_each_law([&](auto law) {
    if (given.name != law.name) return;
    law.parameters(law, [&](const model::LawParameter& p, Quantity& value) {
      const auto found = given.parameters.find(p.key);
      if (found != given.parameters.end())
        value = found->second;
      else if (p.fallback)
        value = Quantity{cpp_rational(*p.fallback)};
      else
        contact.problem(p.key, "nothing", expected(p));
    });
    spec.law = law;
  });
  return spec;
}

}  // namespace

void read_contact(Section contact, CaseSpec& spec) {
  GivenLaw shared;
  read_law(contact, shared);
  for (const bool balls : {true, false}) {
    Section own = contact.section(balls ? "ball_ball" : "ball_wall");
    GivenLaw given = shared;
    read_law(own, given);
    own.reject_unknown_keys();
    (balls ? spec.ball_ball : spec.ball_wall) = to_spec(contact, given);
  }
  contact.reject_unknown_keys();
}

}  // namespace edmill::casefile
