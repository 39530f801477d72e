#include "study/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "base/clean_text.hpp"
#include "base/errors.hpp"
#include "casefile/case_spec.hpp"
#include "io/atomic_file.hpp"
#include "io/checkpoint_file.hpp"
#include "io/input_file.hpp"
#include "io/table_hdf5.hpp"
#include "io/terminal.hpp"

namespace edmill::study {

using Table = io::Table<double>;
using io::Column;
using Type = Column::Type;

namespace {

/// The count of balls nearest to a charge ratio; at least 1.
std::string count_of(const casefile::CaseSpec& spec, const std::string& ratio) {
  const auto fail = [&](const std::string& found, const std::string& expected) {
    throw InputError(spec.file + ": key 'charge_ratio': found " + found + ", expected " + expected);
  };
  const auto value = casefile::parse_decimal(ratio);
  if (!value || !value->positive()) fail("\"" + ratio + "\"", "a positive number");
  if (!spec.powder_mass) fail("a case without powder", "one with powder.mass");
  if (spec.batches.size() != 1 || !spec.balls.empty())
    fail("several kinds of balls", "a case with one batch [[balls]]");
  const auto& balls = spec.batches.front();
  const double d = balls.diameter.to<double>(),
               mass = balls.density.to<double>() * std::numbers::pi / 6 * d * d * d;
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

void write_file(const std::filesystem::path& place, const std::string& bytes) {
  io::AtomicFile file(place);
  file.stream() << bytes;
  file.commit();
}

std::size_t count_ended(const std::vector<Run>& runs, bool with_result) {
  const auto ended = [&](const Run& r) { return r.record && r.record->done() == with_result; };
  return static_cast<std::size_t>(std::ranges::count_if(runs, ended));
}

/// The columns that both tables begin with.
std::vector<Column> point_columns(const std::vector<std::string>& keys) {
  std::vector<Column> columns{{"point", Type::integer}, {"name", Type::text}};
  for (const auto& key : keys) columns.push_back({key, Type::text});
  return columns;
}

void put_point(
    Table& table, std::size_t index, const Point& point, const std::vector<std::string>& keys) {
  table.put(index + 1, point.name);
  for (const auto& key : keys) table.put(value_of(point, key));
}

}  // namespace

std::size_t Point::done() const { return count_ended(runs, true); }
std::size_t Point::failed() const { return count_ended(runs, false); }

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

numerics::OfSeeds Point::estimate(const Quantity& quantity) const {
  const auto means = values(quantity);
  std::vector<double> half_widths;
  for (const auto& run : runs)
    if (run.record && run.record->done() && !quantity.interval.empty())
      if (const auto own = run.record->facts.find(quantity.interval)) half_widths.push_back(*own);
  return numerics::pooled(means, half_widths);
}

std::string text_of(const numerics::OfSeeds& found, const Quantity& quantity) {
  const auto text = [&](double mean, std::optional<double> half_width) {
    if (half_width) *half_width /= quantity.size;
    return with_interval(mean / quantity.size, half_width) + " " + quantity.unit;
  };
  if (found.states.empty()) return found.mean ? text(*found.mean, found.half_width) : "-";
  std::string all;
  for (const auto& state : found.states)
    all += fmt::format("{}{} ({})", all.empty() ? "" : ", ", text(state.mean, state.half_width),
        counted(state.runs, "run"));
  return all;
}

std::string value_of(const Point& point, const std::string& key) {
  const auto found = std::ranges::find(point.settings, key, &casefile::Setting::first);
  return found == point.settings.end() ? "" : found->second;
}

std::vector<std::string> varied_keys(const std::vector<Point>& points) {
  std::vector<std::string> keys;
  for (const auto& setting : points | std::views::transform(&Point::settings) | std::views::join) {
    const auto& key = setting.first;
    const auto differs = [&](const Point& p) {
      return value_of(p, key) != value_of(points[0], key);
    };
    if (std::ranges::find(keys, key) == keys.end() && std::ranges::any_of(points, differs))
      keys.push_back(key);
  }
  return keys;
}

std::string name_of(const std::vector<Point>& points, std::size_t index) {
  std::string name = points[index].name;
  if (name.empty())
    for (const auto& key : varied_keys(points))
      name += fmt::format("{}{} = {}", name.empty() ? "" : ", ", key, value_of(points[index], key));
  return name.empty() ? fmt::format("point {}", index + 1) : name;
}

std::string list_of(const std::vector<Point>& points) {
  constexpr std::size_t most = 40;
  std::string out;
  for (std::size_t k = 0; k < std::min(most, points.size()); ++k) {
    out += fmt::format("  {}:", name_of(points, k));
    std::string_view before = " ";
    for (const auto& quantity : main_quantities()) {
      if (quantity.name == "specific_milling_dose_rate") continue;  // the dose rate in other words
      const auto found = points[k].estimate(quantity);
      if (!found.mean) continue;
      out += fmt::format("{}{}{}", before, quantity.name == "impact_energy" ? "impact energy " : "",
          text_of(found, quantity));
      before = ", ";
    }
    if (before == " ") out += " no result";
    const auto has_reason = [](const Run& r) {
      return r.record && !r.record->done() && !r.record->message.empty();
    };
    if (const auto failed = points[k].failed(); failed > 0)
      out += ", " + counted(failed, "run") + " failed";
    if (const auto run = std::ranges::find_if(points[k].runs, has_reason);
        run != points[k].runs.end())
      out += ": " + run->record->message.substr(0, run->record->message.find('\n'));
    out += '\n';
  }
  if (points.size() > most) out += fmt::format("  and {} more points\n", points.size() - most);
  return out;
}

std::string describe(const Point& point) {
  std::string out;
  for (const auto& quantity : main_quantities()) {
    const auto found = point.estimate(quantity);
    if (!found.mean) continue;
    out += fmt::format("{:<28}{}\n", quantity.title, text_of(found, quantity));
  }
  const auto found = point.estimate(main_quantities().front());
  if (!found.states.empty())
    out +=
        fmt::format("The seeds settle in {} steady states: no single number describes them all.\n",
            found.states.size());
  return out;
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
  for (const auto& [key, value] : point.settings)
    if (key == casefile::charge_ratio_key)
      ratio = value;
    else
      overrides.push_back(key + "=" + value);
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
    run.job.max_cpu_time = spec.max_cpu_time();
  } catch (const InputError& error) {
    run.record = failed_run("", "bad_case", error.what());
  }
  return run;
}

Study::Study(casefile::StudySpec spec, std::filesystem::path folder, std::string name,
    Executor& executor, bool show, Progress progress)
    : spec_(std::move(spec)), folder_(std::move(folder)), name_(std::move(name)),
      executor_(executor), shows_(show), progress_(std::move(progress)), line_(!show) {}

std::size_t Study::add_point(Point point) {
  points_.push_back(std::move(point));
  return points_.size() - 1;
}

void Study::add_runs(std::size_t point, std::uint64_t count) {
  auto& p = points_[point];
  for (std::uint64_t k = 0; k < count; ++k)
    p.runs.push_back(make_run(spec_, p, spec_.seed + p.runs.size()));
}

void Study::require_a_good_case() const {
  if (points_.empty())
    throw InputError(spec_.file + ": the budget is too small for one point: raise runs_max");
  for (const auto& point : points_)
    for (const auto& run : point.runs)
      if (!run.record) return;
  // Read again to report its problems one by one.
  const auto& run = points_.front().runs.front();
  casefile::read_case(run.job.case_file, run.job.overrides);
  throw InputError(spec_.file + ": at every point: " + run.record->message);
}

std::filesystem::path Study::record_file(const std::string& digest) const {
  return folder_ / "runs" / (digest + ".json");
}

std::vector<Job> Study::collect_jobs() {
  std::vector<Job> jobs;
  waiting_.clear();
  for (auto& point : points_)
    for (auto& run : point.runs) {
      if (run.record) continue;
      if (!waiting_.contains(run.job.digest)) {
        run.record = from_json(io::content_of(record_file(run.job.digest)));
        if (run.record && run.record->digest == run.job.digest && run.record->lasting()) {
          log_.emplace_back("kept", run.record->cpu_seconds());
          ++kept_;
          continue;
        }
        run.record.reset();
        jobs.push_back(run.job);
      }
      waiting_.emplace(run.job.digest, &run);
    }
  return jobs;
}

void Study::put(const RunRecord& record) {
  if (record.lasting()) write_file(record_file(record.digest), to_json(record));
  const auto [first, last] = waiting_.equal_range(record.digest);
  for (auto entry = first; entry != last; ++entry) entry->second->record = record;
  log_.emplace_back("ran", record.cpu_seconds());
  ++ran_;
}

void Study::tick() {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_write_) return;
  write_tables();
  // Large tables take time to write: at most a twentieth of the total.
  const auto after = std::chrono::steady_clock::now();
  next_write_ =
      after + std::max<std::chrono::nanoseconds>(std::chrono::seconds(1), 20 * (after - now));
  const auto c = counts();
  if (progress_) progress_(c.kept + c.ran, c.total);
  if (!shows_) return;
  constexpr auto a_while =
      std::chrono::minutes(1);  // between lines where no terminal shows one that changes
  if (!line_ && after < std::max(began_, told_) + a_while) return;
  const auto text = fmt::format("{} of {} runs, {} failed{}", c.kept + c.ran, c.total, c.failed,
      time_left(std::chrono::duration<double>(after - began_).count()));
  if (line_) return line_.show(text);
  io::tell("{}\n", text);
  told_ = after;
}

