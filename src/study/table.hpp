// A table of texts and numbers, as CSV and in HDF5. The same table gives the same bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace edmill::study {

class Table {
 public:
  using Texts = std::vector<std::string>;
  using Integers = std::vector<std::int64_t>;
  using Numbers = std::vector<double>;  ///< nan stands for no value
  struct Column {
    std::string name;
    std::variant<Texts, Integers, Numbers> values;
  };

  void text(const std::string& column, std::string value) {
    values<Texts>(column).push_back(std::move(value));
  }
  void integer(const std::string& column, std::uint64_t value) {
    values<Integers>(column).push_back(static_cast<std::int64_t>(value));
  }
  void number(const std::string& column, const std::optional<double>& value);

  const std::vector<Column>& columns() const { return columns_; }
  std::size_t rows() const;

  /// Header and rows; texts are quoted where they need it, no value is an empty field.
  std::string csv() const;

 private:
  /// The column of that name, added at the end when it is new.
  template <class Values>
  Values& values(const std::string& name) {
    for (auto& column : columns_)
      if (column.name == name) return std::get<Values>(column.values);
    columns_.push_back({name, Values{}});
    return std::get<Values>(columns_.back().values);
  }
  std::vector<Column> columns_;
};

/// An HDF5 file with a compound data set for each table.
std::string hdf5_image(const std::vector<std::pair<std::string, Table>>& tables);

}  // namespace edmill::study
