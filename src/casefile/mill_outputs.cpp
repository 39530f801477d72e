// Keys of the outputs beyond the thesis. docs/outputs.md
#include <algorithm>
#include <cmath>

#include "casefile/output_keys.hpp"

namespace edmill::casefile {

namespace {

using boost::multiprecision::cpp_rational;

/// A number that a table is made of: at least 1 and not beyond reason.
void read_size(Section& s, const char* key, std::uint64_t& size) {
  constexpr std::uint64_t largest = 1000;
  size = s.count(key).value_or(size);
  s.require(size > 0 && size <= largest, key, "1 to " + std::to_string(largest));
}

}  // namespace

void read_spectra(Section& s, OutputSpec& output) {
  auto& spectra = output.spectra;
  spectra.of_speed = s.choice("of", {"energy", "speed"}) == "speed";
  const bool speed = spectra.of_speed;
  const auto dimension = speed ? Dimension::speed : Dimension::energy;
  spectra.low =
      s.quantity("low", dimension, Quantity{speed ? cpp_rational(1, 1000) : cpp_rational(1, 1000000000)});
  spectra.high = s.quantity("high", dimension, Quantity{speed ? cpp_rational(10) : cpp_rational(1)});
  s.require(spectra.low.positive(), "low", "a value above 0: the bins are logarithmic");
  const double low = size_of(spectra.low), high = size_of(spectra.high);
  const bool ascending = low > 0 && high > low * (1 + 1e-6) && std::isfinite(high);
  const bool low_is_wrong = s.has("low") && !s.has("high");
  s.require(ascending || !spectra.low.positive(), low_is_wrong ? "low" : "high",
            low_is_wrong ? "a value below high" : "a value above low");
  read_size(s, "bins_per_decade", spectra.bins_per_decade);
}

void read_rates_above(Section& s, OutputSpec& output) {
  if (!s.has("cutoffs")) {
    for (const int per_metre : {1000, 100, 10, 1})
      output.cutoffs.push_back(Quantity{cpp_rational(1, per_metre)});
    output.cutoffs.insert(output.cutoffs.begin(), Quantity{0});
    return;
  }
  const std::string expected = "an array of speeds of 0 or more";
  for (const auto& text : s.settings("cutoffs")) {
    const auto speed = parse_quantity(text, Dimension::speed);
    const auto* quantity = std::get_if<Quantity>(&speed);
    if (!quantity)
      s.problem("cutoffs", std::get<QuantityProblem>(speed).found, expected);
    else if (quantity->negative())
      s.problem("cutoffs", "\"" + text + "\"", expected);
    else
      output.cutoffs.push_back(*quantity);
  }
  std::sort(output.cutoffs.begin(), output.cutoffs.end(),
            [](const Quantity& a, const Quantity& b) { return size_of(a) < size_of(b); });
}

void read_vessel_load(Section& s, OutputSpec& output) {
  read_interval(s, output.timer, Quantity{cpp_rational(1, 100)});
  if (!output.timer.max_rows) output.timer.max_rows = 32000;
}

void read_coverage(Section& s, OutputSpec& output) {
  auto& c = output.coverage;
  read_size(s, "angles", c.angles);
  read_size(s, "heights", c.heights);
  read_size(s, "rings", c.rings);
}

}  // namespace edmill::casefile
