#include "machines/machines.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

#include "base/clean_text.hpp"
#include "base/errors.hpp"
#include "casefile/nearest.hpp"
#include "casefile/rational.hpp"

namespace edmill::machines {

extern const std::string_view machines_toml;  ///< the file of this folder

namespace {

std::string text_of(const toml::table& table, std::string_view key) {
  return table[key].value_or(std::string());
}

/// Entries of an array; none without it.
void each(const toml::table& table, std::string_view key, const auto& f) {
  if (const auto* entries = table[key].as_array())
    for (const auto& entry : *entries) f(entry);
}

std::vector<std::string> texts_of(const toml::table& table, std::string_view key) {
  std::vector<std::string> texts;
  each(table, key, [&](const auto& text) { texts.push_back(text.value_or(std::string())); });
  return texts;
}

void each_table(const toml::table& root, std::string_view key, const auto& f) {
  each(root, key, [&](const toml::node& entry) { f(*entry.as_table()); });
}

Catalogue read() {
  const auto root = toml::parse(machines_toml);
  const auto source_of = [&](const toml::table& table) {
    return root["source"][text_of(table, "source")].value_or(std::string());
  };
  Catalogue all;
  each_table(root, "machine", [&](const toml::table& m) {
    const auto speeds = texts_of(m, "speeds");
    Machine machine{.key = text_of(m, "key"),
        .name = text_of(m, "name"),
        .also = texts_of(m, "also"),
        .slowest = speeds[0],
        .fastest = speeds[1],
        .usual = text_of(m, "usual")};
    each(m, "jars", [&](const toml::node& jar) {
      const auto size = [&](std::size_t k) { return (*jar.as_array())[k].value_or(std::string()); };
      machine.jars.push_back({size(0), size(1), size(2)});
    });
    each_table(m, "setting", [&](const toml::table& s) {
      machine.settings.push_back(
          {text_of(s, "key"), text_of(s, "value"), source_of(s), text_of(s, "note")});
    });
    all.machines.push_back(std::move(machine));
  });
  each_table(root, "material", [&](const toml::table& m) {
    all.materials.push_back({text_of(m, "key"), text_of(m, "density"), source_of(m),
        text_of(m, "dry"), texts_of(m, "also")});
  });
  each_table(root, "elsewhere", [&](const toml::table& e) {
    all.elsewhere.push_back({texts_of(e, "names"), text_of(e, "what")});
  });
  each_table(root, "contact", [&](const toml::table& c) {
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

/// A name reduced to its distinctive part, for comparisons: "pm100" for "Retsch PM 100".
std::string plain(const std::string& name) {
  std::string text;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)))
      text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const std::string word : {"retsch", "fritsch", "sampleprep", "planetary", "mixermill",
           "ballmill", "micromill", "monomill", "classicline", "premiumline"})
    if (const auto at = text.find(word); at != std::string::npos) text.erase(at, word.size());
  return text;
}

/// The entry of this name, by its key or another name; the list's end where there is none.
auto named(const auto& list, const std::string& name) {
  const auto word = plain(name);
  const auto is_it = [&](const auto& other) { return plain(other) == word; };
  return std::find_if(list.begin(), list.end(), [&](const auto& one) {
    return is_it(one.key) || std::any_of(one.also.begin(), one.also.end(), is_it);
  });
}

/// One batch: "10x12.7mm:zirconia", or "12.7mm" where the number of balls is to be computed.
struct Batch {
  std::uint64_t count;   ///< 0: to be computed
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
double value_of(
    const std::string& option, const std::string& text, Dimension dimension = Dimension::length) {
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
    throw InputError(
        fmt::format("{}: found \"{}\", expected a number from 0 to {:g}", option, text, high));
}

Batch batch_of(const std::string& text) {
  const auto fail = [&](const std::string& expected) -> InputError {
    return InputError(fmt::format("--balls: found \"{}\", expected {}", text, expected));
  };
  std::string diameter, material = "steel";
  for (std::size_t k = 0; k < text.size(); ++k)  // "20 x 15 mm" and "20×15mm" are 20x15mm
    if (text.compare(k, 2, "\u00d7") == 0)
      diameter += 'x', ++k;
    else if (text[k] != ' ')
      diameter += text[k];
  if (const auto colon = diameter.find(':'); colon != std::string::npos) {
    material = diameter.substr(colon + 1);
    diameter.resize(colon);
  }
  const auto times = diameter.find_first_of("x*");
  const bool counted = times != std::string::npos;
  const auto count = casefile::parse_decimal(counted ? diameter.substr(0, times) : "1");
  if (!count || *count < 1 || *count > 1000000 || denominator(casefile::rational(*count)) != 1)
    throw fail(
        "a number of balls and their diameter, \"10x12.7mm\", and a material if not steel, "
        "\"10x12.7mm:zirconia\"");
  if (counted) diameter.erase(0, times + 1);
  const auto& materials = catalogue().materials;
  const auto found = named(materials, material);
  if (found == materials.end()) throw fail("a material among " + keys_of(materials));
  return {counted ? static_cast<std::uint64_t>(count->to<double>()) : 0, diameter,
      value_of("--balls", diameter), &*found};
}

/// The inside of a vessel.
struct Inside {
  bool round_ends = false;
  double diameter = 0, height = 0;  ///< [m]; over all
  std::string note = {};            ///< about a jar that the user named

