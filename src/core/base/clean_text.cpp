#include "base/clean_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <cmath>
#include <utility>

namespace edmill {

namespace {

/// Length of the first character in bytes; 0 if XML does not allow it.
std::size_t character_size(std::string_view text) {
  auto end = text.begin();
  const auto code = boost::locale::utf::utf_traits<char>::decode(end, text.end());
  const bool is_blank = code == '\t' || code == '\n' || code == '\r';
  const bool is_other = code >= 0x20 && code <= 0x10ffff && code != 0xfffe && code != 0xffff;
  return is_blank || is_other ? static_cast<std::size_t>(end - text.begin()) : 0;
}

/// The exponent of `value` in scientific notation with this many digits.
int exponent_of(double value, int digits) {
  const auto text = fmt::format("{:.{}e}", value, digits - 1);
  return std::stoi(text.substr(text.find('e') + 1));
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  constexpr const char* blanks = " \t\r\n\v\f";
  const auto first = text.find_first_not_of(blanks);
  return first == text.npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string clean_text(std::string_view text) {
  std::string clean;
  while (!text.empty()) {
    const auto size = character_size(text);
    clean += size > 0 ? text.substr(0, size) : "\xef\xbf\xbd";
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return clean;
}

std::string one_line(std::string_view text) {
  auto line = clean_text(text);
  // Python's splitlines() takes U+0085, U+2028 and U+2029 for line ends, too.
  for (const std::string_view end : {"\n", "\r", "\xc2\x85", "\xe2\x80\xa8", "\xe2\x80\xa9"})
    for (auto at = line.find(end); at != line.npos; at = line.find(end))
      line.replace(at, end.size(), " ");
  return line;
}

std::string percent(double share) {
  const double hundredths = 100 * share;
  return hundredths < 99.5 ? fmt::format("{:.2g} %", hundredths)
                           : fmt::format("{:.0f} %", hundredths);
}

std::string counted(std::uint64_t number, std::string_view noun) {
  return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

std::string with_interval(double value, std::optional<double> half_width) {
  if (!half_width || !(*half_width > 0) || !std::isfinite(*half_width))
    return fmt::format("{:.4g}{}", value, half_width ? " \u00b1 0" : "");
  double width = *half_width;
  const int exponent = exponent_of(std::max(std::abs(value), width), 4);
  const bool scientific = exponent >= 5 || exponent < -3;
  const double scale = std::pow(10.0, scientific ? exponent : 0);
  value /= scale;
  width /= scale;
  const int last = exponent_of(width, 2) - 1;  // place of the last digit
  const double unit = std::pow(10.0, std::max(last, 0));
  const auto text = [&](double x) {
    return fmt::format("{:.{}f}", last > 0 ? std::round(x / unit) * unit : x, std::max(-last, 0));
  };
  const auto both = text(value) + " \u00b1 " + text(width);
  return scientific ? fmt::format("({})e{}", both, exponent) : both;
}

std::string time_with_interval(double seconds, std::optional<double> half_width) {
  constexpr double min = 60, h = 60 * min, day = 24 * h;
  const auto [size, unit] = seconds >= 3 * day ? std::pair{day, "days"}
      : seconds >= 2 * h                       ? std::pair{h, "h"}
      : seconds >= 2 * min                     ? std::pair{min, "min"}
                                               : std::pair{1.0, "s"};
  if (half_width) half_width = *half_width / size;
  return with_interval(seconds / size, half_width) + " " + unit;
}

std::string energy_text(double joules) {
  constexpr double rounds_up = 0.9995;  // to three digits
  const auto [size, unit] = joules >= rounds_up || joules < 1e-9 ? std::pair{1.0, "J"}
      : joules >= 1e-3 * rounds_up                               ? std::pair{1e-3, "mJ"}
                                                                 : std::pair{1e-6, "\u00b5J"};
  return fmt::format("{:.3g} {}", joules / size, unit);
}

}  // namespace edmill
