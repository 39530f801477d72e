#include "app/variations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/clean_text.hpp"
#include "base/errors.hpp"
#include "casefile/memory_for.hpp"
#include "run/any_run.hpp"
#include "study/executor.hpp"
#include "study/study.hpp"

namespace edmill::app {

namespace {

constexpr const char *restitution = "restitution", *friction = "friction",
                     *least_separation = "least separation speed";

/// A case with other values.
struct Varied {
  Variation variation;
  casefile::CaseSpec spec;
};

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

  std::vector<Varied> list;

  void add(const std::string& what, const std::string& number, const std::vector<std::string>& settings) try {
    auto all = spec_.settings;
    all.insert(all.end(), settings.begin(), settings.end());
    auto varied = casefile::parse_case(spec_.text, spec_.file, all);
    varied.outputs.clear();
    list.push_back({{what, number}, std::move(varied)});
  } catch (const InputError&) {  // no such case
  }
  /// A number of all laws together, within what it can be.
  void add_shifted(const std::string& number, double by, double most) {
    std::vector<std::string> settings;
    for (const auto& section : sections_with(spec_, number)) {
      const auto key = section + "." + number;
      const double value = std::stod(casefile::value_of_key(spec_, key).number),
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
  void add_seed() { add("another seed", "seed", {fmt::format("run.seed={}", spec_.seed + 1)}); }

 private:
  casefile::CaseSpec spec_;
};

const study::Quantity& dose_rate() { return study::main_quantities().front(); }
std::optional<double> rate_of(const Variation& v) {
  return v.record.done() ? dose_rate().of(v.record) : std::nullopt;
}
std::optional<double> half_width_of(const Variation& v) { return v.record.facts.find(dose_rate().interval); }

}  // namespace

bool Variations::by_least_separation() const {
  return std::ranges::any_of(runs,
                             [](const Variation& v) { return v.number == least_separation && v.differs; });
}

std::string Variations::text() const {
  std::string out = "  dose rate of other runs\n";
  std::set<std::string> deciding, others, unknown;
  double low = INFINITY, high = -INFINITY;
  for (const auto& v : runs) {
    const auto rate = rate_of(v);
    out += fmt::format("    {:<38}{:<26}{}\n", v.what,
                       rate ? with_interval(*rate, half_width_of(v)) + " W" : "no result",
                       v.differs ? "differs" : "");
    if (!rate) continue;
    if (!v.number.empty()) (v.differs ? deciding : v.known ? others : unknown).insert(v.number);
    if (v.number.empty() || v.number == restitution || v.number == friction) {
      low = std::min(low, *rate);
      high = std::max(high, *rate);
    }
  }
  for (const auto& number : unknown) others.erase(number);
  for (const auto& number : deciding) {
    others.erase(number);
    unknown.erase(number);
  }
  const auto list = [](const std::set<std::string>& names) {
    std::string text;
    for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
  };
  if (low <= high)
    out += fmt::format("  restitution and friction are known to {:g}: {:.3g} to {:.3g} W\n", uncertainty, low,
                       high);
  if (!deciding.empty()) out += fmt::format("  it depends on: {}\n", list(deciding));
  if (!others.empty())
    out += fmt::format("  it does not depend on, within the intervals: {}\n", list(others));
  if (!unknown.empty())
    out += fmt::format("  the runs are too short to show whether it depends on: {}\n", list(unknown));
  return out;
}

Variations vary(const casefile::CaseSpec& spec, const std::string& precision, const study::RunRecord& own,
                double uncertainty, const std::atomic<bool>* interrupt) {
  Cases cases(spec);
  cases.add_seed();
  cases.add_half_least_separation();
  for (const double by : {-uncertainty, uncertainty}) cases.add_shifted(restitution, by, 1);
  for (const double by : {-uncertainty, uncertainty}) cases.add_shifted(friction, by, INFINITY);
  std::vector<study::Job> jobs;
  for (std::size_t k = 0; k < cases.list.size(); ++k)
    jobs.push_back({.case_file = std::to_string(k), .overrides = {}, .digest = std::to_string(k)});
  study::Ranks ranks;
  std::atomic<bool> never = false;  // runs end by themselves when they are interrupted
  study::Executor executor(
      ranks, 0,
      [&](const study::Job& job) {
        const auto& varied = cases.list[std::stoul(job.case_file)].spec;
        auto record = casefile::with_memory_for(varied, [&] {
          const auto run = run::make_run(precision, varied, {.interrupt = interrupt});
          run->finish();
          return study::record_of(run->facts());
        });
        record.digest = job.digest;
        return record;
      },
      never);
  Variations found{.uncertainty = uncertainty, .runs = {{"the case as it is", "", own}}};
  for (const auto& varied : cases.list) found.runs.push_back(varied.variation);
  executor.run(
      jobs,
      [&](const study::RunRecord& record) {
        if (!record.digest.empty()) found.runs[1 + std::stoul(record.digest)].record = record;
      },
      [] {});
  found.interrupted = interrupt && *interrupt;
  for (auto& v : found.runs) {
    const auto rate = rate_of(v), base = rate_of(found.runs[0]), width = half_width_of(v),
               width_of_base = half_width_of(found.runs[0]);
    if (!rate || !base || !width || !width_of_base) continue;
    constexpr double close = 0.05;  // of the dose rate
    const double both = std::hypot(*width, *width_of_base);
    v.differs = std::abs(*rate - *base) > both;
    v.known = both < close * *base;
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
