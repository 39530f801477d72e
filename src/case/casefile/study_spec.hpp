// Contents of the files that vary a case: sweeps and optimisations.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "casefile/output_spec.hpp"

namespace edmill::casefile {

inline constexpr int most_runs = 1000000;

/// A key of the case and its value as `--set` would take it.
struct Setting : std::pair<std::string, std::string> {
  using pair::pair;
  static constexpr const char* what = "A table.";
  static constexpr Parameter entry = described_key("*", "value", "", "value of a key of the case");
  static std::optional<Setting> read(Section& section, const std::string& key);
};

/// A key of studies only: it sets balls.0.count from the masses of powder and ball.
inline constexpr const char* charge_ratio_key = "charge_ratio";

/// Keys that sweeps and optimisations have in common.
struct StudySpec {
  std::string file;       ///< path of the file itself
  std::string case_file;  ///< path of the case that is varied
  std::string precision;  ///< of all runs; empty for the case's own
  std::uint64_t seed = 1;
  std::optional<Quantity> cpu_limit;
  /// Largest processor time of a run [s]; a longer run ends without a result.
  double max_cpu_time() const {
    return cpu_limit ? cpu_limit->to<double>() : std::numeric_limits<double>::infinity();
  }

  static constexpr Parameter seed_key{
      "seed", Dimension::none, "first seed", {0, 999999999999}, "1"};
  /// @param relative  "case file, relative to the sweep file"
  static void shared_keys(auto& s, auto&& row, const char* relative) {
    row(Parameter{"case", relative}.as("file").usually("required"), s.case_file);
    row(described_key("precision", "name of a scalar", "that of the case", "scalar of all runs"),
        s.precision);
    row({"max_cpu_time", Dimension::time, "processor time after which a run ends without a result",
            Range::positive},
        s.cpu_limit);
  }
};

/// A key and the values that it has in a grid.
struct GridAxis {
  std::string key;
  std::vector<std::string> values;
  static constexpr const char* what = "Values of keys.";
  static constexpr Parameter entry = described_key("*", "list of values", "",
      "values of a key of the case, named as in `--set`, or of `charge_ratio`");
  static std::optional<GridAxis> read(Section& grid, const std::string& key);
};

/// An entry [[sweep.point]].
struct SweepPoint {
  std::string name;
  Named<Setting> set;  ///< the lists of balls first
  AnyValue balls, ball;

  static constexpr const char* what = "Single points.";
  static void keys(auto& p, auto&& row) {
    row(Parameter{"name", "name of the point in the tables"}.usually("none"), p.name);
    row(Parameter{"set", "keys of the case with their values"}.usually("this or a list"), p.set);
    row(described_key("balls", "tables", "those of the case",
            "the whole list of batches, entries `[[sweep.point.balls]]`"),
        p.balls);
    row(described_key("ball", "tables", "those of the case",
            "the whole list of single balls, entries `[[sweep.point.ball]]`"),
        p.ball);
  }
  static void check(Section& entry, std::vector<SweepPoint>& points);
};

struct SweepSpec : StudySpec {
  std::uint64_t replicas = 1;
  Named<GridAxis> grid;  ///< in the order of the file
  std::vector<SweepPoint> entries;

  static constexpr const char* what = "Settings of a sweep.";
  static void keys(auto& s, auto&& row) {
    row(seed_key, s.seed);
    row({"replicas", "number of runs of each point, with successive seeds", Range(1, most_runs),
            "1"},
        s.replicas);
    shared_keys(s, row, "case file, relative to the sweep file");
    row({"grid", "every combination of the values, `[sweep.grid]`"}, s.grid);
    row({"point", "single points, each with all of the grid, entries `[[sweep.point]]`"},
        s.entries);
  }
};

/// An entry [[optimize.variable]].
struct OptimizeVariable {
  std::string key;
  std::vector<std::string> values;  ///< the allowed values, if they are listed
  AnyValue least, most;             ///< as they are written
  double low = 0, high = 0;         ///< in `unit`
  std::string unit;
  bool integer = false;

  static constexpr const char* what = "A variable of the search.";
  static void keys(auto& v, auto&& row) {
    row(Parameter{"key", "a key of the case, or `charge_ratio`"}.usually("required"), v.key);
    row(Parameter{"low", "lower bound"}.as("value").usually("required without `values`"), v.least);
    row(Parameter{"high", "upper bound"}.as("value").usually("required without `values`"), v.most);
    row({"integer", "whole numbers only", Range::any, "false"}, v.integer);
    row(described_key("values", "list of values", "none", "the only values, in place of bounds"),
        v.values);
  }
  static void check(Section& entry, std::vector<OptimizeVariable>& variables);
};

enum class Objective { specific_milling_dose_rate, milling_dose_rate };
inline constexpr std::array<std::string_view, 2> choices_of(Objective) {
  return {"specific_milling_dose_rate", "milling_dose_rate"};
}

struct OptimizeSpec : StudySpec {
  Objective wanted{};
  std::string objective() const {
    return std::string(choices_of(wanted)[static_cast<std::size_t>(wanted)]);
  }
  std::uint64_t runs_max = 0, replicas_first = 3, replicas_max = 24, points = 5, refinements = 2;
  std::vector<OptimizeVariable> variables;

  static constexpr const char* what = "Settings of an optimisation.";
  static void keys(auto& o, auto&& row) {
    row(seed_key, o.seed);
    row({"runs_max", "largest number of runs of the whole search", {1, most_runs}}, o.runs_max);
    row({"replicas_first", "number of runs of every point", {2, 1000}, "3"}, o.replicas_first);
    row({"replicas_max", "largest number of runs of a point that may be the best", {2, 1000}, "24"},
        o.replicas_max);
    row({"points", "number of points of the first grid along each variable", {2, 100}, "5"},
        o.points);
    row({"refinements", "number of finer grids around the best point", {0, 20}, "2"},
        o.refinements);
    shared_keys(o, row, "case file, relative to the optimisation file");
    row(described_key("objective", "name", "`\"specific_milling_dose_rate\"`",
            "quantity to maximise: this or `milling_dose_rate`"),
        o.wanted);
    row({"variable", "variables of the search, one to three entries `[[optimize.variable]]`",
            Range::any, nullptr, "required"},
        o.variables);
  }
};

/// @throws InputError with every problem of the file: file, line, key, found, expected
SweepSpec read_sweep(const std::string& path);
OptimizeSpec read_optimize(const std::string& path);

}  // namespace edmill::casefile
