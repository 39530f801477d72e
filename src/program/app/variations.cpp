#include "app/variations.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/clean_text.hpp"
#include "base/errors.hpp"
#include "run/any_run.hpp"
#include "study/study.hpp"

namespace edmill::app {

namespace {

constexpr const char *restitution = "restitution", *friction = "friction",
                     *least_separation = "least separation speed";

/// The sections of contact laws in which a case gives a number.
std::vector<std::string> sections_with(const casefile::CaseSpec& spec, const std::string& number) {
  std::vector<std::string> candidates{"contact", "contact.ball_ball", "contact.ball_wall"}, found;
  for (std::size_t k = 0; k < spec.pairs.size(); ++k) candidates.push_back(fmt::format("contact.pair.{}", k));
  for (const auto& section : candidates) try {
      casefile::value_of_key(spec, section + "." + number);
      found.push_back(section);
    } catch (const InputError&) {  // the case does not give it there
    }
  return found;
}

class Cases {
 public:
  explicit Cases(casefile::CaseSpec spec) : spec_(std::move(spec)) { spec_.outputs.clear(); }

  std::vector<Variation> runs;
  std::vector<casefile::CaseSpec> specs;  ///< with the same indices

  void add(const std::string& what, const std::string& number, const std::vector<std::string>& settings) try {
    auto all = spec_.settings;
    all.insert(all.end(), settings.begin(), settings.end());
    auto varied = casefile::parse_case(spec_.text, spec_.file, all);
    varied.outputs.clear();
    runs.push_back({what, number});
    specs.push_back(std::move(varied));
  } catch (const InputError&) {  // no such case
  }
  /// Adds a run in which a number is shifted in all laws, within its range.
  void add_shifted(const std::string& number, double by, double most) {
    std::vector<std::string> settings;
    for (const auto& section : sections_with(spec_, number)) {
      const auto key = section + "." + number;
      const double value = casefile::parse_decimal(casefile::value_of_key(spec_, key).number)->to<double>(),
                   shifted = std::clamp(value + by, 0.0, most);
      if (shifted != value) settings.push_back(fmt::format("{}={:.6g}", key, shifted));
    }
    if (!settings.empty())
      add(fmt::format("{} {} {:g}", number, by < 0 ? "-" : "+", std::abs(by)), number, settings);
  }
  void add_half_least_separation() {
    const double speed = std::max(spec_.ball_ball.least_separation.to<double>(),
                                  spec_.ball_wall.least_separation.to<double>());
    auto sections = sections_with(spec_, "least_separation");
    if (sections.empty()) sections = sections_with(spec_, restitution);
    std::vector<std::string> settings;
    for (const auto& section : sections)
      settings.push_back(fmt::format("{}.least_separation=\"{} m/s\"", section, speed / 2));
    if (speed > 0 && !settings.empty()) add("half of the least separation speed", least_separation, settings);
  }

 private:
  casefile::CaseSpec spec_;
};

const study::Quantity& dose_rate() { return study::main_quantities().front(); }
std::optional<double> rate_of(const Variation& v) {
  return v.record.done() ? dose_rate().of(v.record) : std::nullopt;
}
std::optional<double> half_width_of(const Variation& v) { return v.record.facts.find(dose_rate().interval); }

}  // namespace

std::string Variations::text() const {
  std::string out = "  dose rate of other runs\n";
  enum Shown { without_effect, unknown, deciding };
  std::map<std::string, Shown> shown;  // by number that a run varies
  double low = INFINITY, high = -INFINITY;
  for (const auto& v : runs) {
    const auto rate = rate_of(v);
    out += fmt::format("    {:<38}{:<26}{}\n", v.what,
                       rate ? with_interval(*rate, half_width_of(v)) + " W" : "no result",
                       v.differs ? "differs" : "");
    if (!rate) continue;
    if (!v.number.empty())
      shown[v.number] = std::max(shown[v.number], v.differs ? deciding : v.known ? without_effect : unknown);
    if (v.number.empty() || v.number == restitution || v.number == friction) {
      low = std::min(low, *rate);
      high = std::max(high, *rate);
    }
  }
  if (low <= high)
    out += fmt::format("  if restitution and friction are uncertain by {:g}: {:#.3g} to {:#.3g} W\n",
                       uncertainty, low, high);
  constexpr std::pair<Shown, const char*> sentences[] = {
      {deciding, "the dose rate depends on"},
      {without_effect, "the dose rate does not depend on, within the intervals"},
      {unknown, "the runs are too short to show whether the dose rate depends on"}};
  for (const auto& [which, text] : sentences) {
    std::vector<std::string> names;
    for (const auto& [number, what] : shown)
      if (what == which) names.push_back(number);
    if (!names.empty()) out += fmt::format("  {}: {}\n", text, fmt::join(names, ", "));
  }
  return out;
}

Variations vary(const casefile::CaseSpec& spec, const std::string& precision, const study::RunRecord& own,
                double uncertainty, const std::atomic<bool>* interrupt) {
  Cases cases(spec);
  cases.add("another seed", "seed", {fmt::format("run.seed={}", spec.seed + 1)});
  cases.add_half_least_separation();
  for (const double by : {-uncertainty, uncertainty}) cases.add_shifted(restitution, by, 1);
  for (const double by : {-uncertainty, uncertainty}) cases.add_shifted(friction, by, INFINITY);
  Variations found{.uncertainty = uncertainty, .runs = {{"the case as it is", "", own}}};
  found.runs.insert(found.runs.end(), cases.runs.begin(), cases.runs.end());
  tbb::parallel_for(std::size_t{0}, cases.specs.size(), [&](std::size_t k) {
    try {
      const auto run = run::make_run(precision, cases.specs[k], {.interrupt = interrupt});
      run->finish();
      found.runs[1 + k].record = study::record_of(run->facts());
    } catch (const std::exception&) {  // it has no result
    }
  });
  found.interrupted = interrupt && *interrupt;
  const auto base = rate_of(found.runs[0]), width_of_base = half_width_of(found.runs[0]);
  for (auto& v : found.runs) {
    const auto rate = rate_of(v), width = half_width_of(v);
    if (!rate || !base || !width || !width_of_base) continue;
    const double both = std::hypot(*width, *width_of_base);
    v.differs = std::abs(*rate - *base) > both;
    v.known = both < 0.05 * *base;
  }
  return found;
}

std::string what_decides(const casefile::CaseSpec& spec, const std::string& precision, const io::Facts& run,
                         double uncertainty, const std::atomic<bool>* interrupt) {
  const auto own = study::record_of(run);
  if (!own.done() || !run.has(dose_rate().interval)) return "";
  const auto found = vary(spec, precision, own, uncertainty, interrupt);
  return found.interrupted ? "" : found.text();
}

}  // namespace edmill::app
