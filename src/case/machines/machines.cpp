#include "machines/machines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

#include "base/errors.hpp"
#include "casefile/rational.hpp"

namespace edmill::machines {

extern const std::string_view machines_toml;  ///< the file of this folder

namespace {

std::string text_of(const toml::table& table, std::string_view key) {
  return table[key].value_or(std::string());
}

/// Entries of an array of tables.
void each(const toml::table& root, std::string_view key, const auto& f) {
  if (const auto* entries = root[key].as_array())
    for (const auto& entry : *entries) f(*entry.as_table());
}

Catalogue read() {
  const auto root = toml::parse(machines_toml);
  const auto source_of = [&](const toml::table& table) {
    return root["source"][text_of(table, "source")].value_or(std::string());
  };
  Catalogue all;
  each(root, "machine", [&](const toml::table& m) {
    Machine machine{text_of(m, "key"),
                    text_of(m, "name"),
                    m["speeds"][0].value_or(std::string()),
                    m["speeds"][1].value_or(std::string()),
                    {}};
    each(m, "setting", [&](const toml::table& s) {
      machine.settings.push_back({text_of(s, "key"), text_of(s, "value"), source_of(s), text_of(s, "note")});
    });
    all.machines.push_back(std::move(machine));
  });
  each(root, "material", [&](const toml::table& m) {
    all.materials.push_back({text_of(m, "key"), text_of(m, "density"), source_of(m)});
  });
  each(root, "contact", [&](const toml::table& c) {
    all.contacts.push_back({text_of(c, "key"), text_of(c, "what"), text_of(c, "model"),
                            text_of(c, "restitution"), source_of(c)});
  });
  const auto& friction = *root["friction"].as_table();
  all.friction = text_of(friction, "value");
  all.friction_source = source_of(friction);
  return all;
}

/// "mill.type = "spex8000"" as a cell.
std::string code(const std::string& text) { return "`" + text + "`"; }

/// One batch: "10x12.7mm:zirconia".
struct Batch {
  std::uint64_t count;
  std::string diameter;  ///< with its unit
  double size;           ///< [m]
  const Material* material;
};

std::string keys_of(const auto& list) {
  std::string keys;
  for (const auto& one : list) keys += (keys.empty() ? "" : ", ") + one.key;
  return keys;
}

/// An option's quantity, in SI. @throws InputError
double value_of(const std::string& option, const std::string& text, Dimension dimension) {
  const auto read = casefile::parse_quantity(text, dimension);
  const auto* quantity = std::get_if<casefile::Quantity>(&read);
  if (quantity && quantity->positive()) return quantity->to<double>();
  const auto* problem = std::get_if<casefile::QuantityProblem>(&read);
  throw InputError(fmt::format("{}: found {}, expected a positive {}", option,
                               problem ? problem->found : "\"" + text + "\"", casefile::noun(dimension)));
}

/// @throws InputError
void require_number(const std::string& option, const std::string& text, double high) {
  const auto number = casefile::parse_decimal(text);
  if (!number || number->negative() || number->to<double>() > high)
    throw InputError(fmt::format("{}: found \"{}\", expected a number from 0 to {:g}", option, text, high));
}

Batch batch_of(const std::string& text) {
  const auto fail = [&](const std::string& expected) -> InputError {
    return InputError(fmt::format("--balls: found \"{}\", expected {}", text, expected));
  };
  const auto times = text.find_first_of("x*");
  const auto count = casefile::parse_decimal(text.substr(0, times));
  if (times == std::string::npos || !count || *count < 1 || *count > 1000000 ||
      denominator(casefile::rational(*count)) != 1)
    throw fail(
        "a number of balls and their diameter, \"10x12.7mm\", and a material if not steel, "
        "\"10x12.7mm:zirconia\"");
  std::string diameter = text.substr(times + 1), material = "steel";
  if (const auto colon = diameter.find(':'); colon != std::string::npos) {
    material = diameter.substr(colon + 1);
    diameter.resize(colon);
  }
  const auto& materials = catalogue().materials;
  const auto found = std::ranges::find(materials, material, &Material::key);
  if (found == materials.end()) throw fail("a material among " + keys_of(materials));
  return {static_cast<std::uint64_t>(count->to<double>()), diameter,
          value_of("--balls", diameter, Dimension::length), &*found};
}

/// What fills the vessel, and what follows from it.
struct Charge {
  std::vector<Batch> batches;
  double mass = 0, smallest = 1e9, largest = 0;  ///< [kg], [m], [m]

