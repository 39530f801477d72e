// A file that appears whole or not at all.
#pragma once

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "io/destination.hpp"
#include "io/file_buffer.hpp"

namespace edmill::io {

/// A file that is written under a temporary name in the same folder and moved into place by `commit`. Without
/// it, the old file stays unchanged. Devices and pipes are written through.
class AtomicFile {
 public:
  /// @param append  the content of the old file is kept before the new one
  /// @throws InputError when the temporary file cannot be opened
  explicit AtomicFile(const std::filesystem::path& place, bool append = false);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

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
  std::vector<std::filesystem::path> places() const;

  /// Flushes the file to disk. @throws std::runtime_error when anything was not written
  void sync();

  /// What was written, for a checkpoint; the temporary file is then kept even without `commit`. Loading
  /// continues from there, with that file, or a copy of the committed one when it is gone.
  /// @throws InputError when neither begins with exactly the bytes that were written
  void archive(Archive& a);

 private:
  [[noreturn]] void fail() const;
  void open(int more_flags);
  void go_on_from(const std::string& name, std::uint64_t size, const std::string& digest);
  std::optional<Sha256> found_beginning(std::uint64_t size, const std::string& digest,
                                        const std::filesystem::path& fresh) const;

  Destination destination_;
  std::filesystem::path temporary_;
  FileBuffer buffer_;
  std::ostream stream_{&buffer_};
  bool append_, kept_ = false, complete_ = false;
  bool dropped_ = false;  ///< its rows are in place already: see `archive`
};

}  // namespace edmill::io
