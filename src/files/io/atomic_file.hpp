// Files that appear whole or not at all, alone or several together.
#pragma once

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "base/digest.hpp"
#include "io/destination.hpp"

namespace edmill::io {

/// A file that is written under a temporary name in the same folder and moved into place by `commit`. Without
/// it, the old file stays unchanged. Devices and pipes are written through.
class AtomicFile {
 public:
  /// @param append  the content of the old file is kept before the new one
  /// @throws InputError when the temporary file cannot be opened
  explicit AtomicFile(const std::filesystem::path& place, bool append = false);

  /// @throws std::runtime_error when anything was not written: a long run must not go on for nothing
  std::ostream& stream() {
    if (!stream_) fail();
    return stream_;
  }

  /// Writes what is left: nothing can fail for lack of space after it, and nothing more can be written.
  /// @throws std::runtime_error when anything was not written
  void complete();
  /// Completes it and puts it in place.
  /// @throws std::runtime_error when anything was not written; the old file is then kept
  void commit();
  /// Its place, as given, when that holds nothing else: no device, and no rows of other runs.
  std::vector<std::filesystem::path> places() const {
    return append_ ? std::vector<std::filesystem::path>{} : destination_.places();
  }

  /// Flushes the file to disk. @throws std::runtime_error when anything was not written
  void sync();

  /// What was written, for a checkpoint; the temporary file is then kept even without `commit`. Loading
  /// continues from there, with that file, or a copy of the committed one when it is gone.
  /// @throws InputError when neither begins with exactly the bytes that were written
  void archive(Archive& a);

 private:
  [[noreturn]] void fail() const { throw_not_written(destination_.named, buffer_.error()); }
  void go_on_from(const std::filesystem::path& fresh, std::uint64_t size, const std::string& digest);
  std::optional<Sha256> found_beginning(const std::filesystem::path& fresh, std::uint64_t size,
                                        const std::string& digest) const;

  Destination destination_;
  Temporary temporary_;
  FileBuffer buffer_;
  std::ostream stream_{&buffer_};
  bool append_, complete_ = false;
  bool dropped_ = false;  ///< its rows are in place already: see `archive`
};

/// Files are written into a temporary folder; `commit` moves them into place. Other files stay.
class AtomicFolder {
 public:
  /// @throws InputError when the temporary folder cannot be made
  explicit AtomicFolder(const std::filesystem::path& place);

  const std::filesystem::path& place() const { return named_; }
  /// Adds a file. @throws std::runtime_error when it was not written
  void add(const std::string& name, const std::string& text);
  void commit();
  std::vector<std::filesystem::path> places() const;

  /// For a checkpoint; the temporary folder is then kept even without `commit`. Loading continues with
  /// exactly the files that were added so far, from that folder, or from where they were committed.
  /// @throws InputError when one is gone or has other content
  void archive(Archive& a);

 private:
  void note(const std::string& name, const std::string& text);
  void go_on_from(const std::filesystem::path& fresh, const std::vector<std::string>& files,
                  const std::string& digest);

  std::filesystem::path named_, place_;  ///< as given; with links followed
  Temporary temporary_;
  std::vector<std::string> names_;
  std::size_t synced_ = 0;  ///< of the names
  Sha256 digest_;           ///< of names and texts
};

}  // namespace edmill::io
