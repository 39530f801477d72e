// A point of a study: the settings of a case and its runs.
#pragma once

#include <string>
#include <vector>

#include "base/statistics.hpp"
#include "casefile/study_spec.hpp"
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
  /// A quantity of all runs that are done, in the order of their seeds; empty when one of them lacks it.
  std::vector<double> values(const Quantity& quantity) const;
};

/// Points of a sweep: the entries times the grid, whose last key changes fastest.
std::vector<Point> points_of(const casefile::SweepSpec& spec);

/// The run of a point with a seed. A case that is invalid at this point gives a record without a run.
Run make_run(const casefile::StudySpec& spec, const Point& point, std::uint64_t seed);

}  // namespace edmill::study
