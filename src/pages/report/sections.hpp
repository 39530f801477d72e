// The parts of a report. Each adds a <section>, or one line that names the missing output.
#pragma once

#include "plot/chart.hpp"
#include "plot/markup.hpp"
#include "report/run_folder.hpp"
#include "report/series.hpp"
#include "report/ward.hpp"

namespace edmill::report {

void add_headline(pugi::xml_node main, const RunFolder& run);
void add_ward(pugi::xml_node main, const RunFolder& run);
void add_warnings(pugi::xml_node main, const RunFolder& run);
void add_animation(pugi::xml_node main, const RunFolder& run);
void add_rates(pugi::xml_node main, const RunFolder& run);
void add_spectra(pugi::xml_node main, const RunFolder& run);
void add_vessel(pugi::xml_node main, const RunFolder& run);
/// How often powder has been hit, where the case has such an output.
void add_treatment(pugi::xml_node main, const RunFolder& run);
/// How fast neighbouring motions diverge from the run's, where the case has such an output.
void add_exponents(pugi::xml_node main, const RunFolder& run);
void add_ball_speeds(pugi::xml_node main, const RunFolder& run);
void add_energy(pugi::xml_node main, const RunFolder& run);
void add_case(pugi::xml_node main, const RunFolder& run);

struct Animation;
/// Adds <script type="application/json" id="frames">, which page.js plays. Lengths in millimetres:
///   {duration, eye, target,
///    vessel: {radius, height, colour, opacity, poses: [x, y, z, qx, qy, qz, qw of each frame]},
///    spheres: {radii, colours, places: [x, y, z of each sphere, frame by frame]}}
/// Frames divide the playback into equal parts, from its beginning to its end.
void add_frames(pugi::xml_node parent, const Animation& animation);
/// Adds an <svg> of the first frame, seen along the Z axis.
void add_still(pugi::xml_node parent, const Animation& animation);

using Rows = std::vector<std::vector<std::string>>;

/// Balls, powder, vessel, mill and contacts in words: name and text.
Rows case_rows(const RunFolder& run);
/// Dose by energy and impacts by speed of several runs over each other, where they have such tables.
void add_spectra_of(pugi::xml_node main, const std::vector<RunFolder>& runs);
/// The colour of one of several runs in charts.
std::string run_colour(std::size_t place);

/// The label of a partner with the signs of typesetting: "cap −y", "ball–ball".
std::string name_of(const model::PartnerInfo& partner);
/// The colour of a partner in charts, by its place; balls have the same beside any walls.
std::string partner_colour(const model::Partners& partners, int place);

struct MainRate {
  std::string name, unit;
  std::optional<RateOf> rate;  ///< nothing where the run lacks what it needs
};
/// The rates by which mills are compared, of any run in the same order.
std::vector<MainRate> main_rates(const RunFacts& facts);
/// "27.92 ± 0.23"
std::string text_of(const RateOf& rate);
/// "Milling dose rate"
std::string capitalised(std::string text);
/// A histogram of bars that are equally wide, from `first` on.
plot::Curve bars(const std::string& name, const std::string& colour, double first, double width,
                 const std::vector<double>& heights);
/// A short line at the rate, within its interval.
/// @param half_length  of the line, in units of x
void add_point(plot::Chart& chart, double x, double half_length, const RateOf& rate, const std::string& name,
               const std::string& colour);

pugi::xml_node add_section(pugi::xml_node main, const std::string& id, const std::string& heading);
/// "No ball speeds: add [[output]] type = ..."
void add_missing(pugi::xml_node section, const std::string& what, const std::string& output);

/// A table under a heading with this id, and a row of headings; the first cell of each row is its heading.
void add_table(pugi::xml_node section, const std::string& id, const std::string& caption,
               const std::vector<std::string>& headings, const Rows& rows);

/// A chart over the time of the run, with the start of statistics marked unless it is the beginning.
plot::Chart over_time(const RunFolder& run, const std::string& id, const std::string& title,
                      const std::string& y_title);
/// From 0, or the least value, to a little above the highest.
void fit_heights(plot::Chart& chart);

/// Rate of a variable of all impacts, or of those with one partner; nothing when no table has it.
std::optional<Series> rate_of(const RunFolder& run, const char* variable, int partner = -1);

}  // namespace edmill::report
