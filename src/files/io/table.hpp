// Tables with typed columns, written as CSV and HDF5. The same table gives the same bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "base/archive.hpp"
#include "base/clean_text.hpp"
#include "base/errors.hpp"
#include "base/scalar.hpp"

namespace edmill::io {

/// A text as a cell of CSV (RFC 4180), quoted for readers with any separator and comments (#).
inline std::string csv_cell(const std::string& text) {
  const bool blank_ends = text.starts_with(' ') || text.ends_with(' ');
  if (!blank_ends && text.find_first_of(",;\t\"#\n\r") == std::string::npos)
    return clean_text(text);
  std::string quoted = "\"";
  for (const char c : clean_text(text))
    quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

struct Column {
  enum class Type { text, integer, number };
  std::string name;
  Type type;
  std::string unit{};         ///< "1" without a dimension; empty for names and the like
  std::string description{};  ///< empty when the name says it all

  /// "milling_dose [J]", or only the name for a column without a unit.
  std::string title() const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

/// A text of the whole file: an attribute, or a dataset when it is `long_text`.
struct FileNote {
  std::string key, value;
  bool long_text = false;
};

/// The value of a formula if it is defined, otherwise nothing, which becomes an empty cell.
template <class Formula> auto value_if(bool defined, const Formula& formula) {
  return defined ? std::optional(formula()) : std::nullopt;
}

/// @tparam Real  scalar of the numbers, which CSV shows in all of its digits
template <class Real> class Table {
 public:
  using Texts = std::vector<std::string>;
  using Integers = std::vector<std::int64_t>;
  using Numbers = std::vector<std::optional<Real>>;  ///< nothing for an undefined value
  using Cells = std::variant<Texts, Integers, Numbers>;

  Table() = default;
  /// @param comments  lines above the header
  explicit Table(std::vector<Column> columns, std::vector<std::string> comments = {})
      : columns_(std::move(columns)), comments_(std::move(comments)) {
    for (const auto& column : columns_) cells_.push_back(no_cells(column.type));
  }

  /// Adds cells to the row from left to right: texts, integers, and numbers, which may be absent.
  /// @throws std::bad_variant_access when a cell has not the type of its column
  template <class... Cell> void put(const Cell&... cells) { (put_one(cells), ...); }
  /// Whether all rows are complete.
  bool at_row_end() const { return next_ == 0; }
  void clear_rows() {
    for (auto& column : cells_) std::visit([](auto& values) { values.clear(); }, column);
  }

  const std::vector<Column>& columns() const { return columns_; }
  const std::vector<std::string>& comments() const { return comments_; }
  const Cells& cells(std::size_t column) const { return cells_[column]; }
  std::size_t rows() const {
    return cells_.empty()
        ? 0
        : std::visit([](const auto& values) { return values.size(); }, cells_.back());
  }

  /// Comments after "# " and the header; texts are quoted where they need it. (RFC 4180)
  std::string csv_head() const {
    std::string text;
    for (const auto& comment : comments_) text += "# " + one_line(comment) + "\n";
    for (const auto& column : columns_)
      text += (&column == columns_.data() ? "" : ",") + csv_cell(column.title());
    return text + "\n";
  }
  /// All rows; a number that is absent is an empty field.
  std::string csv_rows() const {
    std::string text;
    for (std::size_t row = 0; row < rows(); ++row) {
      for (std::size_t k = 0; k < cells_.size(); ++k)
        text += (k == 0 ? "" : ",") + csv_field(cells_[k], row);
      text += "\n";
    }
    return text;
  }
  std::string csv() const { return csv_head() + csv_rows(); }

  /// The rows; a table of the same columns loads them.
  void archive(Archive& a) {
    a(next_);
    for (auto& column : cells_) std::visit([&](auto& values) { a(values); }, column);
    if (!a.loading()) return;
    bool whole = next_ < cells_.size() || next_ == 0;
    for (std::size_t k = 0; k < cells_.size(); ++k)
      whole = whole &&
          std::visit([](const auto& v) { return v.size(); }, cells_[k]) == rows() + (k < next_);
    if (!whole) throw InputError("the saved table has columns of different lengths");
  }
 private:
  static Cells no_cells(Column::Type type) {
    if (type == Column::Type::text) return Texts{};
    if (type == Column::Type::integer) return Integers{};
    return Numbers{};
  }
  template <class Cell> void put_one(const Cell& cell) {
    auto& column = cells_.at(next_);
    next_ = next_ + 1 == cells_.size() ? 0 : next_ + 1;
    if constexpr (std::is_convertible_v<const Cell&, std::string_view>)
      std::get<Texts>(column).emplace_back(cell);
    else if constexpr (std::is_integral_v<Cell>)
      std::get<Integers>(column).push_back(static_cast<std::int64_t>(cell));
    else
      std::get<Numbers>(column).emplace_back(cell);
  }
  static std::string csv_field(const Cells& column, std::size_t row) {
    if (const auto* texts = std::get_if<Texts>(&column)) return csv_cell((*texts)[row]);
    if (const auto* integers = std::get_if<Integers>(&column))
      return std::to_string((*integers)[row]);
    const auto& number = std::get<Numbers>(column)[row];
    return number ? to_text<Real>(*number) : "";
  }

  std::vector<Column> columns_;
  std::vector<std::string> comments_;
  std::vector<Cells> cells_;
  std::size_t next_ = 0;  ///< column of the next cell
};

}  // namespace edmill::io
