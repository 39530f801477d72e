#include <algorithm>
#include <cstring>

#include "io/hdf5_handle.hpp"
#include "study/table.hpp"

namespace edmill::study {

using Handle = io::Hdf5Handle;
using io::hdf5_check;

namespace {

std::size_t width_of(const Table::Column& column) {
  const auto* texts = std::get_if<Table::Texts>(&column.values);
  if (!texts) return 8;
  std::size_t width = 1;
  for (const auto& text : *texts) width = std::max(width, text.size());
  return width;
}

void put(const Table::Column& column, std::size_t row, char* place) {
  if (const auto* texts = std::get_if<Table::Texts>(&column.values))
    std::memcpy(place, (*texts)[row].data(), (*texts)[row].size());
  else if (const auto* integers = std::get_if<Table::Integers>(&column.values))
    std::memcpy(place, &(*integers)[row], 8);
  else
    std::memcpy(place, &std::get<Table::Numbers>(column.values)[row], 8);
}

void write_table(hid_t file, const std::string& name, const Table& table) {
  std::size_t size = 0;
  for (const auto& column : table.columns()) size += width_of(column);
  const Handle row_type(H5Tcreate(H5T_COMPOUND, size), H5Tclose);
  std::vector<char> rows(size * table.rows(), '\0');
  std::size_t offset = 0;
  for (const auto& column : table.columns()) {
    const std::size_t width = width_of(column);
    const bool text = std::holds_alternative<Table::Texts>(column.values);
    const bool integer = std::holds_alternative<Table::Integers>(column.values);
    const Handle type(H5Tcopy(text ? H5T_C_S1 : integer ? H5T_STD_I64LE : H5T_IEEE_F64LE), H5Tclose);
    if (text) {
      hdf5_check(H5Tset_size(type, width));
      hdf5_check(H5Tset_strpad(type, H5T_STR_NULLPAD));
      hdf5_check(H5Tset_cset(type, H5T_CSET_UTF8));
    }
    hdf5_check(H5Tinsert(row_type, column.name.c_str(), offset, type));
    for (std::size_t k = 0; k < table.rows(); ++k) put(column, k, &rows[k * size + offset]);
    offset += width;
  }
  const hsize_t count = table.rows();
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  hdf5_check(H5Pset_obj_track_times(creation, false));
  const Handle set(H5Dcreate2(file, name.c_str(), row_type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                   H5Dclose);
  hdf5_check(H5Dwrite(set, row_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()));
}

}  // namespace

std::string hdf5_image(const std::vector<std::pair<std::string, Table>>& tables) {
  return io::hdf5_image([&](hid_t file) {
    for (const auto& [name, table] : tables) write_table(file, name, table);
  });
}

}  // namespace edmill::study
