#include "app/study.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "base/errors.hpp"
#include "casefile/case_spec.hpp"
#include "io/input_file.hpp"
#include "io/output_folder.hpp"
#include "plot/chart.hpp"
#include "report/report_page.hpp"
#include "run/any_run.hpp"
#include "run/event_source.hpp"
#include "study/optimizer.hpp"

namespace edmill::app {

namespace {

study::RunRecord do_job(const study::Job& job, const std::atomic<bool>* interrupt) {
  const auto spec = casefile::read_case(job.case_file, job.overrides);
  if (spec.digits)
    throw InputError(spec.file + ": key 'run.digits' is not available in a study: set run.precision");
  return casefile::with_memory_for(spec, [&] {
    const auto run =
        run::make_run(spec.precision, spec, {.interrupt = interrupt, .max_cpu_time = job.max_cpu_time});
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
  const study::RunFunction run = [interrupt](const study::Job& job) { return do_job(job, interrupt); };
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
  constexpr std::size_t most = 10'000'000;  // a ball at rest may make slow hops only, which do not count
  std::size_t all = 0;
  for (std::size_t seen = 0; seen < options.skip + options.keep;) {
    const auto events = source->next(64);
    if (events.empty() || (all += events.size()) > most) return false;
    for (const auto& event : events) {
      if (!event.with_wall || event.ball != 0 || event.approach_speed < options.least_approach) continue;
      if (seen >= options.skip + options.keep || seen++ < options.skip) continue;
      const double periods = static_cast<double>(event.time) / period;
      found.points.push_back({value, periods - std::floor(periods), event.partner});
    }
  }
  return true;
}

/// Draws points as lines of length zero with round ends.
void write_drawing(std::ostream& out, const BifurcationOptions& options, const Bifurcation& found) {
  plot::Chart chart{
      "bifurcation",
      "impact phases over " + options.over,
      "phases of the drive at impacts of ball 0, for each value of " + options.over,
      {options.over + (found.unit.empty() ? "" : " [" + found.unit + "]"), options.from, options.to},
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

}  // namespace

std::optional<StudyResult> sweep(const StudyOptions& options) {
  return on_all_ranks(options, [&](study::Executor& executor) {
    const auto spec = casefile::read_sweep(options.file);
    const auto folder = folder_of(options);
    study::Study study(spec, folder, "sweep", executor, !options.quiet, options.progress);
    for (auto& point : study::points_of(spec)) study.add_runs(study.add_point(point), spec.replicas);
    study.require_a_good_case();
    if (options.estimate) return StudyResult{{}, false, "", "", study.forecast()};
    study.run();
    study.write_page(report::study_page(study, "Sweep", ""));
    return StudyResult{study.counts(), study.interrupted(), folder, study::list_of(study.points()), ""};
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
    throw InputError(fmt::format("--to: found {}, expected more than {}", options.to, options.from));
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
    const double value = std::lerp(options.from, options.to, static_cast<double>(step) / last);  // exact ends
    const auto text = fmt::format("{}{}{}", value, found.unit.empty() ? "" : " ", found.unit);
    if (!add_phases(casefile::with_value(spec, options.over, text), options, value, found)) ++found.ended;
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

}  // namespace edmill::app
