// Files that vary a case: sweeps and optimisations, as they are written.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace edmill::casefile {

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
  std::uint64_t runs_max = 0;        ///< the budget
  std::uint64_t replicas_first = 3;  ///< of every point
  std::uint64_t replicas_max = 24;   ///< of any point
  std::uint64_t points = 0;          ///< of the first grid along each variable
  std::uint64_t refinements = 2;
  std::vector<OptimizeVariable> variables;
};

/// @throws InputError with every problem of the file: file, line, key, found, expected
SweepSpec read_sweep(const std::string& path);
OptimizeSpec read_optimize(const std::string& path);

}  // namespace edmill::casefile
