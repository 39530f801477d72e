#include "output/table_file.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <sstream>

#include "model/impact_variables.hpp"
#include "output/hdf5_parts.hpp"

namespace edmill::output {

namespace {

using Cells = std::vector<std::string>;

/// A line of CSV as cells. (RFC 4180; no cell of ours spans lines)
Cells split(const std::string& line) {
  Cells cells(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (c == '"' && quoted && k + 1 < line.size() && line[k + 1] == '"')
      cells.back() += line[k++];
    else if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

/// The whole text as a number; nothing when it is none. No text is nan.
template <class Number>
std::optional<Number> number_in(const std::string& text) {
  if (std::is_same_v<Number, double> && text.empty()) return std::numeric_limits<Number>::quiet_NaN();
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

/// All cells of a column as numbers, or nothing.
template <class Number>
std::optional<std::vector<Number>> numbers_in(const Cells& column) {
  std::vector<Number> values;
  for (const auto& cell : column) {
    const auto value = number_in<Number>(cell);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

/// Columns whose name does not tell enough and that are no variables.
const std::map<std::string, std::string>& common_columns() {
  static const std::map<std::string, std::string> meanings{
      {"duration", "length of the interval"},
      {"impacts", "number of impacts"},
      {"dose", "milling dose"},
      {"area", "area of the cell"},
      {"dose_per_area", "milling dose of the cell over its area"},
      {"interval", "number of the interval from 1, or below or above all"},
      {"bin", "number of the bin from 1, or below or above all"},
      {"spectrum", "the part of the dose, or the speed, that is binned"},
      {"lower", "lower end, in the interval"},
      {"upper", "upper end, not in the interval"},
      {"mean", "middle of the interval"},
      {"variable", "what the row shows"},
      {"statistic", "which statistic of it"},
      {"unit", "of the numbers in the row"},
      {"milling_dose_rate", "milling dose per second of the record"},
      {"inverse_milling_dose_rate", "time of the record over its milling dose"},
      {"specific_milling_dose", "milling dose over the mass of the powder"},
      {"specific_milling_dose_rate", "milling dose per second over the mass of the powder"},
      {"powder_mass", "mass of the powder"},
      {"charge_ratio", "mass of the balls over the mass of the powder"}};
  return meanings;
}

std::string meaning_of(const std::string& name, const std::map<std::string, std::string>& meanings) {
  static const std::map<std::string, std::string> partners{
      {"wall_0", "with wall 0, the cap at -y"}, {"wall_1", "with wall 1, the cap at +y"},
      {"wall_2", "with wall 2, the cylinder"},  {"walls", "with all walls"},
      {"ball_ball", "between balls"},           {"total", "of all impacts"}};
  for (const auto* table : {&meanings, &partners, &common_columns()})
    if (const auto row = table->find(name); row != table->end()) return row->second;
  const auto space = name.find(' ');
  if (const auto row = partners.find(name.substr(0, space));
      space != std::string::npos && row != partners.end())
    return meaning_of(name.substr(space + 1), meanings) + ", " + row->second;
  const auto variable = model::find_variable(name);
  return variable ? std::string(model::impact_variables[static_cast<std::size_t>(*variable)].meaning) : name;
}

void add_column(hid_t file, const std::string& name, const Cells& cells, hid_t& made) {
  const hsize_t rows = cells.size(), chunk = std::clamp<hsize_t>(rows, 1, 16384);
  if (const auto integers = numbers_in<std::int64_t>(cells); integers && rows > 0) {
    made = make_set(file, name, H5T_STD_I64LE, 1, chunk, true);
    append(made, H5T_NATIVE_INT64, 1, 0, rows, integers->data());
  } else if (const auto numbers = numbers_in<double>(cells)) {
    made = make_set(file, name, H5T_IEEE_F64LE, 1, chunk, true);
    append(made, H5T_NATIVE_DOUBLE, 1, 0, rows, numbers->data());
  } else {
    std::size_t width = 1;
    for (const auto& cell : cells) width = std::max(width, cell.size());
    std::string bytes(width * cells.size(), '\0');
    for (std::size_t k = 0; k < cells.size(); ++k) cells[k].copy(&bytes[k * width], width);
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    hdf5_check(H5Tset_size(type, width));
    hdf5_check(H5Tset_strpad(type, H5T_STR_NULLPAD));
    hdf5_check(H5Tset_cset(type, H5T_CSET_UTF8));
    made = make_set(file, name, type, 1, chunk, true);
    append(made, type, 1, 0, rows, bytes.data());
  }
}

/// The name of a dataset: none has a slash, and no two are the same.
std::string dataset_name(std::string name, std::set<std::string>& taken) {
  std::replace(name.begin(), name.end(), '/', '_');
  if (name.empty() || name == ".") name = "column";
  std::string free = name;
  for (int k = 2; !taken.insert(free).second; ++k) free = name + " " + std::to_string(k);
  return free;
}

}  // namespace

std::string table_image(const std::string& csv, const std::vector<FileNote>& notes,
                        const std::map<std::string, std::string>& meanings) {
  std::istringstream in(csv);
  std::string comment;
  Cells titles;
  std::vector<Cells> columns;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("# "))
      comment += (comment.empty() ? "" : "\n") + line.substr(2);
    else if (titles.empty())
      columns.resize((titles = split(line)).size());
    else if (const auto cells = split(line); cells.size() == titles.size())
      for (std::size_t k = 0; k < cells.size(); ++k) columns[k].push_back(cells[k]);
  }
  return io::hdf5_image([&](hid_t file) {
    add_notes(file, notes);
    if (!comment.empty()) note(file, "comment", comment);
    std::set<std::string> taken;
    for (const auto& n : notes) taken.insert(n.key);
    for (std::size_t k = 0; k < titles.size(); ++k) {
      const auto bracket = titles[k].rfind(" [");
      const bool has_unit = bracket != std::string::npos && titles[k].back() == ']';
      const std::string name = has_unit ? titles[k].substr(0, bracket) : titles[k];
      hid_t made = -1;
      add_column(file, dataset_name(name, taken), columns[k], made);
      const Handle set(made, H5Dclose);
      note(set, "title", titles[k]);
      if (has_unit) note(set, "unit", titles[k].substr(bracket + 2, titles[k].size() - bracket - 3));
      note(set, "description", meaning_of(name, meanings));
    }
  });
}

}  // namespace edmill::output
