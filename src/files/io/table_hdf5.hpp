// Tables in HDF5: a dataset for each column, or a compound dataset for each table.
#pragma once

#include <algorithm>
#include <cmath>

#include "io/table.hpp"

namespace edmill::io {

/// A column as stored in HDF5, where numbers have at most 64 bits.
struct StoredColumn {
  Column what;
  Table<double>::Cells cells;
};

/// The cells of a column as stored: numbers if all texts are numbers, such as flags 1 and 0.
Table<double>::Cells stored(const std::vector<std::string>& texts);
inline Table<double>::Cells stored(const std::vector<std::int64_t>& integers) { return integers; }
/// Numbers in double, or as integers when all of them are whole.
template <class Real> Table<double>::Cells stored(const std::vector<std::optional<Real>>& numbers) {
  const auto whole = [](const std::optional<Real>& number) {
    using std::floor;
    return number && *number == floor(*number) && *number > Real(-1e16) && *number < Real(1e16);
  };
  if (std::all_of(numbers.begin(), numbers.end(), whole)) {
    Table<double>::Integers integers;
    for (const auto& number : numbers) integers.push_back(static_cast<std::int64_t>(*number));
    return integers;
  }
  Table<double>::Numbers doubles;
  for (const auto& number : numbers)
    doubles.push_back(number ? std::optional(static_cast<double>(*number)) : std::nullopt);
  return doubles;
}

/// Bytes of an HDF5 file with a dataset for each column. A missing number is nan. Attributes of a
/// dataset are its `title`, `unit` and `description`; of the file, notes and `comment`.
std::string hdf5_columns(const std::vector<StoredColumn>& columns,
    const std::vector<std::string>& comments, const std::vector<FileNote>& notes);

template <class Real>
std::string hdf5_columns(const Table<Real>& table, const std::vector<FileNote>& notes) {
  std::vector<StoredColumn> columns;
  for (std::size_t k = 0; k < table.columns().size(); ++k) {
    const auto cells =
        std::visit([](const auto& values) { return stored(values); }, table.cells(k));
    columns.push_back({table.columns()[k], table.rows() == 0 ? Table<double>::Numbers{} : cells});
  }
  return hdf5_columns(columns, table.comments(), notes);
}

/// Bytes of an HDF5 file with a compound dataset for each table.
std::string hdf5_compounds(const std::vector<std::pair<std::string, Table<double>>>& tables);

}  // namespace edmill::io
