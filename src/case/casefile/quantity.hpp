// Quantities with units, read exactly: "4.76 mm" is the rational 476/100000 m, "15 deg" is pi/12.
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/dimension.hpp"

namespace edmill::casefile {

using edmill::Dimension;

/// "a length (mm, cm, m, in, ft, ...)", for messages.
std::string describe(Dimension dimension);

/// "length", "number".
std::string noun(Dimension dimension);

/// " m/s"; empty for plain numbers.
std::string si_unit(Dimension dimension);

/// A unit for readers: its dimension, such as "length", and its spellings.
struct UnitText {
  std::string dimension;
  std::vector<std::string> spellings;
};
std::vector<UnitText> unit_texts();

/// An exact SI value: a rational number (defined in casefile/rational.hpp) times pi^`pi_power`.
class Quantity {
 public:
  struct Exact;
  Quantity(std::int64_t numerator = 0, std::int64_t denominator = 1);
  explicit Quantity(std::shared_ptr<const Exact> value, int power)
      : pi_power(power), value_(std::move(value)) {}
  /// @pre `value` is finite
  static Quantity exactly(double value);

  int pi_power = 0;
  const Exact& exact() const { return *value_; }

  bool positive() const;
  bool negative() const;
  bool zero() const;

  friend Quantity operator*(const Quantity& a, const Quantity& b);
  /// @pre b is not zero
  friend Quantity operator/(const Quantity& a, const Quantity& b);
  friend Quantity operator-(const Quantity& a);
  /// @pre the powers of pi are the same
  friend std::strong_ordering operator<=>(const Quantity& a, const Quantity& b);
  friend bool operator==(const Quantity& a, const Quantity& b) { return (a <=> b) == 0; }

  /// Nearest value of a scalar type; the conversion to a wider one does not go through double.
  template <class Real> Real to() const;

  /// Canonical text, "119/25000" or "1/12*pi", for digests.
  std::string text() const;
 private:
  std::shared_ptr<const Exact> value_;  ///< shared by copies
};

/// The reason why a text is not a quantity.
struct QuantityProblem {
  std::string found;  ///< "\"4.76 mn\": unknown unit 'mn'"
};

using QuantityResult = std::variant<Quantity, QuantityProblem>;

/// Whether SI values outside of 1e-30 to 1e30, whose cubes may leave double, are refused.
enum class SizeLimit { physical, none };

/// Treatment of numbers without a unit in dimensions that have one.
enum class Plain { refused, is_si };

/// Number and unit, e.g. "1054 rpm", "8 g/cm^3", "-9.8 m/s²".
QuantityResult parse_quantity(std::string_view text, Dimension dimension,
    SizeLimit limit = SizeLimit::physical, Plain plain = Plain::refused);

/// Whether a text begins with a number that has a comma between its digits.
bool has_comma(std::string_view text);

/// Exact value of a decimal number; nothing for anything else, nan and inf included.
std::optional<Quantity> parse_decimal(std::string_view text);

/// "4.76 mm" is 4.76 and " mm"; nothing for a text that does not begin with a number.
std::optional<std::pair<double, std::string>> split_number(const std::string& text);

/// A number and its unit in SI: "200 rpm" is 20.94... and "rad/s"; nothing for the ambiguous "m".
std::optional<std::pair<double, std::string>> in_si(std::string_view text);

}  // namespace edmill::casefile