  double volume() const {
    const double r = diameter / 2;
    return std::numbers::pi * r * r * (height - (round_ends ? 2 * r / 3 : 0));
  }
};

Inside inside_of(const Machine& machine, const std::string& wanted) {
  const std::string jar(trimmed(wanted));
  Inside inside;
  for (const auto& s : machine.settings) {
    const auto size = [&] { return value_of(s.key, s.value.substr(1, s.value.size() - 2)); };
    if (s.key == "vessel.type") inside.round_ends = s.value == "\"capsule\"";
    if (s.key == "vessel.diameter") inside.diameter = size();
    if (s.key == "vessel.height") inside.height = size();
  }
  if (jar.empty()) return inside;
  inside.note = "the jar that was asked for";
  if (const auto times = jar.find('x'); times != std::string::npos) {
    auto first = jar.substr(0, times);
    const auto second = jar.substr(times + 1);
    const auto unit = std::min(second.find_first_not_of("0123456789. "), second.size());
    if (casefile::parse_decimal(trimmed(first))) first += second.substr(unit);
    inside.diameter = value_of("--jar", first);
    inside.height = value_of("--jar", second);
    return inside;
  }
  const auto end = jar.find_first_not_of("0123456789.");
  const auto number = casefile::parse_decimal(jar.substr(0, end));
  static const std::map<std::string, double> units{{"ml", 1e-6}, {"cm3", 1e-6}, {"l", 1e-3}};
  const auto unit = end == std::string::npos ? units.end() : units.find(plain(jar.substr(end)));
  if (!number || !number->positive() || unit == units.end())
    throw InputError(
        fmt::format("--jar: found \"{}\", expected a volume, \"250ml\", or the inner diameter and "
                    "height, \"75x57mm\"",
            jar));
  const double volume = number->to<double>() * unit->second;
  for (const auto& sold : machine.jars)
    if (plain(sold.volume) == plain(jar)) {
      inside.diameter = value_of("jar", sold.diameter);
      inside.height = value_of("jar", sold.height);
      inside.note = "a jar of " + sold.volume + ", assumed: measure its inside";
      return inside;
    }
  const double scale = std::cbrt(volume / inside.volume());
  inside.diameter *= scale;
  inside.height *= scale;
  inside.note = jar + " in the shape of another jar, assumed: measure its inside";
  return inside;
}

/// A positive number: "30%", "0.3". @throws InputError
double number_of(const std::string& option, std::string text, const char* expected) {
  const auto given = text;
  double unit = 1;
  if (text.ends_with('%')) {
    unit = 0.01;
    text.pop_back();
  }
  const auto number = casefile::parse_decimal(trimmed(text));
  if (!number || !number->positive())
    throw InputError(fmt::format("{}: found \"{}\", expected {}", option, given, expected));
  return unit * number->to<double>();
}

constexpr double packing = 0.6;  ///< packing fraction of a heap of balls

/// The charge of a vessel: its balls and powder, and quantities that follow from them.
struct Charge {
  std::vector<Batch> batches;
  double mass = 0, powder = 0, volume = 0;  ///< [kg], [kg], [m^3]
  double smallest = 1e9, largest = 0;       ///< [m]

