// The comparison with the thesis.
#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "report/embedded.hpp"
#include "report/sections.hpp"

namespace edmill::report {

namespace {

using casefile::CaseSpec;
using casefile::Quantity;

/// What the thesis gives of a case but its balls, exact.
std::string text_without_balls(const CaseSpec& spec) {
  std::string text = spec.powder_mass->text() + "\n" + text_of(spec.mill) + "\n" + text_of(spec.vessel);
  for (const auto& component : spec.gravity) text += "\n" + component.text();
  for (const auto* law : {&spec.ball_ball, &spec.ball_wall}) {
    text += "\n" + std::string(law->name());
    law->parameters([&](const model::Parameter&, const Quantity& value) { text += " " + value.text(); });
  }
  return text;
}

std::string text_of(const casefile::BallSpec& ball) {
  return ball.diameter.text() + " " + ball.density.text() + " " + ball.reduced_inertia.text();
}

/// Whether every ball of a case equals this one.
bool all_balls_are(const CaseSpec& spec, const casefile::BallSpec& ball) {
  const auto is_same = [&](const casefile::BallSpec& b) { return text_of(b) == text_of(ball); };
  return std::ranges::all_of(spec.balls, is_same) && std::ranges::all_of(spec.batches, [&](const auto& b) {
           return is_same(b) && b.diameter_spread.zero();
         });
}

/// A case of the table as a case file.
CaseSpec spec_of(const WardCase& ward) {
  return casefile::parse_case(
      std::string(ward_toml), "ward.toml",
      {"powder.mass=" + ward.powder + " g", "balls.0.diameter=" + ward.diameter + " mm",
       "balls.0.count=" + std::to_string(ward.balls), "contact.restitution=" + ward.restitution});
}

std::vector<WardCase> ward_cases() {
  std::vector<WardCase> cases;
  std::istringstream lines{std::string(thesis_csv)};
  bool header = true;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) continue;
    if (std::exchange(header, false)) continue;
    std::istringstream fields(line);
    WardCase c;
    std::string balls, inverse, rate;
    for (auto* field : {&c.powder, &c.charge_ratio, &c.diameter, &balls, &c.restitution, &inverse, &rate})
      std::getline(fields, *field, ',');
    c.balls = std::stoi(balls);
    c.inverse_dose_rate = std::stod(inverse);
    if (!rate.empty()) c.collision_rate = std::stod(rate);
    cases.push_back(std::move(c));
  }
  return cases;
}

}  // namespace

std::optional<WardCase> ward_case_of(const CaseSpec& spec) {
  if (!spec.powder_mass || !spec.pairs.empty() || !spec.pistons.empty()) return std::nullopt;
  for (const auto& ward : ward_cases()) {
    if (static_cast<std::size_t>(ward.balls) != spec.ball_count()) continue;
    const CaseSpec known = spec_of(ward);
    if (text_without_balls(known) == text_without_balls(spec) && all_balls_are(spec, known.batches.front()))
      return ward;
  }
  return std::nullopt;
}

void add_ward(pugi::xml_node main, const RunFolder& run) {
  const auto ward = ward_case_of(run.spec);
  const auto& f = run.facts;
  const auto inverse = rate_in(f, "inverse_milling_dose_rate");
  if (!ward || !inverse) return;
  auto section = add_section(main, "thesis", "Comparison with the thesis");
  const double rate = f.number("collision_rate/total");
  Rows rows{{"inverse milling dose rate [s/J]", text_of(*inverse), readable(ward->inverse_dose_rate),
             readable(ward->inverse_dose_rate / inverse->value, 3)}};
  if (ward->collision_rate)
    rows.push_back({"collisions [1/s]", readable(rate), readable(*ward->collision_rate),
                    readable(*ward->collision_rate / rate, 3)});
  add_table(section, "thesis-table",
            fmt::format("{} balls of {} mm, {} g of powder, charge ratio {}: tables 5.5 and 5.6", ward->balls,
                        ward->diameter, ward->powder, ward->charge_ratio),
            {"quantity", "this run", "thesis", "thesis / this run"}, rows);
  add_note(
      section,
      "A case of Ward et al. (2005) as Barahona (2011) ran it in chapter 5. The thesis's inverse dose rates "
      "are higher than edmill's in all 24 cases: they result when impacts in quick succession lose no energy "
      "(docs/ward.md). Its collision rates depend on the treatment of sustained contact.");
}

}  // namespace edmill::report