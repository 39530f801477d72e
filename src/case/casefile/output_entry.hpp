// How an entry [[output]] is read, and the keys that several types of output have. What is special to a type
// is where that output is: output/registry.hpp
#pragma once

#include <span>
#include <string_view>

#include "casefile/key_reader.hpp"

namespace edmill::casefile {

/// What a reader needs to know of one key of an output.
struct KeyText {
  std::string_view name;
  std::string_view kind;      ///< "time", "count", "list of texts"
  std::string_view fallback;  ///< as in a file, "required", or what holds without the key
  std::string_view meaning;
};

inline constexpr KeyText columns_key{"columns", "list of tables", "required", "what the table contains"};
inline constexpr KeyText column_keys[] = {columns_key};
inline constexpr KeyText interval_of_30_s{"interval", "time", "`\"30 s\"`", "length of an interval"};
inline constexpr KeyText interval_of_10_ms{"interval", "time", "`\"10 ms\"`", "length of an interval"};
inline constexpr KeyText interval_if_given{"interval", "time", "each impact", "length of an interval"};
inline constexpr KeyText max_rows_key{"max_rows", "count", "32000", "the record ends after this many rows"};
inline constexpr KeyText contact_point_key{"contact_point", "table", "none",
                                           "a sphere where the bodies touch"};

/// What a type of output allows in its columns.
struct ColumnRules {
  bool flags, counts, numbers;
  std::vector<Statistic> of_flags, of_numbers;  ///< none: the type shows single values
};

/// Reads `columns`, each with a variable of an impact.
void read_columns(Section& s, const ColumnRules& rules, OutputSpec& output);

/// Reads `variable`; place in impact_variables, or nothing when it is wrong, which is reported.
std::optional<int> read_variable(Section& s, bool flags, bool counts, bool numbers);

std::vector<Statistic> read_statistics(Section& s, const std::vector<Statistic>& allowed);

/// Reads `interval` and `max_rows`.
void read_interval(Section& s, TimerSpec& timer, const std::optional<Quantity>& fallback = std::nullopt);

/// The size of a table: at least 1 and not beyond reason.
inline constexpr Range table_size{1, 1000};

void read_contact_point(Section& s, OutputSpec& output);

/// The dimension in which a unit of the variables is given in a case.
Dimension dimension_of(std::string_view unit);

/// "a, b, c", for messages.
std::string listed(const std::vector<std::string>& names);

/// Reads the keys that an entry of one type has beyond those of every entry.
using ReadOutputKeys = void(Section& entry, const CaseSpec& spec, OutputSpec& output);

struct OutputType {
  std::string_view name;       ///< `type` in a case
  std::string_view extension;  ///< of its file unless the entry names one; ".csv" for tables
  std::string_view what;       ///< it writes, for readers
  ReadOutputKeys* read;
  std::span<const KeyText> keys = {};        ///< that `read` looks up
  void (*see)(const SeeKey& see) = nullptr;  ///< shows those of a struct that lists them
};

/// Of outputs without keys of their own.
inline void read_no_keys(Section&, const CaseSpec&, OutputSpec&) {}
/// Reads keys that a struct lists, into OutputSpec::own.
template <class Keys>
void read_own(Section& entry, const CaseSpec&, OutputSpec& output) {
  Keys keys;
  read_keys(entry, keys);
  output.own = keys;
}

/// Every type of output. The registry of the outputs defines it, and makes outputs from the same rows.
std::span<const OutputType> output_types();

/// Reads one entry and adds it to the case.
void read_output(Section entry, CaseSpec& spec);

}  // namespace edmill::casefile
