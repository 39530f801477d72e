// Building blocks of pages: their frame, the parts of a report, and elements that these share.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "casefile/case_spec.hpp"
#include "io/facts.hpp"
#include "model/parts/partners.hpp"
#include "plot/chart.hpp"

namespace edmill::report {

using plot::add, plot::brief, plot::readable;

/// A rate of a run, or of several.
struct RateOf {
  double value;
  std::optional<double> half_width;  ///< of the 95 % interval

  RateOf in_units_of(double unit) const {
    return {value / unit, half_width ? std::optional(*half_width / unit) : std::nullopt};
  }
};

/// A rate of a summary with its interval; nothing if the summary does not have it.
std::optional<RateOf> rate_in(const io::Facts& summary, const std::string& path);

/// A table of an output, as numbers.
struct OutputTable {
  std::string file;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> texts;  ///< of each row, the first columns
  std::vector<std::vector<double>>
      numbers;          ///< of each row, the other columns; nan where it is empty
  double duration = 0;  ///< of the record, where the table says so [s]

  /// Index in `numbers` of the column whose name begins with this text ("total energy").
  /// @throws InputError when there is none
  std::size_t column(std::string_view name) const;
  /// Rows with this first text.
  std::vector<std::vector<double>> rows_of(std::string_view text) const;
};

/// summary.json and case.toml of a run, and the tables of the case.
struct RunFolder {
  std::filesystem::path place;
  io::Facts facts;          ///< of summary.json
  casefile::CaseSpec spec;  ///< with the outputs of the report if the run had them
  model::Partners partners;
  std::string name = {};  ///< among runs that are compared

  using Fits = std::function<bool(const casefile::OutputSpec&)>;
  /// The last output of the case that has this type, satisfies `fits`, is CSV (or X3D), is not
  /// appended to others, and whose file exists and is not empty; null if there is none.
  const casefile::OutputSpec* output(std::string_view type, const Fits& fits) const;
  /// The table of such an output, whose first columns, `texts` of them, are text; by default of all
  /// impacts.
  /// @param expected  "a table of trends", for messages
  /// @throws InputError when it is no such table
  std::optional<OutputTable> table(
      std::string_view type, const std::string& expected, std::size_t texts = 0,
      const Fits& fits = [](const auto& o) { return o.only.empty(); }) const;
  std::filesystem::path file_of(const casefile::OutputSpec& o) const {
    return place / o.folder / o.file;
  }
};

/// @throws InputError when a file is missing or wrong
RunFolder read_run_folder(const std::filesystem::path& place);

/// @param expected  "a table of trends", for messages
/// @param texts     how many columns of text there are before the numbers
/// @throws InputError when it is no such table
OutputTable read_table(
    const std::filesystem::path& file, const std::string& expected, std::size_t texts = 0);

/// An interval of time with the mean of a rate over it.
struct Interval {
  double begin, end, rate;  ///< [s], [s], [unit/s]
};
/// Successive intervals.
using Series = std::vector<Interval>;

/// A column of a table whose rows are of intervals that follow each other.
/// @param start  of the run [s]: the first interval begins there unless the table begins later
Series intervals_of(
    const casefile::OutputSpec& output, const OutputTable& table, std::size_t column, double start);
/// The column of a variable's rate in a table of trends; nothing where it has none.
std::optional<std::size_t> place_of_rate(const casefile::OutputSpec& output, int variable);

/// Intervals merged so that there are at most `most` of them; the last can be shorter.
Series coarser(const Series& series, std::size_t most);

/// Points of a line through the midpoints of the intervals.
plot::Points points_of(const Series& series);

/// Rate of a variable of all impacts, or with one partner, in at most `most` intervals, if a table
/// has it.
std::optional<Series> rate_of(
    const RunFolder& run, const char* variable, std::size_t most, int partner = -1);

/// Contents of a page, whose frame adds head, title, style, the terms of its sections and foot.
struct Page {
  std::string title, subtitle;
  std::string version, commit;  ///< of the program that made what the page shows
  const pugi::xml_document& main;
  std::string scripts = {};  ///< whole <script> elements
};

std::string page_of(const Page& page);

// The parts of a report. Each adds a <section>, or one line that names the missing output.
void add_animation(pugi::xml_node main, const RunFolder& run);
void add_rates(pugi::xml_node main, const RunFolder& run);
void add_spectra(pugi::xml_node main, const RunFolder& run);
void add_vessel(pugi::xml_node main, const RunFolder& run);
/// How often powder has been hit, where the case has such an output.
void add_treatment(pugi::xml_node main, const RunFolder& run);
/// How fast neighbouring motions diverge from the run's, where the case has such an output.
void add_exponents(pugi::xml_node main, const RunFolder& run);
void add_ball_speeds(pugi::xml_node main, const RunFolder& run);

using Rows = std::vector<std::vector<std::string>>;

/// Balls, powder, vessel, mill and contacts in words: name and text.
Rows case_rows(const RunFolder& run);
/// Dose by energy and impacts by speed of several runs over each other, where they have tables.
void add_spectra_of(pugi::xml_node main, const std::vector<RunFolder>& runs);
/// The colour of one of several runs in charts.
std::string run_colour(std::size_t place);

/// The label of a wall or a partner with the signs of typesetting: "cap −y", "ball–ball".
std::string typeset(const std::string& label);
/// The colour of a partner in charts, by its index; that of balls is the same for all vessels.
std::string partner_colour(const model::Partners& partners, int place);

struct MainRate {
  std::string name, unit;
  std::optional<RateOf> rate;  ///< nothing where the run lacks what it needs
};
/// The rates by which mills are compared, in the same order for every run.
std::vector<MainRate> main_rates(const io::Facts& summary);
/// "27.92 ± 0.23"
std::string text_of(const RateOf& rate);
/// "0.5 s to 10 s": of the statistics.
std::string time_window(const io::Facts& summary);
/// "Milling dose rate"
std::string capitalised(std::string text);
/// A histogram of bars that are equally wide, from `first` on.
plot::Curve bars(const std::string& name, const std::string& colour, double first, double width,
    const std::vector<double>& heights);
/// A line at the rate from `left` to `right`, within its interval.
void add_level(plot::Chart& chart, double left, double right, const RateOf& rate,
    const std::string& name, const std::string& colour);

pugi::xml_node add_section(pugi::xml_node main, const std::string& id, const std::string& heading);
/// A remark on what a section shows.
void add_note(pugi::xml_node section, const std::string& text);
/// "No ball speeds: add [[output]] type = ..."
void add_missing(pugi::xml_node section, const std::string& what, const std::string& output);

/// A table under a heading with this id; the first cell of each row is its heading.
void add_table(pugi::xml_node section, const std::string& id, const std::string& caption,
    const std::vector<std::string>& headings, const Rows& rows);

/// A chart over the time of the run; the start of statistics is marked unless it is the beginning.
plot::Chart over_time(const RunFolder& run, const std::string& id, const std::string& title,
    const std::string& y_title);
/// Draws a chart with a y axis from 0, or below a negative value, to a little above the highest.
void draw_fitted(pugi::xml_node grid, plot::Chart chart);

}  // namespace edmill::report
