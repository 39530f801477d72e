// Quantities with units: exact values worked out by hand, udunits2 as an independent reference,
// exact wide scalars.
#include "casefile/quantity.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <udunits2.h>

#include <cmath>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include "casefile/rational.hpp"
#include "core.hpp"

namespace edmill::casefile {
namespace {

using boost::multiprecision::cpp_int;
using boost::multiprecision::cpp_rational;
using D = Dimension;

cpp_rational ratio(long long numerator, long long denominator = 1) {
  return {cpp_int(numerator), cpp_int(denominator)};
}

Quantity parsed(const std::string& text, Dimension dimension) {
  const auto result = parse_quantity(text, dimension);
  if (const auto* problem = std::get_if<QuantityProblem>(&result)) {
    ADD_FAILURE() << text << ": " << problem->found;
    return {};
  }
  return std::get<Quantity>(result);
}

std::string problem(const std::string& text, Dimension dimension) {
  const auto result = parse_quantity(text, dimension);
  const auto* found = std::get_if<QuantityProblem>(&result);
  return found ? found->found : "";
}

struct Sample {
  std::string text;
  Dimension dimension;
  cpp_rational value;
  int pi_power = 0;
};

void expect_values(const std::vector<Sample>& samples) {
  for (const auto& s : samples) {
    const Quantity q = parsed(s.text, s.dimension);
    EXPECT_EQ(rational(q), s.value) << s.text << " is " << q.text();
    EXPECT_EQ(q.pi_power, s.pi_power) << s.text;
  }
}

TEST(Quantity, UnitsOfTheThesisAreExact) {
  expect_values({
      {"3.8 cm", D::length, ratio(38, 1000)},
      {"2 dm", D::length, ratio(1, 5)},
      {"1 ft", D::length, ratio(3048, 10000)},
      {"2.5 in", D::length, ratio(635, 10000)},
      {"7 m", D::length, ratio(7)},
      {"4.76 mm", D::length, ratio(476, 100000)},
      {"5 g", D::mass, ratio(5, 1000)},
      {"5 kg", D::mass, ratio(5)},
      {"1 lb", D::mass, ratio(45359237, 100000000)},
      {"12 mg", D::mass, ratio(12, 1000000)},
      {"1.5 h", D::time, ratio(5400)},
      {"2 m", D::time, ratio(120)},
      {"0.1 ms", D::time, ratio(1, 10000)},
      {"10 s", D::time, ratio(10)},
      {"15 deg", D::angle, ratio(1, 12), 1},
      {"100 grad", D::angle, ratio(1, 2), 1},
      {"0.25 rad", D::angle, ratio(1, 4)},
      {"0.3 J", D::energy, ratio(3, 10)},
      {"10 ft/s", D::speed, ratio(3048, 1000)},
      {"3.1 m/s", D::speed, ratio(31, 10)},
      {"17 Hz", D::angular_speed, ratio(34), 1},
      {"110.5 rad/s", D::angular_speed, ratio(221, 2)},
      {"1098 rpm", D::angular_speed, ratio(183, 5), 1},
      {"32 ft/s2", D::acceleration, ratio(97536, 10000)},
      {"386 in/s2", D::acceleration, ratio(98044, 10000)},
      {"9.8 m/s2", D::acceleration, ratio(98, 10)},
      {"7.85 g/cm3", D::density, ratio(7850)},
      {"8000 kg/m3", D::density, ratio(8000)},
      // 45359237e-8 kg over 3048^3 e-12 m3
      {"1 lb/ft3", D::density, ratio(453592370000, 28316846592)},
  });
}

TEST(Quantity, CompanionUnitsAreExact) {
  expect_values({
      {"3 um", D::length, ratio(3, 1000000)},
      {"4 us", D::time, ratio(4, 1000000)},
      {"5 ns", D::time, ratio(5, 1000000000)},
      {"2 min", D::time, ratio(120)},
      {"6 mJ", D::energy, ratio(6, 1000)},
      {"7 kJ", D::energy, ratio(7000)},
      {"8 cm/s", D::speed, ratio(8, 100)},
      {"9 mm/s", D::speed, ratio(9, 1000)},
      {"10 in/s", D::speed, ratio(254, 1000)},
      {"360 deg/s", D::angular_speed, ratio(2), 1},
      {"1060 cpm", D::angular_speed, ratio(106, 3), 1},
      {"981 cm/s2", D::acceleration, ratio(981, 100)},
  });
}

TEST(Quantity, RpmIsExactInTurns) {
  // 2 pi / w is one turn: 60 s / 1054.
  const Quantity speed = parsed("1054 rpm", D::angular_speed);
  EXPECT_EQ(2 / rational(speed), ratio(60, 1054));
  EXPECT_EQ(speed.pi_power, 1);
}

TEST(Quantity, UsualSpellingsAreOneUnit) {
  const std::vector<std::pair<Dimension, std::vector<std::string>>> families = {
      {D::density,
          {"8 g/cm3", "8 g/cm^3", "8 g/cm³", "8 g/cm**3", "8 g / cm^3", "8g/cm3", "8.0 g/cc",
              " 8 g/cm3 ", "8e0 g/cm3", "+8 g/cm3", "0.8E+1 g/cm3", "80e-1g/cm3"}},
      {D::acceleration, {"9.8 m/s2", "9.8 m/s^2", "9.8 m/s²", "9.8 m/s/s", "9.8m / s 2"}},
      {D::angle, {"15 deg", "15 degree", "15 degrees", "15°", "15 °"}},
      {D::length, {"5 um", "5 µm", "5 μm", "5 micrometers", "5 micrometre"}},
      {D::length, {"38 mm", "3.8 cm", ".38 dm", "0.038 m", "38. mm", "38 millimeters", "38\tmm"}},
      {D::length, {"2 in", "2 inch", "2 inches"}},
      {D::length, {"2 ft", "2 foot", "2 feet"}},
      {D::mass, {"2 lb", "2 lbs", "2 pounds", "2 pound"}},
      {D::time, {"2 h", "2 hr", "2 hours", "120 min", "120 minutes", "7200 s", "7200 seconds"}},
      {D::angular_speed,
          {"60 rpm", "60 cpm", "60 r/min", "60 rev/min", "60 cycles/min", "60 1/min", "60 min^-1",
              "1 Hz", "1 hertz"}},
  };
  for (const auto& [dimension, texts] : families)
    for (const auto& text : texts)
      EXPECT_EQ(parsed(text, dimension).text(), parsed(texts.front(), dimension).text()) << text;
}

TEST(Quantity, EveryUnitOfAMessageIsUnderstood) {
  for (const auto d : {D::length, D::mass, D::time, D::angle, D::energy, D::speed, D::angular_speed,
           D::acceleration, D::density}) {
    const std::string text = describe(d);
    const auto open = text.find('(');
    std::string list = text.substr(open + 1, text.size() - open - 2) + ", ";
    for (std::size_t at = 0, comma; (comma = list.find(", ", at)) != std::string::npos;
         at = comma + 2)
      EXPECT_TRUE(parsed("1 " + list.substr(at, comma - at), d).positive());
  }
}

TEST(Quantity, EveryUnitOfTheReferenceIsUnderstood) {
  std::set<std::string> dimensions;
  for (const auto& unit : unit_texts()) {
    dimensions.insert(unit.dimension);
    for (const auto& spelling : unit.spellings) {
      int understood = 0;
      for (int d = 0; d <= static_cast<int>(D::pressure); ++d)
        if (std::holds_alternative<Quantity>(parse_quantity("1 " + spelling, static_cast<D>(d))))
          understood += describe(static_cast<D>(d)).find(" " + unit.dimension) != std::string::npos;
      EXPECT_EQ(understood, 1) << spelling;
    }
  }
  EXPECT_EQ(dimensions.size(), 11u);
}

TEST(Quantity, ACommaInANumberIsNamed) {
  for (const auto* text :
      {"12,7 mm", "-0,5 m", ",5 mm", "+,5 mm", "1,000.5 mm", "1.000,5 mm", "3,0", "0,1mm"})
    EXPECT_EQ(problem(text, D::length),
        "\"" + std::string(text) +
            "\" (a comma in a number: a decimal point is expected, and no thousands separators)");
  for (const auto* text : {"5 mm,", ", 5 mm", "5, mm", "mm,5"})
    EXPECT_EQ(problem(text, D::length).find("comma"), std::string::npos) << text;
}

TEST(Quantity, WhatIsNoQuantityIsNamed) {
  EXPECT_EQ(problem("4.76 mn", D::length), "\"4.76 mn\" (unknown unit 'mn')");
  EXPECT_EQ(problem("4.76", D::length), "\"4.76\" (no unit)");
  EXPECT_EQ(problem("4.76 kg", D::length), "\"4.76 kg\" (a mass)");
  EXPECT_EQ(problem("4.76 MM", D::length), "\"4.76 MM\" (unknown unit 'MM', did you mean 'mm'?)");
  EXPECT_EQ(problem("0.5 m", D::none), "\"0.5 m\" (a length)");
  for (const auto* text : {"", " ", "mm", "nan mm", "inf m", "-inf m", "NaN", ". m", "+ m", "e5 m",
           "- 5 mm", "--5 mm", "1e99999999 m"})
    EXPECT_EQ(
        problem(text, D::length), "\"" + std::string(text) + "\" (not a finite decimal number)");
}

TEST(Quantity, SizesThatDoubleCannotCubeAreRejected) {
  for (const auto* text :
      {"1e31 m", "-1e31 m", "1e-31 m", "1e400 m", "1e-400 m", "1.1e33 mm", "1e-28 mm"})
    EXPECT_NE(problem(text, D::length).find("outside of 1e-30 to 1e30"), std::string::npos) << text;
  for (const auto* text : {"1e30 m", "1e-30 m", "1e33 mm", "0 m", "0e-300 m", "-0 m"})
    EXPECT_EQ(problem(text, D::length), "") << text;
}

TEST(Quantity, PlainNumbersAreSiOnlyWhereAllowed) {
  EXPECT_EQ(problem("9.8", D::acceleration), "\"9.8\" (no unit)");
  EXPECT_EQ(rational(std::get<Quantity>(
                parse_quantity("9.8", D::acceleration, SizeLimit::physical, Plain::is_si))),
      ratio(98, 10));
  EXPECT_EQ(rational(parsed("0.4", D::none)), ratio(2, 5));
}

TEST(Quantity, DecimalsAreExact) {
  EXPECT_EQ(rational(*parse_decimal("0.53")), ratio(53, 100));
  EXPECT_EQ(rational(*parse_decimal("-.5e-2")), ratio(-1, 200));
  EXPECT_EQ(rational(*parse_decimal("007")), ratio(7));
  EXPECT_EQ(rational(*parse_decimal("0.1000000000000000000000000000000000000001")),
      cpp_rational(cpp_int("1000000000000000000000000000000000000001"), pow(cpp_int(10), 40)));
  for (const auto* text : {"", "nan", "inf", "0x10", "1 ", " 1", "1e", "1,5", "1.2.3", "1e5000"})
    EXPECT_FALSE(parse_decimal(text)) << text;
}

TEST(Quantity, WideScalarsGetEveryDigit) {
  const Quantity tenth = parsed("0.1 m", D::length);
  EXPECT_EQ(tenth.to<mpfr>(), mpfr(1) / 10);
  EXPECT_EQ(tenth.to<float128>(), float128(1) / 10);
  EXPECT_EQ(tenth.to<double>(), 0.1);
  EXPECT_NE(tenth.to<mpfr>(), mpfr(0.1));
  EXPECT_EQ(parsed("4.76 mm", D::length).to<mpfr>(), mpfr(476) / 100000);
  EXPECT_EQ(parsed("4.76 mm", D::length).to<float128>(), float128(476) / 100000);
}

TEST(Quantity, AnglesInWideScalarsUseAsManyDigitsOfPi) {
  const mpfr pi("3.14159265358979323846264338327950288419716939937510582097494459");
  EXPECT_LT(abs(parsed("15 deg", D::angle).to<mpfr>() - pi / 12), mpfr("1e-49"));
  EXPECT_LT(abs(mpfr(parsed("15 deg", D::angle).to<float128>()) - pi / 12), mpfr("1e-33"));
  EXPECT_EQ(parsed("180 deg", D::angle).to<double>(), 3.141592653589793);
}

/// udunits2, for the units that it has: its database, a parsed pair of units, a converter.
class Udunits {
 public:
  Udunits() {
    ut_set_error_message_handler(ut_ignore);
    system_ = ut_read_xml(nullptr);
  }
  Udunits(const Udunits&) = delete;
  Udunits& operator=(const Udunits&) = delete;
  ~Udunits() { ut_free_system(system_); }
  bool good() const { return system_ != nullptr; }

