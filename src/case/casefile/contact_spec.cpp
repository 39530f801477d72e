#include <fmt/format.h>

#include <map>
#include <utility>

#include "casefile/case_parts.hpp"
#include "casefile/key_reader.hpp"
#include "casefile/rational.hpp"

namespace edmill::casefile {

namespace {

/// What a section gives of a law, over what it inherits.
struct GivenLaw {
  std::string name;
  std::map<std::string, Quantity> parameters;
  std::map<std::string, std::vector<std::array<Quantity, 2>>> tables;  ///< by key
  Quantity least_separation{1, 100};
};

using Laws = model::NamedLaws<Quantity>;

void require_least(Section& s, const Quantity& speed) {
  s.require(!speed.negative(), "least_separation", "a speed of 0 or more");
}

/// The table of a law that has one.
template <class Law>
void read_table(Section& s, GivenLaw& given) {
  constexpr const auto& rows = Law::table_rows;
  auto points = s.pairs(Law::table, rows[0].dimension, rows[1].dimension);
  if (!s.has(Law::table)) return;
  bool good = !points.empty();
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (std::size_t place = 0; place < 2; ++place)
      good = good && in_range(points[k][place], rows[place].range);
    if (k > 0) good = good && points[k - 1][0] < points[k][0];
  }
  if (!good) s.problem(Law::table, fmt::format("a table of {} points", points.size()), Law::table_form);
  given.tables[Law::table] = std::move(points);
}

/// Parameters of every law may be given, so that a sweep over laws has all that it needs in one section.
void read_law(Section& s, GivenLaw& given) {
  const bool chosen = s.has("model");
  const auto name = s.choice("model", names_of_kinds<Laws>());
  if (chosen || given.name.empty()) given.name = name;
  if (s.has("restitution") && s.has("restitution_normal"))
    s.problem("restitution_normal", "both 'restitution' and 'restitution_normal'", "one of them");
  const auto take = [&](const std::string& key, const Parameter& p) {
    const bool here = s.has(key);
    const auto found = s.quantity(key, p.dimension);
    if (found) s.require(in_range(*found, p.range), key, expected(p));
    if (here) given.parameters[p.key] = found.value_or(Quantity{});  // what is wrong has been reported
  };
  std::map<std::string, bool> read;
  for_each_kind<Laws>([&](const auto& law) {
    law.parameters(law, [&](const Parameter& p, const Quantity&) {
      if (std::exchange(read[p.key], true)) return;
      take(p.key, p);
      if (p.key == std::string("restitution")) take("restitution_normal", p);
    });
  });
  for_each_kind<Laws>([&]<class Law>(const Law&) {
    if constexpr (requires { Law::table; }) read_table<Law>(s, given);
  });
  if (const auto speed = s.quantity("least_separation", Dimension::speed)) {
    given.least_separation = *speed;
    require_least(s, *speed);
  }
  s.replaced("collapse_time", "'least_separation', the least speed at which bodies leave an impact");
}

/// Mass of the balls over that of the powder, where the case has powder.
std::optional<Quantity> charge_ratio(const CaseSpec& spec) {
  if (!spec.powder_mass || !spec.powder_mass->positive()) return std::nullopt;
  Rational mass = 0;  // times pi
  // The mean cube of diameters that are uniform in d +- s is d^3 + d s^2.
  const auto add = [&](const BallSpec& b, int count, const Rational& s) {
    const auto& d = rational(b.diameter);
    mass += count * rational(b.density) * d * (d * d + s * s) / 6;
  };
  for (const auto& ball : spec.balls) add(ball, 1, 0);
  for (const auto& batch : spec.batches) add(batch, batch.count, rational(batch.diameter_spread));
  return quantity_of(mass / rational(*spec.powder_mass), 1);
}

/// The powder-load table has balls of 2.36 mm to 9.52 mm.
void require_diameters(Section& s, const CaseSpec& spec) {
  using Law = model::PowderLoad<Quantity>;
  const Rational least(Law::diameters.front(), 1000000), largest(Law::diameters.back(), 1000000);
  const auto check = [&](const BallSpec& ball, const Rational& spread) {
    const Rational& diameter = rational(ball.diameter);
    if (diameter - spread < least || diameter + spread > largest)
      s.problem("model", fmt::format("\"{}\" with balls of {:g} m", Law::name, ball.diameter.to<double>()),
                "balls of 2.36 mm to 9.52 mm, which its table is for");
  };
  for (const auto& ball : spec.balls) check(ball, 0);
  for (const auto& batch : spec.batches) check(batch, rational(batch.diameter_spread));
}

/// @param missing  called with the key of what its law needs and is not given, and what was expected
ContactSpec to_spec(Section& contact, const GivenLaw& given, const CaseSpec& spec, const auto& missing) {
  ContactSpec result;
  result.least_separation = given.least_separation;
  for_each_kind<Laws>([&](auto law) {
    if (given.name != law.name) return;
    law.parameters(law, [&](const Parameter& p, Quantity& value) {
      const auto found = given.parameters.find(p.key);
      if (found != given.parameters.end()) {
        value = found->second;
      } else if (p.fallback) {
        value = fallback_of(p);
      } else if (const auto ratio = charge_ratio(spec); ratio && p.key == std::string("charge_ratio")) {
        value = *ratio;
        if (!in_range(value, p.range))
          contact.problem(p.key, fmt::format("{:.4g} from [[balls]] and [powder]", value.to<double>()),
                          expected(p));
      } else {
        missing(p.key, expected(p));
      }
    });
    if constexpr (requires { law.points; }) {
      if (const auto found = given.tables.find(law.table); found != given.tables.end())
        law.points = found->second;
      else
        missing(law.table, law.table_form);
    }
    if constexpr (std::is_same_v<decltype(law), model::PowderLoad<Quantity>>)
      require_diameters(contact, spec);
    result.law = law;
  });
  return result;
}

ContactSpec to_spec(Section& contact, const GivenLaw& given, const CaseSpec& spec) {
  return to_spec(contact, given, spec, [&](const std::string& key, const std::string& expected) {
    contact.problem(key, "nothing", expected);
  });
}

/// Whether all that its law needs is given.
bool is_complete(const GivenLaw& given, const CaseSpec& spec) {
  Document ignored;
  Section nothing(ignored, nullptr, "contact");
  bool complete = true;
  to_spec(nothing, given, spec, [&](const auto&...) { complete = false; });
  return complete;
}

void read_pairs(Section& contact, const GivenLaw& shared, CaseSpec& spec) {
  for (Section& entry : contact.sections("pair")) {
    const auto names = entry.settings("materials", Section::Twice::allowed);
    PairSpec pair;
    bool known = names.size() == 2;
    for (std::size_t k = 0; known && k < 2; ++k) {
      pair.materials[k] = spec.material_named(names[k]);
      known = pair.materials[k] > 0;
    }
    if (!known)
      entry.problem("materials",
                    names.empty() ? "nothing" : fmt::format("\"{}\"", fmt::join(names, "\", \"")),
                    "the names of two [[material]] entries");
    for (const auto& other : spec.pairs)
      if (known && other.is_of(pair.materials[0], pair.materials[1]))
        entry.problem("materials", fmt::format("\"{}\" and \"{}\" again", names[0], names[1]),
                      "one entry for each pair");
    GivenLaw given = shared;
    read_law(entry, given);
    entry.reject_unknown_keys();
    pair.law = to_spec(entry, given, spec);
    spec.pairs.push_back(std::move(pair));
  }
}

/// Where the case has laws for pairs of materials only, every contact that can be has one.
void require_all_pairs(Section& contact, const CaseSpec& spec) {
  const auto& walls = spec.wall_materials;
  std::vector<int> of_balls;
  for (const auto& ball : spec.balls) of_balls.push_back(ball.material);
  for (const auto& batch : spec.batches) of_balls.push_back(batch.material);
  const auto name = [&](int material) {
    return material == 0 ? "what has no material" : "\"" + spec.materials[material - 1].name + "\"";
  };
  const auto require = [&](int one, int other) {
    for (const auto& pair : spec.pairs)
      if (pair.is_of(one, other)) return;
    contact.problem("pair", "no law between " + name(one) + " and " + name(other),
                    "an entry [[contact.pair]] for it, or a law in [contact]");
  };
  for (const int ball : of_balls) {
    for (const int other : of_balls) require(ball, other);
    for (const int wall : walls) require(ball, wall);
  }
}

}  // namespace

void check(Section contact, const ContactSpec& law, const CaseSpec& spec) {
  law.parameters([&](const Parameter& p, const Quantity& value) {
    contact.require(in_range(value, p.range), p.key, expected(p));
  });
  if (std::holds_alternative<model::PowderLoad<Quantity>>(law.law)) require_diameters(contact, spec);
  require_least(contact, law.least_separation);
}

void read_contact(Section contact, CaseSpec& spec) {
  GivenLaw shared;
  read_law(contact, shared);
  read_pairs(contact, shared, spec);
  GivenLaw of_balls = shared, of_walls = shared;
  for (const bool balls : {true, false}) {
    Section own = contact.section(balls ? "ball_ball" : "ball_wall");
    read_law(own, balls ? of_balls : of_walls);
    own.reject_unknown_keys();
  }
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