  explicit Charge(const std::vector<std::string>& texts) {
    for (const auto& text : texts) {
      batches.push_back(batch_of(text));
      const auto& b = batches.back();
      const double density = value_of("density", b.material->density, Dimension::density);
      mass += static_cast<double>(b.count) * density * std::numbers::pi / 6 * b.size * b.size * b.size;
      smallest = std::min(smallest, b.size);
      largest = std::max(largest, b.size);
    }
  }
};

const Contact& contact_of(const Charge& charge, double powder_mass) {
  const auto named = [](std::string_view key) -> const Contact& {
    return *std::ranges::find(catalogue().contacts, key, &Contact::key);
  };
  if (powder_mass <= 0) return named("bare");
  const double ratio = charge.mass / powder_mass;
  const bool measured =
      ratio >= 2.5 && ratio <= 10 && charge.smallest >= 2.36e-3 && charge.largest <= 9.52e-3;
  return named(measured ? "coated" : "powder");
}

class Writer {
 public:
  void section(const std::string& name) { text_ += "\n[" + name + "]\n"; }
  void key(const std::string& name, const std::string& value, const std::string& comment) {
    const auto line = name + " = " + value;
    text_ += comment.empty() ? line + "\n" : fmt::format("{:<28} # {}\n", line, comment);
  }
  void comment(const std::string& text) { text_ += "# " + text + "\n"; }
  std::string text() const { return text_; }

