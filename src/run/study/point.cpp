// A point of a study: the settings of a case and its runs.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/errors.hpp"
#include "casefile/case_spec.hpp"
#include "study/study.hpp"

namespace edmill::study {

namespace {

/// The count of balls nearest to a charge ratio; at least 1.
std::string count_of(const casefile::CaseSpec& spec, const std::string& ratio) {
  const auto fail = [&](const std::string& found, const std::string& expected) {
    throw InputError(spec.file + ": key 'charge_ratio': found " + found + ", expected " + expected);
  };
  const auto value = casefile::parse_decimal(ratio);
  if (!value || !value->positive()) fail("\"" + ratio + "\"", "a positive number");
  if (!spec.powder_mass) fail("no powder", "a case with powder.mass");
  if (spec.batches.size() != 1 || !spec.balls.empty()) fail("other balls", "a case with one batch [[balls]]");
  const auto& balls = spec.batches.front();
  const double d = balls.diameter.to<double>();
  const double mass = balls.density.to<double>() * std::numbers::pi / 6 * d * d * d;
  const double count = std::round(value->to<double>() * spec.powder_mass->to<double>() / mass);
  if (count > 1e8) fail(ratio, "a charge ratio of fewer than 1e8 balls");
  return std::to_string(static_cast<std::uint64_t>(std::max(count, 1.0)));
}

void estimate_cost(const casefile::CaseSpec& spec, Job& job) {
  job.initial_time = spec.initial_time.to<double>();
  if (spec.end_time) job.end_time = spec.end_time->to<double>();
  // A run without an end time may be long: it starts early.
  const double time = std::clamp(job.end_time - job.initial_time, 1e-9, 1e9);
  job.cost = static_cast<double>(std::max<std::size_t>(spec.ball_count(), 1)) * time;
}

}  // namespace

std::size_t Point::done() const {
  return static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [](const Run& r) { return r.record && r.record->done(); }));
}

std::size_t Point::failed() const {
  return static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [](const Run& r) { return r.record && !r.record->done(); }));
}

std::vector<double> Point::values(const Quantity& quantity) const {
  std::vector<double> values;
  for (const auto& run : runs) {
    if (!run.record || !run.record->done()) continue;
    const auto value = quantity.of(*run.record);
    if (!value) return {};
    values.push_back(*value);
  }
  return values;
}

std::vector<Point> points_of(const casefile::SweepSpec& spec) {
  std::vector<Point> points;
  for (const auto& entry : spec.entries) points.push_back({entry.name, entry.set, {}});
  if (points.empty()) points.emplace_back();
  for (const auto& axis : spec.grid) {
    std::vector<Point> finer;
    for (const auto& point : points)
      for (const auto& value : axis.values) {
        finer.push_back(point);
        finer.back().settings.emplace_back(axis.key, value);
      }
    points = std::move(finer);
  }
  return points;
}

Run make_run(const casefile::StudySpec& spec, const Point& point, std::uint64_t seed) {
  Run run;
  run.seed = seed;
  run.job.case_file = spec.case_file;
  auto& overrides = run.job.overrides;
  std::string ratio;
  for (const auto& [key, value] : point.settings) {
    if (key == casefile::charge_ratio_key)
      ratio = value;
    else
      overrides.push_back(key + "=" + value);
  }
  overrides.push_back("run.seed=" + std::to_string(seed));
  if (!spec.precision.empty()) overrides.push_back("run.precision=" + spec.precision);
  try {
    auto the_case = casefile::read_case(spec.case_file, overrides);
    if (!ratio.empty()) {
      overrides.push_back("balls.0.count=" + count_of(the_case, ratio));
      the_case = casefile::read_case(spec.case_file, overrides);
    }
    run.walls = casefile::partners_of(the_case).walls();
    run.job.digest = the_case.digest;
    estimate_cost(the_case, run.job);
    run.job.max_cpu_time = spec.max_cpu_time;
  } catch (const InputError& error) {
    run.record = failed_run("", "bad_case", error.what());
  }
  return run;
}

}  // namespace edmill::study
