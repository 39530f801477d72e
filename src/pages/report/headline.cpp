// The main results, the comparison with the thesis, and warnings.
#include <fmt/format.h>

#include "report/sections.hpp"

namespace edmill::report {

using plot::add;
using plot::brief;
using plot::readable;

void add_headline(pugi::xml_node main, const RunFolder& run) {
  const auto& f = run.facts;
  auto section = add_section(main, "results", "Results");
  add(section, "p", {},
      fmt::format("{} collisions between {} s and {} s of simulated time.", brief(f.all_collisions(), 12),
                  brief(f.start_time, 12), brief(f.end_time, 12)));
  auto list = add(section, "dl", {{"class", "cards"}});
  bool any = false;
  for (const auto& [name, unit, rate] : main_rates(f)) {
    if (!rate || !(f.duration() > 0)) continue;
    auto box = add(list, "div", {{"class", "card"}});
    add(box, "dt", {}, capitalised(name));
    auto value = add(box, "dd", {{"data-unit", unit}, {"data-value", fmt::format("{}", rate->value)}});
    const auto [number, width] = plot::with_interval(rate->value, rate->half_width.value_or(0));
    add(value, "strong", {}, number);
    add(value, "span", {{"class", "unit"}}, " " + unit);
    if (rate->half_width) {
      any = true;
      value.append_attribute("data-interval") = fmt::format("{}", *rate->half_width).c_str();
      add(box, "dd", {{"class", "interval"}}, "\u00b1 " + width + " " + unit);
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
