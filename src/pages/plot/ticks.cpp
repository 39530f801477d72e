#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plot/chart.hpp"

namespace edmill::plot {

namespace {

const std::string minus = "\u2212";

std::string superscript(int number) {
  static const char* const digits[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074", "\u2075",
      "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = number < 0 ? "\u207b" : "";
  for (const char c : std::to_string(std::abs(number))) text += digits[c - '0'];
  return text;
}

/// A number with this many decimals, a typographic minus and thin spaces between thousands.
std::string fixed(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool zero = text.find_first_not_of("0.") == std::string::npos;
  const std::size_t whole = std::min(text.find('.'), text.size());
  if (whole > 4)
    for (std::size_t k = whole; k > 3; k -= 3) text.insert(k - 3, "\u202f");
  return (value < 0 && !zero ? minus : "") + text;
}

/// The exponent of a number in scientific notation with this many digits.
int exponent_of(double value, int digits) {
  const std::string text = fmt::format("{:.{}e}", std::abs(value), digits - 1);
  return std::stoi(text.substr(text.find('e') + 1));
}

std::string power_of_ten(int exponent) {
  return exponent >= -2 && exponent <= 4 ? fixed(std::pow(10.0, exponent), std::max(0, -exponent))
                                         : "10" + superscript(exponent);
}

std::string scientific(double value, int exponent, int digits) {
  return fixed(value / std::pow(10.0, exponent), std::max(0, digits - 1)) + " \u00d7 10" +
      superscript(exponent);
}

std::string without_zeros(const std::string& text) {
  const auto end = text.find(" \u00d7"), point = text.find('.');
  if (point == std::string::npos || point > end) return text;
  std::string mantissa = text.substr(0, end);
  mantissa.erase(mantissa.find_last_not_of('0') + 1);
  if (mantissa.back() == '.') mantissa.pop_back();
  return end == std::string::npos ? mantissa : mantissa + text.substr(end);
}

/// Label of a tick that is too large or too small for plain decimals.
std::string tick_label(double value) {
  return value == 0 ? "0" : without_zeros(scientific(value, exponent_of(value, 3), 3));
}

}  // namespace

std::vector<Tick> linear_ticks(double low, double high, int most) {
  const double range = high - low;
  int exponent = static_cast<int>(std::floor(std::log10(range / most))) - 1;
  for (;; ++exponent)
    for (const int factor : {1, 2, 5}) {
      // Steps are integers over or times a power of ten, so that 3 steps of 0.1 are 0.3.
      const double scale = std::pow(10.0, std::abs(exponent));
      const auto place = [&](double k) {
        return exponent < 0 ? k * factor / scale : k * factor * scale;
      };
      const double step = place(1), slack = 1e-9 * range;
      const double first = std::ceil((low - slack) / step),
                   last = std::floor((high + slack) / step);
      if (last - first + 1 > most) continue;
      std::vector<Tick> ticks;
      const double largest = std::max(std::abs(low), std::abs(high));
      // Scientific notation for large and small numbers, unless ticks differ in late digits only.
      const bool scientific = (largest >= 1e5 || largest < 1e-3) && step > 1e-3 * largest;
      for (double k = first; k <= last; ++k) {
        const double value = place(k);
        ticks.push_back(
            {value, scientific ? tick_label(value) : fixed(value, std::max(0, -exponent))});
      }
      return ticks;
    }
}

std::vector<Tick> fitting_ticks(double low, double high, int most, double room) {
  constexpr double apart = 8;
  for (;; --most) {
    auto ticks = linear_ticks(low, high, most);
    if (most <= 2 || static_cast<double>(ticks.size()) * (width_of(ticks) + apart) <= room)
      return ticks;
  }
}

std::vector<Tick> log_ticks(double low, double high, int most) {
  const int first = static_cast<int>(std::floor(std::log10(low) - 1e-9));
  const int last = static_cast<int>(std::ceil(std::log10(high) + 1e-9));
  const int every = std::max(1, (last - first + most - 1) / most);
  std::vector<Tick> ticks;
  for (int e = first; e <= last; ++e)
    for (int m = 1; m <= 9; ++m) {
      if (m > 1 && last - first > 10) break;
      const double place = m * std::pow(10.0, e);
      if (place < low * (1 - 1e-9) || place > high * (1 + 1e-9)) continue;
      ticks.push_back({place, m == 1 && e % every == 0 ? power_of_ten(e) : ""});
    }
  return ticks;
}

double width_of(const std::string& label) {
  constexpr double letter = 7.8;
  // Characters of more than one byte have continuations.
  return letter * static_cast<double>(std::count_if(label.begin(), label.end(), [](char c) {
    return (c & 0xC0) != 0x80;
  }));
}

double width_of(const std::vector<Tick>& ticks) {
  double width = 0;
  for (const auto& tick : ticks) width = std::max(width, width_of(tick.label));
  return width;
}

std::string readable(double value, int digits) {
  if (!std::isfinite(value))
    return std::isnan(value) ? "\u2013" : value < 0 ? minus + "\u221e" : "\u221e";
  if (value == 0) return "0";
  const int exponent = exponent_of(value, digits);
  if (exponent >= -3 && exponent < std::max(7, digits))
    return fixed(value, std::max(0, digits - 1 - exponent));
  return scientific(value, exponent, digits);
}

std::string brief(double value, int digits) { return without_zeros(readable(value, digits)); }

std::pair<std::string, std::string> with_interval(double value, double half_width) {
  if (!(half_width > 0) || !std::isfinite(half_width))
    return {readable(value), readable(half_width, 2)};
  const int exponent = exponent_of(half_width, 2);
  if (exponent < -5 || exponent > 6 || std::abs(value) < half_width)
    return {readable(value, 2), readable(half_width, 2)};
  const int decimals = std::max(0, 1 - exponent);
  return {fixed(value, decimals), fixed(half_width, decimals)};
}

}  // namespace edmill::plot
