// The tables of a study; their columns are described in docs/files.md.
#include <algorithm>

#include "study/study.hpp"

namespace edmill::study {

namespace {

std::string setting_of(const Point& point, const std::string& key) {
  for (const auto& [name, value] : point.settings)
    if (name == key) return value;
  return "";
}

void put_point(Table& table, std::size_t index, const Point& point, const std::vector<std::string>& keys) {
  table.integer("point", index + 1);
  table.text("name", point.name);
  for (const auto& key : keys) table.text(key, setting_of(point, key));
}

std::optional<double> charge_ratio(const RunRecord& r) {
  if (!r.powder_mass || !r.ball_mass) return std::nullopt;
  return *r.ball_mass / *r.powder_mass;
}

}  // namespace

std::vector<std::string> Study::keys() const {
  std::vector<std::string> keys;
  for (const auto& point : points_)
    for (const auto& [key, value] : point.settings)
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  return keys;
}

Table Study::point_table() const {
  Table table;
  const auto varied = keys();
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const auto& point = points_[k];
    put_point(table, k, point, varied);
    table.integer("replicas", point.runs.size());
    table.integer("done", point.done());
    table.integer("failed", point.failed());
    for (std::size_t q = 0; q < quantity_names.size(); ++q) {
      const auto e = estimate(point.values(q));
      table.number(std::string(quantity_names[q]), e.mean);
      table.number(std::string(quantity_names[q]) + "_ci95", e.half_width);
    }
  }
  return table;
}

Table Study::run_table() const {
  Table table;
  const auto varied = keys();
  for (std::size_t k = 0; k < points_.size(); ++k)
    for (const auto& run : points_[k].runs) {
      const auto record = run.record.value_or(RunRecord{});
      const bool ran = run.record && !run.record->end_reason.empty();
      const auto if_ran = [&](double x) { return ran ? std::optional<double>(x) : std::nullopt; };
      put_point(table, k, points_[k], varied);
      table.integer("seed", run.seed);
      table.text("status", run.record ? record.status : "pending");
      table.text("end_reason", record.end_reason);
      table.number("start_time", if_ran(record.start_time));
      table.number("end_time", if_ran(record.end_time));
      table.number("charge_ratio_reached", charge_ratio(record));
      table.number("milling_dose", if_ran(record.milling_dose));
      table.number("wall_work", if_ran(record.wall_work));
      const auto quantities = quantities_of(record);
      for (std::size_t q = 0; q < quantities.size(); ++q)
        table.number(std::string(quantity_names[q]), quantities[q]);
      table.text("digest", run.job.digest);
      table.text("message", record.message);
    }
  return table;
}

Table Study::log_table() const {
  Table table;
  for (const auto& [what, seconds] : log_) {
    table.text("run", what);
    table.number("cpu_seconds", seconds);
  }
  return table;
}

}  // namespace edmill::study
