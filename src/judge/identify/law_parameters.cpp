// Numbers of the contact laws, and other laws in their place.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include "identify/parameters.hpp"

namespace edmill::identify {

namespace {

using casefile::Quantity;
using AnyLaw = decltype(casefile::ContactSpec::law);

/// Values so near each other that a fit from the best of them ends at the number.
std::vector<double> decades(double from, double to) {
  std::vector<double> values;
  for (double value = from; value < to; value *= 1.3) values.push_back(value);
  return values;
}

/// A law that a code may have in place of the case's, by the number of it that is fitted. A new one is a row.
struct OtherLaw {
  std::string_view model, number;
  Dimension dimension;
  double change;
  std::vector<double> first_values;  ///< from which fits begin
};
const OtherLaw other_laws[] = {
    {"constant", "restitution_tangential", Dimension::none, 0.1, {-0.9, -0.6, -0.3, 0, 0.3, 0.6, 0.9}},
    {"walton-braun", "friction", Dimension::none, 0.1, {0.03, 0.1, 0.2, 0.4, 0.8}},
    {"walton-braun", "restitution", Dimension::none, 0.1, {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}},
    {"viscoelastic", "dissipative_time", Dimension::time, 1e-7, decades(1e-8, 1e-4)},
    {"elastic-plastic", "yield_pressure", Dimension::pressure, 1e9, decades(1e8, 1e11)}};

/// What another law has where the case's says nothing: all sticks, and E* of steel, on which the restitution
/// depends together with the fitted number alone. None of a number without which there is no such law.
std::optional<double> otherwise(std::string_view key) {
  if (key == "min_tangential") return -1;
  if (key == "effective_modulus") return 113e9;
  return std::nullopt;
}

template <std::size_t k = 0>
AnyLaw law_named(std::string_view name) {
  if constexpr (k + 1 < std::variant_size_v<AnyLaw>) {
    AnyLaw law(std::in_place_index<k>);
    if (std::visit([](const auto& l) { return std::string_view(l.name); }, law) == name) return law;
    return law_named<k + 1>(name);
  } else {
    return {};
  }
}

using Law = casefile::ContactSpec;
struct Entry {
  std::string key;
  Dimension dimension;
  double value;
};

/// The single numbers of a law; tables of numbers are left out.
template <class F>
void each(Law& law, F&& f) {
  const auto visit = [&]<class Value>(const auto& p, Value& value) {
    if constexpr (std::is_same_v<Value, Quantity>) f(p.key, p.dimension, value);
  };
  std::visit([&](auto& own) { own.parameters(own, visit); }, law.law);
  f("least_separation", Dimension::speed, law.least_separation);
}

std::vector<Entry> entries(Law law) {
  std::vector<Entry> list;
  each(law, [&](const char* key, Dimension dimension, Quantity& q) {
    list.push_back({key, dimension, q.to<double>()});
  });
  return list;
}

/// The number of this name; another law may not have it. Points of tables have one name, and differ
/// by their place.
void put(Law& law, const std::string& key, std::size_t which, double value) {
  std::size_t k = 0;
  each(law, [&](const char* own, Dimension, Quantity& q) {
    if (own == key && k++ == which) q = exactly(value);
  });
}

/// The law with one number of another: its others are the law's own where they have the same name.
/// @return whether it has all numbers that such a law needs
bool replace(Law& law, const OtherLaw& other, double value) {
  const auto own = entries(law);
  bool complete = true;
  law.law = law_named(other.model);
  each(law, [&](const char* key, Dimension, Quantity& q) {
    const auto same = std::find_if(own.begin(), own.end(), [&](const Entry& e) { return e.key == key; });
    const auto value_there = key == other.number ? value : same != own.end() ? same->value : otherwise(key);
    complete = complete && value_there;
    q = exactly(value_there.value_or(0));
  });
  return complete;
}

/// Where a case gives a law, or two that are alike.
struct Section {
  std::string key;  ///< "contact.ball_wall"
  std::function<std::vector<Law*>(Assumptions&)> laws;
};

/// The numbers of a section that its laws have alike.
void add_numbers_of(const Section& section, Assumptions nominal, std::vector<Parameter>& list) {
  const auto laws = section.laws(nominal);
  const auto own = entries(*laws.front()), others = entries(*laws.back());
  if (own.size() != others.size()) return;  // tables with other points
  std::map<std::string, std::size_t> seen;
  for (std::size_t k = 0; k < own.size(); ++k) {
    const auto& [key, dimension, value] = own[k];
    const auto set = [laws = section.laws, key = key, which = seen[key]++](Assumptions& a, double x) {
      for (Law* law : laws(a)) put(*law, key, which, x);
    };
    if (value != others[k].value) continue;
    list.push_back(number(section.key + "." + key, dimension, value, set));
    if (value == 0) list.back().change = dimension == Dimension::speed ? 0.01 : 0.1;
  }
}

void add_other_laws(const Section& section, Assumptions nominal, std::vector<Parameter>& list) {
  const Law& law = *section.laws(nominal).front();
  for (const auto& other : other_laws) {
    Law tried = law;
    if (law.name() == other.model || !replace(tried, other, other.first_values.front())) continue;
    list.push_back({.key = fmt::format("{}, law \"{}\": {}", section.key, other.model, other.number),
                    .dimension = other.dimension,
                    .value = std::numeric_limits<double>::quiet_NaN(),
                    .change = other.change,
                    .set =
                        [laws = section.laws, &other](Assumptions& a, double x) {
                          for (Law* own : laws(a)) replace(*own, other, x);
                        },
                    .of_flights = false,
                    .prior = 1,  // of two that fit alike, a number of the case's law comes first
                    .in_place_of = fmt::format("the law \"{}\"", law.name()),
                    .first_values = other.first_values});
  }
}

}  // namespace

void add_laws(const Assumptions& nominal, std::vector<Parameter>& list) {
  using Laws = std::vector<Law*>;
  const auto& spec = nominal.spec;
  std::vector<Section> sections;
  if (!spec.pairs_only) {
    if (spec.ball_ball.law.index() == spec.ball_wall.law.index())
      sections.push_back({"contact", [](Assumptions& a) {
                            return Laws{&a.spec.ball_ball, &a.spec.ball_wall};
                          }});
    sections.push_back({"contact.ball_ball", [](Assumptions& a) { return Laws{&a.spec.ball_ball}; }});
    sections.push_back({"contact.ball_wall", [](Assumptions& a) { return Laws{&a.spec.ball_wall}; }});
  }
  for (const auto& section : sections) add_numbers_of(section, nominal, list);
  for (const auto& section : sections) add_other_laws(section, nominal, list);
  for (std::size_t k = 0; k < spec.pairs.size(); ++k)
    add_numbers_of(
        {fmt::format("contact.pair.{}", k), [k](Assumptions& a) { return Laws{&a.spec.pairs[k].law}; }},
        nominal, list);
}

}  // namespace edmill::identify