std::string Study::time_left(double spent) const {
  std::vector<Job> to_do;
  for (const auto& point : points_)
    for (const auto& run : point.runs)
      if (!run.record) to_do.push_back(run.job);
  auto left = forecast_.wall_time(to_do, executor_.threads());
  if (!left && ran_ > 0)
    left = spent * static_cast<double>(to_do.size()) / static_cast<double>(ran_);
  return left ? ", " + in_words(*left) + " left" : "";
}

std::string Study::forecast(const std::vector<Job>& jobs, const RecordFunction& done) {
  forecast_.make(jobs, executor_, done);
  const auto threads = executor_.threads();
  const auto wall_time = forecast_.wall_time(jobs, threads);
  const auto with_time = [&](std::uint64_t runs) {
    const double more =
        static_cast<double>(runs) / static_cast<double>(std::max<std::size_t>(jobs.size(), 1));
    return counted(runs, "run") + (wall_time ? ", " + in_words(*wall_time * more) : "");
  };
  const auto c = counts();
  auto text = c.kept > 0 ? counted(c.kept, "run") + " reused; " : "";
  if (jobs.empty()) return text + "no run is left to do";
  text += with_time(jobs.size()) + " on " + counted(static_cast<std::uint64_t>(threads), "thread");
  if (!wall_time) text += "; how long they take is not known where no end_time ends them";
  if (most_runs_ > c.total) text += "; in all at most " + with_time(most_runs_ - c.kept);
  return text;
}

