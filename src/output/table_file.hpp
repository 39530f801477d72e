// A table as HDF5: one dataset for each column.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "output/file_note.hpp"

namespace edmill::output {

/// Bytes of an HDF5 file with the columns of a table. Integers and numbers have 64 bits, no number is nan,
/// any other column is text. Attributes of a dataset are its `unit` and `description`; those of the file are
/// the notes, and the table's comments as `comment`.
/// @param csv       the table as text: comments (#), a header of "name [unit]", rows
/// @param meanings  of columns by name, before those that are known for every table
std::string table_image(const std::string& csv, const std::vector<FileNote>& notes,
                        const std::map<std::string, std::string>& meanings);

}  // namespace edmill::output