  /// NaN when a unit is unknown or the two do not convert.
  double convert(double value, const std::string& from, const std::string& to) const {
    ut_unit* a = ut_parse(system_, from.c_str(), UT_UTF8);
    ut_unit* b = ut_parse(system_, to.c_str(), UT_UTF8);
    double result = std::nan("");
    if (a && b)
      if (cv_converter* converter = ut_get_converter(a, b)) {
        result = cv_convert_double(converter, value);
        cv_free(converter);
      }
    ut_free(a);
    ut_free(b);
    return result;
  }
 private:
  ut_system* system_ = nullptr;
};

TEST(Quantity, UdunitsAgrees) {
  struct Pair {
    std::string ours, theirs, si;
    Dimension dimension;
  };
  // Hz is a frequency there, 1/s: without the 2 pi, which a second test adds.
  const std::vector<Pair> pairs = {
      {"cm", "cm", "m", D::length},
      {"dm", "dm", "m", D::length},
      {"mm", "mm", "m", D::length},
      {"um", "um", "m", D::length},
      {"in", "in", "m", D::length},
      {"ft", "ft", "m", D::length},
      {"g", "g", "kg", D::mass},
      {"mg", "mg", "kg", D::mass},
      {"lb", "lb", "kg", D::mass},
      {"h", "h", "s", D::time},
      {"m", "min", "s", D::time},
      {"min", "min", "s", D::time},
      {"ms", "ms", "s", D::time},
      {"us", "us", "s", D::time},
      {"ns", "ns", "s", D::time},
      {"deg", "arc_degree", "radian", D::angle},
      {"deg", "degree", "radian", D::angle},
      {"mJ", "mJ", "J", D::energy},
      {"kJ", "kJ", "J", D::energy},
      {"J", "kg.m2.s-2", "J", D::energy},
      {"ft/s", "ft/s", "m/s", D::speed},
      {"in/s", "in/s", "m/s", D::speed},
      {"cm/s", "cm/s", "m/s", D::speed},
      {"mm/s", "mm/s", "m/s", D::speed},
      {"deg/s", "degree/s", "radian/s", D::angular_speed},
      {"ft/s2", "ft/s2", "m/s2", D::acceleration},
      {"in/s2", "in/s2", "m/s2", D::acceleration},
      {"cm/s2", "cm/s2", "m/s2", D::acceleration},
      {"g/cm3", "g/cm3", "kg/m3", D::density},
      {"lb/ft3", "lb/ft3", "kg/m3", D::density},
  };
  const Udunits udunits;
  ASSERT_TRUE(udunits.good());
  for (const auto& p : pairs)
    for (const auto* number : {"1", "8", "4.76", "-0.3", "1054", "6.02e5"}) {
      const double ours = parsed(number + (" " + p.ours), p.dimension).to<double>();
      const double theirs = udunits.convert(std::strtod(number, nullptr), p.theirs, p.si);
      EXPECT_LE(std::abs(ours - theirs), 1e-15 * std::abs(ours)) << number << " " << p.ours;
    }
}

TEST(Quantity, UdunitsAgreesOnTurns) {
  const Udunits udunits;
  ASSERT_TRUE(udunits.good());
  const double turn = udunits.convert(360, "degree", "radian");
  for (const double value : {1.0, 17.5, 1054.0}) {
    const std::string number = std::to_string(value);
    EXPECT_NEAR(parsed(number + " Hz", D::angular_speed).to<double>() /
            (udunits.convert(value, "Hz", "s-1") * turn),
        1, 1e-15);
    EXPECT_NEAR(parsed(number + " rpm", D::angular_speed).to<double>() /
            (udunits.convert(value, "min-1", "s-1") * turn),
        1, 1e-15);
    EXPECT_NEAR(parsed(number + " grad", D::angle).to<double>() / (value / 400 * turn), 1, 1e-15);
  }
}

/// A decimal as text and, composed of the same digits in another way, as a rational.
struct Decimal {
  std::string text;
  cpp_rational value;
};

Decimal draw_decimal() {
  const auto digits = [](int least, int most) {
    std::string text;
    const int size = *rc::gen::inRange(least, most + 1);
    for (int k = 0; k < size; ++k) text += static_cast<char>('0' + *rc::gen::inRange(0, 10));
    return text;
  };
  const std::string sign = *rc::gen::element<std::string>("", "+", "-");
  const std::string whole = digits(1, 9), fraction = digits(0, 9);
  const int exponent = *rc::gen::inRange(-9, 10);
  const std::string mark = *rc::gen::element<std::string>("e", "E");
  Decimal d;
  d.text = sign + whole + (fraction.empty() ? "" : "." + fraction);
  for (std::size_t k = 0; k < whole.size(); ++k) d.value = d.value * 10 + (whole[k] - '0');
  cpp_rational place(1);
  for (const char c : fraction) {
    place /= 10;
    d.value += place * (c - '0');
  }
  if (*rc::gen::arbitrary<bool>()) {
    d.text += mark + std::to_string(exponent);
    for (int k = 0; k < std::abs(exponent); ++k) d.value *= exponent < 0 ? ratio(1, 10) : ratio(10);
  }
  if (sign == "-") d.value = -d.value;
  return d;
}

RC_GTEST_PROP(Quantity, RandomDecimalsAreExactInEveryUnit, ()) {
  struct Unit {
    std::string name;
    Dimension dimension;
    cpp_rational factor;
    int pi_power;
  };
  static const std::vector<Unit> units = {{"m", D::length, 1, 0},
      {"mm", D::length, ratio(1, 1000), 0}, {"in", D::length, ratio(127, 5000), 0},
      {"lb", D::mass, ratio(45359237, 100000000), 0}, {"h", D::time, 3600, 0},
      {"deg", D::angle, ratio(1, 180), 1}, {"rpm", D::angular_speed, ratio(1, 30), 1},
      {"g/cm^3", D::density, 1000, 0}, {"ft/s²", D::acceleration, ratio(381, 1250), 0}};
  const Decimal d = draw_decimal();
  const Unit& unit = *rc::gen::elementOf(units);
  const std::string space = *rc::gen::element<std::string>("", " ", "  ");
  const auto result = parse_quantity(d.text + space + unit.name, unit.dimension);
  RC_ASSERT(std::holds_alternative<Quantity>(result));
  RC_ASSERT(rational(std::get<Quantity>(result)) == d.value * unit.factor);
  RC_ASSERT(std::get<Quantity>(result).pi_power == unit.pi_power);
}

RC_GTEST_PROP(Quantity, SiDecimalsRoundCorrectlyToDouble, ()) {
  const Decimal d = draw_decimal();
  static const std::vector<std::pair<std::string, Dimension>> units = {{" m", D::length},
      {" kg", D::mass}, {" s", D::time}, {" rad", D::angle}, {" J", D::energy}, {" m/s", D::speed},
      {" rad/s", D::angular_speed}, {" m/s2", D::acceleration}, {" kg/m3", D::density},
      {"", D::none}};
  const auto [unit, dimension] = *rc::gen::elementOf(units);
  const auto result = parse_quantity(d.text + unit, dimension);
  RC_ASSERT(std::holds_alternative<Quantity>(result));
  RC_ASSERT(std::get<Quantity>(result).to<double>() == std::strtod(d.text.c_str(), nullptr));
}

}  // namespace
}  // namespace edmill::casefile
