// Building blocks of pages: their frame, the parts of a report, and elements that these share.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plot/chart.hpp"
#include "plot/ticks.hpp"
#include "report/run_folder.hpp"

namespace edmill::report {

using plot::add, plot::brief, plot::readable;

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
