#include "study/table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "io/csv_cell.hpp"

namespace edmill::study {

namespace {

std::string field(const Table::Column& column, std::size_t row) {
  if (const auto* integers = std::get_if<Table::Integers>(&column.values))
    return std::to_string((*integers)[row]);
  if (const auto* numbers = std::get_if<Table::Numbers>(&column.values))
    return std::isnan((*numbers)[row]) ? "" : fmt::format("{}", (*numbers)[row]);
  return io::csv_cell(std::get<Table::Texts>(column.values)[row]);
}

}  // namespace

void Table::number(const std::string& column, const std::optional<double>& value) {
  values<Numbers>(column).push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
}

std::size_t Table::rows() const {
  if (columns_.empty()) return 0;
  return std::visit([](const auto& values) { return values.size(); }, columns_.front().values);
}

std::string Table::csv() const {
  std::string out;
  const auto line = [&](const auto& entry) {
    for (std::size_t k = 0; k < columns_.size(); ++k) out += (k ? "," : "") + entry(columns_[k]);
    out += "\n";
  };
  line([](const Column& column) { return column.name; });
  for (std::size_t row = 0; row < rows(); ++row)
    line([&](const Column& column) { return field(column, row); });
  return out;
}

}  // namespace edmill::study
