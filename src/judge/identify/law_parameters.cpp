// Numbers of the contact laws, and other laws in their place.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
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

/// Numbers of contact laws: those of both kinds of contact together where they are equal, and of each.
class Laws {
 public:
  explicit Laws(const Assumptions& nominal, std::vector<Parameter>& list) : nominal_(nominal), list_(list) {}

  void add() {
    const auto& spec = nominal_.spec;
    if (!spec.pairs_only) add_both(spec.ball_ball, spec.ball_wall);
    for (std::size_t k = 0; k < spec.pairs.size(); ++k)
      add_law(fmt::format("contact.pair.{}", k), spec.pairs[k].law,
              [k](Assumptions& a) -> casefile::ContactSpec& { return a.spec.pairs[k].law; });
  }

 private:
  using Law = casefile::ContactSpec;
  struct Entry {
    std::string key;
    Dimension dimension;
    double value;
  };
  /// The single numbers of a law; tables of numbers are left out.
  template <class L, class F>
  static void each(L& law, F&& f) {
    const auto visit = [&]<class Value>(const auto& p, Value& value) {
      if constexpr (std::is_same_v<Value, Quantity>) f(p.key, p.dimension, value);
    };
    std::visit([&](auto& own) { own.parameters(own, visit); }, law.law);
    f("least_separation", Dimension::speed, law.least_separation);
  }
  static std::vector<Entry> entries(Law law) {
    std::vector<Entry> list;
    each(law, [&](const char* key, Dimension dimension, Quantity& q) {
      list.push_back({key, dimension, q.to<double>()});
    });
    return list;
  }
  /// The number of this name; another law may not have it. Points of tables have one name, and are told apart
  /// by their place.
  static void put(Law& law, const std::string& key, std::size_t which, double value) {
    std::size_t k = 0;
    each(law, [&](const char* own, Dimension, Quantity& q) {
      if (own == key && k++ == which) q = exactly(value);
    });
  }
  static std::size_t which(const std::vector<Entry>& list, std::size_t place) {
    return static_cast<std::size_t>(std::count_if(list.begin(),
                                                  list.begin() + static_cast<std::ptrdiff_t>(place),
                                                  [&](const Entry& e) { return e.key == list[place].key; }));
  }
  void push(const Entry& e, const std::string& section, std::function<void(Assumptions&, double)> set) {
    auto p = number(section + "." + e.key, e.dimension, e.value, std::move(set));
    if (e.value == 0) p.change = e.dimension == Dimension::speed ? 0.01 : 0.1;
    list_.push_back(std::move(p));
  }
  /// The law with one number of another: its others are the law's own where they have the same name.
  /// @return whether it has all numbers that such a law needs
  static bool replace(Law& law, const OtherLaw& other, double value) {
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
  template <class Find>
  void add_others(const std::string& section, const Law& law, Find find) {
    for (const auto& other : other_laws) {
      Law tried = law;
      if (law.name() == other.model || !replace(tried, other, other.first_values.front())) continue;
      list_.push_back({.key = fmt::format("{}, law \"{}\": {}", section, other.model, other.number),
                       .dimension = other.dimension,
                       .value = std::numeric_limits<double>::quiet_NaN(),
                       .change = other.change,
                       .set =
                           [find, &other](Assumptions& a, double x) {
                             for (Law* own : find(a)) replace(*own, other, x);
                           },
                       .of_flights = false,
                       .prior = 1,  // of two that fit alike, a number of the case's law comes first
                       .in_place_of = fmt::format("the law \"{}\"", law.name()),
                       .first_values = other.first_values});
    }
  }
  template <class Find>
  void add_law(const std::string& section, const Law& law, Find find) {
    const auto own = entries(law);
    for (std::size_t k = 0; k < own.size(); ++k)
      push(own[k], section, [find, key = own[k].key, n = which(own, k)](Assumptions& a, double x) {
        put(find(a), key, n, x);
      });
  }
  void add_both(const Law& balls, const Law& walls) {
    const auto one = entries(balls), two = entries(walls);
    const bool alike = balls.law.index() == walls.law.index();
    for (std::size_t k = 0; alike && k < one.size(); ++k)
      if (one[k].value == two[k].value)
        push(one[k], "contact", [key = one[k].key, n = which(one, k)](Assumptions& a, double x) {
          put(a.spec.ball_ball, key, n, x);
          put(a.spec.ball_wall, key, n, x);
        });
    if (alike)
      add_others("contact", balls, [](Assumptions& a) -> std::vector<Law*> {
        return {&a.spec.ball_ball, &a.spec.ball_wall};
      });
    add_others("contact.ball_ball", balls,
               [](Assumptions& a) -> std::vector<Law*> { return {&a.spec.ball_ball}; });
    add_others("contact.ball_wall", walls,
               [](Assumptions& a) -> std::vector<Law*> { return {&a.spec.ball_wall}; });
    add_law("contact.ball_ball", balls, [](Assumptions& a) -> Law& { return a.spec.ball_ball; });
    add_law("contact.ball_wall", walls, [](Assumptions& a) -> Law& { return a.spec.ball_wall; });
  }

  const Assumptions& nominal_;
  std::vector<Parameter>& list_;
};

}  // namespace

void add_laws(const Assumptions& nominal, std::vector<Parameter>& list) { Laws(nominal, list).add(); }

}  // namespace edmill::identify
