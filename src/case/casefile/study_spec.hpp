// Files that vary a case: sweeps and optimisations, as they are written.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "casefile/quantity.hpp"
#include "model/parts/parameter.hpp"

namespace edmill::casefile {

class Section;

inline constexpr int most_runs = 1000000;

/// A key of the case and its value as `--set` would take it.
struct Setting : std::pair<std::string, std::string> {
  using pair::pair;
  static constexpr const char* what = "A table.";
  static constexpr model::Parameter entry =
      model::Parameter{"*", "the key is one of the case"}.as("value").usually("");
  static std::optional<Setting> read(Section& section, const std::string& key);
};

/// A key that is no key of the case: it sets balls.0.count from the masses of powder and ball.
inline constexpr const char* charge_ratio_key = "charge_ratio";

/// What sweeps and optimisations have in common.
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
};

/// A key and the values that it has in a grid.
struct GridAxis {
  std::string key;
  std::vector<std::string> values;
  static constexpr const char* what = "Values of keys.";
  static constexpr model::Parameter entry =
      model::Parameter{"*", "the key is one of the case, as `--set` takes it, or `charge_ratio`"}
          .as("list of values")
          .usually("");
  static std::optional<GridAxis> read(Section& grid, const std::string& key);
};

struct SweepSpec : StudySpec {
  struct Entry {
    std::string name;
    std::vector<Setting> set;
  };
  std::uint64_t replicas = 1;
  std::vector<GridAxis> grid;  ///< in the order of the file
  std::vector<Entry> entries;  ///< [[sweep.point]]
};

struct OptimizeVariable {
  std::string key;
  std::vector<std::string> values;  ///< when given, all that the variable can be
  double low = 0, high = 0;         ///< in `unit`
  std::string unit;
  bool integer = false;
};

enum class Objective { specific_milling_dose_rate, milling_dose_rate };
inline constexpr std::array<std::string_view, 2> choices_of(Objective) {
  return {"specific_milling_dose_rate", "milling_dose_rate"};
}

struct OptimizeSpec : StudySpec {
  Objective wanted{};
  std::string objective() const { return std::string(choices_of(wanted)[static_cast<std::size_t>(wanted)]); }
  std::uint64_t runs_max = 0, replicas_first = 3, replicas_max = 24, points = 5, refinements = 2;
  std::vector<OptimizeVariable> variables;
};

/// @throws InputError with every problem of the file: file, line, key, found, expected
SweepSpec read_sweep(const std::string& path);
OptimizeSpec read_optimize(const std::string& path);

}  // namespace edmill::casefile
