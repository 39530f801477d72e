#include "app/study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <sstream>

#include "app/judge.hpp"
#include "base/clean_text.hpp"
#include "base/errors.hpp"
#include "casefile/case_spec.hpp"
#include "dem/contact_rates.hpp"
#include "io/input_file.hpp"
#include "io/output_folder.hpp"
#include "plot/chart.hpp"
#include "report/report_page.hpp"
#include "run/any_run.hpp"
#include "run/event_source.hpp"
#include "study/optimizer.hpp"
#include "study/study.hpp"

namespace edmill::app {

namespace {

study::RunRecord do_job(const study::Job& job, const std::atomic<bool>* interrupt) {
  const auto spec = casefile::read_case(job.case_file, job.overrides);
  if (spec.digits)
    throw InputError(
        spec.file + ": key 'run.digits' is not available in a study: set run.precision");
  return casefile::with_memory_for(spec, [&] {
    const auto run = run::make_run(
        spec.precision, spec, {.interrupt = interrupt, .max_cpu_time = job.max_cpu_time});
    try {
      run->finish();
    } catch (const UndecidedError&) {  // part of the record
    }
    return study::record_of(run->facts());
  });
}

std::string folder_of(const StudyOptions& options) {
  if (!options.folder.empty()) return options.folder;
  auto name = std::filesystem::path(options.file).stem();  // ward.sweep.toml: ward
  return "out/" + name.stem().string();
}

/// Rank 0 executes `command`; the other ranks do its runs.
template <class Command>
std::optional<StudyResult> on_all_ranks(const StudyOptions& options, const Command& command) {
  const auto* interrupt = options.interrupt;
  const study::RunFunction run = [interrupt](
                                     const study::Job& job) { return do_job(job, interrupt); };
  study::Ranks ranks;
  if (ranks.rank() > 0) {
    study::serve(ranks, options.jobs, run, *options.interrupt);
    return std::nullopt;
  }
  study::Executor executor(ranks, options.jobs, run, *options.interrupt);
  return command(executor);
}

/// @return whether there were enough impacts
bool add_phases(const casefile::CaseSpec& spec, const BifurcationOptions& options, double value,
    Bifurcation& found) {
  const double period = casefile::period_of(spec.mill).to<double>();
  const auto source = run::make_source("double", spec, false, options.interrupt);
  constexpr std::size_t most =
      10'000'000;  // a ball at rest may make slow hops only, which do not count
  std::size_t all = 0;
  for (std::size_t seen = 0; seen < options.skip + options.keep;) {
    const auto events = source->next(64);
    if (events.empty() || (all += events.size()) > most) return false;
    for (const auto& event : events) {
      if (!event.with_wall || event.ball != 0 || event.approach_speed < options.least_approach)
        continue;
      if (seen >= options.skip + options.keep || seen++ < options.skip) continue;
      const double periods = static_cast<double>(event.time) / period;
      found.points.push_back({value, periods - std::floor(periods), event.partner});
    }
  }
  return true;
}

/// Draws points as lines of length zero with round ends.
void write_drawing(std::ostream& out, const BifurcationOptions& options, const Bifurcation& found) {
  plot::Chart chart{"bifurcation", "impact phases over " + options.over,
      "phases of the drive at impacts of ball 0, for each value of " + options.over,
      {options.over + (found.unit.empty() ? "" : " [" + found.unit + "]"), options.from,
          options.to},
      {"phase of the drive [periods]"}};
  std::map<int, plot::Points> walls;
  for (const auto& [value, phase, wall] : found.points)
    for (const double y : {phase, phase, std::numeric_limits<double>::quiet_NaN()})
      walls[wall].emplace_back(value, y);
  for (const auto& [wall, points] : walls)
    chart.curves.push_back(
        {fmt::format("wall {}", wall), fmt::format("c{}", chart.curves.size() % 4), points});
  plot::save(out, chart);
}

constexpr const char *restitution = "restitution", *friction = "friction",
                     *least_separation = "least separation speed";

/// The sections of contact laws in which a case gives a number.
std::vector<std::string> sections_with(const casefile::CaseSpec& spec, const std::string& number) {
  std::vector<std::string> candidates{"contact", "contact.ball_ball", "contact.ball_wall"}, found;
  for (std::size_t k = 0; k < spec.pairs.size(); ++k)
    candidates.push_back(fmt::format("contact.pair.{}", k));
  for (const auto& section : candidates) {
    try {
      casefile::value_of_key(spec, section + "." + number);
      found.push_back(section);
    } catch (const InputError&) {  // the case does not give it there
    }
  }
  return found;
}

class Cases {
 public:
  explicit Cases(casefile::CaseSpec spec) : spec_(std::move(spec)) { spec_.outputs.clear(); }