void Study::take_folder() {
  if (lock_) return;
  io::prepare_folder(folder_);
  lock_.emplace(folder_);
  io::require_no_checkpoint(folder_);
  std::vector<std::string> own;
  for (const auto& table : table_places()) own.push_back(table.filename().string());
  io::require_own_files(folder_, own);
  io::prepare_folder(folder_ / "runs");
  for (const auto& folder : {folder_, folder_ / "runs"}) io::remove_temporaries(folder);
  io::record_files(folder_, table_places());
}

std::vector<std::filesystem::path> Study::table_places() const {
  return {folder_ / (name_ + ".csv"), folder_ / "runs.csv", folder_ / (name_ + ".h5"),
      folder_ / (name_ + "_log.csv"), folder_ / (name_ + ".html")};
}

void Study::run() {
  take_folder();
  auto jobs = collect_jobs();
  if (shows_ && !jobs.empty() && ran_ == 0) {
    const auto text = forecast(jobs, [this](const RunRecord& r) { put(r); });
    constexpr double a_while = 60;  // [s]
    if (line_ || forecast_.wall_time(jobs, executor_.threads()).value_or(0) > a_while)
      io::tell("{}\n", text);
    std::erase_if(jobs,
        [this](const Job& job) { return waiting_.find(job.digest)->second->record.has_value(); });
  }
  write_tables();
  if (began_ == std::chrono::steady_clock::time_point{}) began_ = std::chrono::steady_clock::now();
  executor_.run(
      jobs, [this](const RunRecord& r) { put(r); }, [this] { tick(); });
  if (progress_) progress_(kept_ + ran_, counts().total);
  write_tables();
  if (kept_ + ran_ > 0) io::remove_other_files(folder_, table_places());
}