 private:
  std::string text_;
};

/// "Barahona", of a source: the whole one is in `edmill machines`.
std::string brief(const std::string& source) { return source.substr(0, source.find_first_of(",:")); }

std::string quoted(const std::string& text) { return "\"" + text + "\""; }

void put_machine(Writer& out, const Machine& machine, const Wanted& wanted) {
  std::string section, source;
  for (const auto& s : machine.settings) {
    const auto dot = s.key.find('.');
    if (s.key.substr(0, dot) != section) {
      section = s.key.substr(0, dot);
      out.section(section);
      source.clear();
    }
    const bool given = s.key == "mill.speed" && !wanted.speed.empty();
    std::string comment = given ? "as given" : s.source == source ? "" : brief(s.source);
    if (!given && !s.note.empty()) comment = s.note + (comment.empty() ? "" : "; " + comment);
    out.key(s.key.substr(dot + 1), given ? quoted(wanted.speed) : s.value, comment);
    if (!given) source = s.source;
  }
}

void put_contact(Writer& out, const Wanted& wanted, const Contact& contact) {
  out.section("contact");
  if (!wanted.restitution.empty()) {
    out.key("restitution", wanted.restitution, "as given");
  } else if (!contact.model.empty()) {
    out.key("model", quoted(contact.model),
            "restitution by charge ratio and diameter; " + brief(contact.source));
  } else {
    out.key("restitution", contact.restitution, contact.what + "; " + brief(contact.source));
  }
  const auto& all = catalogue();
  out.key("friction", wanted.friction.empty() ? all.friction : wanted.friction,
          wanted.friction.empty() ? brief(all.friction_source) : "as given");
}

}  // namespace

const Catalogue& catalogue() {
  static const Catalogue all = read();
  return all;
}

std::string table() {
  std::string out;
  for (const auto& m : catalogue().machines) {
    out += fmt::format("{:<16}{}, {} to {}\n", m.key, m.name, m.slowest, m.fastest);
    std::string before;
    for (const auto& s : m.settings) {
      out += fmt::format("  {:<18}{:<26}{}\n", s.key, s.value, s.source == before ? "\"" : s.source);
      if (!s.note.empty()) out += fmt::format("  {:<18}  {}\n", "", s.note);
      before = s.source;
    }
  }
  return out;
}

std::string markdown() {
  const auto& all = catalogue();
  std::string out =
      "# Machines\n\nWritten by `edmill machines --markdown`. Mills that [edmill new](usage.md) knows, with "
      "the source of each number. Data sheets round, and a mill wears: measure your own machine where the "
      "result matters.\n";
  for (const auto& m : all.machines) {
    out += fmt::format("\n## {}\n\n`--mill {}`, {} to {}.\n\n| key | value | source |\n|---|---|---|\n",
                       m.name, m.key, m.slowest, m.fastest);
    for (const auto& s : m.settings)
      out += fmt::format("| {} | {}{} | {} |\n", code(s.key), code(s.value),
                         s.note.empty() ? "" : ", " + s.note, s.source);
  }
  out +=
      "\n## Balls\n\n`--balls 10x12.7mm:zirconia`; steel unless a material is given.\n\n| material | density "
      "| source |\n|---|---|---|\n";
  for (const auto& m : all.materials)
    out += fmt::format("| {} | {} | {} |\n", code(m.key), m.density, m.source);
  out +=
      "\n## Contacts\n\nWhat a case has unless `--restitution` and `--friction` say otherwise. The powder "
      "decides the restitution more than the balls do; the [tutorial](tutorial.md) shows what a change of "
      "either does to the result.\n\n| charge | restitution | source |\n|---|---|---|\n";
  for (const auto& c : all.contacts)
    out += fmt::format("| {} | {} | {} |\n", c.what,
                       c.model.empty() ? c.restitution : "model " + code(c.model), c.source);
  return out + fmt::format("| all | friction {} | {} |\n", all.friction, all.friction_source);
}

std::string new_case(const Wanted& wanted) {
  const auto& machines = catalogue().machines;
  const auto machine = std::ranges::find(machines, wanted.machine, &Machine::key);
  if (machine == machines.end())
    throw InputError(
        fmt::format("--mill: found \"{}\", expected one of {}", wanted.machine, keys_of(machines)));
  const Charge charge(wanted.balls.empty() ? std::vector<std::string>{"10x10mm"} : wanted.balls);
  const double powder = wanted.powder.empty() ? 0 : value_of("--powder", wanted.powder, Dimension::mass);
  if (!wanted.speed.empty()) value_of("--speed", wanted.speed, Dimension::angular_speed);
  if (!wanted.target_dose.empty()) {
    value_of("--target-dose", wanted.target_dose, Dimension::specific_energy);
    if (powder <= 0) throw InputError("--target-dose: found no --powder, expected the mass of the powder");
  }
  if (!wanted.restitution.empty()) require_number("--restitution", wanted.restitution, 1);
  if (!wanted.friction.empty()) require_number("--friction", wanted.friction, 1e6);
  const double time = value_of("--time", wanted.time, Dimension::time);
  Writer out;
  out.comment(fmt::format("{}, {} to {}. Sources of its numbers: edmill machines", machine->name,
                          machine->slowest, machine->fastest));
  out.comment("Check it with `edmill check`, simulate it with `edmill run FILE --report`.");
  out.section("run");
  out.key("start_time", quoted(fmt::format("{:g} s", time / 10)),
          "statistics begin here, when the charge has spread");
  out.key("end_time", quoted(wanted.time),
          "or until the dose rate is known: edmill run --until-precision 1%");
  out.key("gravity", quoted("9.81 m/s2"), "downward, along -Y");
  put_machine(out, *machine, wanted);
  if (powder > 0) {
    out.section("powder");
    out.key("mass", quoted(wanted.powder), fmt::format("charge ratio {:.3g}", charge.mass / powder));
    if (!wanted.target_dose.empty())
      out.key("target_dose", quoted(wanted.target_dose), "the run tells the milling time");
  }
  put_contact(out, wanted, contact_of(charge, powder));
  for (const auto& b : charge.batches) {
    out.section("[balls]");
    out.key("count", std::to_string(b.count), "");
    out.key("diameter", quoted(b.diameter), "");
    out.key("density", quoted(b.material->density), b.material->key + "; " + brief(b.material->source));
  }
  return out.text();
}

}  // namespace edmill::machines
