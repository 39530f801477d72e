// Output folders: locks, temporary files of killed processes, the record of the files written.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace edmill::io {

/// Creates the folder, with its parents. @throws InputError when it cannot be created or written to
void prepare_folder(const std::filesystem::path& folder);

/// A lock on a folder; the system releases it when the process ends, however it ends.
class FolderLock {
 public:
  /// The exclusive lock of a run, or the shared lock of a single file that a user has named.
  enum class Kind { alone, shared };

  /// @throws InputError when another process holds a lock that excludes this one
  explicit FolderLock(const std::filesystem::path& folder, Kind kind = Kind::alone);
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;
  ~FolderLock();

  /// False where the file system has no locks; then nothing keeps another process out.
  bool held() const { return descriptor_ >= 0; }
 private:
  int descriptor_;
};

/// A file whose name a user has given, for one result: `--out`, `--json`, `--draw`,
/// `--certificate`. Made before the work, it refuses the folder of a run early. Without a name
/// there is no file.
class NamedFile {
 public:
  /// @throws InputError when a run is being written into its folder
  explicit NamedFile(std::filesystem::path place);

  /// Writes the whole file, and makes the folders above it when they are absent.
  /// @throws InputError when it cannot be made, std::runtime_error when anything was not written
  void write(const std::function<void(std::ostream&)>& put);
  void write(const std::string& text) {
    write([&](std::ostream& out) { out << text; });
  }
 private:
  std::filesystem::path place_, folder_;  ///< no folder where the place is written through
  std::optional<FolderLock> lock_;
};

/// Removes temporary files of killed processes. @pre the caller holds the folder's lock
void remove_temporaries(const std::filesystem::path& folder);

/// Asks the system to write the contents of a file or a folder to disk. @throws std::runtime_error
void sync_to_disk(const std::filesystem::path& place);

/// Name of the record of written files; a later run removes only files in the record.
inline constexpr const char* file_record_name = ".edmill-files";

/// Adds files inside the folder to its record; to be called before they are put in place.
/// @throws std::runtime_error when the record was not written
void record_files(
    const std::filesystem::path& folder, const std::vector<std::filesystem::path>& files);

/// @throws InputError when one of these files of the folder exists and is not in the record
void require_own_files(const std::filesystem::path& folder, const std::vector<std::string>& names);

/// Removes recorded files that are not in `files`, which becomes the record, and empty folders.
/// @throws std::runtime_error when the record was not written
void remove_other_files(
    const std::filesystem::path& folder, const std::vector<std::filesystem::path>& files);

/// Folders below this one that contain recorded files.
std::vector<std::filesystem::path> recorded_folders(const std::filesystem::path& folder);

}  // namespace edmill::io
