#include "casefile/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

#include "base/clean_text.hpp"
#include "casefile/rational.hpp"

namespace edmill::casefile {

using boost::multiprecision::cpp_int;

namespace {

/// A unit of the thesis's tables D.1 and D.2, or another common one: spellings and exact SI factor.
struct Unit {
  Dimension dimension;
  std::vector<std::string_view> spellings;
  Quantity factor;

  bool has(std::string_view spelling) const {
    return std::find(spellings.begin(), spellings.end(), spelling) != spellings.end();
  }
};

Quantity pi_by(int divisor) { return quantity_of({1, divisor}, 1); }

const std::vector<Unit>& units() {
  using D = Dimension;
  static const Quantity inch(254, 10000), foot(3048, 10000), pound(45359237, 100000000);
  static const std::vector<Unit> table = {
      {D::length, {"m", "meter", "meters", "metre", "metres"}, 1},
      {D::length, {"dm", "decimeter", "decimeters", "decimetre", "decimetres"}, {1, 10}},
      {D::length, {"cm", "centimeter", "centimeters", "centimetre", "centimetres"}, {1, 100}},
      {D::length, {"mm", "millimeter", "millimeters", "millimetre", "millimetres"}, {1, 1000}},
      {D::length, {"um", "micrometer", "micrometers", "micrometre", "micrometres"}, {1, 1000000}},
      {D::length, {"in", "inch", "inches"}, inch},
      {D::length, {"ft", "foot", "feet"}, foot},
      {D::mass, {"kg", "kilogram", "kilograms"}, 1},
      {D::mass, {"g", "gram", "grams"}, {1, 1000}},
      {D::mass, {"mg", "milligram", "milligrams"}, {1, 1000000}},
      {D::mass, {"lb", "lbs", "pound", "pounds"}, pound},
      {D::time, {"s", "sec", "second", "seconds"}, 1},
      {D::time, {"ms", "millisecond", "milliseconds"}, {1, 1000}},
      {D::time, {"us", "microsecond", "microseconds"}, {1, 1000000}},
      {D::time, {"ns", "nanosecond", "nanoseconds"}, {1, 1000000000}},
      {D::time, {"min", "m", "minute", "minutes"}, 60},  // "m" is the thesis's own
      {D::time, {"h", "hr", "hour", "hours"}, 3600},
      {D::angle, {"rad", "radian", "radians"}, 1},
      {D::angle, {"deg", "degree", "degrees"}, pi_by(180)},
      {D::angle, {"grad", "gradient", "gradients", "gon"}, pi_by(200)},
      {D::energy, {"J", "joule", "joules"}, 1},
      {D::energy, {"mJ", "millijoule", "millijoules"}, {1, 1000}},
      {D::energy, {"uJ", "microjoule", "microjoules"}, {1, 1000000}},
      {D::energy, {"kJ", "kilojoule", "kilojoules"}, 1000},
      {D::specific_energy, {"J/kg"}, 1},
      {D::specific_energy, {"kJ/kg", "J/g"}, 1000},
      {D::specific_energy, {"kJ/g"}, 1000000},
      {D::specific_energy, {"MJ/kg"}, 1000000},
      {D::specific_energy, {"kWh/t", "Wh/kg"}, 3600},
      {D::speed, {"m/s"}, 1},
      {D::speed, {"cm/s"}, {1, 100}},
      {D::speed, {"mm/s"}, {1, 1000}},
      {D::speed, {"in/s"}, inch},
      {D::speed, {"ft/s"}, foot},
      {D::angular_speed, {"rad/s"}, 1},
      {D::angular_speed, {"deg/s"}, pi_by(180)},
      {D::angular_speed, {"Hz", "hertz"}, Quantity(2) * pi_by(1)},
      {D::angular_speed, {"rpm", "cpm", "r/min", "rev/min", "cycles/min", "1/min", "min-1"},
          pi_by(30)},
      {D::acceleration, {"m/s2", "m/s/s"}, 1},
      {D::acceleration, {"cm/s2", "cm/s/s"}, {1, 100}},
      {D::acceleration, {"in/s2", "in/s/s"}, inch},
      {D::acceleration, {"ft/s2", "ft/s/s"}, foot},
      {D::pressure, {"Pa", "pascal"}, 1},
      {D::pressure, {"kPa"}, 1000},
      {D::pressure, {"MPa"}, 1000000},
      {D::pressure, {"GPa"}, 1000000000},
      {D::density, {"kg/m3"}, 1},
      {D::density, {"g/cm3", "g/cc"}, 1000},
      {D::density, {"lb/ft3"}, pound / (foot * foot * foot)},
  };
  return table;
}

/// "g/cm³", "g / cm^3" and "g/cm3" are one spelling; "µ" is u, "°" is deg.
std::string plain_unit(std::string_view text) {
  constexpr std::pair<std::string_view, std::string_view> replacements[]{{"²", "2"}, {"³", "3"},
      {"**", ""}, {"^", ""}, {"µ", "u"}, {"μ", "u"}, {"°", "deg"}, {" ", ""}};
  std::string unit(text);
  for (const auto& [from, to] : replacements)
    for (auto at = unit.find(from); at != std::string::npos; at = unit.find(from, at + to.size()))
      unit.replace(at, from.size(), to);
  return unit;
}

const Unit* find_unit(std::string_view spelling, Dimension dimension) {
  for (const auto& unit : units())
    if (unit.dimension == dimension && unit.has(spelling)) return &unit;
  return nullptr;
}

/// In the order of the enumerators.
constexpr std::array dimension_names{"a plain number", "a length", "a mass", "a time", "an angle",
    "an energy", "an energy per mass", "a speed", "an angular speed", "an acceleration",
    "a density", "a pressure"};
static_assert(dimension_names.size() == static_cast<std::size_t>(Dimension::pressure) + 1);

std::string name(Dimension dimension) {
  return dimension_names[static_cast<std::size_t>(dimension)];
}

/// The arc cotangent of x times 2^bits, with an error of a few hundred at most.
cpp_int arc_cotangent(int x, int bits) {
  cpp_int power = (cpp_int(1) << bits) / x, sum = power;
  for (int k = 3; power != 0; k += 2) {
    power /= -x * x;
    sum += power / k;
  }
  return sum;
}

/// pi times 2^bits, truncated, by Machin's formula.
cpp_int pi_in_bits(int bits) {
  constexpr int spare = 64, most = 4096;
  const auto computed = [](int to) {
    return cpp_int(16 * arc_cotangent(5, to + spare) - 4 * arc_cotangent(239, to + spare));
  };
  static const cpp_int common = computed(most);
  return bits <= most ? cpp_int(common >> (most + spare - bits)) : cpp_int(computed(bits) >> spare);
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_same_letter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

/// Length of the decimal number that `text` begins with; an exponent has digits, unlike "1 eV".
std::size_t number_length(std::string_view text) {
  const auto is_one_of = [&](std::string_view any, std::size_t at) {
    return at < text.size() && any.find(text[at]) != any.npos;
  };
  const auto after_sign = [&](std::size_t at) { return is_one_of("+-", at) ? at + 1 : at; };
  const auto after_digits = [&](std::size_t at) {
    return std::min(text.find_first_not_of("0123456789", at), text.size());
  };
  const auto begin = after_sign(0), whole = after_digits(begin);
  auto end = whole, digits = whole - begin;
  if (is_one_of(".", end)) {
    end = after_digits(whole + 1);
    digits = end - begin - 1;
  }
  if (digits == 0) return 0;
  if (is_one_of("eE", end)) {
    const auto exponent = after_sign(end + 1), last = after_digits(exponent);
    if (last > exponent) end = last;
  }
  return end;
}

bool of_physical_size(const Quantity& quantity, SizeLimit limit) {
  if (limit == SizeLimit::none) return true;
  static const Rational largest(boost::multiprecision::pow(cpp_int(10), 30));
  const Rational size = abs(rational(quantity));
  return size == 0 || (size <= largest && size * largest >= 1);
}

}  // namespace

std::string describe(Dimension dimension) {
  std::string text = name(dimension);
  if (dimension == Dimension::none) return text;
  std::vector<std::string_view> list;
  for (const auto& unit : units())
    if (unit.dimension == dimension) list.push_back(unit.spellings.front());
  return fmt::format("{} ({})", text, fmt::join(list, ", "));
}

std::string noun(Dimension dimension) {
  if (dimension == Dimension::none) return "number";
  const auto with_article = name(dimension);  // "a length"
  return with_article.substr(with_article.find(' ') + 1);
}

std::string si_unit(Dimension dimension) {
  for (const auto& unit : units())
    if (unit.dimension == dimension) return " " + std::string(unit.spellings.front());
  return "";
}

std::vector<UnitText> unit_texts() {
  std::vector<UnitText> texts;
  for (const auto& unit : units())
    texts.push_back({noun(unit.dimension), {unit.spellings.begin(), unit.spellings.end()}});
  return texts;
}

Quantity::Quantity(std::int64_t numerator, std::int64_t denominator)
    : Quantity(quantity_of({numerator, denominator})) {}
Quantity Quantity::exactly(double value) { return quantity_of(Rational(value)); }
bool Quantity::positive() const { return rational(*this) > 0; }
bool Quantity::negative() const { return rational(*this) < 0; }
bool Quantity::zero() const { return rational(*this) == 0; }

Rational value_of(const Quantity& quantity, int bits) {
  Rational value = rational(quantity);
  if (quantity.pi_power == 0) return value;
  constexpr int spare = 16;
  const Rational pi(pi_in_bits(bits + spare), cpp_int(1) << (bits + spare));
  for (int k = 0; k < quantity.pi_power; ++k) value *= pi;
  for (int k = 0; k > quantity.pi_power; --k) value /= pi;
  return value;
}

Quantity operator*(const Quantity& a, const Quantity& b) {
  return quantity_of(rational(a) * rational(b), a.pi_power + b.pi_power);
}
Quantity operator/(const Quantity& a, const Quantity& b) {
  return quantity_of(rational(a) / rational(b), a.pi_power - b.pi_power);
}
Quantity operator-(const Quantity& a) { return quantity_of(-rational(a), a.pi_power); }
std::strong_ordering operator<=>(const Quantity& a, const Quantity& b) {
  return rational(a).compare(rational(b)) <=> 0;
}

std::string Quantity::text() const {
  const auto number = rational(*this).str();
  if (pi_power == 0) return number;
  return number + (pi_power == 1 ? "*pi" : "*pi^" + std::to_string(pi_power));
}

bool has_comma(std::string_view text) {
  const auto end = text.find_first_not_of("+-0123456789.");
  return end != std::string_view::npos && text[end] == ',' && end + 1 < text.size() &&
      is_digit(text[end + 1]);
}

std::optional<Quantity> parse_decimal(std::string_view text) {
  if (text.empty() || number_length(text) != text.size()) return std::nullopt;
  const auto end = std::min(text.find_first_of("eE"), text.size());
  const std::string last(text.substr(std::min(end + 1, text.size())));
  if (last.size() > 6) return std::nullopt;
  long exponent = last.empty() ? 0 : std::stol(last);
  std::string digits(text.substr(0, end));
  if (const auto point = digits.find('.'); point != digits.npos)
    exponent -= static_cast<long>(end - point - 1);
  std::erase_if(digits, [](char c) { return !is_digit(c); });
  // Refuses numbers beyond any physical size, which could also fill the memory.
  if (digits.size() > 400 || exponent > 400 || exponent < -800) return std::nullopt;
  const auto first = digits.find_first_not_of('0');
  const cpp_int mantissa(first == std::string::npos ? std::string("0") : digits.substr(first));
  const cpp_int power = pow(cpp_int(10), static_cast<unsigned>(std::abs(exponent)));
  const Quantity value =
      quantity_of(exponent < 0 ? Rational(mantissa, power) : Rational(mantissa * power));
  return text.front() == '-' ? -value : value;
}

std::optional<std::pair<double, std::string>> split_number(const std::string& text) {
  const auto end = std::min(text.find_first_not_of("0123456789+-."), text.size());
  const auto number = parse_decimal(text.substr(0, end));
  if (!number) return std::nullopt;
  return std::pair{number->to<double>(), text.substr(end)};
}

QuantityResult parse_quantity(
    std::string_view text, Dimension dimension, SizeLimit limit, Plain plain) {
  const auto problem = [&](const std::string& what) {
    return QuantityProblem{fmt::format("\"{}\" ({})", text, what)};
  };
  const std::string_view body = trimmed(text);
  if (has_comma(body))
    return problem("a comma in a number: a decimal point is expected, and no thousands separators");
  const auto length = number_length(body);
  const auto number = parse_decimal(body.substr(0, length));
  if (!number) return problem("not a finite decimal number");
  const auto given = trimmed(body.substr(length));
  const std::string unit = plain_unit(given);
  const Unit* known = find_unit(unit, dimension);
  if (!known && !unit.empty()) {
    for (const auto& other : units())
      if (other.has(unit)) return problem(name(other.dimension));
    for (const auto& other : units())
      for (const auto& spelling : other.spellings)
        if (std::equal(spelling.begin(), spelling.end(), unit.begin(), unit.end(), is_same_letter))
          return problem(fmt::format("unknown unit '{}', did you mean '{}'?", given, spelling));
    return problem(fmt::format("unknown unit '{}'", given));
  }
  if (!known && plain == Plain::refused && dimension != Dimension::none) return problem("no unit");
  const Quantity quantity = known ? *number * known->factor : *number;
  if (!of_physical_size(quantity, limit))
    return problem("its size is outside of 1e-30 to 1e30 in SI units");
  return quantity;
}

std::optional<std::pair<double, std::string>> in_si(std::string_view text) {
  std::optional<Dimension> tried;
  std::optional<std::pair<double, std::string>> in_one;
  for (const auto& unit : units()) {  // the first unit of a dimension is that of SI
    if (tried == unit.dimension) continue;
    tried = unit.dimension;
    const auto found = parse_quantity(text, unit.dimension);
    const auto* quantity = std::get_if<Quantity>(&found);
    if (!quantity) continue;
    if (in_one) return std::nullopt;
    in_one = {quantity->to<double>(), std::string(unit.spellings.front())};
  }
  return in_one;
}

}  // namespace edmill::casefile
