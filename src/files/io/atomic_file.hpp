// Files that appear whole or not at all, alone or several together.
#pragma once

#include <filesystem>
#include <functional>
#include <list>
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
  /// @param beside  where the temporary file is made, if not beside the place
  /// @throws InputError when the temporary file cannot be opened
  explicit AtomicFile(const std::filesystem::path& place, bool append = false,
                      const std::filesystem::path& beside = {});

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
  void prepend_others();
  void go_on_from(const std::filesystem::path& left, std::uint64_t size, const std::string& digest);
  std::optional<Sha256> found_beginning(const std::filesystem::path& left, std::uint64_t size,
                                        const std::string& digest) const;

  Destination destination_;
  FileBuffer buffer_;
  std::ostream stream_{&buffer_};
  bool append_, complete_ = false;
  bool synced_ = false;   ///< it is complete and on the disk
  bool dropped_ = false;  ///< its rows are in place already: see `archive`
};

/// Files that are complete at once and put in place together.
class AtomicFiles {
 public:
  /// Writes a file, as AtomicFile does. @throws std::runtime_error when anything was not written
  void add(const std::filesystem::path& place, const std::function<void(std::ostream&)>& put,
           const std::filesystem::path& beside = {});
  void commit();
  void clear() { files_.clear(); }
  std::vector<std::filesystem::path> places() const;
  /// @pre loading: files of the same places were added
  void archive(Archive& a);

 private:
  std::list<AtomicFile> files_;
};

}  // namespace edmill::io
