#include "study/run_record.hpp"

#include <algorithm>

#include "base/errors.hpp"
#include "base/version.hpp"
#include "io/json_file.hpp"
#include "io/summary.hpp"
#include "model/parts/partners.hpp"

namespace edmill::study {

constexpr const char* format_name = "edmill run record 2";

RunRecord record_of(io::Facts summary) {
  using enum model::EndReason;
  constexpr model::EndReason before_the_end[] = {
      inelastic_collapse, stalled, max_cpu_time, undecided, interrupted};
  RunRecord r{summary.text("case_digest"), "done", "", std::move(summary)};
  if (std::ranges::count(before_the_end, io::end_reason_of(r.facts)) > 0) r.status = r.end_reason();
  if (r.facts.has("error")) r.message = r.facts.text("error");
  if (const auto ball = r.facts.find("inelastic_collapse/ball"))
    r.message = fmt::format("ball {:.0f} came to rest in a series of impacts", *ball);
  return r;
}

RunRecord failed_run(
    const std::string& digest, const std::string& status, const std::string& message) {
  RunRecord record{digest, status, "", io::Facts()};
  for (const char c : message) record.message += c == '\n' ? std::string("; ") : std::string(1, c);
  return record;
}

std::string to_json(const RunRecord& r) {
  auto all = r.facts;
  for (const auto& [key, text] :
      {std::pair{"format", std::string(format_name)}, {"version", version()}, {"commit", commit()},
          {"case_digest", r.digest}, {"status", r.status}, {"message", r.message}})
    all.set(key, text);
  return all.json();
}

std::optional<RunRecord> from_json(const std::string& text) try {
  const auto facts = io::facts_in(nlohmann::json::parse(text), "a record");
  if (facts.text("format") != format_name || facts.text("version") != version() ||
      facts.text("commit") != commit())
    return std::nullopt;
  RunRecord r{facts.text("case_digest"), facts.text("status"), facts.text("message"), facts};
  r.end_reason(), r.cpu_seconds();
  for (const auto& list : {amounts(), quantities(0)})
    for (const auto& quantity : list) quantity.of(r);
  for (const auto& partner : facts.keys_of("collision_rate"))
    facts.find("collision_rate/" + partner);
  return r;
} catch (const std::exception&) {
  return std::nullopt;
}

std::vector<Quantity> amounts() {
  return {{"start_time", "s", "start_time"}, {"end_time", "s", "end_time"},
      {"charge_ratio_reached", "1", "charge_ratio"}, {"milling_dose", "J", "milling_dose"},
      {"wall_work", "J", "wall_work"},
      {"milling_dose_rate_ci95", "W", "intervals/milling_dose_rate"}};
}

const std::vector<Quantity>& main_quantities() {
  static const std::vector<Quantity> list{
      {"milling_dose_rate", "W", "milling_dose_rate", "intervals/milling_dose_rate",
          "milling dose rate", "W"},
      {"specific_milling_dose_rate", "W/kg", "specific_milling_dose_rate",
          "intervals/specific_milling_dose_rate", "specific milling dose rate", "W/kg"},
      {"impact_energy", "J", "impact_energy_by_dose/median", "", "median impact energy", "mJ",
          1e-3},
      {"milling_time", "s", "target/milling_time", "target/milling_time_half_width", "milling time",
          "h", 3600}};
  return list;
}

std::vector<Quantity> quantities(int walls) {
  const auto& shown = main_quantities();
  std::vector<Quantity> list{{"inverse_milling_dose_rate", "s/J", "inverse_milling_dose_rate",
      "intervals/inverse_milling_dose_rate"}};
  list.insert(list.end(), shown.begin(), shown.end());
  list.push_back({"wall_work_rate", "W", "wall_work_rate", "intervals/wall_work_rate"});
  list.push_back({"fast_impact_rate", "1/s", "fast_impact_rate", "intervals/fast_impact_rate"});
  list.push_back({"mean_impact_speed", "m/s", "mean_impact_speed"});
  const auto add = [&](const std::string& partner) {
    list.push_back({"collision_rate_" + partner, "1/s", "collision_rate/" + partner});
    list.push_back({"impact_rate_" + partner, "1/s", "impact_rate/" + partner,
        "intervals/impact_rate/" + partner});
  };
  for (int k = 0; k <= walls; ++k) add(model::partner_key(k, walls));
  add("total");
  return list;
}

Quantity quantity_named(const std::string& name) {
  const auto list = quantities(0);
  const auto found = std::ranges::find(list, name, &Quantity::name);
  EDMILL_REQUIRE(found != list.end(), "the name of a quantity of studies");
  return *found;
}

}  // namespace edmill::study
