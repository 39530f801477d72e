// Files that appear whole or not at all; devices and pipes are written through.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <streambuf>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "base/digest.hpp"
#include "base/errors.hpp"

namespace edmill::io {

/// @param error  errno; 0 when it is not known
std::runtime_error not_written(const std::filesystem::path& place, int error = 0);

/// Thrown when nobody reads a pipe any more, so that the rest of the output is not wanted.
class PipeClosed : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws PipeClosed, or what `not_written` returns.
[[noreturn]] void throw_not_written(const std::filesystem::path& place, int error);

/// Writes to a descriptor; keeps the error number of a failure and the digest of all bytes.
class FileBuffer : public std::streambuf {
 public:
  FileBuffer() = default;
  FileBuffer(const FileBuffer&) = delete;
  FileBuffer& operator=(const FileBuffer&) = delete;
  /// Closes without writing what is still in the buffer.
  ~FileBuffer() override;

  /// Takes over a descriptor positioned after `size` bytes with this digest.
  void open(int descriptor, std::uint64_t size = 0, Sha256 digest = {});
  /// @return whether everything was written
  bool close();
  /// Discards the buffer and closes.
  void drop();

  int error() const { return error_; }  ///< errno of the first failure
  /// Number of bytes flushed so far, including those that preceded `open`.
  std::uint64_t size() const { return size_; }
  std::string digest() const { return digest_.hex(); }
 protected:
  int_type overflow(int_type c) override;
  int sync() override;
 private:
  static constexpr std::size_t size_of_buffer = 1 << 16;

  std::vector<char> bytes_;
  int descriptor_ = -1, error_ = 0;
  std::uint64_t size_ = 0;
  Sha256 digest_;
};

/// The descriptor of this process that a path names: /dev/stdout, /dev/fd/63, a link to one.
std::optional<int> descriptor_named(const std::filesystem::path& path);
/// Another descriptor of the same open file, above the standard ones. @return -1 with errno
int duplicate(int descriptor);

/// Whether a path names a device, a pipe or a socket, if only by a descriptor.
bool is_device(const std::filesystem::path& path);

/// Whether a name ends as those of temporary files do.
bool is_temporary(const std::string& name);

/// The place of a file and its temporary name. Devices, pipes and sockets are written through;
/// anything else, also the target of a link, is replaced.
struct Destination {
  std::filesystem::path named, place;  ///< as given; with links followed
  bool through = false;
  std::filesystem::path temporary;  ///< beside the place, or among the system's temporary files
  bool kept = false;  ///< a checkpoint names the temporary file; else it is removed at the end

  /// @param beside  where the temporary file is made, if not beside the place
  /// @throws InputError for a folder and for links that lead nowhere
  explicit Destination(std::filesystem::path given, std::filesystem::path beside = {});
  Destination(const Destination&) = delete;
  Destination& operator=(const Destination&) = delete;
  ~Destination();

  /// A descriptor of what is written through, or -1 with errno.
  int open_through() const;
  /// Moves the complete temporary file into place, or copies it through. @throws std::runtime_error
  void commit() const;

  /// @throws InputError for a device, pipe or socket, which a resumed run could not continue
  void require_file() const;
  /// Saves the name of the temporary file. @return loading: the run's, which may be gone
  /// @throws InputError unless it is such a name: no other file is touched
  std::filesystem::path archive(Archive& a);
  /// Continues with the file that a run left. @param is_kept  a checkpoint names it still
  void continue_with(const std::filesystem::path& left, bool is_kept);
  /// The error for a file whose bytes differ from those in the checkpoint of its run.
  InputError another_file() const;
 private:
  std::filesystem::path beside_;
};

/// A file that is made under another name until it is put in place.
class WholeFile {
 public:
  virtual ~WholeFile() = default;
  /// Puts it in place. @throws std::runtime_error when that fails; the old file is then kept
  virtual void commit() = 0;
  /// Its path as given; empty for a device, and for a file that has rows of other runs as well.
  virtual std::filesystem::path place() const = 0;
};

/// A file that `commit` moves into place; without it, the old one stays. See Destination.
class AtomicFile : public WholeFile {
 public:
  /// @param append  the content of the old file is kept before the new one
  /// @param beside  as of Destination @throws InputError when the temporary file cannot be opened
  explicit AtomicFile(const std::filesystem::path& place, bool append = false,
      const std::filesystem::path& beside = {});

  /// @throws std::runtime_error when anything was not written: a long run must not continue in vain
  std::ostream& stream() {
    if (!stream_) fail();
    return stream_;
  }

  /// Writes the rest; then nothing can fail for lack of space. @throws std::runtime_error
  void complete();
  /// Completes the file and puts it in place.
  void commit() override;
  std::filesystem::path place() const override {
    return append_ || destination_.through ? std::filesystem::path() : destination_.named;
  }

  /// Flushes the file to disk. @throws std::runtime_error when anything was not written
  void sync();

  /// Saves or loads a record of what was written, for a checkpoint; the temporary file is then kept
  /// even without `commit`. Loading continues that file, or a copy of the committed one.
  /// @throws InputError when neither begins with exactly the bytes that were written
  void archive(Archive& a);
 private:
  [[noreturn]] void fail() const { throw_not_written(destination_.named, buffer_.error()); }
  void prepend_others();
  void go_on_from(const std::filesystem::path& left, std::uint64_t size, const std::string& digest);
  std::optional<Sha256> found_beginning(
      const std::filesystem::path& left, std::uint64_t size, const std::string& digest) const;

  Destination destination_;
  FileBuffer buffer_;
  std::ostream stream_{&buffer_};
  bool append_, complete_ = false;
  bool synced_ = false;   ///< it is complete and on the disk
  bool dropped_ = false;  ///< its rows are in place already: see `archive`
};

}  // namespace edmill::io
