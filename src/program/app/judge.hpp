// Checks cases as a run would, with derived numbers in SI, and logs by docs/log-format.md; judges
// logs by another log, or by the physics of a case, with a search for causes.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "casefile/case_spec.hpp"
#include "compare/comparison.hpp"
#include "identify/identify.hpp"

namespace edmill::dem {
struct Limit;
}  // namespace edmill::dem

namespace edmill::app {

struct CheckedCase {
  std::string file;
  /// Names and values; an empty name continues the entry before.
  std::vector<std::pair<std::string, std::string>> facts;

  std::string text() const;
};

/// @throws InputError when its balls do not fit, UndecidedError when no scalar decides a contact
CheckedCase check(const casefile::CaseSpec& spec);

/// An SVG of how the vessel moves. @throws InputError when the file cannot be written
void draw_mill(const casefile::CaseSpec& spec, const std::filesystem::path& file);

/// The description of a log; its JSON is the header of docs/log-format.schema.json.
struct LogDescription {
  struct Column {
    std::string name, unit;
  };
  std::string kind;                  ///< "impacts", or "contacts" that last
  std::vector<Column> columns;       ///< those of the format, in the order of the file
  std::vector<std::string> skipped;  ///< other columns
  std::uint64_t rows = 0;
  std::optional<double> first, last;  ///< times [s]
  int balls = 0, walls = 0;           ///< up to the highest number that occurs

  std::string text() const;
  std::string json() const;
};

/// True if the first line that is no comment is the header of a CSV file, and not of a case.
bool is_log(const std::string& file);

/// @throws InputError with the problems of the header, or the first ten of the rows
LogDescription describe_log(const std::string& file);

struct Judged {
  compare::Verdict verdict;
  std::string json, junit, table;
};

/// Compares two logs, or only their dose rates if one is a log of contacts. @throws InputError
Judged compare(const compare::ComparisonOptions& options);

/// Options of an audit, which override the case's section [audit].
struct AuditOptions {
  std::string log;                   ///< of collisions, or of contacts that last
  std::vector<std::string> columns;  ///< "ours=theirs [unit]"
  std::optional<double> tolerance, gap_tolerance;
  std::optional<int> first_ball;
  std::string walls;
  bool from_start = false;
  bool identify = false;                     ///< search beyond single causes
  std::optional<std::size_t> examples = {};  ///< of each kind of violation; 3 by default
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double time, std::uint64_t events)> progress{};
  identify::Progress searching{};  ///< called at each stage of a search for the cause
};

/// @throws InputError
Judged audit(const casefile::CaseSpec& spec, const AuditOptions& options);

/// Tables of the keys of all documents of verdicts, for docs/reference.md.
std::string document_keys();

/// The points of a limit, the line through them and edmill's value, as SVG.
std::string limit_drawing(const dem::Limit& limit);

}  // namespace edmill::app
