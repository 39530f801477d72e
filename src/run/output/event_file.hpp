// The event log as HDF5: one dataset for each column, so that a reader takes only what it needs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "io/atomic_file.hpp"
#include "io/table.hpp"

namespace edmill::output {

/// A column of the log.
struct EventColumn {
  enum class Type {
    integer,
    number,
    vector
  };  ///< 64-bit integer, 64-bit number, three of those a row
  std::string name, unit, description;
  Type type;
};

/// Written in blocks under a temporary name; `commit` puts it in place. The same rows make the same
/// bytes: no time stamps. Integers are compressed; the digits of measured numbers are noise.
class EventFile : public io::WholeFile {
 public:
  EventFile(const std::filesystem::path& place, std::vector<EventColumn> columns,
      const std::vector<io::FileNote>& notes);
  EventFile(const EventFile&) = delete;
  EventFile& operator=(const EventFile&) = delete;
  ~EventFile() override;

  void add(std::size_t column, std::int64_t value);
  void add(std::size_t column, double value);
  /// Ends a row, after a value, or three for a vector, was added to every column.
  void end_row();

  /// A table of its own beside the events: rows of `width` numbers.
  void add_table(const std::string& name, const std::string& unit, const std::string& description,
      const std::vector<double>& values, std::size_t width);

  /// Writes the remaining rows. @throws std::runtime_error when anything was not written
  void complete();
  /// @pre it is complete
  void commit() override;
  std::filesystem::path place() const override;

  /// Saves or loads the progress of the file, for a checkpoint; from then on the temporary file is
  /// kept even without `commit`. HDF5 cannot open a file whose writer was killed, but a block never
  /// changes once it is written: loading rebuilds the file from the blocks at the positions in the
  /// checkpoint.
  /// @throws InputError when the blocks there differ in any byte
  void archive(Archive& a);
 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace edmill::output
