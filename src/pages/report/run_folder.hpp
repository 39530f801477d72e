// The folder of `edmill run`, as the report reads it.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "casefile/case_spec.hpp"
#include "report/run_facts.hpp"

namespace edmill::report {

/// summary.json and case.toml of a run, and the tables of the case.
struct RunFolder {
  std::filesystem::path place;
  RunFacts facts;
  casefile::CaseSpec spec;  ///< with the outputs of the report if the run had them
  model::Partners partners;

  using Fits = std::function<bool(const casefile::OutputSpec&)>;
  /// An output of a type, of which `fits` holds, that is CSV (or X3D), not appended to others, and
  /// whose file exists and is not empty; null when there is none. The last such output of the case.
  const casefile::OutputSpec* output(std::string_view type, const Fits& fits) const;
  std::filesystem::path file_of(const casefile::OutputSpec& output) const;
};

/// @throws InputError when a file is missing or wrong
RunFolder read_run_folder(const std::filesystem::path& place);

/// Adds the outputs of the report to a case; their files are in the folder `report`.
void add_report_outputs(casefile::CaseSpec& spec);

}  // namespace edmill::report
