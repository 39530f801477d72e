#include <fmt/format.h>

#include <utility>

#include "casefile/rational.hpp"
#include "casefile/tables.hpp"

namespace edmill::casefile {

namespace {

/// Reads the keys of a law that a section gives; the others keep their inherited values.
void read_law(Section& s, LawTable& given) {
  LawTable::keys(given, KeyReader(s, KeyReader::Absent::kept));
  if (s.has("restitution") && s.has("restitution_normal"))
    s.problem("restitution_normal", "both 'restitution' and 'restitution_normal'", "one of them");
  if (s.has("collapse_time"))
    s.problem("collapse_time", "a key that no longer exists",
        "'least_separation', the lowest speed at which bodies separate after an impact");
}

/// Mass of the balls over that of the powder, where the case has powder.
std::optional<Quantity> charge_ratio(const CaseSpec& spec) {
  if (!spec.powder_mass || !spec.powder_mass->positive()) return std::nullopt;
  Rational mass = 0;  // times pi
  // The mean cube of diameters that are uniform in d +- s is d^3 + d s^2.
  spec.for_each_ball([&](const BallSpec& b) {
    const auto &d = rational(b.diameter), &s = rational(b.diameter_spread);
    mass += b.count * rational(b.density) * d * (d * d + s * s) / 6;
  });
  return quantity_of(mass / rational(*spec.powder_mass), 1);
}

/// Reports balls outside of the powder-load table, which covers 2.36 mm to 9.52 mm.
void require_diameters(Section& s, const CaseSpec& spec) {
  using Law = model::PowderLoad<Quantity>;
  const Rational least(Law::diameters.front(), 1000000), largest(Law::diameters.back(), 1000000);
  spec.for_each_ball([&](const BallSpec& ball) {
    const auto &diameter = rational(ball.diameter), &spread = rational(ball.diameter_spread);
    if (diameter - spread < least || diameter + spread > largest)
      s.problem("model",
          fmt::format("\"{}\" with balls of {:g} m", Law::name, ball.diameter.to<double>()),
          "balls of 2.36 mm to 9.52 mm, the range of its table");
  });
}

/// @param missing  called for each missing parameter, with its key and the expected value
ContactSpec to_spec(
    Section& contact, const LawTable& given, const CaseSpec& spec, const auto& missing) {
  ContactSpec result;
  result.least_separation = given.least_separation;
  for_each_kind<Laws>([&](auto law) {
    if (given.name.text != law.name) return;
    law.parameters(law, [&](const Parameter& p, Quantity& value) {
      if (const auto found = given.parameters.find(p.key);
          found != given.parameters.end() && found->second) {
        value = *found->second;
      } else if (p.fallback) {
        value = fallback_of(p);
      } else if (const auto ratio = charge_ratio(spec);
                 ratio && p.key == std::string("charge_ratio")) {
        value = *ratio;
        if (!in_range(value, p.range))
          contact.problem(p.key,
              fmt::format("{:.4g} from [[balls]] and [powder]", value.to<double>()), expected(p));
      } else {
        missing(p.key, expected(p));
      }
    });
    if constexpr (requires { law.points; }) {
      if (const auto found = given.points.find(law.table.key); found != given.points.end())
        law.points = found->second;
      else
        missing(law.table.key, law.table_form);
    }
    if constexpr (std::is_same_v<decltype(law), model::PowderLoad<Quantity>>)
      require_diameters(contact, spec);
    result.law = law;
  });
  return result;
}

ContactSpec to_spec(Section& contact, const LawTable& given, const CaseSpec& spec) {
  return to_spec(contact, given, spec, [&](const std::string& key, const std::string& expected) {
    contact.problem(key, "nothing", expected);
  });
}

/// True if all parameters that the law needs are given.
bool is_complete(const LawTable& given, const CaseSpec& spec) {
  Document ignored;
  Section nothing(ignored, nullptr, "contact");
  bool complete = true;
  to_spec(nothing, given, spec, [&](const auto&...) { complete = false; });
  return complete;
}

void read_pairs(ContactTable& contact, CaseSpec& spec) {
  for (Section& entry : contact.pairs) {
    PairTable table;
    read_keys(entry, table);
    const auto& names = table.materials.names;
    PairSpec pair;
    if (names.size() == 2)
      pair.materials = {spec.material_named(names[0]), spec.material_named(names[1])};
    const bool known = pair.materials[0] > 0 && pair.materials[1] > 0;
    if (!known)
      entry.problem("materials",
          names.empty() ? "nothing" : fmt::format("\"{}\"", fmt::join(names, "\", \"")),
          "the names of two [[material]] entries");
    for (const auto& other : spec.pairs)
      if (known && other.is_of(pair.materials[0], pair.materials[1]))
        entry.problem("materials", fmt::format("\"{}\" and \"{}\" again", names[0], names[1]),
            "one entry for each pair");
    LawTable given = contact.shared;
    read_law(entry, given);
    entry.reject_unknown_keys();
    pair.law = to_spec(entry, given, spec);
    spec.pairs.push_back(std::move(pair));
  }
}

/// For a case with laws for pairs of materials only: reports possible contacts that have none.
void require_all_pairs(Section& contact, const CaseSpec& spec) {
  std::vector<int> of_balls;
  spec.for_each_ball([&](const BallSpec& ball) { of_balls.push_back(ball.material); });
  const auto name = [&](int material) {
    return material == 0 ? "bodies without a material"
                         : "\"" + spec.materials[material - 1].name + "\"";
  };
  const auto require = [&](int one, int other) {
    for (const auto& pair : spec.pairs)
      if (pair.is_of(one, other)) return;
    const auto partners = name(one) + " and " + name(other);
    contact.problem(
        "pair", "nothing", "an entry [[contact.pair]] for " + partners + ", or a law in [contact]");
  };
  for (const int ball : of_balls) {
    for (const int other : of_balls) require(ball, other);
    for (const int wall : spec.wall_materials) require(ball, wall);
  }
}

}  // namespace

void LawTable::Name::read_from(Section& section, const char* key) {
  const bool chosen = section.has(key);
  const auto name = section.choice(key, names_of_kinds<Laws>());
  if (chosen || text.empty()) text = name;
}

template <class Law> void LawTable::PointsOf<Law>::read_from(Section& s, const char* key) {
  constexpr const auto& rows = Law::table_rows;
  auto found = s.pairs(key, rows[0].dimension, rows[1].dimension);
  if (!s.has(key)) return;
  bool good = !found.empty();
  for (std::size_t k = 0; k < found.size(); ++k)
    good = good && in_range(found[k][0], rows[0].range) && in_range(found[k][1], rows[1].range) &&
        (k == 0 || found[k - 1][0] < found[k][0]);
  if (!good) s.problem(key, fmt::format("a table of {} points", found.size()), Law::table_form);
  points[key] = std::move(found);
}

void check(Section contact, const ContactSpec& law, const CaseSpec& spec) {
  law.parameters(KeyChecker{contact});
  if (std::holds_alternative<model::PowderLoad<Quantity>>(law.law))
    require_diameters(contact, spec);
  contact.require(!law.least_separation.negative(), "least_separation", "a speed of 0 or more");
}

void read_contact(Section& contact, CaseSpec& spec) {
  ContactTable table;
  ContactTable::keys(table, KeyReader(contact, KeyReader::Absent::kept));
  read_law(contact, table.shared);
  read_pairs(table, spec);
  LawTable of_balls = table.shared, of_walls = table.shared;
  read_law(*table.ball_ball, of_balls);
  read_law(*table.ball_wall, of_walls);
  table.ball_ball->reject_unknown_keys();
  table.ball_wall->reject_unknown_keys();
  if (!spec.pairs.empty() && !is_complete(of_balls, spec) && !is_complete(of_walls, spec)) {
    spec.pairs_only = true;
    spec.ball_ball = spec.ball_wall = spec.pairs.front().law;
    require_all_pairs(contact, spec);
  } else {
    spec.ball_ball = to_spec(contact, of_balls, spec);
    spec.ball_wall = to_spec(contact, of_walls, spec);
  }
  contact.reject_unknown_keys();
}

}  // namespace edmill::casefile