void Study::write_tables() const {
  const auto points = point_table(), runs = run_table();
  const auto places = table_places();
  const std::string tables[] = {points.csv(), runs.csv(),
      io::hdf5_compounds({{"points", points}, {"runs", runs}}), log_table().csv()};
  for (std::size_t k = 0; k < std::size(tables); ++k) write_file(places[k], tables[k]);
}

void Study::write_page(const std::string& html) const { write_file(table_places().back(), html); }

StudyCounts Study::counts() const {
  StudyCounts c{.kept = kept_, .ran = ran_};
  for (const auto& point : points_) {
    c.total += point.runs.size();
    c.failed += point.failed();
  }
  return c;
}

std::vector<std::string> Study::keys() const {
  std::vector<std::string> keys;
  for (const auto& point : points_)
    for (const auto& [key, value] : point.settings)
      if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
  return keys;
}

std::vector<Quantity> Study::quantities() const {
  int walls = 0;
  for (const auto& point : points_)
    for (const auto& run : point.runs) walls = std::max(walls, run.walls);
  return study::quantities(walls);
}

Table Study::point_table() const {
  const auto varied = keys();
  const auto shown = quantities();
  auto columns = point_columns(varied);
  for (const auto* name : {"replicas", "done", "failed", "states"})
    columns.push_back({name, Type::integer});
  for (const auto& quantity : shown) {
    columns.push_back({quantity.name, Type::number, quantity.si_unit});
    if (!quantity.interval.empty())
      columns.push_back({quantity.name + "_ci95", Type::number, quantity.si_unit});
  }
  Table table(std::move(columns));
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const auto& point = points_[k];
    put_point(table, k, point, varied);
    const auto states = point.estimate(main_quantities().front()).states.size();
    table.put(point.runs.size(), point.done(), point.failed(), std::max<std::size_t>(states, 1));
    for (const auto& quantity : shown) {
      const auto e = point.estimate(quantity);
      table.put(e.mean);
      if (!quantity.interval.empty()) table.put(e.half_width);
    }
  }
  return table;
}

Table Study::run_table() const {
  const auto varied = keys();
  auto shown = amounts();
  std::ranges::copy(quantities(), std::back_inserter(shown));
  auto columns = point_columns(varied);
  columns.push_back({"seed", Type::integer});
  for (const auto* name : {"status", "end_reason"}) columns.push_back({name, Type::text});
  for (const auto& quantity : shown)
    columns.push_back({quantity.name, Type::number, quantity.si_unit});
  for (const auto* name : {"digest", "message"}) columns.push_back({name, Type::text});
  Table table(std::move(columns));
  for (std::size_t k = 0; k < points_.size(); ++k)
    for (const auto& run : points_[k].runs) {
      const auto record = run.record.value_or(RunRecord{});
      put_point(table, k, points_[k], varied);
      table.put(run.seed, run.record ? record.status : "pending", record.end_reason());
      for (const auto& quantity : shown) table.put(quantity.of(record));
      table.put(run.job.digest, record.message);
    }
  return table;
}

Table Study::log_table() const {
  if (log_.empty()) return {};
  Table table({{"run", Type::text}, {"cpu_seconds", Type::number, "s"}});
  for (const auto& [what, seconds] : log_) table.put(what, seconds);
  return table;
}

}  // namespace edmill::study
