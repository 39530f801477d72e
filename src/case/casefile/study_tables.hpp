// The sections of files that vary a case, before they are checked.
#pragma once

#include "casefile/key_reader.hpp"
#include "casefile/study_spec.hpp"

namespace edmill::casefile {

inline constexpr Parameter study_seed_key{
    "seed", Dimension::none, "the first of the seeds", {0, 999999999999}, "1"};
/// @param relative  "relative to the sweep file"
inline void shared_keys(auto& s, auto&& row, const char* relative) {
  using enum Dimension;
  row(Parameter{"case", relative}.as("file").usually("required"), s.case_file);
  row(Parameter{"precision", "of all runs"}.as("name of a scalar").usually("that of the case"), s.precision);
  row({"max_cpu_time", time, "of processor time, after which a run ends without a result", Range::positive},
      s.cpu_limit);
}

struct PointTable {
  std::string name;
  Inner<Named<Setting>> set;
  AnyValue balls, ball;

  static constexpr const char* what = "Single points.";
  static void keys(auto& p, auto&& row) {
    using enum Dimension;
    row(Parameter{"name", "of the point in the tables"}.usually("none"), p.name);
    row(Parameter{"set", "keys of the case with their values"}.usually("this or a list"), p.set);
    row(Parameter{"balls", "whole list, entries `[[sweep.point.balls]]`"}.as("tables").usually(
            "those of the case"),
        p.balls);
    row(Parameter{"ball", "whole list, entries `[[sweep.point.ball]]`"}.as("tables").usually(
            "those of the case"),
        p.ball);
  }
};

struct SweepTable : SweepSpec {
  Inner<Named<GridAxis>> grid_table;
  Entries<PointTable> points;

  static constexpr const char* what = "Of a sweep file.";
  static void keys(auto& s, auto&& row) {
    row(study_seed_key, s.seed);
    row({"replicas", "runs of each point, with successive seeds", Range(1, most_runs), "1"}, s.replicas);
    shared_keys(s, row, "relative to the sweep file");
    row({"grid", "every combination of the values, `[sweep.grid]`"}, s.grid_table);
    row({"point", "single points, each with all of the grid, entries `[[sweep.point]]`"}, s.points);
  }
};

struct VariableTable {
  std::string key;
  AnyValue low, high;
  bool integer = false;
  std::optional<std::vector<std::string>> values;

  static constexpr const char* what = "What is varied.";
  static void keys(auto& v, auto&& row) {
    using enum Dimension;
    row(Parameter{"key", "a key of the case, or `charge_ratio`"}.usually("required"), v.key);
    row(Parameter{"low", "lower bound"}.as("value").usually("required without `values`"), v.low);
    row(Parameter{"high", "upper bound"}.as("value").usually("required without `values`"), v.high);
    row({"integer", "whole numbers only", Range::any, "false"}, v.integer);
    row(Parameter{"values", "the only values, in place of bounds"}.as("list of values").usually("none"),
        v.values);
  }
};

struct OptimizeTable : OptimizeSpec {
  Entries<VariableTable> variable_tables;

  static constexpr const char* what = "Of an optimisation file.";
  static void keys(auto& o, auto&& row) {
    using enum Dimension;
    row(study_seed_key, o.seed);
    row({"runs_max", "the whole budget", {1, most_runs}}, o.runs_max);
    row({"replicas_first", "runs of every point", {2, 1000}, "3"}, o.replicas_first);
    row({"replicas_max", "runs of a point that may be the best", {2, 1000}, "24"}, o.replicas_max);
    row({"points", "of the first grid along each variable", {2, 100}, "5"}, o.points);
    row({"refinements", "finer grids around the best point", {0, 20}, "2"}, o.refinements);
    shared_keys(o, row, "relative to the optimisation file");
    row(Parameter{"objective", "this or `milling_dose_rate`"}.as("name").usually(
            "`\"specific_milling_dose_rate\"`"),
        o.wanted);
    row(Parameter{"variable", "one to three entries `[[optimize.variable]]`"}.usually("required"),
        o.variable_tables);
  }
};

/// The sections of files of studies, of which each has one.
struct StudyFile {
  Inner<SweepTable> sweep;
  Inner<OptimizeTable> optimize;

  static void keys(auto& f, auto&& row) {
    row({"sweep", ""}, f.sweep);
    row({"optimize", ""}, f.optimize);
  }
};

}  // namespace edmill::casefile
