// Reads entries [[output]]: the keys of several types; output/registry.hpp has those of one type.
#pragma once

#include <span>
#include <string_view>

#include "casefile/keys.hpp"

namespace edmill::casefile {

/// The variables that a type of output has in its columns.
struct ColumnRules {
  bool of_balls = false, flags = false, counts = false, numbers = false;
  std::vector<Statistic> of_flags{}, of_numbers{};  ///< empty if the type shows single values
};

/// An entry of `columns`. Which keys it has depends on the type of output.
struct ColumnTable : ColumnSpec {
  ColumnRules rules;
  std::string name;
  std::optional<std::vector<std::string>> wanted;  ///< statistics

  static constexpr const char* what = "A list of tables, one for each column.";
  static void keys(auto& c, auto&& row) {
    const bool single = c.rules.of_numbers.empty();
    row(described_key(
            "variable", "name", "required", "a variable; for `trends_balls` a quantity of a ball"),
        c.name);
    if (!single)
      row(described_key("statistics", "list of names", "required",
              "`sum`, `average`, `minimum`, `maximum`, `rate` (per second), `percentage` (of the "
              "total's sum); for flags only `sum`, `rate` and `percentage`; not for "
              "`trends_instant`"),
          c.wanted);
    row(Parameter{"label", "name of the column in the header"}.usually("the variable's name"),
        c.label);
    if (single && (c.name.empty() || is_flag(c.name))) {
      row(Parameter{"true_text", "text for a flag that is true", Range::any, "1", "`\"1\"`"}
              .only_of("trends_instant"),
          c.true_text);
      row(Parameter{"false_text", "text for a flag that is false", Range::any, "0", "`\"0\"`"}
              .only_of("trends_instant"),
          c.false_text);
    }
    if (c.rules.of_balls)
      row(Parameter{"with_ball", "add which ball has the minimum or maximum", Range::any, "false"}
              .only_of("trends_balls"),
          c.with_ball);
  }
  static bool is_flag(const std::string& variable);
};

/// Reads `columns` for a type of output.
struct ColumnReader {
  ColumnRules rules;
  std::vector<ColumnSpec>& columns;
  ColumnTable like{{}, rules, {}, {}};

  void read_from(Section& output, const char* key);
};

inline constexpr Parameter columns_key =
    Parameter{"columns", "columns of the table"}.as("list of tables").usually("required");
constexpr Parameter interval_key(const char* fallback) {
  return {"interval", Dimension::time, "length of an interval", Range::positive, fallback};
}
constexpr Parameter max_rows_key(const char* fallback = nullptr) {
  return {
      "max_rows", Dimension::none, "the record ends after this many rows", Range::count, fallback};
}
inline constexpr Parameter contact_point_key{
    "contact_point", Dimension::none, "mark the point where the bodies touch by a sphere"};

/// Index in impact_variables of a name; nothing for an unknown or excluded one, which is reported.
std::optional<int> variable_of(Section& s, const std::string& name, const ColumnRules& rules);

/// Range of the size of a table.
inline constexpr Range table_size{1, 1000};

/// Dimension of a unit of the variables.
Dimension dimension_of(std::string_view unit);

/// "a, b, c", for messages.
std::string listed(const std::vector<std::string>& names);

/// The keys that one type of output has beyond those of every entry.
struct OutputKeys {
  void (*read)(Section& entry, const CaseSpec& spec, OutputSpec& output);
  void (*list)(const KeyLister& lister);
};

struct OutputType {
  std::string_view name;       ///< `type` in a case
  std::string_view extension;  ///< of its file unless the entry names one; ".csv" for tables
  std::string_view what;       ///< it writes, for readers
  OutputKeys keys;
};

/// The keys that `Keys::keys(output, row)` lists, and conditions that `Keys::check` may check.
template <class Keys>
inline constexpr OutputKeys output_keys{
    [](Section& entry, const CaseSpec& spec, OutputSpec& output) {
      Keys::keys(output, KeyReader(entry));
      if constexpr (requires { Keys::check(entry, spec, output); })
        Keys::check(entry, spec, output);
    },
    [](const KeyLister& lister) {
      OutputSpec output;
      Keys::keys(output, lister);
    }};
/// The keys of a struct that is stored in OutputSpec::own.
template <Keyed Keys> struct OwnKeys {
  static void keys(auto& output, auto&& row) { Keys::keys(output.template make_own<Keys>(), row); }
};
struct NoKeys {
  static void keys(auto&, auto&&) {}
};

/// Every type of output, defined by the registry, which makes outputs from the same rows.
std::span<const OutputType> output_types();

/// Reads one entry and adds it to the case.
void read_output(Section& entry, CaseSpec& spec);

}  // namespace edmill::casefile
