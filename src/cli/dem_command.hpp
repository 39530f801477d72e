// The commands for DEM codes, and audits and comparisons of contacts that last.
#pragma once

#include <string>
#include <vector>

#include "casefile/case_spec.hpp"
#include "dem/contact_audit.hpp"
#include "dem/deck.hpp"
#include "dem/import_dump.hpp"

namespace edmill::cli {

struct ExportOptions : dem::DeckOptions {
  std::string folder = ".";
  bool quiet = false;
};
int run_export(const casefile::CaseSpec& spec, const ExportOptions& options);

struct ImportOptions : dem::ImportOptions {
  std::string out;    ///< the log of contacts
  std::string frame;  ///< "vessel" or "laboratory"
  bool quiet = false;
};
int run_import(const casefile::CaseSpec& spec, ImportOptions options);

/// Results by name; none where a name is empty.
struct ResultFiles {
  std::string json, junit;
};

int run_contact_audit(const casefile::CaseSpec& spec, const dem::ContactAuditOptions& options,
                      const ResultFiles& files, bool quiet);
int run_contact_comparison(const std::string& a, const std::string& b, double from, double until,
                           const ResultFiles& files, bool quiet);

struct LimitOptions {
  std::vector<std::string> logs;
  std::string run, json, svg;
  double from = 0;
  bool quiet = false;
};
int run_limit(const LimitOptions& options);

}  // namespace edmill::cli
