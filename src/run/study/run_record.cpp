#include "study/run_record.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/errors.hpp"
#include "base/version.hpp"
#include "io/json_text.hpp"

namespace edmill::study {

namespace {

constexpr const char* format_name = "edmill run record 1";

/// The number of walls that a record counts impacts with.
int walls_of(const RunRecord& r) { return static_cast<int>(r.collisions.size()) - 1; }

/// An amount per second of the statistics; nothing when they cover no time.
std::optional<double> rate(const RunRecord& r, double amount) {
  const double duration = r.end_time - r.start_time;
  return duration > 0 ? std::optional<double>(amount / duration) : std::nullopt;
}

std::optional<double> collision_rate(const RunRecord& r, std::size_t place) {
  return place < r.collisions.size() ? rate(r, static_cast<double>(r.collisions[place])) : std::nullopt;
}

Quantity wall_rate(int wall) {
  const auto of = [wall](const RunRecord& r) {
    return wall < walls_of(r) ? collision_rate(r, static_cast<std::size_t>(wall)) : std::nullopt;
  };
  return {"collision_rate_" + model::partner_key(wall, wall + 1), of};
}

}  // namespace

RunRecord record_of(const io::Summary<double>& s) {
  RunRecord r;
  r.digest = s.provenance.case_digest;
  r.end_reason = model::name(s.end_reason);
  switch (s.end_reason) {
    case model::EndReason::inelastic_collapse:
    case model::EndReason::stalled:
    case model::EndReason::max_cpu_time:
    case model::EndReason::undecided:
    case model::EndReason::interrupted:
      r.status = r.end_reason;
      break;
    default:
      r.status = "done";
  }
  r.message = s.error;
  if (s.collapse)
    r.message = "ball " + std::to_string(s.collapse->ball) + " came to rest in a series of impacts";
  r.start_time = s.start_time;
  r.end_time = s.end_time;
  r.collisions = s.collisions;
  r.milling_dose = s.milling_dose;
  r.wall_work = s.wall_work;
  r.powder_mass = s.powder_mass;
  r.ball_mass = s.ball_mass;
  if (s.intervals.any()) r.dose_rate_half_width = s.intervals.dose_rate.half_width;
  r.milling_time = s.milling_time();
  r.cpu_seconds = s.cpu_seconds;
  return r;
}

RunRecord failed_run(const std::string& digest, const std::string& status, const std::string& message) {
  RunRecord record;
  record.digest = digest;
  record.status = status;
  for (const char c : message) record.message += c == '\n' ? std::string("; ") : std::string(1, c);
  return record;
}

std::string to_json(const RunRecord& r) {
  io::JsonText json;
  json.text("format", format_name);
  json.text("version", version());
  json.text("commit", commit());
  json.text("case_digest", r.digest);
  json.text("status", r.status);
  json.text("end_reason", r.end_reason);
  json.text("message", r.message);
  json.number("start_time", r.start_time);
  json.number("end_time", r.end_time);
  json.begin("collisions");
  for (int k = 0; k <= walls_of(r); ++k) json.integer(model::partner_key(k, walls_of(r)), r.collisions[k]);
  json.end();
  json.number("milling_dose", r.milling_dose);
  json.number("wall_work", r.wall_work);
  if (r.powder_mass) json.number("powder_mass", *r.powder_mass);
  if (r.ball_mass) json.number("ball_mass", *r.ball_mass);
  if (r.dose_rate_half_width) json.number("dose_rate_half_width", *r.dose_rate_half_width);
  if (r.milling_time) json.number("milling_time", *r.milling_time);
  json.number("cpu_seconds", r.cpu_seconds);
  return json.finish();
}

std::optional<RunRecord> from_json(const std::string& text) try {
  const auto root = nlohmann::ordered_json::parse(text);
  const auto word = [&](const char* key) { return root.at(key).get<std::string>(); };
  const auto number = [&](const char* key) { return root.at(key).get<double>(); };
  const auto number_if_there = [&](const char* key) {
    return root.contains(key) ? std::optional<double>(number(key)) : std::nullopt;
  };
  if (word("format") != format_name || word("version") != version() || word("commit") != commit())
    return std::nullopt;
  RunRecord r;
  r.digest = word("case_digest");
  r.status = word("status");
  r.end_reason = word("end_reason");
  r.message = word("message");
  r.start_time = number("start_time");
  r.end_time = number("end_time");
  for (const auto& count : root.at("collisions"))  // in the order of the partners
    r.collisions.push_back(count.get<std::uint64_t>());
  r.milling_dose = number("milling_dose");
  r.wall_work = number("wall_work");
  r.powder_mass = number_if_there("powder_mass");
  r.ball_mass = number_if_there("ball_mass");
  r.dose_rate_half_width = number_if_there("dose_rate_half_width");
  r.milling_time = number_if_there("milling_time");
  r.cpu_seconds = number("cpu_seconds");
  return r;
} catch (const std::exception&) {
  return std::nullopt;
}

std::vector<Quantity> quantities(int walls) {
  std::vector<Quantity> list{
      {"inverse_milling_dose_rate",
       [](const RunRecord& r) -> std::optional<double> {
         const double duration = r.end_time - r.start_time;
         if (!(duration > 0 && r.milling_dose > 0)) return std::nullopt;
         return duration / r.milling_dose;
       }},
      {"milling_dose_rate", [](const RunRecord& r) { return rate(r, r.milling_dose); }},
      {"specific_milling_dose_rate",
       [](const RunRecord& r) {
         return r.powder_mass ? rate(r, r.milling_dose / *r.powder_mass) : std::nullopt;
       }},
      {"milling_time", [](const RunRecord& r) { return r.milling_time; }},
      {"wall_work_rate", [](const RunRecord& r) { return rate(r, r.wall_work); }}};
  for (int wall = 0; wall < walls; ++wall) list.push_back(wall_rate(wall));
  list.push_back({"collision_rate_" + model::partner_key(walls, walls),
                  [](const RunRecord& r) { return collision_rate(r, r.collisions.size() - 1); }});
  list.push_back({"collision_rate_total", [](const RunRecord& r) {
                    return rate(r, static_cast<double>(std::accumulate(
                                       r.collisions.begin(), r.collisions.end(), std::uint64_t{0})));
                  }});
  return list;
}

Quantity quantity_named(const std::string& name) {
  const auto list = quantities(0);
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const Quantity& q) { return q.name == name; });
  EDMILL_REQUIRE(found != list.end(), "the name of a quantity of studies");
  return *found;
}

}  // namespace edmill::study
