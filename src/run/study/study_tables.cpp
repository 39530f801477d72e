// The tables of a study; their columns are described in docs/files.md.
#include <algorithm>

#include "study/study.hpp"

namespace edmill::study {

using Table = io::Table<double>;
using io::Column;
using Type = Column::Type;

namespace {

std::string setting_of(const Point& point, const std::string& key) {
  for (const auto& [name, value] : point.settings)
    if (name == key) return value;
  return "";
}

/// What both tables begin with.
std::vector<Column> point_columns(const std::vector<std::string>& keys) {
  std::vector<Column> columns{{"point", Type::integer}, {"name", Type::text}};
  for (const auto& key : keys) columns.push_back({key, Type::text});
  return columns;
}

void put_point(Table& table, std::size_t index, const Point& point, const std::vector<std::string>& keys) {
  table.put(index + 1, point.name);
  for (const auto& key : keys) table.put(setting_of(point, key));
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

std::vector<Quantity> Study::quantities() const {
  int walls = 0;
  for (const auto& point : points_)
    for (const auto& run : point.runs) walls = std::max(walls, run.walls);
  return study::quantities(walls);
}

Table Study::point_table() const {
  const auto varied = keys();
  const auto shown = quantities();
  auto columns = point_columns(varied);
  for (const auto* name : {"replicas", "done", "failed"}) columns.push_back({name, Type::integer});
  for (const auto& quantity : shown)
    for (const auto* what : {"", "_ci95"}) columns.push_back({quantity.name + what, Type::number});
  Table table(std::move(columns));
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const auto& point = points_[k];
    put_point(table, k, point, varied);
    table.put(point.runs.size(), point.done(), point.failed());
    for (const auto& quantity : shown) {
      const auto e = numerics::estimate(point.values(quantity));
      table.put(e.mean, e.half_width);
    }
  }
  return table;
}

Table Study::run_table() const {
  const auto varied = keys();
  const auto shown = quantities();
  auto columns = point_columns(varied);
  columns.push_back({"seed", Type::integer});
  for (const auto* name : {"status", "end_reason"}) columns.push_back({name, Type::text});
  for (const auto* name : {"start_time", "end_time", "charge_ratio_reached", "milling_dose", "wall_work",
                           "milling_dose_rate_ci95"})
    columns.push_back({name, Type::number});
  for (const auto& quantity : shown) columns.push_back({quantity.name, Type::number});
  for (const auto* name : {"digest", "message"}) columns.push_back({name, Type::text});
  Table table(std::move(columns));
  for (std::size_t k = 0; k < points_.size(); ++k)
    for (const auto& run : points_[k].runs) {
      const auto record = run.record.value_or(RunRecord{});
      const bool ran = run.record && !run.record->end_reason.empty();
      const auto if_ran = [&](double x) { return ran ? std::optional<double>(x) : std::nullopt; };
      put_point(table, k, points_[k], varied);
      table.put(run.seed, run.record ? record.status : "pending", record.end_reason);
      table.put(if_ran(record.start_time), if_ran(record.end_time), charge_ratio(record),
                if_ran(record.milling_dose), if_ran(record.wall_work), record.dose_rate_half_width);
      for (const auto& quantity : shown) table.put(quantity.of(record));
      table.put(run.job.digest, record.message);
    }
  return table;
}

Table Study::log_table() const {
  if (log_.empty()) return {};
  Table table({{"run", Type::text}, {"cpu_seconds", Type::number}});
  for (const auto& [what, seconds] : log_) table.put(what, seconds);
  return table;
}

}  // namespace edmill::study
