// Files that vary a case: sweeps and optimisations, as they are written.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "model/parts/parameter.hpp"

namespace edmill::casefile {

using model::Parameter;
using model::Range;

inline constexpr int most_runs = 1000000;

/// A key of the case and its value as `--set` would take it.
using Setting = std::pair<std::string, std::string>;

/// A key that is no key of the case: it sets balls.0.count from the masses of powder and ball.
inline constexpr const char* charge_ratio_key = "charge_ratio";

/// What sweeps and optimisations have in common.
struct StudySpec {
  std::string file;       ///< path of the file itself
  std::string case_file;  ///< path of the case that is varied
  std::string precision;  ///< of all runs; empty for the case's own
  std::uint64_t seed = 1;
  /// Largest processor time of a run [s]; a longer run ends without a result.
  double max_cpu_time = std::numeric_limits<double>::infinity();

  static void study_keys(auto& s, auto&& row) {
    row(Parameter{"seed", Dimension::none, "the first of the seeds", {0, 999999999999}, "1"}, s.seed);
  }
};

struct SweepSpec : StudySpec {
  struct Entry {
    std::string name;
    std::vector<Setting> set;
  };
  struct Axis {
    std::string key;
    std::vector<std::string> values;
  };
  std::uint64_t replicas = 1;
  std::vector<Axis> grid;      ///< in the order of the file
  std::vector<Entry> entries;  ///< [[sweep.point]]

  static void keys(auto& s, auto&& row) {
    study_keys(s, row);
    row(Parameter{"replicas", Dimension::none, "runs of each point, with successive seeds",
                  Range(1, most_runs), "1"},
        s.replicas);
  }
};

struct OptimizeVariable {
  std::string key;
  std::vector<std::string> values;  ///< when given, all that the variable can be
  double low = 0, high = 0;         ///< in `unit`
  std::string unit;
  bool integer = false;
};

struct OptimizeSpec : StudySpec {
  std::string objective;
  std::uint64_t runs_max = 0, replicas_first = 3, replicas_max = 24, points = 5, refinements = 2;
  std::vector<OptimizeVariable> variables;

  static void keys(auto& o, auto&& row) {
    using enum Dimension;
    study_keys(o, row);
    row(Parameter{"runs_max", none, "the whole budget", {1, most_runs}}, o.runs_max);
    row(Parameter{"replicas_first", none, "runs of every point", {2, 1000}, "3"}, o.replicas_first);
    row(Parameter{"replicas_max", none, "runs of a point that may be the best", {2, 1000}, "24"},
        o.replicas_max);
    row(Parameter{"points", none, "of the first grid along each variable", {2, 100}, "5"}, o.points);
    row(Parameter{"refinements", none, "finer grids around the best point", {0, 20}, "2"}, o.refinements);
  }
};

/// @throws InputError with every problem of the file: file, line, key, found, expected
SweepSpec read_sweep(const std::string& path);
OptimizeSpec read_optimize(const std::string& path);

}  // namespace edmill::casefile
