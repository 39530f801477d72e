// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "base/archive.hpp"

namespace edmill::io {

/// Makes the folder, with its parents, when it is absent.
/// @throws InputError when it cannot be made or written to
void prepare_folder(const std::filesystem::path& folder);

/// Shared or sole use of a folder; the system takes it back from a process that is killed.
class FolderLock {
 public:
  /// A run that leaves checkpoints must be alone, since another could go on with the same temporary files.
  /// @throws InputError when another run is in the way
  FolderLock(const std::filesystem::path& folder, bool alone);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  int descriptor_;
};

/// What the names of this process's temporary files have in common, and those of no other process.
const std::string& temporary_mark();

/// The name under which what will stand in `place` is written, in the same folder.
std::filesystem::path temporary_name(const std::filesystem::path& place);

/// Removes temporary files that killed runs have left for a file, or files that begin with its stem.
/// @param kept  the mark of those that stay
void remove_temporaries(const std::filesystem::path& place, const std::string& kept);

/// Up to 4096 bytes before the place `size` of a file, to know it again; nothing when it is shorter than
/// `size`.
std::optional<std::string> bytes_before(const std::filesystem::path& file, std::uint64_t size);

/// Asks the system to bring a file's, or a folder's, contents to the disk. @throws std::runtime_error
void sync_to_disk(const std::filesystem::path& place);

/// A file that is written under a temporary name beside its place and put there by `commit`. Without it, the
/// file that stood there stays as it was.
class AtomicFile {
 public:
  /// @param append  what stands there when the file is put in place is kept before it
  /// @throws InputError when the temporary file cannot be opened
  explicit AtomicFile(std::filesystem::path place, bool append = false);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  /// @throws std::runtime_error when anything was not written: a long run must not go on to its end for
  /// nothing
  std::ostream& stream() {
    if (!stream_) fail();
    return stream_;
  }

  /// @throws std::runtime_error when anything was not written; the old file is then still there
  void commit();

  /// Brings what was written to the disk. @throws std::runtime_error when anything was not
  void sync();

  /// How far it is written, for a checkpoint; the temporary file is then no longer removed without `commit`.
  /// Loading goes on from there, with that file, or a copy of what was put in place when it is gone.
  /// @throws InputError when neither is what the checkpoint was made with
  void archive(Archive& a);

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path place_, temporary_;
  std::ofstream stream_;
  bool append_, kept_ = false;
};

}  // namespace edmill::io
