// Many runs of one case: those to do, those reused from an earlier study, and their tables on disk.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/statistics.hpp"
#include "casefile/study_spec.hpp"
#include "io/output_folder.hpp"
#include "io/progress_line.hpp"
#include "io/table.hpp"
#include "study/executor.hpp"

namespace edmill::study {

struct Run {
  std::uint64_t seed = 0;
  int walls = 0;  ///< of its vessel; 0 when the case is invalid
  Job job;
  std::optional<RunRecord> record;  ///< nothing until the run has ended
};

struct Point {
  std::string name;
  std::vector<casefile::Setting> settings;
  std::vector<Run> runs;

  std::size_t done() const;
  std::size_t failed() const;
  /// A quantity of all runs done, in the order of their seeds; empty when one of them lacks it.
  std::vector<double> values(const Quantity& quantity) const;
  /// Estimate of a quantity from these runs and their own intervals.
  numerics::OfSeeds estimate(const Quantity& quantity) const;
};

/// "1.0934 ± 0.0021 W"; for several states "1.0934 ± 0.0021 W (5 runs), 1.36 ± 0.01 W (3 runs)".
std::string text_of(const numerics::OfSeeds& found, const Quantity& quantity);

/// Combined results of the runs of a point, with their steady states, as lines for a terminal.
std::string describe(const Point& point);

/// The value of a key at a point, as text; empty if the point keeps that of the case.
std::string value_of(const Point& point, const std::string& key);
/// Keys whose values differ between the points, in their order.
std::vector<std::string> varied_keys(const std::vector<Point>& points);
/// The name of a point: the one in its file, or else its values of the keys that vary.
std::string name_of(const std::vector<Point>& points, std::size_t index);
/// Each point with its main quantities: lines for a terminal.
std::string list_of(const std::vector<Point>& points);

/// Points of a sweep: the entries times the grid, whose last key changes fastest.
std::vector<Point> points_of(const casefile::SweepSpec& spec);

/// The run of a point with a seed. An invalid case gives a record without a run.
Run make_run(const casefile::StudySpec& spec, const Point& point, std::uint64_t seed);

/// Numbers of runs: all, found on disk, done now, and failed.
struct StudyCounts {
  std::size_t total = 0, kept = 0, ran = 0, failed = 0;
};

class Study {
 public:
  /// Receives the numbers of runs that are done and of all, at most once a second, and at the end.
  using Progress = std::function<void(std::size_t done, std::size_t total)>;

  /// @param name  of the files: `name`.csv, `name`.h5, `name`_log.csv
  /// @param show  whether progress is wanted: a line on a terminal, elsewhere one every minute
  Study(casefile::StudySpec spec, std::filesystem::path folder, std::string name,
      Executor& executor, bool show, Progress progress = nullptr);

  std::size_t add_point(Point point);
  /// The next seeds of a point. Nothing is read from disk or run before `run`.
  void add_runs(std::size_t point, std::uint64_t count);

  /// @throws InputError with the problems of the first point when no point has a good case
  void require_a_good_case() const;

  /// Does every run without a record, then writes the tables.
  void run();
  /// The runs left to do and the time that they will take, from short trials; writes nothing.
  std::string forecast() {
    return forecast(collect_jobs(), [](const RunRecord&) {});
  }
  /// Sets the largest number of runs that may be added, for the forecast.
  void expect_at_most(std::uint64_t runs) { most_runs_ = runs; }
  void write_tables() const;
  /// Writes a page next to the tables, under the study's name.
  void write_page(const std::string& html) const;

  const std::string& file() const { return spec_.file; }
  const std::string& name() const { return name_; }  ///< of the files
  const std::vector<Point>& points() const { return points_; }
  StudyCounts counts() const;
  bool interrupted() const { return executor_.interrupted(); }

  io::Table<double> point_table() const;
  io::Table<double> run_table() const;
 private:
  /// Locks the folder at the first run of a study, so that no other process writes into it.
  void take_folder();
  std::vector<std::filesystem::path> table_places() const;
  std::vector<Job> collect_jobs();
  void put(const RunRecord& record);
  void tick();
  /// @param done  called with the records of completed trials
  std::string forecast(const std::vector<Job>& jobs, const RecordFunction& done);
  std::string time_left(double spent) const;
  io::Table<double> log_table() const;
  std::filesystem::path record_file(const std::string& digest) const;
  std::vector<std::string> keys() const;
  /// The quantities in the tables' columns, for the vessel with the most walls.
  std::vector<Quantity> quantities() const;

  casefile::StudySpec spec_;
  std::filesystem::path folder_;
  std::optional<io::FolderLock> lock_;
  std::string name_;
  Executor& executor_;
  bool shows_;
  Progress progress_;
  io::ProgressLine line_;
  std::vector<Point> points_;
  std::multimap<std::string, Run*> waiting_;  ///< by digest: points can share a case
  std::vector<std::pair<std::string, double>> log_;
  std::size_t kept_ = 0, ran_ = 0;
  std::uint64_t most_runs_ = 0;
  Forecast forecast_;
  std::chrono::steady_clock::time_point next_write_{}, began_{}, told_{};
};

}  // namespace edmill::study
