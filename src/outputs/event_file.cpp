#include "edmill/outputs/event_file.hpp"

#include <unistd.h>

#include <optional>

#include "edmill/core/errors.hpp"
#include "hdf5_parts.hpp"

namespace edmill::outputs {

namespace {
constexpr hsize_t block = 16384;  ///< rows that are written at a time
}  // namespace

struct EventFile::Data {
  struct Column {
    EventColumn what;
    std::unique_ptr<Handle> set;
    std::vector<std::int64_t> integers;
    std::vector<double> numbers;
    std::size_t width() const { return what.type == EventColumn::Type::vector ? 3 : 1; }
  };

  std::filesystem::path place, temporary;
  std::optional<Handle> file, group;
  std::vector<Column> columns;
  hsize_t written = 0, waiting = 0;

  void write_block() {
    for (auto& c : columns) {
      const bool integer = c.what.type == EventColumn::Type::integer;
      append(*c.set, integer ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE, c.width(), written, waiting,
             integer ? static_cast<const void*>(c.integers.data()) : c.numbers.data());
      c.integers.clear();
      c.numbers.clear();
    }
    written += waiting;
    waiting = 0;
  }
  void close() {
    for (auto& c : columns) c.set.reset();
    group.reset();
    file.reset();
  }
};

EventFile::EventFile(std::filesystem::path place, std::vector<EventColumn> columns,
                     const std::vector<FileNote>& notes)
    : data_(new Data) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // failures are told by exceptions
  data_->place = std::move(place);
  data_->temporary = data_->place.string() + ".partial-" + std::to_string(::getpid());
  std::error_code ignored;
  if (std::filesystem::is_directory(data_->place, ignored))
    throw InputError(data_->place.string() + ": found a folder, expected a place for a file");
  data_->file.emplace(make_file(data_->temporary), H5Fclose);
  add_notes(*data_->file, notes);
  data_->group.emplace(make_group(*data_->file, "events"), H5Gclose);
  for (auto& column : columns) {
    Data::Column c{std::move(column), nullptr, {}, {}};
    const bool integer = c.what.type == EventColumn::Type::integer;
    c.set = std::make_unique<Handle>(
        make_set(*data_->group, c.what.name, integer ? H5T_STD_I64LE : H5T_IEEE_F64LE, c.width(), block,
                 integer),
        H5Dclose);
    note(*c.set, "unit", c.what.unit);
    note(*c.set, "description", c.what.description);
    data_->columns.push_back(std::move(c));
  }
}

EventFile::~EventFile() {
  data_->close();
  std::error_code ignored;
  std::filesystem::remove(data_->temporary, ignored);  // after `commit` there is none
}

void EventFile::add(std::size_t column, std::int64_t value) {
  data_->columns[column].integers.push_back(value);
}
void EventFile::add(std::size_t column, double value) { data_->columns[column].numbers.push_back(value); }

void EventFile::end_row() {
  if (++data_->waiting == block) data_->write_block();
}

void EventFile::add_table(const std::string& name, const std::string& unit, const std::string& description,
                          const std::vector<double>& values, std::size_t width) {
  const hsize_t rows = values.size() / width;
  const Handle set(make_set(*data_->file, name, H5T_IEEE_F64LE, width, rows > 0 ? rows : 1, false), H5Dclose);
  note(set, "unit", unit);
  note(set, "description", description);
  append(set, H5T_NATIVE_DOUBLE, width, 0, rows, values.data());
}

void EventFile::commit() {
  if (data_->waiting > 0) data_->write_block();
  hdf5_check(H5Fflush(*data_->file, H5F_SCOPE_GLOBAL));
  data_->close();
  std::filesystem::rename(data_->temporary, data_->place);
}

}  // namespace edmill::outputs