  Charge(const Wanted& wanted, const Inside& inside) {
    if (!wanted.powder.empty()) powder = value_of("--powder", wanted.powder, Dimension::mass);
    double fill = 0, ratio = 0;
    if (!wanted.fill.empty())
      fill = number_of("--fill", wanted.fill, "a share of the jar, \"30%\"");
    if (!wanted.ratio.empty())
      ratio = number_of("--bpr", wanted.ratio.substr(0, wanted.ratio.find(':')),
          "mass of the balls over that of the powder, 10");
    if (fill > 1)
      throw InputError(fmt::format(
          "--fill: found {}, which is more than the jar, expected a share of it, \"30%\"",
          wanted.fill));
    const bool finds_number = fill > 0 || (ratio > 0 && powder > 0);
    auto texts = wanted.balls;
    if (texts.empty()) texts = {finds_number ? "10mm" : "10x10mm"};
    for (const auto& text : texts) batches.push_back(batch_of(text));
    Batch* open = nullptr;
    for (auto& b : batches) {
      if (b.count == 0 && (open || !finds_number))
        throw InputError(
            fmt::format("--balls: found \"{0}\" without a number of balls, expected \"10x{0}\", or "
                        "--fill, or --powder and --bpr, which determine their number",
                b.diameter));
      if (b.count == 0) open = &b;
      add(b);
    }
    if (finds_number && !open)
      throw InputError(
          fmt::format("{} determines the number of balls: give --balls with a diameter alone",
              fill > 0 ? "--fill" : "--bpr"));
    if (fill > 0 && ratio > 0 && powder > 0)
      throw InputError(
          "--bpr cannot be combined with both --fill and --powder: give two of the three");
    if (open) {
      const double wanted_now = fill > 0
          ? (fill * packing * inside.volume() - volume) / volume_of(*open)
          : (ratio * powder - mass) / mass_of(*open);
      open->count = static_cast<std::uint64_t>(std::clamp(std::round(wanted_now), 1.0, 1e6));
      add(*open);
    }
    if (ratio > 0 && powder <= 0) powder = mass / ratio;
  }
 private:
  static double volume_of(const Batch& b) {
    return std::numbers::pi / 6 * b.size * b.size * b.size;
  }
  static double mass_of(const Batch& b) {
    return value_of("density", b.material->density, Dimension::density) * volume_of(b);
  }
  void add(const Batch& b) {
    mass += static_cast<double>(b.count) * mass_of(b);
    volume += static_cast<double>(b.count) * volume_of(b);
    smallest = std::min(smallest, b.size);
    largest = std::max(largest, b.size);
  }
};

const Contact& contact_of(const Charge& charge) {
  const double ratio = charge.powder > 0 ? charge.mass / charge.powder : 0;
  const bool measured =
      ratio >= 2.5 && ratio <= 10 && charge.smallest >= 2.36e-3 && charge.largest <= 9.52e-3;
  const std::string_view key = charge.powder <= 0 ? "bare" : measured ? "coated" : "powder";
  const auto& all = catalogue().contacts;
  return *std::find_if(all.begin(), all.end(), [&](const Contact& one) { return one.key == key; });
}

/// A case file as it grows.
struct Writer {
  std::string text;
  void section(const std::string& name) { text += "\n[" + name + "]\n"; }
  void key(const std::string& name, const std::string& value, const std::string& comment) {
    const auto line = name + " = " + value;
    text += comment.empty() ? line + "\n" : fmt::format("{:<28} # {}\n", line, comment);
  }
  void comment(const std::string& line) { text += "# " + line + "\n"; }
};

/// The first word or words of a source, "Barahona"; `edmill machines` prints the whole source.
std::string brief(const std::string& source) {
  return source.substr(0, source.find_first_of(",:"));
}

std::string quoted(const std::string& text) { return "\"" + text + "\""; }

void put_machine(Writer& out, const Machine& machine, const Wanted& wanted, const Inside& inside) {
  std::string section, source;
  const auto& speed = wanted.speed.empty() ? machine.usual : wanted.speed;
  const auto rate = [](const auto& text) {
    return value_of("--speed", text, Dimension::angular_speed);
  };
  const bool outside = !wanted.speed.empty() &&
      (rate(speed) < rate(machine.slowest) || rate(speed) > rate(machine.fastest));
  const std::string as_given = outside
      ? fmt::format("as given; the machine has {} to {}", machine.slowest, machine.fastest)
      : "as given";
  for (const auto& s : machine.settings) {
    const auto dot = s.key.find('.');
    if (s.key.substr(0, dot) != section) {
      section = s.key.substr(0, dot);
      out.section(section);
      source.clear();
    }
    const auto name = s.key.substr(dot + 1);
    if (s.key == "mill.speed" && !wanted.speed.empty()) {
      out.key(name, quoted(speed), as_given);
      continue;
    }
    std::string value = s.value, comment = s.source == source ? "" : brief(s.source);
    source = s.source;
    const bool is_diameter = s.key == "vessel.diameter";
    if (!inside.note.empty() && (is_diameter || s.key == "vessel.height")) {
      const double size = is_diameter ? inside.diameter : inside.height;
      out.key(name, quoted(fmt::format("{:.4g} mm", 1000 * size)), inside.note);
      continue;
    }
    if (const auto at = value.find("{speed}"); at != std::string::npos) {
      value.replace(at, 7, speed);
      if (outside) comment += (comment.empty() ? "speed " : "; speed ") + as_given;
    }
    if (!s.note.empty()) comment = s.note + (comment.empty() ? "" : "; " + comment);
    out.key(name, value, comment);
  }
}

void put_contact(Writer& out, const Wanted& wanted, const Charge& charge) {
  const auto& contact = contact_of(charge);
  const auto other = std::find_if(charge.batches.begin(), charge.batches.end(),
      [](const Batch& b) { return b.material->key.find("steel") == std::string::npos; });
  const auto source = brief(contact.source) +
      (other == charge.batches.end() ? "" : "; assumed for " + other->material->key);
  out.section("contact");
  if (wanted.restitution.empty() || wanted.friction.empty())
    out.comment("Known to 0.1 at best; what that changes: edmill run --check");
  if (!wanted.restitution.empty())
    out.key("restitution", wanted.restitution, "as given");
  else if (!contact.model.empty())
    out.key("model", quoted(contact.model), "restitution by charge ratio and diameter; " + source);
  else
    out.key("restitution", contact.restitution, contact.what + "; " + source);
  const auto& all = catalogue();
  if (wanted.friction.empty())
    out.key("friction", all.friction, brief(all.friction_source));
  else
    out.key("friction", wanted.friction, "as given");
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
      out +=
          fmt::format("  {:<18}{:<26}{}\n", s.key, s.value, s.source == before ? "\"" : s.source);
      if (!s.note.empty()) out += fmt::format("  {:<18}  {}\n", "", s.note);
      before = s.source;
    }
  }
  return out;
}

