#include "io/table_hdf5.hpp"

#include <fmt/format.h>

#include <charconv>
#include <limits>
#include <set>

#include "base/archive.hpp"
#include "io/hdf5_parts.hpp"

namespace edmill::io {

namespace {

using DoubleTable = Table<double>;
using Texts = DoubleTable::Texts;
using Integers = DoubleTable::Integers;
using Numbers = DoubleTable::Numbers;

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// All texts as numbers, or nothing.
template <class Number> std::optional<std::vector<Number>> numbers_in(const Texts& texts) {
  std::vector<Number> values;
  for (const auto& text : texts) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    values.push_back(value);
  }
  return values;
}

/// Cells as bytes in the order of rows, with their type in the file.
struct Packed {
  Handle type;
  std::size_t width;  ///< of a cell [bytes]
  std::string bytes;
};

Packed packed(const DoubleTable::Cells& cells) {
  if (const auto* texts = std::get_if<Texts>(&cells)) {
    std::size_t width = 1;
    for (const auto& text : *texts) width = std::max(width, text.size());
    Handle type = text_type(width);
    hdf5_check(H5Tset_strpad(type, H5T_STR_NULLPAD));
    std::string bytes(width * texts->size(), '\0');
    for (std::size_t k = 0; k < texts->size(); ++k) (*texts)[k].copy(&bytes[k * width], width);
    return {std::move(type), width, std::move(bytes)};
  }
  const auto bytes_of = [](auto values) {
    for (auto& value : values) value = in_file_order(value);
    return std::string(reinterpret_cast<const char*>(values.data()), 8 * values.size());
  };
  if (const auto* integers = std::get_if<Integers>(&cells))
    return {Handle(H5Tcopy(H5T_STD_I64LE), H5Tclose), 8, bytes_of(*integers)};
  std::vector<double> doubles;
  for (const auto& number : std::get<Numbers>(cells)) doubles.push_back(number.value_or(no_number));
  return {Handle(H5Tcopy(H5T_IEEE_F64LE), H5Tclose), 8, bytes_of(doubles)};
}

/// Makes a valid dataset name: without slashes, and different from those in `taken`.
std::string dataset_name(std::string name, std::set<std::string>& taken) {
  std::replace(name.begin(), name.end(), '/', '_');
  if (name.empty() || name == ".") name = "column";
  std::string free = name;
  for (int k = 2; !taken.insert(free).second; ++k) free = name + " " + std::to_string(k);
  return free;
}

void add_column(hid_t file, const std::string& name, const StoredColumn& column) {
  const Packed cells = packed(column.cells);
  const hsize_t rows = cells.bytes.size() / cells.width,
                chunk = std::clamp<hsize_t>(rows, 1, 16384);
  const Handle set = make_set(file, name, cells.type, 1, chunk, true);
  append(set, cells.type, 1, 0, rows, cells.bytes.data());
  note(set, "title", column.what.title());
  if (!column.what.unit.empty()) note(set, "unit", column.what.unit);
  note(set, "description",
      column.what.description.empty() ? column.what.name : column.what.description);
}

void add_compound(hid_t file, const std::string& name, const DoubleTable& table) {
  std::vector<Packed> columns;
  std::size_t size = 0;
  for (std::size_t k = 0; k < table.columns().size(); ++k) {
    columns.push_back(packed(table.cells(k)));
    size += columns.back().width;
  }
  const Handle row_type(H5Tcreate(H5T_COMPOUND, size), H5Tclose);
  std::string rows(size * table.rows(), '\0');
  std::size_t offset = 0;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto& [type, width, bytes] = columns[k];
    hdf5_check(H5Tinsert(row_type, table.columns()[k].name.c_str(), offset, type));
    for (std::size_t row = 0; row < table.rows(); ++row)
      bytes.copy(&rows[row * size + offset], width, row * width);
    offset += width;
  }
  const hsize_t count = table.rows();
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  add_set(file, name, row_type, space, rows.data());
}

}  // namespace

Table<double>::Cells stored(const std::vector<std::string>& texts) {
  if (auto integers = numbers_in<std::int64_t>(texts)) return std::move(*integers);
  if (const auto doubles = numbers_in<double>(texts))
    return Numbers(doubles->begin(), doubles->end());
  return texts;
}

std::string hdf5_columns(const std::vector<StoredColumn>& columns,
    const std::vector<std::string>& comments, const std::vector<FileNote>& notes) {
  return hdf5_image([&](hid_t file) {
    add_notes(file, notes);
    if (!comments.empty()) note(file, "comment", fmt::format("{}", fmt::join(comments, "\n")));
    std::set<std::string> taken;
    for (const auto& n : notes) taken.insert(n.key);
    for (const auto& column : columns)
      add_column(file, dataset_name(column.what.name, taken), column);
  });
}

std::string hdf5_compounds(const std::vector<std::pair<std::string, Table<double>>>& tables) {
  return hdf5_image([&](hid_t file) {
    for (const auto& [name, table] : tables) add_compound(file, name, table);
  });
}

}  // namespace edmill::io
