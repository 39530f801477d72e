// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "base/archive.hpp"

namespace edmill::io {

/// Creates the folder, with its parents, when it is absent.
/// @throws InputError when it cannot be created or written to
void prepare_folder(const std::filesystem::path& folder);

/// The name of a temporary file of `place` as a checkpoint has it, which can come from elsewhere.
/// @throws InputError unless it is such a name: no other file is opened, changed or removed for it
std::string temporary_name_from(const std::string& found, const std::filesystem::path& place);

/// A shared or exclusive lock on a folder; the system releases it when the process is killed.
class FolderLock {
 public:
  /// A run with checkpoints needs an exclusive lock, since another could continue with the same temporary
  /// files.
  /// @throws InputError when another run holds the lock
  FolderLock(const std::filesystem::path& folder, bool alone);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  int descriptor_;
};

/// A mark in the names of this process's temporary files that no other process uses.
const std::string& temporary_mark();

/// The temporary name of the file for `place`, in the same folder.
std::filesystem::path temporary_name(const std::filesystem::path& place);

/// Removes temporary files of killed runs for a file, or for files that begin with its stem.
/// @param kept  the mark of the files to keep
void remove_temporaries(const std::filesystem::path& place, const std::string& kept);

/// Up to 4096 bytes before the position `size` of a file, to recognise it; nothing when it is shorter than
/// `size`.
std::optional<std::string> bytes_before(const std::filesystem::path& file, std::uint64_t size);

/// Asks the system to write the contents of a file or a folder to disk. @throws std::runtime_error
void sync_to_disk(const std::filesystem::path& place);

/// A file that is written under a temporary name in the same folder and moved into place by `commit`. Without
/// it, the old file stays unchanged.
class AtomicFile {
 public:
  /// @param append  the content of the old file is kept before the new one
  /// @throws InputError when the temporary file cannot be opened
  explicit AtomicFile(std::filesystem::path place, bool append = false);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  /// @throws std::runtime_error when anything was not written: a long run must not continue to its end for
  /// nothing
  std::ostream& stream() {
    if (!stream_) fail();
    return stream_;
  }

  /// @throws std::runtime_error when anything was not written; the old file is then kept
  void commit();

  /// Flushes the file to disk. @throws std::runtime_error when anything was not written
  void sync();

  /// The length written, for a checkpoint; the temporary file is then kept even without `commit`.
  /// Loading continues from there, with that file, or a copy of the committed one when it is gone.
  /// @throws InputError when neither matches the checkpoint
  void archive(Archive& a);

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path place_, temporary_;
  std::ofstream stream_;
  bool append_, kept_ = false;
};

}  // namespace edmill::io
