#include "numbers.hpp"

#include <cstdlib>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace checker {
namespace {

constexpr auto none = std::string::npos;

[[noreturn]] void refuse(const std::string& text) {
  throw std::invalid_argument("no number: " + text.substr(0, 60));
}

/// Whether a word is an integer in hexadecimal of at most so many digits.
bool is_hexadecimal(const std::string& word, bool may_be_negative, std::size_t most_digits) {
  const std::string digits = word.substr(may_be_negative && word[0] == '-');
  return !digits.empty() && digits.size() <= most_digits &&
      digits.find_first_not_of("0123456789abcdef") == none;
}

/// A mantissa of zero is written "0 0", with its exponent; no other mantissa begins with a zero.
bool writes_zero_as_zero(const std::string& mantissa, const std::string& exponent) {
  const bool begins_with_zero = mantissa[mantissa[0] == '-'] == '0';
  return !begins_with_zero || (mantissa == "0" && exponent == "0");
}

}  // namespace

long small_integer(const std::string& text) {
  const bool digits = text.find_first_not_of("0123456789", text[0] == '-') == none;
  if (text.empty() || text == "-" || text.size() > 7 || !digits) refuse(text);
  return std::stol(text);
}

Real exact_number(const std::string& text) {
  if (text.size() > 100000 || text.find_first_not_of("-0123456789/*pi^") != none) refuse(text);
  const auto star = text.find("*pi");
  const std::string power = star == none ? "^0" : text.substr(star + 3);
  const std::optional<Real> factor = fraction(text.substr(0, star));
  if (!factor || (!power.empty() && power[0] != '^')) refuse(text);
  const long exponent = power.empty() ? 1 : small_integer(power.substr(1));
  if (std::abs(exponent) > 16) refuse(text);
  Real value = *factor;
  for (long k = 0; k < std::abs(exponent); ++k) value = exponent > 0 ? value * pi() : value / pi();
  return value;
}

Real enclosure(const std::string& text) {
  std::istringstream in(text);
  std::string midpoint, midpoint_exponent, radius, radius_exponent, more;
  const bool four_words =
      in >> midpoint >> midpoint_exponent >> radius >> radius_exponent && !(in >> more);
  // Arb aborts on a radius of more than 30 bits, and on a zero with an exponent.
  const bool good = four_words && is_hexadecimal(midpoint, true, 25000) &&
      is_hexadecimal(midpoint_exponent, true, 6) && is_hexadecimal(radius, false, 7) &&
      is_hexadecimal(radius_exponent, true, 6) &&
      writes_zero_as_zero(midpoint, midpoint_exponent) &&
      writes_zero_as_zero(radius, radius_exponent);
  const std::optional<Real> value = good ? midpoint_and_radius(text) : std::nullopt;
  if (!value) refuse(text);
  return *value;
}

}  // namespace checker