std::string markdown() {
  const auto& all = catalogue();
  std::string out =
      "# Machines\n\nWritten by `edmill machines --markdown`. Mills that [edmill new](usage.md) "
      "knows, with the source of each number. Data sheets round, and a mill wears: measure your "
      "own machine where the result matters.\n";
  for (const auto& m : all.machines) {
    out += fmt::format(
        "\n## {}\n\n`--mill {}`, {} to {}.\n\n| key | value | source |\n|---|---|---|\n", m.name,
        m.key, m.slowest, m.fastest);
    for (const auto& s : m.settings)
      out += fmt::format("| {} | {}{} | {} |\n", code(s.key), code(s.value),
          s.note.empty() ? "" : ", " + s.note, s.source);
  }
  out +=
      "\n## Other machines\n\n| machine | what to do, or why it cannot be simulated |\n|---|---|\n";
  for (const auto& other : all.elsewhere)
    out += fmt::format("| {} | {} |\n", fmt::join(other.names, ", "), other.what);
  out +=
      "\n## Balls\n\n`--balls 10x12.7mm:zirconia`; steel unless a material is given.\n\n| material "
      "| density | source | contacts without powder in the literature |\n|---|---|---|---|\n";
  for (const auto& m : all.materials)
    out += fmt::format("| {} | {} | {} | {} |\n", code(m.key), m.density, m.source,
        m.dry.empty() ? "not known" : m.dry);
  out +=
      "\n## Contacts\n\nWhat a case has unless `--restitution` and `--friction` say otherwise. The "
      "powder decides the restitution more than the balls do, and only that of steel with powder "
      "has a source; the [tutorial](tutorial.md) shows what a change of either does to the "
      "result.\n\n| charge | restitution | source |\n|---|---|---|\n";
  for (const auto& c : all.contacts)
    out += fmt::format("| {} | {} | {} |\n", c.what,
        c.model.empty() ? c.restitution : "model " + code(c.model), c.source);
  return out + fmt::format("| all | friction {} | {} |\n", all.friction, all.friction_source);
}

