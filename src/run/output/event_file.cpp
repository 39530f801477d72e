#include "output/event_file.hpp"

#include <fstream>
#include <optional>

#include "base/digest.hpp"
#include "base/errors.hpp"
#include "io/hdf5_parts.hpp"
#include "io/output_folder.hpp"

namespace edmill::output {

using io::Handle;
using io::hdf5_check;

/// Position of a chunk in the file [bytes].
struct ChunkPlace {
  std::uint64_t at = 0, size = 0;
  std::uint64_t end() const { return at + size; }
  void archive(Archive& a) { a(at, size); }
  bool operator==(const ChunkPlace&) const = default;
};

namespace {
constexpr hsize_t block = 16384;  ///< rows that are written at a time

ChunkPlace place_of_chunk(hid_t set, hsize_t row) {
  const hsize_t offset[2] = {row, 0};
  unsigned filters = 0;
  haddr_t at = 0;
  hsize_t size = 0;
  hdf5_check(H5Dget_chunk_info_by_coord(set, offset, &filters, &at, &size));
  return {at, size};
}

std::string bytes_of_chunk(hid_t set, hsize_t row, std::uint64_t size) {
  const hsize_t offset[2] = {row, 0};
  unsigned filters = 0;
  std::string bytes(size, '\0');
  hdf5_check(H5Dread_chunk(set, H5P_DEFAULT, offset, &filters, bytes.data()));
  return bytes;
}

/// Appends a chunk of another file without changing it.
void append_chunk(
    hid_t set, std::size_t width, hsize_t before, hsize_t rows, const std::string& bytes) {
  const hsize_t size[2] = {before + rows, width}, offset[2] = {before, 0};
  hdf5_check(H5Dset_extent(set, size));
  hdf5_check(H5Dwrite_chunk(set, H5P_DEFAULT, 0, offset, bytes.size(), bytes.data()));
}

}  // namespace

struct EventFile::Data {
  struct Column {
    EventColumn what;
    std::optional<Handle> set{};
    std::vector<std::int64_t> integers{};
    std::vector<double> numbers{};
    std::vector<ChunkPlace> chunks{};  ///< those that are full
    std::size_t width() const { return what.type == EventColumn::Type::vector ? 3 : 1; }
  };

  explicit Data(const std::filesystem::path& place) : destination(place) {}

  io::Destination destination;
  std::optional<Handle> file, group;
  std::vector<Column> columns;
  hsize_t written = 0, waiting = 0;
  Sha256 digest;  ///< of the blocks as written in the file

  /// Calls `work`, which uses HDF5; a failure is reported with the file's name.
  template <class Work> void with_name(const Work& work) const {
    try {
      work();
    } catch (const io::Hdf5Error& error) {
      throw io::not_written(destination.named, error.system_error);
    }
  }

