#include "casefile/value_of_key.hpp"

#include <algorithm>

#include "base/errors.hpp"
#include "casefile/rational.hpp"
#include "casefile/section.hpp"

namespace edmill::casefile {

namespace {

using boost::multiprecision::cpp_int;

/// The text of a key as the file or a setting gives it; empty where there is none.
std::string written(const CaseSpec& spec, const std::string& key) {
  Document document;
  document.name = spec.file;
  const auto table = parse_toml(spec.text, "a case file", spec.settings, document);
  const toml::node* node = &table;
  for (std::size_t begin = 0; node && begin <= key.size();) {
    const auto end = std::min(key.find('.', begin), key.size());
    const std::string part = key.substr(begin, end - begin);
    if (const auto* inner = node->as_table())
      node = inner->get(part);
    else if (const auto* list = node->as_array(); list && !part.empty() &&
                                                  part.find_first_not_of("0123456789") == std::string::npos &&
                                                  part.size() < 9)
      node = list->get(std::stoul(part));
    else
      node = nullptr;
    begin = end + 1;
  }
  return node && (node->is_string() || node->is_number()) ? document.raw(*node, key) : "";
}

/// The number as an integer times a power of ten.
std::pair<cpp_int, int> in_decimals(const std::string& number) {
  const Rational value = rational(*parse_decimal(number));
  cpp_int denominator = boost::multiprecision::denominator(value);
  int exponent = 0;
  cpp_int power = 1;
  for (; power % denominator != 0; --exponent) power *= 10;
  return {cpp_int(numerator(value) * (power / denominator)), exponent};
}

std::vector<std::string> settings_with(const CaseSpec& spec, const std::string& key,
                                       const std::string& value) {
  auto settings = spec.settings;
  const bool plain = value.find(' ') == std::string::npos;  // a number without a unit
  settings.push_back(key + "=" + (plain ? value : "\"" + value + "\""));
  return settings;
}

}  // namespace

std::string WrittenNumber::plus(int sign, unsigned digits) const {
  auto [mantissa, exponent] = in_decimals(number);
  const int last = std::min(exponent, -static_cast<int>(digits));
  const auto in_last = [&](const cpp_int& m, int e) {
    return cpp_int(m * boost::multiprecision::pow(cpp_int(10), static_cast<unsigned>(e - last)));
  };
  const cpp_int sum = in_last(mantissa, exponent) + in_last(sign, -static_cast<int>(digits));
  const std::string text = sum.str() + "e" + std::to_string(last);
  return unit.empty() ? text : text + " " + unit;
}

WrittenNumber value_of_key(const CaseSpec& spec, const std::string& key) {
  const std::string text = written(spec, key);
  const auto end = std::min(text.find_first_not_of("0123456789+-.eE"), text.size());
  WrittenNumber found{text.substr(0, end), ""};
  const auto unit = text.find_first_not_of(' ', end);
  if (unit != std::string::npos) found.unit = text.substr(unit);
  if (!parse_decimal(found.number))
    throw InputError(spec.file + ": key '" + key + "': found " +
                     (text.empty() ? "nothing" : "\"" + text + "\"") +
                     ", expected a number that the case file or a setting gives");
  return found;
}

CaseSpec with_value(const CaseSpec& spec, const std::string& key, const std::string& value) {
  return parse_case(spec.text, spec.file, settings_with(spec, key, value));
}

CaseSpec with_close_value(const CaseSpec& spec, const std::string& key, const std::string& value) {
  return parse_close_case(spec, settings_with(spec, key, value));
}

}  // namespace edmill::casefile