std::string new_case(const Wanted& wanted) {
  const auto& all = catalogue();
  const auto machine = named(all.machines, wanted.machine);
  if (machine == all.machines.end()) {
    for (const auto& other : all.elsewhere)
      if (std::any_of(other.names.begin(), other.names.end(),
              [&](const auto& name) { return plain(name) == plain(wanted.machine); }))
        throw InputError(fmt::format("--mill: \"{}\": {}", wanted.machine, other.what));
    std::vector<std::string> keys;
    for (const auto& one : all.machines) keys.push_back(one.key);
    throw InputError(fmt::format(
        "--mill: found \"{}\", expected {}; other mills are described by joints, [[mill.joint]]",
        wanted.machine, casefile::nearest_of(wanted.machine, keys)));
  }
  const auto inside = inside_of(*machine, wanted.jar);
  const Charge charge(wanted, inside);
  if (!wanted.speed.empty()) value_of("--speed", wanted.speed, Dimension::angular_speed);
  if (!wanted.target_dose.empty()) {
    value_of("--target-dose", wanted.target_dose, Dimension::specific_energy);
    if (charge.powder <= 0)
      throw InputError("--target-dose needs the mass of the powder: give --powder");
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
  put_machine(out, *machine, wanted, inside);
  out.comment(fmt::format(
      "The balls fill {} of the jar, with the gaps between them; makers advise a third.",
      percent(charge.volume / packing / inside.volume())));
  if (charge.volume / packing > inside.volume() / 2)
    out.comment(
        "Above half, balls rest on each other for long: see docs/limits.md before you trust the "
        "result.");
  if (charge.powder > 0) {
    out.comment(
        fmt::format("For grains up to {:.2g} mm: makers advise balls of three times the largest.",
            1000 * charge.smallest / 3));
    out.section("powder");
    out.key("mass",
        quoted(
            wanted.powder.empty() ? fmt::format("{:.4g} g", 1000 * charge.powder) : wanted.powder),
        fmt::format("charge ratio {:.3g}", charge.mass / charge.powder));
    if (!wanted.target_dose.empty())
      out.key("target_dose", quoted(wanted.target_dose), "the run gives the milling time");
  }
  put_contact(out, wanted, charge);
  for (const auto& b : charge.batches) {
    out.section("[balls]");
    out.key("count", std::to_string(b.count), "");
    out.key("diameter", quoted(b.diameter), "");
    out.key(
        "density", quoted(b.material->density), b.material->key + "; " + brief(b.material->source));
  }
  return out.text;
}

}  // namespace edmill::machines
