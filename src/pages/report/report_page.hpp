// Presentation of runs: self-contained HTML pages of a run, of several side by side and of a study;
// a table for the terminal; a drawing of the mill.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "casefile/case_spec.hpp"
#include "io/summary.hpp"
#include "model/parts/partners.hpp"

namespace edmill::study {
class Study;
}  // namespace edmill::study

namespace edmill::report {

/// File in the folder of a run with a text on what decides its dose rate; the page shows it.
inline constexpr const char* check_file = "check.txt";

/// Adds the outputs of the report to a case; their files are in the folder `report`.
void add_report_outputs(casefile::CaseSpec& spec);

/// Writes report.html into the folder of a run.
/// @return its place
/// @throws InputError when the folder has no complete run or is in use, or a table is wrong
std::filesystem::path write_report(const std::filesystem::path& folder);
/// Writes the page as `write_report` does. @pre the caller holds the folder's lock
std::filesystem::path put_report(const std::filesystem::path& folder);

/// Writes one page that shows runs side by side. @param folders  two or more
/// @throws InputError when a folder is no run, or the file cannot be written
void write_comparison(const std::vector<std::string>& folders, const std::filesystem::path& file);

/// The page of a sweep or an optimisation: rates of all points with their intervals.
/// @param kind     "Sweep"
/// @param finding  lines of text, such as what an optimisation found; none when empty
std::string study_page(
    const study::Study& study, const std::string& kind, const std::string& finding);

/// The results of a run on the terminal.
std::string result_table(const io::Facts& summary, const model::Partners& partners);

/// An SVG with three views of a mill's motion, along z, x and y: the vessel at time 0 and at three
/// later quarters of a period of the clock, the paths of its centre and of one of its points, and a
/// chain's joints at time 0, by number from the ground: dashed axes of rotations, arms of
/// translations.
std::string mill_drawing(const model::Mill<double>& mill);

}  // namespace edmill::report