  void begin(std::vector<EventColumn> given, const std::vector<io::FileNote>& notes) {
    file.emplace(io::make_file(destination.temporary));
    io::add_notes(*file, notes);
    group.emplace(io::make_group(*file, "events"));
    for (auto& column : given) {
      Column& c = columns.emplace_back(Column{.what = std::move(column)});
      const bool integer = c.what.type == EventColumn::Type::integer;
      c.set.emplace(io::make_set(*group, c.what.name, integer ? H5T_STD_I64LE : H5T_IEEE_F64LE,
          c.width(), block, integer));
      io::note(*c.set, "unit", c.what.unit);
      io::note(*c.set, "description", c.what.description);
    }
  }
  void write_block() {
    for (auto& c : columns) {
      const bool integer = c.what.type == EventColumn::Type::integer;
      io::append(*c.set, integer ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE, c.width(), written,
          waiting, integer ? static_cast<const void*>(c.integers.data()) : c.numbers.data());
      c.integers.clear();
      c.numbers.clear();
      c.chunks.push_back(place_of_chunk(*c.set, written));
      digest.add(bytes_of_chunk(*c.set, written, c.chunks.back().size));
    }
    written += waiting;
    waiting = 0;
  }
  /// Copies the full blocks of a file that has the same columns.
  void take_blocks(const std::filesystem::path& from, hsize_t rows) {
    std::ifstream in(from, std::ios::binary);
    std::error_code none;
    const auto size = std::filesystem::file_size(from, none);
    if (none && rows > 0)
      throw InputError(
          destination.named.string() + ": no such file: restore the one that the run left");
    std::string bytes;
    for (written = 0; written < rows; written += block)
      for (auto& c : columns) {
        const ChunkPlace& chunk = c.chunks.at(written / block);
        if (chunk.at > size || chunk.size > size - chunk.at)
          throw InputError(destination.named.string() +
              ": the file ends before a block of the checkpoint: restore the files as the run left "
              "them");
        bytes.resize(chunk.size);
        in.seekg(static_cast<std::streamoff>(chunk.at));
        if (!in.read(bytes.data(), static_cast<std::streamsize>(bytes.size())))
          throw std::runtime_error(from.string() + ": could not be read");
        digest.add(bytes);
        append_chunk(*c.set, c.width(), written, block, bytes);
        EDMILL_REQUIRE(
            place_of_chunk(*c.set, written) == chunk, "a block has the place that it had");
      }
  }
  void close() {
    for (auto& c : columns) c.set.reset();
    group.reset();
    file.reset();
  }
};

EventFile::EventFile(const std::filesystem::path& place, std::vector<EventColumn> columns,
    const std::vector<io::FileNote>& notes)
    : data_(new Data(place)) {
  io::hdf5_begin();
  data_->with_name([&] { data_->begin(std::move(columns), notes); });
}

EventFile::~EventFile() { data_->close(); }

void EventFile::add(std::size_t column, std::int64_t value) {
  data_->columns[column].integers.push_back(value);
}
void EventFile::add(std::size_t column, double value) {
  data_->columns[column].numbers.push_back(value);
}

void EventFile::end_row() {
  if (++data_->waiting == block) data_->with_name([&] { data_->write_block(); });
}

void EventFile::add_table(const std::string& name, const std::string& unit,
    const std::string& description, const std::vector<double>& values, std::size_t width) {
  data_->with_name([&] {
    const hsize_t rows = values.size() / width;
    const Handle set =
        io::make_set(*data_->file, name, H5T_IEEE_F64LE, width, rows > 0 ? rows : 1, false);
    io::note(set, "unit", unit);
    io::note(set, "description", description);
    io::append(set, H5T_NATIVE_DOUBLE, width, 0, rows, values.data());
  });
}

void EventFile::complete() {
  data_->with_name([&] {
    if (data_->waiting > 0) data_->write_block();
    hdf5_check(H5Fflush(*data_->file, H5F_SCOPE_GLOBAL));
  });
  data_->close();
}

void EventFile::commit() { data_->destination.commit(); }

std::filesystem::path EventFile::place() const {
  return data_->destination.through ? std::filesystem::path() : data_->destination.named;
}

void EventFile::archive(Archive& a) {
  auto& d = *data_;
  if (!a.loading()) io::sync_to_disk(d.destination.temporary);
  hsize_t rows = d.written;
  a(rows, d.waiting);
  for (auto& c : d.columns) a(c.integers, c.numbers, c.chunks);
  for (const auto& c : d.columns)
    if (a.loading() && (rows % block != 0 || c.chunks.size() != rows / block))
      throw InputError(
          d.destination.named.string() + ": the checkpoint has blocks for another number of rows");
  std::string digest = d.digest.hex();
  a(digest);
  const auto left = d.destination.archive(a);
  if (!a.loading()) return;
  std::error_code ignored;
  const bool is_there = std::filesystem::exists(left, ignored);
  d.take_blocks(is_there ? left : d.destination.place, rows);
  if (d.digest.hex() != digest) throw d.destination.another_file();
  // The blocks have the same places in both files, so that the checkpoint is valid for either.
  std::filesystem::rename(d.destination.temporary, left);
  d.destination.continue_with(left, is_there);
}

}  // namespace edmill::output
