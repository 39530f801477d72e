// The main results, the comparison with the thesis, and warnings.
#include <fmt/format.h>

#include "report/sections.hpp"

namespace edmill::report {

using plot::add;
using plot::brief;
using plot::readable;

namespace {

struct Card {
  std::string name, unit;
  double value;
  std::optional<double> half_width;
};

std::vector<Card> cards_of(const RunFolder& run) {
  const auto& f = run.facts;
  const double time = f.duration();
  if (!(time > 0)) return {};
  const double dose_rate = f.milling_dose / time;
  std::vector<Card> cards{{"Milling dose rate", "W", dose_rate, f.half_width("milling_dose_rate")}};
  if (dose_rate > 0)
    cards.push_back(
        {"Inverse milling dose rate", "s/J", 1 / dose_rate, f.half_width("inverse_milling_dose_rate")});
  if (f.powder_mass)
    cards.push_back({"Specific milling dose rate", "W/kg", dose_rate / *f.powder_mass,
                     f.half_width("specific_milling_dose_rate")});
  if (f.milling_time)
    cards.push_back({"Milling time", "h", *f.milling_time / 3600,
                     f.milling_time_half_width ? std::optional<double>(*f.milling_time_half_width / 3600)
                                               : std::nullopt});
  cards.push_back({"Power from the walls", "W", f.wall_work / time, f.half_width("wall_work_rate")});
  cards.push_back({"Collisions", "1/s", f.all_collisions() / time, f.half_width("collision_rate/total")});
  return cards;
}

}  // namespace

std::string title_of(const RunFolder& run) {
  return std::filesystem::path(run.facts.case_file).filename().string();
}

void add_headline(pugi::xml_node main, const RunFolder& run) {
  const auto& f = run.facts;
  auto section = add_section(main, "results", "Results");
  add(section, "p", {},
      fmt::format("{} collisions between {} s and {} s of simulated time.", brief(f.all_collisions(), 12),
                  brief(f.start_time, 12), brief(f.end_time, 12)));
  auto list = add(section, "dl", {{"class", "cards"}});
  bool any = false;
  for (const auto& card : cards_of(run)) {
    auto box = add(list, "div", {{"class", "card"}});
    add(box, "dt", {}, card.name);
    auto value = add(box, "dd", {{"data-unit", card.unit}, {"data-value", fmt::format("{}", card.value)}});
    if (card.half_width)
      value.append_attribute("data-interval") = fmt::format("{}", *card.half_width).c_str();
    const auto [number, width] = plot::with_interval(card.value, card.half_width.value_or(0));
    add(value, "strong", {}, number);
    add(value, "span", {{"class", "unit"}}, " " + card.unit);
    if (card.half_width) {
      any = true;
      add(box, "dd", {{"class", "interval"}}, "\u00b1 " + width + " " + card.unit);
    }
  }
  if (any)
    add(section, "p", {{"class", "note"}},
        fmt::format(
            "\u00b1: 95 % interval of this run, Student\u2019s t over {} batches of {} s, whole drive "
            "periods. It covers longer runs of the same mill; other seeds may settle at another mean "
            "(edmill sweep).",
            brief(f.batches), readable(f.batch_length)));
  else
    add(section, "p", {{"class", "note"}}, "Too short for intervals: fewer than 5 drive periods.");
  if (f.target_dose)
    add(section, "p", {{"class", "note"}},
        f.milling_time ? fmt::format("Milling time to {} kJ/g, counting {}.", readable(*f.target_dose / 1e6),
                                     f.target_counts)
                       : fmt::format("No milling time to {} kJ/g: nothing of the dose counts ({}).",
                                     readable(*f.target_dose / 1e6), f.target_counts));
}

void add_ward(pugi::xml_node main, const RunFolder& run) {
  const auto ward = ward_case_of(run.spec);
  const auto& f = run.facts;
  if (!ward || !(f.duration() > 0) || !(f.milling_dose > 0)) return;
  auto section = add_section(main, "thesis", "Comparison with the thesis");
  const double inverse = f.duration() / f.milling_dose, rate = f.all_collisions() / f.duration();
  const auto width = f.half_width("inverse_milling_dose_rate");
  const auto [here, interval] = plot::with_interval(inverse, width.value_or(0));
  std::vector<std::vector<std::string>> rows{
      {"inverse milling dose rate [s/J]", width ? here + " \u00b1 " + interval : readable(inverse),
       readable(ward->inverse_dose_rate), readable(ward->inverse_dose_rate / inverse, 3)}};
  if (ward->collision_rate)
    rows.push_back({"collisions [1/s]", readable(rate), readable(*ward->collision_rate),
                    readable(*ward->collision_rate / rate, 3)});
  add_table(section, "thesis-table",
            fmt::format("{} balls of {} mm, {} g of powder, charge ratio {}: tables 5.5 and 5.6", ward->balls,
                        ward->diameter, ward->powder, ward->charge_ratio),
            {"quantity", "this run", "thesis", "thesis / this run"}, rows);
  add(section, "p", {{"class", "note"}},
      "A case of Ward et al. (2005) as Barahona (2011) ran it in chapter 5. The thesis's inverse dose rates "
      "are higher than edmill's in all 24 cases: they result when impacts in quick succession lose no energy "
      "(docs/ward.md). Its collision rates depend on the treatment of sustained contact.");
}

void add_warnings(pugi::xml_node main, const RunFolder& run) {
  const auto& warnings = run.facts.warnings;
  if (warnings.empty()) return;
  auto section = add_section(main, "warnings", warnings.size() == 1 ? "A warning" : "Warnings");
  auto list = add(section, "ul");
  for (const auto& [kind, text] : warnings) add(list, "li", {{"data-kind", kind}}, text);
}

}  // namespace edmill::report
