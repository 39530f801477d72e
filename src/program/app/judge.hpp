// Judges logs by another log, or by the physics of a case, with a search for causes.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "casefile/case_spec.hpp"
#include "compare/comparison.hpp"
#include "identify/identify.hpp"

namespace edmill::dem {
struct Limit;
}  // namespace edmill::dem

namespace edmill::app {

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