  std::vector<Variation> runs;
  std::vector<casefile::CaseSpec> specs;  ///< with the same indices

  void add(const std::string& what, const std::string& number,
      const std::vector<std::string>& settings) try {
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
      const double value = casefile::parse_decimal(casefile::value_of_key(spec_, key).number)
                               ->to<double>(),
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
    if (speed > 0 && !settings.empty())
      add("half of the least separation speed", least_separation, settings);
  }
 private:
  casefile::CaseSpec spec_;
};

const study::Quantity& dose_rate() { return study::main_quantities().front(); }
std::optional<double> rate_of(const Variation& v) {
  return v.record.done() ? dose_rate().of(v.record) : std::nullopt;
}
std::optional<double> half_width_of(const Variation& v) {
  return v.record.facts.find(dose_rate().interval);
}

}  // namespace

std::optional<StudyResult> sweep(const StudyOptions& options) {
  return on_all_ranks(options, [&](study::Executor& executor) {
    const auto spec = casefile::read_sweep(options.file);
    const auto folder = folder_of(options);
    study::Study study(spec, folder, "sweep", executor, !options.quiet, options.progress);
    for (auto& point : study::points_of(spec))
      study.add_runs(study.add_point(point), spec.replicas);
    study.require_a_good_case();
    if (options.estimate) return StudyResult{{}, false, "", "", study.forecast()};
    study.run();
    study.write_page(report::study_page(study, "Sweep", ""));
    return StudyResult{
        study.counts(), study.interrupted(), folder, study::list_of(study.points()), ""};
  });
}

std::optional<StudyResult> optimize(const StudyOptions& options) {
  return on_all_ranks(options, [&](study::Executor& executor) {
    const auto spec = casefile::read_optimize(options.file);
    const auto folder = folder_of(options);
    study::Study study(spec, folder, "optimize", executor, !options.quiet, options.progress);
    if (options.estimate) return StudyResult{{}, false, "", "", study::forecast(spec, study)};
    const auto result = study::optimize(spec, study);
    const auto finding = study::describe(spec, study, result);
    study.write_page(report::study_page(study, "Optimisation", finding));
    return StudyResult{study.counts(), study.interrupted(), folder, finding, ""};
  });
}

std::optional<StudyResult> seeds(const SeedsOptions& options) {
  if (io::is_stream(options.file))
    throw InputError("--seeds: found a case from a pipe, expected a file: each run reads it");
  const auto the_case = casefile::read_case(options.file, options.settings);
  casefile::SweepSpec spec;
  spec.file = spec.case_file = options.file;
  spec.precision = options.precision;
  spec.seed = the_case.seed;
  study::Point point;
  for (const auto& setting : options.settings) {
    const auto equals = setting.find('=');
    point.settings.push_back({setting.substr(0, equals), setting.substr(equals + 1)});
  }
  return on_all_ranks(options, [&](study::Executor& executor) {
    study::Study study(spec, options.folder, "seeds", executor, !options.quiet, options.progress);
    study.add_runs(study.add_point(point), options.count);
    study.require_a_good_case();
    if (options.estimate) return StudyResult{{}, false, "", "", study.forecast()};
    study.run();
    const auto found = study::describe(study.points().front());
    study.write_page(report::study_page(study, fmt::format("{} seeds", options.count), found));
    return StudyResult{study.counts(), study.interrupted(), options.folder, found, ""};
  });
}

Bifurcation bifurcation(const casefile::CaseSpec& spec, const BifurcationOptions& options) {
  if (!(options.from < options.to))
    throw InputError(
        fmt::format("--to: found {}, expected more than {}", options.to, options.from));
  Bifurcation found;
  found.unit = casefile::value_of_key(spec, options.over).unit;
  io::NamedFile drawing(options.file);
  const std::filesystem::path place(options.file);
  if (place.has_extension() && place.extension() != ".svg")
    throw InputError("--out: found \"" + options.file +
        "\", expected the name of a drawing, .svg: its points are written beside it as .csv");
  io::NamedFile table(place.has_extension() ? std::filesystem::path(place).replace_extension(".csv")
                                            : "");  // none beside a device
  for (std::size_t step = 0; step < options.steps; ++step) {
    const double last = static_cast<double>(std::max<std::size_t>(options.steps - 1, 1));
    const double value =
        std::lerp(options.from, options.to, static_cast<double>(step) / last);  // exact ends
    const auto text = fmt::format("{}{}{}", value, found.unit.empty() ? "" : " ", found.unit);
    if (!add_phases(casefile::with_value(spec, options.over, text), options, value, found))
      ++found.ended;
    found.interrupted = options.interrupt && *options.interrupt;
    if (found.interrupted) return found;
    options.progress(step + 1);
  }
  drawing.write([&](std::ostream& out) { write_drawing(out, options, found); });
  table.write([&](std::ostream& out) {
    out << "# case digest " << spec.digest << "\nvalue,phase,wall\n";
    for (const auto& point : found.points)
      out << fmt::format("{},{},{}\n", point.value, point.phase, point.wall);
  });
  return found;
}

std::string limit_drawing(const dem::Limit& limit) {
  const double last = 1e6 * limit.points.front().contact_time, value = limit.at_zero.dose_rate;
  plot::Chart chart{"limit", "dose rate over contact time",
      "dose rates of runs with contacts of several durations, and their limit",
      {"contact time [us]", 0, 1.08 * last}, {"dose rate [W]", INFINITY, -INFINITY}};
  chart.curves.push_back({"line", "c0", {{0, value}, {last, value + 1e-6 * limit.slope * last}}});
  const auto bar = [&](double x, const dem::ContactRates& r, const char* colour, const char* name) {
    const double low = r.dose_rate - r.half_width, high = r.dose_rate + r.half_width;
    chart.y.low = std::min(chart.y.low, low);
    chart.y.high = std::max(chart.y.high, high);
    chart.curves.push_back({name, colour, {{x, low}, {x, high}}});
  };
  for (const auto& p : limit.points)
    bar(1e6 * p.contact_time, p, "c1", &p == &limit.points.front() ? "runs" : "");
  bar(0.004 * last, limit.at_zero, "c0", "limit");
  if (limit.to_edmill) bar(0.012 * last, limit.to_edmill->a, "c2", "edmill");
  const double room = 0.08 * (chart.y.high - chart.y.low);
  chart.y.low -= room;
  chart.y.high += room;
  std::ostringstream out;
  plot::save(out, chart);
  return out.str();
}

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
      shown[v.number] = std::max(shown[v.number],
          v.differs     ? deciding
              : v.known ? without_effect
                        : unknown);
    if (v.number.empty() || v.number == restitution || v.number == friction) {
      low = std::min(low, *rate);
      high = std::max(high, *rate);
    }
  }
  if (low <= high)
    out +=
        fmt::format("  if restitution and friction are uncertain by {:g}: {:#.3g} to {:#.3g} W\n",
            uncertainty, low, high);
  constexpr std::pair<Shown, const char*> sentences[] = {{deciding, "the dose rate depends on"},
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

Variations vary(const casefile::CaseSpec& spec, const std::string& precision,
    const study::RunRecord& own, double uncertainty, const std::atomic<bool>* interrupt) {
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

std::string what_decides(const casefile::CaseSpec& spec, const std::string& precision,
    const io::Facts& run, double uncertainty, const std::atomic<bool>* interrupt) {
  const auto own = study::record_of(run);
  if (!own.done() || !run.has(dose_rate().interval)) return "";
  const auto found = vary(spec, precision, own, uncertainty, interrupt);
  return found.interrupted ? "" : found.text();
}

}  // namespace edmill::app
